#include "io/mat5_matrix.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "counted.hpp"
#include "io/number_cell.hpp"

namespace zwidth::internal {
namespace {

using Bytes = std::span<const unsigned char>;
using Damage = tl::unexpected<Problem>;
using Kind = SkippedMatArray::Kind;

constexpr unsigned int8_type = 1;
constexpr unsigned uint8_type = 2;
constexpr unsigned int32_type = 5;
constexpr unsigned uint32_type = 6;
constexpr unsigned utf8_type = 16;

constexpr unsigned complex_flag = 0x0800;
constexpr unsigned logical_flag = 0x0200;

constexpr std::size_t most_dimensions = 32;
constexpr std::size_t longest_name = 1024;
constexpr std::size_t longest_field_name = 128;
constexpr std::size_t most_fields = 20000;  // in one variable, over all elements of its struct arrays

/// Bytes per number of an element's type; 0 for what holds no numbers.
std::size_t bytes_per_number(unsigned type) {
  constexpr std::array<std::size_t, 14> sizes{0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8};
  return type < sizes.size() ? sizes[type] : 0;
}

enum MatlabClass : unsigned {
  cell = 1,
  structure = 2,
  object = 3,
  text = 4,
  sparse = 5,
  first_numeric = 6,
  last_numeric = 15,
  function = 16,
  opaque = 17,
};

constexpr std::array<std::string_view, 10> numeric_classes{"double", "single", "int8",   "uint8", "int16",
                                                           "uint16", "int32",  "uint32", "int64", "uint64"};

std::string text_of(Bytes bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), 0);
  return as_utf8(std::string(bytes.begin(), end));
}

Damage wrong_element(std::string part, const Mat5Element& element) {
  return Damage({.code = ProblemCode::wrong_element,
                 .evidence = {counted("type", element.type), counted("bytes", element.bytes.size())},
                 .subjects = {{"part", std::move(part)}}});
}

Problem wrong_field(std::string field, std::int32_t value) {
  return {.code = ProblemCode::wrong_field,
          .evidence = {{"value", static_cast<double>(value)}},
          .subjects = {{"field", std::move(field)}}};
}

Problem bytes_missing(std::size_t announced, std::size_t left) {
  return {.code = ProblemCode::bytes_missing, .evidence = {counted("bytes", announced), counted("left", left)}};
}

/// What stands at the front of every matrix element but an opaque one.
struct MatrixHead {
  unsigned matlab_class = 0;
  bool is_complex = false;
  bool is_logical = false;
  std::vector<std::size_t> dimensions;
  std::string name;
};

class MatrixWalk {
 public:
  explicit MatrixWalk(ByteOrder order) : order_(order) {}

  /// `name` names what is inside a struct; a variable has its own.
  tl::expected<void, Problem> walk(Bytes bytes, const std::string* name, int depth);

  Mat5Matrix found;

 private:
  tl::expected<MatrixHead, Problem> take_head(Bytes& rest) const;
  tl::expected<std::string, Problem> take_name(Bytes& rest) const;
  tl::expected<void, Problem> add_numbers(const MatrixHead& head, const std::string& name, Bytes rest);
  tl::expected<void, Problem> walk_struct(const MatrixHead& head, const std::string& name, Bytes rest, int depth);
  tl::expected<std::vector<std::string>, Problem> take_field_names(Bytes& rest) const;

  ByteOrder order_;
  std::size_t fields_ = 0;
};

tl::expected<std::string, Problem> MatrixWalk::take_name(Bytes& rest) const {
  const auto element = take_mat5_element(rest, order_);
  if (!element) return Damage(element.error());
  const bool is_text = element->type == int8_type || element->type == uint8_type || element->type == utf8_type;
  if (!is_text || element->bytes.size() > longest_name) return wrong_element("name", *element);
  return text_of(element->bytes);
}

tl::expected<MatrixHead, Problem> MatrixWalk::take_head(Bytes& rest) const {
  MatrixHead head;
  const auto flags = take_mat5_element(rest, order_);
  if (!flags) return Damage(flags.error());
  if ((flags->type != uint32_type && flags->type != int32_type) || flags->bytes.size() != 8) {
    return wrong_element("flags", *flags);
  }
  const auto word = load<std::uint32_t>(flags->bytes.data(), order_);
  head.matlab_class = word & 0xFF;
  head.is_complex = (word & complex_flag) != 0;
  head.is_logical = (word & logical_flag) != 0;
  if (head.matlab_class != opaque) {
    const auto sizes = take_mat5_element(rest, order_);
    if (!sizes) return Damage(sizes.error());
    const std::size_t dimensions = sizes->bytes.size() / 4;
    if (sizes->type != int32_type || sizes->bytes.size() % 4 != 0 || dimensions < 2 || dimensions > most_dimensions) {
      return wrong_element("size", *sizes);
    }
    for (std::size_t i = 0; i < dimensions; ++i) {
      const auto size = load<std::int32_t>(sizes->bytes.data() + 4 * i, order_);
      if (size < 0) return Damage(wrong_field("size", size));
      head.dimensions.push_back(static_cast<std::size_t>(size));
    }
  }
  auto name = take_name(rest);
  if (!name) return Damage(std::move(name.error()));
  head.name = std::move(*name);
  return head;
}

tl::expected<void, Problem> MatrixWalk::add_numbers(const MatrixHead& head, const std::string& name, Bytes rest) {
  const auto element = take_mat5_element(rest, order_);
  if (!element) return Damage(element.error());
  const std::size_t size = bytes_per_number(element->type);
  if (size == 0) return wrong_element("numbers", *element);
  const std::size_t count = mat_count(head.dimensions, element->bytes.size());
  if (element->bytes.size() % size != 0 || count != element->bytes.size() / size) {
    return Damage({.code = ProblemCode::size_disagrees,
                   .evidence = {counted("count", element->bytes.size())},
                   .subjects = {{"unit", "bytes"}}});
  }
  if (head.is_complex) {
    found.contents.skip(name, Kind::complex, wrong_kind("complex"));
    return {};
  }
  const std::string_view class_name = head.is_logical ? "logical" : numeric_classes[head.matlab_class - first_numeric];
  const std::size_t before = found.contents.arrays.size();
  found.contents.add(name, std::string(class_name), head.dimensions);
  if (found.contents.arrays.size() > before) found.numbers.push_back(*element);
  return {};
}

tl::expected<std::vector<std::string>, Problem> MatrixWalk::take_field_names(Bytes& rest) const {
  const auto length_element = take_mat5_element(rest, order_);
  if (!length_element) return Damage(length_element.error());
  if (length_element->type != int32_type || length_element->bytes.size() != 4) {
    return wrong_element("name length", *length_element);
  }
  const auto length = load<std::int32_t>(length_element->bytes.data(), order_);
  const auto names = take_mat5_element(rest, order_);
  if (!names) return Damage(names.error());
  if (length < 1 || static_cast<std::size_t>(length) > longest_field_name) {
    Problem problem = wrong_field("name length", length);
    problem.evidence.push_back(counted("most", longest_field_name));
    return Damage(std::move(problem));
  }
  const auto step = static_cast<std::size_t>(length);
  if (names->bytes.size() % step != 0) return wrong_element("field names", *names);
  std::vector<std::string> fields;
  for (std::size_t begin = 0; begin < names->bytes.size(); begin += step) {
    fields.push_back(text_of(names->bytes.subspan(begin, step)));
  }
  return fields;
}

tl::expected<void, Problem> MatrixWalk::walk_struct(const MatrixHead& head, const std::string& name, Bytes rest,
                                                    int depth) {
  const auto fields = take_field_names(rest);
  if (!fields) return Damage(fields.error());
  const std::size_t elements = mat_count(head.dimensions, most_fields);
  if (elements == 0 || fields->empty()) {
    found.contents.skip(name, Kind::no_table, wrong_kind("empty"));
    return {};
  }
  if (fields->size() > most_fields || elements > (most_fields - fields_) / fields->size()) {
    found.contents.skip(name, Kind::no_table,
                        {.code = ProblemCode::has_too_many,
                         .evidence = {counted("most", most_fields)},
                         .subjects = {{"what", "fields"}}});
    return {};
  }
  fields_ += elements * fields->size();
  for (std::size_t i = 0; i < elements; ++i) {
    for (const std::string& field : *fields) {
      const auto element = take_mat5_element(rest, order_);
      if (!element) return Damage(element.error());
      if (element->type != mat5_matrix) return wrong_element("field", *element);
      const std::string field_name = mat_field_name(name, i, elements, field);
      if (auto walked = walk(element->bytes, &field_name, depth + 1); !walked) return walked;
    }
  }
  return {};
}

tl::expected<void, Problem> MatrixWalk::walk(Bytes bytes, const std::string* name, int depth) {
  if (depth > mat_deepest_nesting) {
    return Damage({.code = ProblemCode::nested_too_deep, .evidence = {{"most", mat_deepest_nesting}}});
  }
  if (bytes.empty()) {
    found.contents.skip(name != nullptr ? *name : "", Kind::no_table, wrong_kind("empty"));
    return {};
  }
  const auto head = take_head(bytes);
  if (!head) return Damage(head.error());
  const std::string& full_name = name != nullptr ? *name : head->name;
  const auto skip = [&](Kind kind, Problem why) -> tl::expected<void, Problem> {
    found.contents.skip(full_name, kind, std::move(why));
    return {};
  };
  switch (head->matlab_class) {
    case opaque:
    case object:
      return skip(Kind::object, wrong_kind("a MATLAB object"));
    case structure:
      return walk_struct(*head, full_name, bytes, depth);
    case cell:
      return skip(Kind::other_class, wrong_kind("a cell array"));
    case text:
      return skip(Kind::other_class, wrong_kind("text"));
    case sparse:
      return skip(Kind::other_class, wrong_kind("sparse"));
    case function:
      return skip(Kind::other_class, wrong_kind("a function handle"));
    default:
      break;
  }
  if (head->matlab_class < first_numeric || head->matlab_class > last_numeric) {
    return skip(Kind::other_class, {.code = ProblemCode::wrong_kind,
                                    .evidence = {counted("class", head->matlab_class)},
                                    .subjects = {{"wanted", "array"}}});
  }
  return add_numbers(*head, full_name, bytes);
}

}  // namespace

tl::expected<Mat5Element, Problem> take_mat5_element(Bytes& rest, ByteOrder order) {
  if (rest.size() < 8) return Damage({.code = ProblemCode::data_end_inside, .subjects = {{"part", "an element"}}});
  const auto first = load<std::uint32_t>(rest.data(), order);
  if (const std::size_t small = first >> 16; small > 0) {  // up to four bytes stand in the tag itself
    if (small > 4) return Damage(bytes_missing(small, 4));
    const Mat5Element element{first & 0xFFFF, rest.subspan(4, small)};
    rest = rest.subspan(8);
    return element;
  }
  const std::size_t size = load<std::uint32_t>(rest.data() + 4, order);
  if (size > rest.size() - 8) return Damage(bytes_missing(size, rest.size() - 8));
  const Mat5Element element{first, rest.subspan(8, size)};
  const std::size_t padded = (size + 7) / 8 * 8;
  rest = rest.subspan(std::min(8 + padded, rest.size()));
  return element;
}

tl::expected<Mat5Matrix, Problem> read_mat5_matrix(Bytes bytes, ByteOrder order) {
  MatrixWalk walk(order);
  if (auto walked = walk.walk(bytes, nullptr, 0); !walked) return Damage(std::move(walked.error()));
  return std::move(walk.found);
}

std::vector<double> mat5_numbers(const Mat5Element& element, ByteOrder order) {
  switch (element.type) {
    case 1:
      return load_all<std::int8_t>(element.bytes, order);
    case 2:
      return load_all<std::uint8_t>(element.bytes, order);
    case 3:
      return load_all<std::int16_t>(element.bytes, order);
    case 4:
      return load_all<std::uint16_t>(element.bytes, order);
    case 5:
      return load_all<std::int32_t>(element.bytes, order);
    case 6:
      return load_all<std::uint32_t>(element.bytes, order);
    case 7:
      return load_all<float>(element.bytes, order);
    case 9:
      return load_all<double>(element.bytes, order);
    case 12:
      return load_all<std::int64_t>(element.bytes, order);
    case 13:
      return load_all<std::uint64_t>(element.bytes, order);
    default:
      return {};
  }
}

}  // namespace zwidth::internal
