#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/device_keys.hpp"
#include "io/needed_value.hpp"
#include "io/toml.hpp"
#include "model/key_members.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/number_with_unit.hpp"

namespace zwidth::internal {

/// One reading of a device file: what is wrong with it, and where each of its keys stands.
///
/// Reading goes on after a refusal (its result is thrown away), so that readers need no error path of their own.
class DeviceReading {
 public:
  explicit DeviceReading(std::string_view source) : source_(source) {}

  /// Of which motion the units are from now on.
  void set_motion(Motion motion) { motion_ = motion; }
  [[nodiscard]] Motion motion() const { return motion_; }

  /// Keeps the first refusal of every key, and none of a key below one that is refused: it would follow from that.
  void refuse(const toml::source_region& place, const std::string& key, InputProblem problem);
  void refuse(const toml::source_region& place, const std::string& key, Problem problem,
              std::optional<std::string> suggestion = std::nullopt) {
    refuse(place, key, input_problem({}, std::move(problem), std::move(suggestion)));
  }
  /// Nothing is refused of the key any more: what is wrong with it follows from another refusal.
  void leave(const std::string& key) { left_.insert(key); }
  void note_place(const std::string& key, const toml::source_region& place) { places_.emplace(key, place); }

  /// Refuses what find_problem() found, at the place of its key or of the table that lacks it.
  void refuse(const DeviceProblem& problem);
  /// The same of a problem whose place has a key.
  void refuse_at(InputProblem problem);

  [[nodiscard]] bool passed() const noexcept { return problems_.empty(); }
  [[nodiscard]] std::size_t count() const noexcept { return problems_.size(); }
  /// All that is refused, in the order of reading. Requires that something is.
  [[nodiscard]] InputError error() const;

 private:
  [[nodiscard]] toml::source_region place_of(std::string key) const;  // or of the table that lacks it

  std::string source_;
  Motion motion_ = Motion::linear;
  std::map<std::string, toml::source_region> places_;
  std::set<std::string> left_;
  std::vector<InputProblem> problems_;
};

/// Typed access to the keys of one table; what is not as it must be is refused in the reading.
class TableReader {
 public:
  /// `key` is the table's own key, as in an override.
  TableReader(DeviceReading& reading, const toml::table& table, std::string key);

  /// Refuses every key that does not belong in a table of this kind.
  void refuse_keys_not_of(DeviceTable kind);
  /// The same of a table of another file.
  void refuse_keys_not_in(std::span<const std::string> keys);

  /// From now on keys are reported below `key`.
  void rename(std::string key);

  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
  [[nodiscard]] bool is_text(std::string_view key) const { return has(key) && table_.get(key)->is_string(); }
  /// In SI units; a text with its unit too, where something is measured.
  [[nodiscard]] std::optional<double> number(std::string_view key, std::optional<Measure> measure = std::nullopt);
  /// Refused when missing; that it is positive is for find_problem() to check.
  [[nodiscard]] double required_positive_number(std::string_view key, std::optional<Measure> measure);
  /// A whole number of at most 1e9 in magnitude.
  [[nodiscard]] std::optional<int> whole_number(std::string_view key);
  /// How the key of a row is spelt in this table: "inertia" for "mass" where that is given, refused where it may not be.
  [[nodiscard]] std::string_view spelling_of(const DeviceKey& key);
  [[nodiscard]] std::optional<std::string> text(std::string_view key);
  /// The same over several lines.
  [[nodiscard]] std::optional<std::string> lines(std::string_view key);
  /// Of a joint that turns or slides, and which of the two its unit says, where it has one.
  [[nodiscard]] std::optional<double> number_of_either_motion(std::string_view key, Measure measure,
                                                              std::optional<Motion>& unit);
  /// Every key that the table has.
  [[nodiscard]] std::vector<std::string> keys() const;
  /// All elements, each required to be what the name says; empty (and refused) when the key is missing.
  [[nodiscard]] std::vector<double> required_numbers(std::string_view key,
                                                     std::optional<Measure> measure = std::nullopt);
  /// `needed` says what the array is of: "texts", "keys", "bodies".
  [[nodiscard]] std::vector<std::string> required_texts(std::string_view key, const NeededValue& needed);
  [[nodiscard]] std::vector<std::vector<double>> required_rows(std::string_view key);
  /// The table of that kind below this one, or null.
  [[nodiscard]] const toml::table* table(DeviceTable kind);
  /// The [[tables]] of that kind below this one, in order.
  [[nodiscard]] std::vector<const toml::table*> tables(DeviceTable kind);
  /// The same by name; `header` is how it is written: "[[parameter]]".
  [[nodiscard]] const toml::table* table(std::string_view name, std::string_view header);
  [[nodiscard]] std::vector<const toml::table*> tables(std::string_view name, std::string_view header);

  void refuse(std::string_view key, InputProblem problem);
  void refuse(std::string_view key, Problem problem, std::optional<std::string> suggestion = std::nullopt) {
    refuse(key, input_problem({}, std::move(problem), std::move(suggestion)));
  }
  /// Refuses the table that lacks the key; not beside an unknown key, which may be the one that is missed.
  void refuse_missing(std::string_view key, const NeededValue& needed);
  /// Nothing is refused of the key, or of the whole table, any more.
  void leave(std::string_view key) { reading_.leave(full_key(key)); }
  void leave() { reading_.leave(key_); }

 private:
  [[nodiscard]] const toml::node* find(std::string_view key);
  [[nodiscard]] std::optional<double> number_of(const toml::node& node, std::string_view key,
                                                std::optional<Measure> measure, bool is_element = false);
  [[nodiscard]] std::vector<double> numbers_of(const toml::array& array, std::string_view key,
                                               std::optional<Measure> measure = std::nullopt);
  [[nodiscard]] const toml::array* required_array(std::string_view key, const NeededValue& needed);
  [[nodiscard]] std::string full_key(std::string_view key) const;
  /// `each` of an array: "element", "row".
  void refuse_type(const toml::node& node, std::string_view key, const NeededValue& needed, std::string_view each = {});

  DeviceReading& reading_;
  const toml::table& table_;
  std::string key_;
  bool has_unknown_key_ = false;
};

/// Reads every key that has a member in the table's struct; what the file leaves out stays as it is there.
template <typename Table>
void read_members(TableReader& reader, DeviceTable kind, Table& members) {
  visit_members(kind, members, [&](const DeviceKey& key, auto& member) {
    using Value = std::remove_reference_t<decltype(member)>;
    const std::string_view name = reader.spelling_of(key);
    if constexpr (std::is_same_v<Value, std::string>) {
      member = reader.text(name).value_or(member);
    } else if constexpr (std::is_same_v<Value, std::optional<int>>) {
      member = reader.whole_number(name);
    } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
      member = reader.number(name, key.measure);
    } else if constexpr (std::is_same_v<Value, double>) {
      const bool is_needed = key.otherwise == needed_key;
      member = is_needed ? reader.required_positive_number(name, key.measure)
                         : reader.number(name, key.measure).value_or(member);
    }
  });
}

}  // namespace zwidth::internal
