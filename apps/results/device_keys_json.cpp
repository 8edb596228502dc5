#include "results/device_keys_json.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "results/units.hpp"
#include "zwidth/model/device_key.hpp"

namespace zwidth {

NLOHMANN_JSON_SERIALIZE_ENUM(KeyType, {{KeyType::number, "number"},
                                       {KeyType::whole_number, "whole_number"},
                                       {KeyType::sign, "sign"},
                                       {KeyType::text, "text"},
                                       {KeyType::numbers, "numbers"},
                                       {KeyType::texts, "texts"},
                                       {KeyType::matrix, "matrix"}})

}  // namespace zwidth

namespace zwidth::results {
namespace {

std::string allowed_values(const DeviceKey& key) {
  std::string allowed;
  if (key.range == positive_numbers) allowed = "> 0";
  if (key.range == not_negative_numbers) allowed = ">= 0";
  if (key.range && allowed.empty()) allowed = fmt::format("{} to {}", key.range->least, key.range->greatest);
  return fmt::format("{}{}{}", allowed, allowed.empty() || key.allowed.empty() ? "" : "; ", key.allowed);
}

Json key_json(const DeviceKey& key) {
  Json unit = nullptr;
  if (key.measure) {
    const bool is_of_joint = key.table == DeviceTable::transmission || key.table == DeviceTable::mechanism_joint ||
                             key.table == DeviceTable::mechanism_tendon;
    const Motion linear = is_of_joint ? Motion::rotary : Motion::linear;
    unit = {{"linear", unit_of(*key.measure, linear)}, {"rotary", unit_of(*key.measure, Motion::rotary)}};
  }
  return {{"key", key.name},
          {"type", key.type},
          {"unit", unit},
          {"least", key.range ? Json(key.range->least) : Json()},
          {"greatest", key.range ? Json(key.range->greatest) : Json()},
          {"takes_zero", key.range && key.range->takes_zero},
          {"default", key.otherwise},
          {"allowed", allowed_values(key)},
          {"help", key.help},
          {"same_as", key.same_as},
          {"since", key.since}};
}

}  // namespace

Json device_keys_json() {
  Json tables = Json::array();
  for (const DeviceTableKey& table : device_tables()) {
    Json keys = Json::array();
    for (const DeviceKey& key : device_keys()) {
      if (key.table == table.table) keys.push_back(key_json(key));
    }
    tables.push_back({{"path", path_of(table.table)},
                      {"header", header_of(table.table)},
                      {"is_many", table.is_many},
                      {"default", table.otherwise},
                      {"allowed", table.allowed},
                      {"since", table.since},
                      {"keys", keys}});
  }
  return {{"tables", tables}};
}

}  // namespace zwidth::results
