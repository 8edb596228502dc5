#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "zwidth/model/device.hpp"
#include "zwidth/model/device_key.hpp"

namespace zwidth::internal {

/// Where a value stands in its table's struct; monostate: what is read and written in a way of its own.
using KeyMember =
    std::variant<std::monostate, double Body::*, double Link::*, double Loop::*, double Actuator::*, double Sensor::*,
                 double Wall::*, double WallFilter::*, double User::*, double MotorDrive::*, double Transmission::*,
                 std::optional<double> LoopDamper::*, std::optional<double> Actuator::*, std::optional<double> Wall::*,
                 std::optional<double> MotorDrive::*, int WallFilter::*, std::optional<int> MotorDrive::*,
                 std::string MotorDrive::*, std::string MechanismFile::*>;

template <typename Member, typename... Members>
constexpr bool is_member_of(std::type_identity<std::variant<Members...>>) {
  return (std::is_same_v<Member, Members> || ...);
}

/// What depends on a number of a device, but for its motion in time.
enum class KeyReach {
  nothing,  ///< simulations and rigs alone use it
  limits,   ///< limits, not the response of force to position that the device itself has
  response  ///< both
};

struct KeyRow {
  DeviceKey key;
  KeyMember member = {};
  KeyReach reach = KeyReach::response;
  bool zero_is_apart = false;  ///< its 0 is another structure (no link, no filter), not what small values come to
};

/// The table's rows of the table of keys, in the order in which a file is written.
[[nodiscard]] std::span<const KeyRow> rows_of(DeviceTable table);

/// The row of a key that is there.
[[nodiscard]] const DeviceKey& key_of(DeviceTable table, std::string_view name);

/// The row of a device's key, "body.motor.mass" or "link.stiffness"; nothing for what is no key.
[[nodiscard]] const KeyRow* row_of(std::string_view key);

/// Whether the number may come down to 0: a mass may not, nor what is another structure there.
[[nodiscard]] inline bool may_vanish(const KeyRow& row) {
  return row.key.range && row.key.range->takes_zero && !row.zero_is_apart;
}

/// Whether a filter of the kind may have the key, as a notch its depth.
[[nodiscard]] bool is_key_of(WallFilter::Kind kind, std::string_view key);

/// Whether this filter has the number: of its kind, and a low-pass of order 2 alone its damping ratio.
[[nodiscard]] bool is_number_of(const WallFilter& filter, std::string_view key);

template <typename Value>
inline constexpr bool is_real_number = std::is_same_v<std::remove_const_t<Value>, double> ||
                                       std::is_same_v<std::remove_const_t<Value>, std::optional<double>>;

/// visit(key, member) for every key that has a member in the table's struct, in the order of the file.
template <typename Table, typename Visitor>
void visit_members(DeviceTable kind, Table& table, Visitor&& visit) {
  const auto visit_value = [&]<typename Value>(const KeyRow& row, std::type_identity<Value>) {
    using Member = Value std::remove_const_t<Table>::*;
    if constexpr (is_member_of<Member>(std::type_identity<KeyMember>{})) {
      if (const Member* member = std::get_if<Member>(&row.member)) visit(row.key, table.**member);
    }
  };
  for (const KeyRow& row : rows_of(kind)) {
    visit_value(row, std::type_identity<double>{});
    visit_value(row, std::type_identity<std::optional<double>>{});
    visit_value(row, std::type_identity<int>{});
    visit_value(row, std::type_identity<std::optional<int>>{});
    visit_value(row, std::type_identity<std::string>{});
  }
}

}  // namespace zwidth::internal
