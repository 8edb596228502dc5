#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

const std::string standard_input = "standard input";

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

tl::unexpected<InputError> refusal(const std::string& source, std::string what, std::string allowed) {
  return tl::unexpected(InputError{source, 0, 0, "", std::move(what), std::move(allowed)});
}

tl::unexpected<InputError> system_refusal(const std::string& source, int error) {
  return refusal(source, fmt::format("cannot be read: {}", std::generic_category().message(error)),
                 "must be a readable device file, or \"-\" for standard input");
}

tl::expected<std::string, InputError> read_all(std::FILE* file, const std::string& source) {
  std::string text(device_file_size_limit + 1, '\0');  // one more, to tell a file at the limit from a longer one
  errno = 0;
  text.resize(std::fread(text.data(), 1, text.size(), file));
  if (std::ferror(file)) return system_refusal(source, errno);
  if (text.size() > device_file_size_limit) {
    return refusal(source, fmt::format("is larger than {} MiB", device_file_size_limit >> 20),
                   "must be a device file, which takes a few hundred bytes");
  }
  return text;
}

tl::expected<std::string, InputError> read_text(const std::string& path) {
  if (path == "-") return read_all(stdin, standard_input);
  if (path.empty()) return refusal("\"\"", "is no file name", "must be a device file, or \"-\" for standard input");
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (error) return system_refusal(path, error.value());
  if (fs::is_directory(status)) return refusal(path, "is a directory", "must be a device file");
  if (!fs::is_regular_file(status) && !fs::is_fifo(status)) {
    return refusal(path, "is neither a file nor a pipe", "must be a device file, or \"-\" for standard input");
  }
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) return system_refusal(path, errno);
  return read_all(file.get(), path);
}

}  // namespace

tl::expected<Device, InputError> read_device_file(const std::string& path, std::span<const std::string> overrides) {
  const auto text = read_text(path);
  if (!text) return tl::unexpected(text.error());
  return parse_device(*text, path == "-" ? standard_input : path, overrides);
}

}  // namespace zwidth
