#include "io/input_file.hpp"

#include <sys/types.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace zwidth::internal {

void InputFile::Close::operator()(std::FILE* file) const noexcept {
  if (file != stdin) std::fclose(file);
}

InputError InputFile::refusal(int error) const {
  return {InputPlace{.file = source_},
          Problem{.code = ProblemCode::cannot_be_read,
                  .subjects = {{"reason", std::generic_category().message(error)}, {"kind", kind_}}}};
}

tl::expected<InputFile, InputError> InputFile::open(const std::string& path, const std::string& kind) {
  const auto refused = [&kind](const std::string& source, const char* found) {
    return tl::unexpected(InputError(
        {.file = source}, {.code = ProblemCode::not_a_file, .subjects = {{"found", found}, {"kind", kind}}}));
  };
  InputFile input;
  input.kind_ = kind;
  if (path == "-") {
    input.source_ = "standard input";
    input.file_.reset(stdin);
    return input;
  }
  if (path.empty()) return refused("\"\"", "nothing");
  namespace fs = std::filesystem;
  input.source_ = path;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (error) return tl::unexpected(input.refusal(error.value()));
  if (fs::is_directory(status)) return refused(path, "directory");
  input.regular_ = fs::is_regular_file(status);
  if (!input.regular_ && !fs::is_fifo(status)) {
    return refused(path, "device");
  }
  input.file_.reset(std::fopen(path.c_str(), "rb"));
  if (!input.file_) return tl::unexpected(input.refusal(errno));
  if (input.regular_) {
    const std::uintmax_t size = fs::file_size(path, error);
    input.size_ = error ? 0 : size;
  }
  return input;
}

tl::expected<std::size_t, InputError> InputFile::read(std::span<char> bytes) {
  errno = 0;
  const std::size_t count = std::fread(bytes.data(), 1, bytes.size(), file_.get());
  if (std::ferror(file_.get())) return tl::unexpected(refusal(errno));
  return count;
}

tl::expected<std::string, InputError> InputFile::read_up_to(std::size_t most) {
  std::string text;
  std::array<char, 4096> part;
  while (text.size() < most) {
    const auto count = read(std::span(part).first(std::min(part.size(), most - text.size())));
    if (!count) return tl::unexpected(count.error());
    if (*count == 0) break;
    text.append(part.data(), *count);
  }
  return text;
}

tl::expected<void, InputError> InputFile::seek(std::uintmax_t offset) {
  if (fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0) return tl::unexpected(refusal(errno));
  return {};
}

}  // namespace zwidth::internal
