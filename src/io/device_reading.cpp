#include "io/device_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/prose.hpp"

namespace zwidth::internal {
namespace {

std::optional<double> as_number(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return number->get();
  if (const auto* number = node.as_integer()) return static_cast<double>(number->get());
  return std::nullopt;
}

/// What stands there instead, as the phrase of `of_other_type` names it.
void describe(const toml::node& node, Problem& problem) {
  if (const auto* text = node.as_string()) {
    problem.subjects.push_back({"text", shortened(text->get())});
  } else if (const auto number = as_number(node)) {
    problem.evidence.push_back({"number", *number});
  } else if (const auto* truth = node.as_boolean()) {
    problem.subjects.push_back({"kind", truth->get() ? "true" : "false"});
  } else {
    problem.subjects.push_back({"kind", node.is_array() ? "array" : node.is_table() ? "table" : "time"});
  }
}

/// The key of the table that holds `key`: body names may contain dots, which only adds a look-up or two.
std::string parent(const std::string& key) {
  const auto dot = key.rfind('.');
  return dot == std::string::npos ? std::string{} : key.substr(0, dot);
}

}  // namespace

void DeviceReading::refuse(const toml::source_region& place, const std::string& key, InputProblem problem) {
  constexpr std::size_t most = 100;
  for (std::string above = key; !above.empty(); above = parent(above)) {
    if (left_.contains(above)) return;
  }
  leave(key);
  if (problems_.size() == most) return;
  InputPlace where{source_, std::max<std::size_t>(1, place.begin.line), std::max<std::size_t>(1, place.begin.column),
                   key, ""};
  if (place.path && *place.path == override_source) where = {override_source, 0, 0, key, ""};
  problem.place = std::move(where);
  problems_.push_back(std::move(problem));
}

InputError DeviceReading::error() const {
  InputError first(problems_.front());
  first.others.assign(problems_.begin() + 1, problems_.end());
  return first;
}

void DeviceReading::refuse(const DeviceProblem& problem) {
  constexpr std::string_view mass = "mass";
  std::string named = problem.key;
  if (named.ends_with(mass) && !places_.contains(named)) {
    const std::string alias = named.substr(0, named.size() - mass.size()) + "inertia";
    if (places_.contains(alias)) named = alias;
  }
  InputProblem told{{}, problem.what, problem.allowed, {}};
  told.problem = problem.problem;
  if (problem.problem && problem.problem->code == ProblemCode::no_whole_ratio) {
    told.suggestion = fmt::format("{}", problem.problem->evidence.back().value);
  }
  refuse(place_of(named), named, std::move(told));
}

void DeviceReading::refuse_at(InputProblem problem) {
  const std::string key = problem.place.key;
  refuse(place_of(key), key, std::move(problem));
}

toml::source_region DeviceReading::place_of(std::string key) const {
  auto found = places_.find(key);
  while (found == places_.end() && !key.empty()) {
    key = parent(key);
    found = places_.find(key);
  }
  return found == places_.end() ? toml::source_region{} : found->second;
}

TableReader::TableReader(DeviceReading& reading, const toml::table& table, std::string key)
    : reading_(reading), table_(table) {
  rename(std::move(key));
}

void TableReader::refuse_keys_not_of(DeviceTable kind) {
  for (const auto& [name, node] : table_) {
    if (is_key_of(kind, name.str())) continue;
    has_unknown_key_ = true;
    reading_.refuse(name.source(), full_key(shortened(name.str())), unknown_key_of(kind, name.str()));
  }
}

void TableReader::refuse_keys_not_in(std::span<const std::string> keys) {
  for (const auto& [name, node] : table_) {
    if (std::ranges::find(keys, name.str()) != keys.end()) continue;
    has_unknown_key_ = true;
    reading_.refuse(name.source(), full_key(shortened(name.str())), unknown_key_beside(keys, name.str()));
  }
}

void TableReader::rename(std::string key) {
  key_ = std::move(key);
  reading_.note_place(key_, table_.source());
}

std::string TableReader::full_key(std::string_view key) const {
  return key_.empty() ? std::string(key) : fmt::format("{}.{}", key_, key);
}

const toml::node* TableReader::find(std::string_view key) {
  const toml::node* node = table_.get(key);
  if (node) reading_.note_place(full_key(key), node->source());
  return node;
}

void TableReader::refuse(std::string_view key, InputProblem problem) {
  const toml::node* node = table_.get(key);
  reading_.refuse(node ? node->source() : table_.source(), full_key(key), std::move(problem));
}

void TableReader::refuse_missing(std::string_view key, const NeededValue& needed) {
  if (has_unknown_key_) return leave(key);
  Problem problem = needs(ProblemCode::is_missing, needed);
  problem.evidence.push_back({"missing", 1.0});
  refuse(key, std::move(problem));
}

void TableReader::refuse_type(const toml::node& node, std::string_view key, const NeededValue& needed,
                              std::string_view each) {
  Problem problem = needs(ProblemCode::of_other_type, needed);
  describe(node, problem);
  if (!each.empty()) problem.evidence.push_back({each, 1.0});
  reading_.refuse(node.source(), full_key(key), std::move(problem));
}

std::optional<double> TableReader::number(std::string_view key, std::optional<Measure> measure) {
  const toml::node* node = find(key);
  return node ? number_of(*node, key, measure) : std::nullopt;
}

std::optional<double> TableReader::number_of(const toml::node& node, std::string_view key,
                                             std::optional<Measure> measure, bool is_element) {
  if (const auto value = as_number(node)) return value;
  if (!measure || !node.is_string()) {
    const bool names_elements = is_element && !measure;
    refuse_type(node, key, measure ? needed_number(*measure, reading_.motion()) : NeededValue{"number"},
                names_elements ? "element" : "");
    return std::nullopt;
  }
  auto value = number_with_unit(node.as_string()->get(), *measure, reading_.motion());
  if (value) return *value;
  reading_.refuse(node.source(), full_key(key), input_problem_of(value.error()));
  return std::nullopt;
}

double TableReader::required_positive_number(std::string_view key, std::optional<Measure> measure) {
  if (!has(key)) refuse_missing(key, {"positive"});
  return number(key, measure).value_or(0.0);
}

std::optional<int> TableReader::whole_number(std::string_view key) {
  const std::optional<double> value = number(key);
  constexpr double largest = 1e9;
  if (!value || (std::abs(*value) <= largest && std::trunc(*value) == *value)) {
    return value ? std::optional(static_cast<int>(*value)) : std::nullopt;
  }
  refuse(key, {.code = ProblemCode::no_whole_number,
               .evidence = {{"value", *value}, {"least", -largest}, {"most", largest}}});
  return std::nullopt;
}

std::string_view TableReader::spelling_of(const DeviceKey& key) {
  constexpr std::string_view inertia = "inertia";
  if (key.measure != Measure::mass || key.name == inertia || !has(inertia)) return key.name;
  if (reading_.motion() == Motion::linear) {
    refuse(inertia, {.code = ProblemCode::inertia_of_linear_motion});
  } else if (has(key.name)) {
    refuse(inertia, {.code = ProblemCode::given_beside, .subjects = {{"other", std::string(key.name)}}});
  }
  return inertia;
}

std::optional<std::string> TableReader::text(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  if (const auto* text = node->as_string()) {
    if (has_controls(text->get())) refuse(key, {.code = ProblemCode::control_character});
    return text->get();
  }
  refuse_type(*node, key, {"text"});
  return std::nullopt;
}

std::optional<std::string> TableReader::lines(std::string_view key) {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  if (const auto* text = node->as_string()) return text->get();
  refuse_type(*node, key, {"text"});
  return std::nullopt;
}

std::optional<double> TableReader::number_of_either_motion(std::string_view key, Measure measure,
                                                           std::optional<Motion>& unit) {
  const toml::node* node = find(key);
  if (node == nullptr || !node->is_string()) return number(key);
  const std::string& text = node->as_string()->get();
  for (const Motion motion : {Motion::rotary, Motion::linear}) {
    if (const auto value = number_with_unit(text, measure, motion)) {
      unit = motion;
      return *value;
    }
  }
  refuse(key, input_problem_of(number_with_unit(text, measure, Motion::rotary).error()));
  return std::nullopt;
}

std::vector<std::string> TableReader::keys() const {
  std::vector<std::string> result;
  for (const auto& [name, node] : table_) result.emplace_back(name.str());
  return result;
}

const toml::array* TableReader::required_array(std::string_view key, const NeededValue& needed) {
  const toml::node* node = find(key);
  if (!node) {
    refuse_missing(key, needed);
    return nullptr;
  }
  if (!node->is_array()) refuse_type(*node, key, needed);
  return node->as_array();
}

std::vector<double> TableReader::required_numbers(std::string_view key, std::optional<Measure> measure) {
  const toml::array* array = required_array(key, {"numbers"});
  return array ? numbers_of(*array, key, measure) : std::vector<double>{};
}

std::vector<std::vector<double>> TableReader::required_rows(std::string_view key) {
  std::vector<std::vector<double>> rows;
  const toml::array* array = required_array(key, {"rows"});
  if (!array) return rows;
  for (const toml::node& row : *array) {
    if (!row.is_array()) refuse_type(row, key, {"numbers"}, "row");
    rows.push_back(row.is_array() ? numbers_of(*row.as_array(), key) : std::vector<double>{});
  }
  return rows;
}

std::vector<double> TableReader::numbers_of(const toml::array& array, std::string_view key,
                                            std::optional<Measure> measure) {
  std::vector<double> numbers;
  for (const toml::node& element : array) {
    numbers.push_back(number_of(element, key, measure, true).value_or(0.0));
  }
  return numbers;
}

std::vector<std::string> TableReader::required_texts(std::string_view key, const NeededValue& needed) {
  std::vector<std::string> texts;
  const toml::array* array = required_array(key, needed);
  if (!array) return texts;
  for (const toml::node& element : *array) {
    const auto* text = element.as_string();
    if (!text) refuse_type(element, key, {"text"}, "element");
    texts.push_back(text ? text->get() : std::string{});
  }
  return texts;
}

const toml::table* TableReader::table(DeviceTable kind) { return table(entry_of(kind).name, header_of(kind)); }

const toml::table* TableReader::table(std::string_view name, std::string_view header) {
  const toml::node* node = find(name);
  if (!node) return nullptr;
  if (!node->is_table()) refuse_type(*node, name, {"table", std::string(header)});
  return node->as_table();
}

std::vector<const toml::table*> TableReader::tables(DeviceTable kind) {
  return tables(entry_of(kind).name, header_of(kind));
}

std::vector<const toml::table*> TableReader::tables(std::string_view name, std::string_view header) {
  std::vector<const toml::table*> result;
  const toml::node* node = find(name);
  if (!node) return result;
  const NeededValue needed{"tables", std::string(header)};
  if (!node->is_array()) {
    refuse_type(*node, name, needed);
    return result;
  }
  for (const toml::node& element : *node->as_array()) {
    if (element.is_table()) {
      result.push_back(element.as_table());
    } else {
      refuse_type(element, name, needed);
    }
  }
  return result;
}

}  // namespace zwidth::internal
