#include "io/device_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "io/key_synonyms.hpp"
#include "io/prose.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

std::vector<std::vector<std::string>> made_keys() {
  std::vector<std::vector<std::string>> keys(device_tables().size());
  for (const DeviceKey& each : device_keys()) keys[static_cast<std::size_t>(each.table)].emplace_back(each.name);
  for (const DeviceTableKey& each : device_tables().subspan(1)) {
    keys[static_cast<std::size_t>(each.parent)].emplace_back(each.name);
  }
  return keys;
}

}  // namespace

std::span<const std::string> keys_of(DeviceTable table) {
  static const std::vector<std::vector<std::string>> keys = made_keys();
  return keys[static_cast<std::size_t>(table)];
}

const DeviceTableKey& entry_of(DeviceTable table) { return device_tables()[static_cast<std::size_t>(table)]; }

bool is_key_of(DeviceTable table, std::string_view key) { return std::ranges::count(keys_of(table), key) > 0; }

Problem unknown_key_of(DeviceTable table, std::string_view key) {
  Problem problem{.code = ProblemCode::unknown_key, .subjects = remedy_for_synonym(table, key)};
  std::vector<std::string> homes;
  for (const DeviceTableKey& other : device_tables()) {
    if (is_key_of(other.table, key)) homes.push_back(header_of(other.table));
  }
  if (problem.subjects.empty() && homes.empty()) {
    problem = unknown_key_beside(keys_of(table), key);
    problem.subjects.push_back({"table", header_of(table)});
    return problem;
  }
  if (problem.subjects.empty()) problem.subjects.push_back({"homes", fmt::format("{}", fmt::join(homes, " or "))});
  problem.subjects.push_back({"name", shortened(key)});
  return problem;
}

Problem unknown_key_beside(std::span<const std::string> keys, std::string_view key) {
  Problem problem{.code = ProblemCode::unknown_key, .subjects = {{"name", shortened(key)}}};
  const std::string meant = nearest_word(key, keys);
  problem.subjects.push_back(meant.empty() ? Subject{"keys", listed(keys)} : Subject{"meant", meant});
  return problem;
}

}  // namespace zwidth::internal
