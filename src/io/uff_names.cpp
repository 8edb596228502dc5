#include "io/uff_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "counted.hpp"
#include "io/column_names.hpp"
#include "io/prose.hpp"
#include "uff_function_name.hpp"

namespace zwidth::internal {
namespace {

/// Ways to name a record, the best first; the third ID line is a date.
using Naming = std::string (*)(const UffRecord&);
constexpr std::array<Naming, 6> namings{
    [](const UffRecord& record) { return record.id_lines[0]; },
    [](const UffRecord& record) { return record.response.entity; },
    [](const UffRecord& record) { return uff_point_name(record.response); },
    [](const UffRecord& record) { return record.id_lines[3]; },
    [](const UffRecord& record) { return record.id_lines[4]; },
    [](const UffRecord& record) { return record.id_lines[1]; },
};

std::string name_of_record(const std::string& name, const std::string& unit) {
  const bool has_unit = name.ends_with(unit) || !name_and_unit(name).unit.empty();
  return has_unit ? name : with_unit(name, unit);
}

}  // namespace

std::string uff_point_name(const UffPoint& point) {
  constexpr std::array<std::string_view, 7> axes{"", "X", "Y", "Z", "RX", "RY", "RZ"};
  if (point.node == 0) return {};
  const auto axis = static_cast<std::size_t>(std::abs(point.direction));
  if (axis == 0 || axis >= axes.size()) return std::to_string(point.node);
  return fmt::format("{}{}{}", point.node, point.direction < 0 ? '-' : '+', axes[axis]);
}

std::vector<std::string> uff_names(const UffFile& file) {
  std::vector<std::string> names(file.records.size());
  for (const Naming name_of : namings) {
    std::map<std::string, std::size_t> counts;
    for (const UffRecord& record : file.records) ++counts[name_of(record)];
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string name = name_of(file.records[i]);
      if (names[i].empty() && !name.empty() && counts[name] == 1) names[i] = name;
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) names[i] = fmt::format("record {}", i + 1);
    names[i] = name_of_record(names[i], file.records[i].ordinate.unit);
  }
  return names;
}

InputError wrong_record(const UffFile& file, const UffRecord& record, const std::string& asked, std::string wanted) {
  return {{.file = file.source, .line = record.line, .column = 1, .key = shortened(asked)},
          {.code = ProblemCode::wrong_kind,
           .subjects = {{"kind", "a " + uff_description(record)}, {"wanted", std::move(wanted)}}}};
}

std::string uff_description(const UffRecord& record) {
  const std::string unit = record.abscissa.unit.empty() ? "" : " " + record.abscissa.unit;
  return fmt::format("{}{}, {} points, {}", record.is_complex ? "complex " : "",
                     uff_function_name(record.function_type), record.points,
                     record.is_even ? fmt::format("every {:.6g}{}", record.step, unit) : "unevenly spaced");
}

tl::expected<std::size_t, InputError> find_uff_record(const UffFile& file, const std::string& asked) {
  const auto names = uff_names(file);
  const auto named = find_column(names, asked, file.source);
  if (named || asked.empty()) return named;
  for (const Naming name_of : namings) {
    std::vector<std::string> numbers;
    std::size_t found = 0;
    for (std::size_t i = 0; i < file.records.size(); ++i) {
      if (name_of(file.records[i]) != asked) continue;
      numbers.push_back(std::to_string(i + 1));
      found = i;
    }
    if (numbers.size() == 1) return found;
    if (numbers.size() > 1) {
      return tl::unexpected(
          InputError({.file = file.source, .key = shortened(asked)}, {.code = ProblemCode::column_name_not_unique,
                                                                      .evidence = {counted("records", numbers.size())},
                                                                      .subjects = {{"numbers", listed(numbers)}}}));
    }
  }
  return named;
}

}  // namespace zwidth::internal
