#include "io/mat5_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "counted.hpp"
#include "io/inflate.hpp"
#include "io/mat5_matrix.hpp"

namespace zwidth::internal {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::size_t header_size = 128;
constexpr std::size_t largest_variable = std::size_t{1} << 30;  // bytes

/// A variable in the file: a matrix element, compressed or not.
struct Variable {
  std::uintmax_t offset = 0;  ///< of its tag in the file
  Bytes matrix;               ///< what follows the tag of the matrix element
};

/// The variables of a file of version 5, one after the other.
class Variables {
 public:
  static tl::expected<Variables, InputError> start(InputFile file, std::size_t most_unpacked);

  /// The next variable; nothing at the file's end. A variable that does not unpack is the inner refusal.
  using Result = tl::expected<Variable, Problem>;
  [[nodiscard]] tl::expected<std::optional<Result>, InputError> next();
  [[nodiscard]] tl::expected<Variable, InputError> at(std::uintmax_t offset);

  [[nodiscard]] ByteOrder order() const { return order_; }
  [[nodiscard]] const InputFile& file() const { return file_; }
  [[nodiscard]] std::uintmax_t position() const { return position_; }

  /// Where MATLAB keeps what its objects need; no variable of the user's.
  [[nodiscard]] std::uintmax_t subsystem() const { return subsystem_; }

 private:
  Variables(InputFile file, std::size_t most_unpacked) : file_(std::move(file)), most_unpacked_(most_unpacked) {}
  [[nodiscard]] tl::unexpected<InputError> damaged(Problem how) const {
    how.evidence.push_back(counted("byte", position_));
    return tl::unexpected(InputError({.file = file_.source()}, std::move(how)));
  }

  InputFile file_;
  std::size_t most_unpacked_;
  std::size_t unpacked_ = 0;  // so far
  ByteOrder order_ = ByteOrder::little;
  std::uintmax_t position_ = header_size;
  std::uintmax_t subsystem_ = 0;
};

Problem ends_inside(std::string part) {
  return {.code = ProblemCode::data_end_inside, .subjects = {{"part", std::move(part)}}};
}

Problem unpacks_to_more(std::size_t most) {
  return {.code = ProblemCode::unpacks_to_more, .evidence = {counted("most", most)}};
}

InputError changed_while_read(const InputFile& file) {
  return {{.file = file.source()}, {.code = ProblemCode::changed_while_read}};
}

std::span<char> as_characters(std::span<unsigned char> bytes) {
  return {reinterpret_cast<char*>(bytes.data()), bytes.size()};
}

tl::expected<Variables, InputError> Variables::start(InputFile file, std::size_t most_unpacked) {
  Variables variables(std::move(file), most_unpacked);
  std::array<unsigned char, header_size> header{};
  const auto size = variables.file_.read(as_characters(header));
  if (!size) return tl::unexpected(size.error());
  variables.order_ = header[126] == 'I' ? ByteOrder::little : ByteOrder::big;
  variables.subsystem_ = load<std::uint64_t>(header.data() + 116, variables.order_);
  if (*size < header_size) {
    variables.position_ = *size;
    return variables.damaged(ends_inside("its header"));
  }
  return variables;
}

tl::expected<std::optional<Variables::Result>, InputError> Variables::next() {
  std::array<unsigned char, 8> tag{};
  const auto tag_size = file_.read(as_characters(tag));
  if (!tag_size) return tl::unexpected(tag_size.error());
  if (*tag_size == 0) return std::nullopt;
  if (*tag_size < tag.size()) return damaged(ends_inside("a variable"));
  const auto type = load<std::uint32_t>(tag.data(), order_);
  const std::size_t size = load<std::uint32_t>(tag.data() + 4, order_);
  if (type != mat5_matrix && type != mat5_compressed) {
    return damaged({.code = ProblemCode::wrong_element,
                    .evidence = {counted("type", type), counted("bytes", size)},
                    .subjects = {{"part", "variable"}}});
  }
  if (size > file_.size() || position_ + tag.size() > file_.size() - size) {
    const std::uintmax_t left = file_.size() - std::min<std::uintmax_t>(file_.size(), position_ + tag.size());
    return damaged({.code = ProblemCode::bytes_missing, .evidence = {counted("bytes", size), counted("left", left)}});
  }
  Variable variable{position_, Bytes(size)};
  const auto read = file_.read(as_characters(variable.matrix));
  if (!read) return tl::unexpected(read.error());
  if (*read < size) return damaged(ends_inside("a variable"));
  position_ += tag.size() + size;
  if (type == mat5_matrix) return Result(std::move(variable));

  const std::size_t left = most_unpacked_ - unpacked_;
  auto unpacked = inflate_all(variable.matrix, std::min(largest_variable, left));
  if (!unpacked && unpacked.error() == InflateFailure::too_large) {
    if (left >= largest_variable) return Result(tl::unexpected(unpacks_to_more(largest_variable)));
    Problem in_all = unpacks_to_more(most_unpacked_);
    in_all.evidence.push_back({"in_all", 1.0});
    return tl::unexpected(InputError({.file = file_.source()}, std::move(in_all)));
  }
  if (!unpacked) return Result(tl::unexpected(Problem{.code = ProblemCode::does_not_unpack}));
  unpacked_ += unpacked->size();
  // The outermost size is not used: matio writes one too large for text, and what is inside is checked anyway.
  constexpr std::ptrdiff_t tag_bytes = 8;
  if (unpacked->size() < tag_bytes || load<std::uint32_t>(unpacked->data(), order_) != mat5_matrix) {
    return Result(tl::unexpected(Problem{.code = ProblemCode::does_not_unpack}));
  }
  unpacked->erase(unpacked->begin(), unpacked->begin() + tag_bytes);
  variable.matrix = std::move(*unpacked);
  return Result(std::move(variable));
}

tl::expected<Variable, InputError> Variables::at(std::uintmax_t offset) {
  if (auto sought = file_.seek(offset); !sought) return tl::unexpected(std::move(sought.error()));
  position_ = offset;
  unpacked_ = 0;
  auto variable = next();
  if (!variable) return tl::unexpected(std::move(variable.error()));
  if (!*variable || !**variable) return tl::unexpected(changed_while_read(file_));
  return std::move(***variable);
}

/// Where an array's numbers are: the variable that holds it, and its index among the variable's arrays.
struct Place {
  std::uintmax_t offset = 0;
  std::size_t index = 0;
};

/// Reads arrays at their places. The variable of the last one is kept: its neighbours are often next.
class ArrayReader {
 public:
  ArrayReader(Variables variables, std::vector<Place> places)
      : variables_(std::move(variables)), places_(std::move(places)) {}

  tl::expected<std::vector<double>, InputError> values(std::size_t array) {
    const Place place = places_.at(array);
    if (!last_ || last_->offset != place.offset) {
      last_.reset();
      auto variable = variables_.at(place.offset);
      if (!variable) return tl::unexpected(std::move(variable.error()));
      last_ = std::move(*variable);
    }
    const auto matrix = read_mat5_matrix(last_->matrix, variables_.order());
    if (!matrix || place.index >= matrix->numbers.size()) {
      return tl::unexpected(changed_while_read(variables_.file()));
    }
    return mat5_numbers(matrix->numbers[place.index], variables_.order());
  }

 private:
  Variables variables_;
  std::vector<Place> places_;
  std::optional<Variable> last_;
};

void append(std::vector<SkippedMatArray>& skipped, std::vector<SkippedMatArray> more) {
  std::move(more.begin(), more.end(), std::back_inserter(skipped));
}

}  // namespace

tl::expected<MatFile, InputError> open_mat5_file(InputFile file, std::size_t most_unpacked, const Progress& progress) {
  auto variables = Variables::start(std::move(file), most_unpacked);
  if (!variables) return tl::unexpected(std::move(variables.error()));
  MatContents contents;
  std::vector<Place> places;
  const auto skip_damaged = [&](std::uintmax_t offset, Problem why) {
    contents.skip(fmt::format("byte {}", offset), SkippedMatArray::Kind::damaged, std::move(why));
  };
  for (;;) {
    const std::uintmax_t offset = variables->position();
    auto variable = variables->next();
    if (!variable) return tl::unexpected(std::move(variable.error()));
    if (!*variable) break;
    if (progress) {
      progress(static_cast<double>(variables->position()) / static_cast<double>(variables->file().size()));
    }
    if (!**variable) {
      skip_damaged(offset, (**variable).error());
      continue;
    }
    auto matrix = read_mat5_matrix((**variable)->matrix, variables->order());
    if (!matrix) {
      skip_damaged(offset, matrix.error());
      continue;
    }
    if (offset == variables->subsystem()) continue;
    for (std::size_t i = 0; i < matrix->contents.arrays.size(); ++i) {
      places.push_back({offset, i});
      contents.arrays.push_back(std::move(matrix->contents.arrays[i]));
    }
    append(contents.skipped, std::move(matrix->contents.skipped));
  }
  const auto reader = std::make_shared<ArrayReader>(std::move(*variables), std::move(places));
  return MatFile{std::move(contents), [reader](std::size_t array) { return reader->values(array); }};
}

}  // namespace zwidth::internal
