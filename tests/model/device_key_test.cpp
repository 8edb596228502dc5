#include "zwidth/model/device_key.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <limits>
#include <set>
#include <string>
#include <type_traits>

#include "model/key_members.hpp"

namespace zwidth {
namespace {

using namespace internal;

/// Number of defaults that the table states as numbers; each must be the struct's own.
template <typename Table>
int stated_defaults(DeviceTable kind) {
  int stated = 0;
  const Table table;
  visit_members(kind, table, [&](const DeviceKey& key, const auto& member) {
    double value = 0.0;
    const char* const end = key.otherwise.data() + key.otherwise.size();
    const bool is_number = !key.otherwise.empty() && std::from_chars(key.otherwise.data(), end, value).ptr == end;
    if constexpr (requires { member.value(); }) {
      EXPECT_FALSE(member.has_value()) << key.name;
      EXPECT_FALSE(is_number) << key.name;
    } else if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(member)>>) {
      if (!is_number) return;
      EXPECT_EQ(static_cast<double>(member), value) << key.name;
      ++stated;
    } else {
      EXPECT_EQ(member, key.otherwise);
    }
  });
  return stated;
}

TEST(DeviceKey, DefaultsAreThoseOfTheModel) {
  EXPECT_EQ(stated_defaults<Body>(DeviceTable::body), 3);
  EXPECT_EQ(stated_defaults<Link>(DeviceTable::link), 2);
  EXPECT_EQ(stated_defaults<Transmission>(DeviceTable::transmission), 4);
  EXPECT_EQ(stated_defaults<Loop>(DeviceTable::loop), 1);
  EXPECT_EQ(stated_defaults<LoopDamper>(DeviceTable::loop_damper), 0);
  EXPECT_EQ(stated_defaults<Actuator>(DeviceTable::actuator), 1);
  EXPECT_EQ(stated_defaults<Sensor>(DeviceTable::sensor), 2);
  EXPECT_EQ(stated_defaults<Wall>(DeviceTable::wall), 2);
  EXPECT_EQ(stated_defaults<WallFilter>(DeviceTable::filter), 2);
  EXPECT_EQ(stated_defaults<User>(DeviceTable::user), 3);
  EXPECT_EQ(stated_defaults<MotorDrive>(DeviceTable::driver), 3);
}

TEST(DeviceKey, TablesAreInTheirOrderAndEveryKeyStandsOnce) {
  for (std::size_t i = 0; i < device_tables().size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(device_tables()[i].table), i);
    EXPECT_LE(device_tables()[i].parent, device_tables()[i].table);
  }
  std::set<std::string> seen;
  for (const DeviceKey& key : device_keys()) {
    EXPECT_TRUE(seen.insert(path_of(key.table) + "." + std::string(key.name)).second) << key.name;
    EXPECT_FALSE(key.help.empty()) << key.name;
    if (!key.same_as.empty()) {
      EXPECT_EQ(key_of(key.table, key.same_as).name, key.same_as);
    }
  }
  EXPECT_EQ(path_of(DeviceTable::filter), "wall.filter");
  EXPECT_EQ(header_of(DeviceTable::filter), "[[wall.filter]]");
  EXPECT_EQ(header_of(DeviceTable::user), "[operator]");
  EXPECT_EQ(header_of(DeviceTable::loop_damper), "[loop.damper]");
  EXPECT_EQ(header_of(DeviceTable::mechanism_pose), "[mechanism.pose]");
  EXPECT_EQ(header_of(DeviceTable::mechanism_joint), "[mechanism.joint.NAME]");
  EXPECT_EQ(header_of(DeviceTable::transmission), "[[transmission]]");
}

TEST(DeviceKey, RangesHoldTheirEnds) {
  EXPECT_TRUE(positive_numbers.contains(1e-30));
  EXPECT_FALSE(positive_numbers.contains(0.0));
  EXPECT_TRUE(not_negative_numbers.contains(0.0));
  EXPECT_FALSE(not_negative_numbers.contains(-1.0));
  EXPECT_FALSE(not_negative_numbers.contains(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(not_negative_numbers.contains(1e31));
}

}  // namespace
}  // namespace zwidth
