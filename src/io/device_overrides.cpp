#include "io/device_overrides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "io/device_keys.hpp"
#include "io/device_reading.hpp"
#include "io/number_cell.hpp"
#include "io/prose.hpp"
#include "io/toml_text.hpp"
#include "io/whole_text.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

InputError refusal(std::string_view key, Problem problem) {
  return {InputPlace{.file = override_source, .key = std::string(key)}, std::move(problem)};
}

/// Where an override goes: a table of the document (null: the document is malformed there) and a key in it.
struct Target {
  toml::table* table = nullptr;
  std::string key;
};

std::vector<std::string> names_in(const toml::array& tables) {
  std::vector<std::string> names;
  for (const toml::node& element : tables) {
    const toml::table* table = element.as_table();
    const toml::node* name = table ? table->get("name") : nullptr;
    names.push_back(name && name->is_string() ? name->as_string()->get() : std::string{});
  }
  return names;
}

/// Which of the [[tables]] `selector` means: a body's name, an index, or nothing where there is one table.
tl::expected<std::size_t, InputError> selected(const toml::array& tables, DeviceTable kind, std::string_view selector,
                                               std::string_view key, std::string_view whole_key) {
  const auto names = names_in(tables);
  const auto named = std::ranges::find(names, selector);
  if (kind == DeviceTable::body && !selector.empty() && named != names.end()) {
    return static_cast<std::size_t>(named - names.begin());
  }
  if (const auto index = whole_text_as<std::size_t>(selector); index && *index < tables.size()) return *index;
  if (selector.empty() && tables.size() == 1) return 0;

  const std::string table = path_of(kind);
  if (selector.empty()) {
    return tl::unexpected(refusal(
        whole_key, {.code = ProblemCode::in_several_tables,
                    .evidence = {counted("count", tables.size())},
                    .subjects = {{"header", header_of(kind)}, {"example", fmt::format("{}.0.{}", table, key)}}}));
  }
  if (kind == DeviceTable::body) {
    return tl::unexpected(refusal(whole_key, no_such_body(selector, names, nearest_word(selector, names))));
  }
  return tl::unexpected(refusal(whole_key, {.code = ProblemCode::no_such_name,
                                            .evidence = {counted("last", tables.size() - 1)},
                                            .subjects = {{"what", table}, {"name", shortened(selector)}}}));
}

/// The node of the table or the [[tables]]; null where the file left it out, the one that holds it where that is no table.
toml::node* node_of(toml::table& document, DeviceTable kind) {
  if (kind == DeviceTable::root) return &document;
  toml::node* parent = node_of(document, entry_of(kind).parent);
  return parent && parent->is_table() ? parent->as_table()->get(entry_of(kind).name) : parent;
}

/// The same, made where the file left it out.
toml::node* made_node(toml::table& document, DeviceTable kind) {
  if (toml::node* node = node_of(document, kind)) return node;
  toml::table& parent = *made_node(document, entry_of(kind).parent)->as_table();
  return &parent.insert_or_assign(toml::key(entry_of(kind).name, override_region()), toml::table{}).first->second;
}

/// Resolves body.NAME.key, body.0.key, link.0.key, link.key, wall.filter.0.key, wall.filter.key.
tl::expected<Target, InputError> target_in_tables(toml::table& document, DeviceTable kind, std::string_view path,
                                                  std::string_view whole_key) {
  const auto dot = path.rfind('.');  // body names may contain dots, keys do not
  const std::string_view selector = dot == std::string_view::npos ? std::string_view{} : path.substr(0, dot);
  const std::string_view key = dot == std::string_view::npos ? path : path.substr(dot + 1);
  if (!is_key_of(kind, key)) {
    return tl::unexpected(refusal(whole_key, unknown_key_of(kind, key)));
  }
  toml::node* node = node_of(document, kind);
  if (!node) {
    Problem problem{.code = ProblemCode::no_table_to_override, .subjects = {{"header", header_of(kind)}}};
    if (kind == DeviceTable::filter) {
      problem.subjects.push_back({"example", R"(wall.filter=[{type="low_pass", frequency_hz=60}])"});
    }
    return tl::unexpected(refusal(whole_key, std::move(problem)));
  }
  toml::array* tables = node->as_array();
  if (!tables || tables->empty()) return Target{};
  const auto index = selected(*tables, kind, selector, key, whole_key);
  if (!index) return tl::unexpected(index.error());
  return Target{tables->get_as<toml::table>(*index), std::string(key)};
}

/// Resolves loop.delay and the like, making the table where the file left it out.
tl::expected<Target, InputError> target_in_table(toml::table& document, DeviceTable kind, std::string_view key,
                                                 std::string_view whole_key) {
  if (kind != DeviceTable::mechanism_pose && !is_key_of(kind, key)) {
    const std::string_view head = key.substr(0, key.find('.'));  // of wall.fliter.0.depth, what is misspelt
    const std::string_view unknown = is_key_of(kind, head) ? key : head;
    return tl::unexpected(refusal(whole_key, unknown_key_of(kind, unknown)));
  }
  return Target{made_node(document, kind)->as_table(), std::string(key)};
}

/// Resolves mechanism.joint.NAME.key, making the tables that the file left out; mechanism.joint.NAME is a whole table.
tl::expected<Target, InputError> target_by_name(toml::table& document, DeviceTable kind, std::string_view path,
                                                std::string_view whole_key) {
  const auto dot = path.rfind('.');
  toml::table* parts = made_node(document, kind)->as_table();
  if (dot == std::string_view::npos || !parts) return Target{parts, std::string(path)};
  const std::string_view key = path.substr(dot + 1);
  if (!is_key_of(kind, key)) return tl::unexpected(refusal(whole_key, unknown_key_of(kind, key)));
  const std::string_view name = path.substr(0, dot);
  toml::node* part = parts->get(name);
  if (!part) part = &parts->insert_or_assign(toml::key(name, override_region()), toml::table{}).first->second;
  return Target{part->as_table(), std::string(key)};
}

tl::expected<Target, InputError> find_target(toml::table& document, std::string_view whole_key) {
  const auto dot = whole_key.find('.');
  const std::string_view first = whole_key.substr(0, dot);
  if (!is_key_of(DeviceTable::root, first)) {
    return tl::unexpected(refusal(whole_key, unknown_key_of(DeviceTable::root, first)));
  }
  if (dot == std::string_view::npos) return Target{&document, std::string(first)};
  const DeviceTableKey* table = nullptr;  // the innermost
  for (const DeviceTableKey& each : device_tables().subspan(1)) {
    if (whole_key.starts_with(path_of(each.table) + ".")) table = &each;
  }
  if (table) {
    const std::string_view rest = whole_key.substr(path_of(table->table).size() + 1);
    const auto target = table->is_many ? target_in_tables : table->is_by_name ? target_by_name : target_in_table;
    return target(document, table->table, rest, whole_key);
  }
  return tl::unexpected(
      refusal(whole_key, {.code = ProblemCode::value_and_no_table, .subjects = {{"name", std::string(first)}}}));
}

/// A TOML document with the one key "value", or why the text is no TOML value.
tl::expected<toml::table, InputError> parse_value(std::string_view key, std::string_view text) {
  auto document = parse_toml(fmt::format("value = {}", text), override_source);
  // A bare word is text, and so is a number with a unit: neither starts like an array or quoted text.
  if (!document && is_bare_text(text)) {
    document = parse_toml(fmt::format("value = \"{}\"", text), override_source);
  }
  const bool is_beyond_range =
      !document && document.error().problem && document.error().problem->code == ProblemCode::number_beyond_range;
  if (!document && (is_beyond_range || document.error().suggestion)) {
    document.error().place = {.file = override_source, .key = std::string(key)};
    return document;
  }
  if (!document || document->size() != 1) {
    return tl::unexpected(
        refusal(key, {.code = ProblemCode::not_a_toml_value, .subjects = {{"text", shortened(text)}}}));
  }
  return std::move(*document);
}

}  // namespace

std::optional<InputError> apply_override(toml::table& document, const std::string& assignment) {
  const std::string_view whole = assignment;
  const auto equals = whole.find('=');
  const std::string_view key = trimmed(whole.substr(0, equals));
  if (equals == std::string_view::npos || key.empty()) {
    return refusal(
        "", {.code = ProblemCode::not_an_assignment,
             .subjects = {{"text", shortened(whole)}, {"form", "KEY=VALUE"}, {"example", "loop.delay=0.25e-3"}}});
  }
  auto value = parse_value(key, trimmed(whole.substr(equals + 1)));
  if (!value) return value.error();
  const auto target = find_target(document, key);
  if (!target) return target.error();
  if (!target->table) return std::nullopt;
  // Two keys of one quantity: the override replaces whichever the file gave.
  for (const DeviceKey& each : device_keys()) {
    if (each.same_as.empty()) continue;
    if (target->key == each.name) target->table->erase(each.same_as);
    if (target->key == each.same_as) target->table->erase(each.name);
  }
  value->get("value")->visit(
      [&](auto& node) { target->table->insert_or_assign(toml::key(target->key, override_region()), std::move(node)); });
  return std::nullopt;
}

}  // namespace zwidth::internal
