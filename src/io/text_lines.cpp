#include "io/text_lines.hpp"

#include <algorithm>
#include <utility>

#include "counted.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t block = std::size_t{1} << 20;
constexpr std::size_t longest_line = std::size_t{4} << 20;

}  // namespace

tl::expected<TextLines, InputError> TextLines::start(InputFile file) {
  TextLines lines(std::move(file));
  if (auto filled = lines.refill(); !filled) return tl::unexpected(std::move(filled.error()));
  return lines;
}

tl::expected<void, InputError> TextLines::refill() {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_),
            buffer_.begin());
  end_ -= begin_;
  begin_ = 0;
  if (end_ > longest_line) {
    return tl::unexpected(InputError({file_.source(), line_ + 1, 1},
                                     {.code = ProblemCode::too_many_bytes_read,
                                      .evidence = {counted("most", longest_line >> 20), counted("line", line_ + 1)}}));
  }
  buffer_.resize(end_ + block);
  const auto count = file_.read({buffer_.data() + end_, block});
  if (!count) return tl::unexpected(count.error());
  end_ += *count;
  bytes_read_ += *count;
  ended_ = *count < block;
  return {};
}

tl::expected<std::optional<TextLine>, InputError> TextLines::next(const Progress& progress) {
  std::size_t searched = 0;  // of the buffered text, without a line's end
  std::size_t length = buffered().find('\n');
  while (length == std::string_view::npos && !ended_) {
    searched = buffered().size();
    if (auto filled = refill(); !filled) return tl::unexpected(std::move(filled.error()));
    if (progress && file_.size() > 0) {
      progress(std::min(1.0, static_cast<double>(bytes_read_) / static_cast<double>(file_.size())));
    }
    length = buffered().find('\n', searched);
  }
  if (begin_ == end_) return std::nullopt;
  open_line_ = length == std::string_view::npos;
  std::string_view text = buffered().substr(0, length);
  begin_ = open_line_ ? end_ : begin_ + length + 1;
  if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
  return TextLine{++line_, text};
}

}  // namespace zwidth::internal
