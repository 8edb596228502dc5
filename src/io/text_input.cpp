#include <span>
#include <string>
#include <utility>

#include "counted.hpp"
#include "io/input_file.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {
using namespace internal;
namespace {

tl::expected<std::string, InputError> read_all(InputFile& file) {
  auto text = file.read_up_to(device_file_size_limit + 1);  // one more tells a file at the limit from a longer one
  if (text && text->size() > device_file_size_limit) {
    return tl::unexpected(
        InputError({.file = file.source()}, {.code = ProblemCode::too_many_bytes_read,
                                             .evidence = {counted("most", device_file_size_limit >> 20)},
                                             .subjects = {{"kind", "device file"}}}));
  }
  return text;
}

}  // namespace

tl::expected<Device, InputError> read_device_file(const std::string& path, std::span<const std::string> overrides) {
  auto file = InputFile::open(path, "device file");
  if (!file) return tl::unexpected(std::move(file.error()));
  const auto text = read_all(*file);
  if (!text) return tl::unexpected(text.error());
  return parse_device(*text, file->source(), overrides);
}

}  // namespace zwidth
