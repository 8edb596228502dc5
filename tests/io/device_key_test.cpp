// A key of the device file is its row of the table: what the row says is read, written and refused.
#include "zwidth/model/device_key.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "model/key_members.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/number_with_unit.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

tl::expected<Device, InputError> with_key(const DeviceKey& key, const std::string& value) {
  const bool is_rotary = key.name == "inertia";
  const std::string text = fmt::format(
      "motion = \"{}\"\n[[body]]\nname = \"a\"\nmass = 1\n[[body]]\nname = \"b\"\nmass = 1\n[[link]]\n"
      "between = [\"a\", \"b\"]\nstiffness = 5\ndamping = 5\n[loop]\nsampling_period = 0.125\n[driver]\ntravel = 1\n",
      is_rotary ? "rotary" : "linear");
  const bool is_many = key.table == DeviceTable::body || key.table == DeviceTable::link;
  const std::vector<std::string> overrides{
      fmt::format("{}.{}{}={}", path_of(key.table), is_many ? "0." : "", key.name, value)};
  return parse_device(text, "f.toml", overrides);
}

/// Beside a mechanism alone.
bool is_of_mechanism(const DeviceKey& key) {
  return key.table == DeviceTable::mechanism_joint || key.table == DeviceTable::mechanism_tendon ||
         key.table == DeviceTable::transmission;
}

TEST(DeviceKey, EveryNumberIsReadInItsUnitAndRefusedOutsideItsRange) {
  int count = 0;
  for (const DeviceKey& key : device_keys()) {
    if (key.type != KeyType::number || !key.measure || key.table == DeviceTable::filter) continue;
    if (is_of_mechanism(key)) continue;
    ++count;
    const Motion motion = key.name == "inertia" ? Motion::rotary : Motion::linear;
    const std::string_view unit = si_unit(*key.measure, motion);
    const auto read = with_key(key, fmt::format("0.25 {}", unit.empty() ? "count" : unit));
    ASSERT_TRUE(read) << read.error().str();
    const std::string_view written = key.name == "velocity_filter_tau" ? "velocity_filter_hz = " : "= 0.25\n";
    EXPECT_NE(write_device(read->parameters()).find(written), std::string::npos) << key.name;
    const auto refused = with_key(key, "-1");
    ASSERT_FALSE(refused) << key.name;
    EXPECT_TRUE(refused.error().place.key.ends_with(fmt::format(".{}", key.name))) << refused.error().str();
    EXPECT_EQ(with_key(key, "0").has_value(), key.range->takes_zero) << key.name;
    EXPECT_FALSE(with_key(key, "\"1 furlong\"")) << key.name;
  }
  EXPECT_EQ(count, 27);
}

TEST(DeviceKey, EveryNumberOfTheLoopIsAParameter) {
  const auto device = with_key(device_keys()[3], "2");  // a body's mass
  ASSERT_TRUE(device) << device.error().str();
  DeviceParameters parameters = device->parameters();
  for (const DeviceKey& key : device_keys()) {
    const bool is_of_rig = key.table == DeviceTable::driver || is_of_mechanism(key);
    if (key.type != KeyType::number || key.table == DeviceTable::filter || is_of_rig || !key.same_as.empty()) continue;
    const std::string path = key.table == DeviceTable::body   ? "body.a"
                             : key.table == DeviceTable::link ? "link.0"
                                                              : path_of(key.table);
    const std::string full = fmt::format("{}.{}", path, key.name);
    set_parameter(parameters, full, 3.0);
    EXPECT_EQ(parameter(parameters, full), 3.0);
    EXPECT_EQ(measure_of(full), key.measure) << full;
  }
}

TEST(DeviceKey, IsFoundByItsTableAndItsName) {
  EXPECT_EQ(internal::row_of("body.a b.c.inertia")->key.same_as, "mass");
  EXPECT_EQ(internal::row_of("link.damping"), internal::row_of("link.12.damping"));
  EXPECT_EQ(internal::row_of("wall.filter.0.damping_ratio")->key.table, DeviceTable::filter);
  EXPECT_EQ(internal::row_of("mechanism.joint.a.b.damping")->key.table, DeviceTable::mechanism_joint);
  EXPECT_EQ(internal::row_of("mechanism.tendon.cable 1.armature"), nullptr);
  EXPECT_EQ(internal::row_of("operator.stiffness")->key.table, DeviceTable::user);
  for (const char* none : {"loop.mass", "wall.0.damping", "walls.damping", "wall.filter", "body.mass.", ""}) {
    EXPECT_EQ(internal::row_of(none), nullptr) << none;
    EXPECT_FALSE(measure_of(none)) << none;
  }
}

TEST(DeviceKey, OfAFilterIsThatOfItsKind) {
  using enum WallFilter::Kind;
  EXPECT_TRUE(internal::is_key_of(biquad, "frequency_hz"));
  EXPECT_FALSE(internal::is_number_of({.kind = biquad, .frequency_hz = 0.0}, "frequency_hz"));
  EXPECT_TRUE(internal::is_key_of(low_pass, "damping_ratio"));
  EXPECT_FALSE(internal::is_number_of({.kind = low_pass, .frequency_hz = 1.0, .order = 1}, "damping_ratio"));
  EXPECT_FALSE(internal::is_key_of(digital, "frequency_hz"));
  EXPECT_FALSE(internal::is_key_of(low_pass, "numerator"));
}

}  // namespace
}  // namespace zwidth
