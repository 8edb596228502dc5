#include "io/column_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "io/column_unit.hpp"
#include "io/number_cell.hpp"
#include "io/prose.hpp"
#include "io/whole_text.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

/// Numbers from 1 of the columns that are in question, as the user may give them.
std::string numbers_of(const std::vector<std::size_t>& indices) {
  std::vector<std::string> numbers;
  numbers.reserve(indices.size());
  for (const std::size_t index : indices) numbers.push_back(std::to_string(index + 1));
  return listed(numbers);
}

std::vector<std::size_t> where(std::span<const std::string> columns,
                               const std::function<bool(std::string_view)>& fits) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (fits(columns[i])) indices.push_back(i);
  }
  return indices;
}

InputError unknown_column(std::span<const std::string> columns, const std::string& asked, const std::string& source,
                          std::span<const std::string> shown) {
  std::vector<std::string> names;
  for (const std::string& column : columns) {
    names.push_back(column);
    if (const auto [name, unit] = name_and_unit(column); !unit.empty()) names.emplace_back(name);
  }
  const std::string meant = nearest_word(asked, names);
  Problem problem = with_columns({.code = ProblemCode::no_such_column}, shown.empty() ? columns : shown);
  if (!meant.empty()) problem.subjects.push_back({"meant", meant});
  return {{.file = source, .key = shortened(asked)}, std::move(problem)};
}

}  // namespace

NameAndUnit name_and_unit(std::string_view column) {
  column = trimmed(column);
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const std::size_t begin = column.rfind(open);
    if (begin == std::string_view::npos || begin == 0 || column.back() != close) continue;
    return {trimmed(column.substr(0, begin)), trimmed(column.substr(begin + 1, column.size() - begin - 2))};
  }
  return {column, {}};
}

std::string name_in_cell(std::string_view cell) {
  std::string name = as_utf8(trimmed(cell));
  for (std::size_t quote = name.find("\"\""); quote != std::string_view::npos; quote = name.find("\"\"", quote + 1)) {
    name.erase(quote, 1);
  }
  return without_controls(name);
}

std::string with_unit(const std::string& name, const std::string& unit) {
  if (unit.empty()) return name;
  return unit.front() == '[' || unit.front() == '(' ? name + " " + unit : fmt::format("{} [{}]", name, unit);
}

Problem with_columns(Problem problem, std::span<const std::string> columns) {
  std::vector<std::string> shown;
  shown.reserve(columns.size());
  for (const std::string& column : columns) shown.push_back(shortened(column));
  problem.evidence.push_back(counted("columns", columns.size()));
  problem.subjects.push_back({"names", listed(shown)});
  return problem;
}

tl::expected<std::size_t, InputError> find_column(std::span<const std::string> columns, const std::string& asked,
                                                  const std::string& source, std::span<const std::string> shown) {
  const std::string asked_lower = lower_case(asked);
  const auto without_unit = [](std::string_view column) {
    const std::string_view name = name_and_unit(column).name;
    const std::size_t end = name.rfind('_');  // "force_N"
    return end != std::string_view::npos && end > 0 && is_unit(name.substr(end + 1)) ? name.substr(0, end) : name;
  };
  const std::function<bool(std::string_view)> readings[] = {
      [&](std::string_view column) { return column == asked; },
      [&](std::string_view column) { return without_unit(column) == asked; },
      [&](std::string_view column) { return lower_case(column) == asked_lower; },
      [&](std::string_view column) { return lower_case(without_unit(column)) == asked_lower; },
  };
  for (const auto& reading : readings) {
    const auto found = where(columns, reading);
    if (found.size() == 1) return found.front();
    if (found.size() > 1) {
      return tl::unexpected(InputError{{.file = source, .key = shortened(asked)},
                                       {.code = ProblemCode::column_name_not_unique,
                                        .evidence = {counted("columns", found.size())},
                                        .subjects = {{"numbers", numbers_of(found)}}}});
    }
  }
  const auto number = whole_text_as<std::size_t>(asked);
  if (number && *number >= 1 && *number <= columns.size()) return *number - 1;
  return tl::unexpected(unknown_column(columns, asked, source, shown));
}

}  // namespace zwidth::internal
