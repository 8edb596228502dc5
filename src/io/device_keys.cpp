#include "io/device_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "io/key_synonyms.hpp"
#include "io/prose.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

struct TableKeys {
  std::string_view name;
  std::vector<std::string> keys;
};

/// In the order of DeviceTable.
const std::array<TableKeys, 12>& all_tables() {
  static const std::array<TableKeys, 12> tables{{
      {"",
       {"name", "motion", "body", "link", "loop", "actuator", "sensor", "wall", "operator", "transfer_function",
        "uncertainty", "driver"}},
      {"body", {"name", "mass", "inertia", "damping", "stiffness", "coulomb"}},
      {"link", {"between", "stiffness", "damping"}},
      {"loop", {"actuated", "sensed", "held", "sampling_period", "delay"}},
      {"actuator", {"time_constant", "force_limit"}},
      {"sensor", {"resolution"}},
      {"wall", {"stiffness", "damping", "velocity_filter_hz", "velocity_filter_tau", "filter"}},
      {"filter", {"type", "frequency_hz", "order", "damping_ratio", "depth", "ratio", "numerator", "denominator"}},
      {"operator", {"mass", "inertia", "damping", "stiffness"}},
      {"transfer_function", {"numerator", "denominator"}},
      {"uncertainty", {"parameters", "covariance", "verdict", "warning", "reasons", "assumed"}},
      {"driver", {"travel", "gear", "sign", "torque_constant", "torque_per_volt", "id", "command", "baud"}},
  }};
  return tables;
}

const TableKeys& entry(DeviceTable table) { return all_tables()[static_cast<std::size_t>(table)]; }

}  // namespace

std::span<const std::string> keys_of(DeviceTable table) { return entry(table).keys; }

std::string_view name_of(DeviceTable table) { return entry(table).name; }

std::string path_of(DeviceTable table) {
  return table == DeviceTable::filter ? "wall.filter" : std::string(name_of(table));
}

std::string header_of(DeviceTable table) {
  switch (table) {
    case DeviceTable::root:
      return "the top level";
    case DeviceTable::body:
    case DeviceTable::link:
    case DeviceTable::filter:
      return fmt::format("[[{}]]", path_of(table));
    default:
      return fmt::format("[{}]", name_of(table));
  }
}

bool is_key_of(DeviceTable table, std::string_view key) { return std::ranges::count(keys_of(table), key) > 0; }

std::string remedy_for_unknown_key(DeviceTable table, std::string_view key) {
  if (auto remedy = remedy_for_synonym(table, key)) return *std::move(remedy);
  std::vector<std::string> homes;
  for (std::size_t i = 0; i < all_tables().size(); ++i) {
    const auto other = static_cast<DeviceTable>(i);
    if (is_key_of(other, key)) homes.push_back(header_of(other));
  }
  if (!homes.empty()) return fmt::format("it belongs in {}", fmt::join(homes, " or "));
  const std::string meant = nearest_word(key, keys_of(table));
  if (!meant.empty()) return fmt::format("did you mean \"{}\"?", meant);
  return fmt::format("the keys of {} are {}", header_of(table), listed(keys_of(table)));
}

}  // namespace zwidth::internal
