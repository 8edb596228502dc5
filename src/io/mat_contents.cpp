#include "io/mat_contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "counted.hpp"

namespace zwidth::internal {
namespace {

/// A recording has no more signals; an array of more columns has its signals in rows, or is no recording.
constexpr std::size_t most_columns = 1024;

}  // namespace

Problem wrong_kind(std::string kind, std::string wanted) {
  return {.code = ProblemCode::wrong_kind, .subjects = {{"kind", std::move(kind)}, {"wanted", std::move(wanted)}}};
}

void MatContents::skip(std::string name, SkippedMatArray::Kind kind, Problem why) {
  skipped.push_back({std::move(name), kind, std::move(why)});
}

void MatContents::add(std::string name, std::string class_name, const std::vector<std::size_t>& dimensions) {
  using Kind = SkippedMatArray::Kind;
  if (std::ranges::find(dimensions, 0U) != dimensions.end()) {
    return skip(std::move(name), Kind::no_table, wrong_kind("empty"));
  }
  if (dimensions.size() != 2) {
    return skip(std::move(name), Kind::no_table,
                {.code = ProblemCode::no_table, .evidence = {counted("dimensions", dimensions.size())}});
  }
  const std::size_t rows = dimensions[0];
  const std::size_t columns = dimensions[1];
  if (rows > 1 && columns > most_columns) {
    return skip(std::move(name), Kind::no_table,
                {.code = ProblemCode::no_table,
                 .evidence = {counted("rows", rows), counted("columns", columns), counted("most", most_columns)}});
  }
  arrays.push_back({std::move(name), std::move(class_name), rows, columns});
}

std::size_t mat_count(const std::vector<std::size_t>& dimensions, std::size_t most) {
  if (std::ranges::find(dimensions, 0U) != dimensions.end()) return 0;
  std::size_t count = 1;
  for (const std::size_t dimension : dimensions) {
    if (dimension > most / count) return most + 1;
    count *= dimension;
  }
  return count;
}

std::string mat_field_name(const std::string& parent, std::size_t index, std::size_t elements,
                           const std::string& field) {
  return elements == 1 ? fmt::format("{}.{}", parent, field) : fmt::format("{}({}).{}", parent, index + 1, field);
}

}  // namespace zwidth::internal
