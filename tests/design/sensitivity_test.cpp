#include "zwidth/design/sensitivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

const Sensitivity& of(const std::vector<Sensitivity>& sensitivities, const std::string& key) {
  const auto found = std::find_if(sensitivities.begin(), sensitivities.end(),
                                  [&](const Sensitivity& each) { return each.key == key; });
  if (found == sensitivities.end()) throw std::out_of_range(key);
  return *found;
}

/// A device with every kind of parameter.
DeviceParameters everything() {
  DeviceParameters device = test::with_delay(test::lhifam_parameters(), 0.25e-3);
  device.bodies[1].stiffness = 200.0;
  device.actuator.time_constant = 2e-4;
  device.wall.damping = 5.0;
  device.wall.velocity_filter_hz = 80.0;
  device.wall.filters.push_back({.kind = WallFilter::Kind::notch, .frequency_hz = 90.0, .damping_ratio = 0.3});
  device.wall.filters.push_back({.kind = WallFilter::Kind::low_pass, .frequency_hz = 300.0, .order = 2});
  device.wall.filters.push_back({.kind = WallFilter::Kind::lead_lag, .frequency_hz = 30.0, .ratio = 2.0});
  device.wall.filters.push_back({.kind = WallFilter::Kind::biquad,
                                 .frequency_hz = 50.0,
                                 .numerator = {1e-6, 1e-3, 1.0},
                                 .denominator = {2e-6, 4e-3, 1.0}});
  device.wall.filters.push_back(
      {.kind = WallFilter::Kind::biquad, .numerator = {1e-3, 1.0}, .denominator = {2e-3, 1.0}});
  device.user = {0.5, 6.0, 135.0};
  return device;
}

// Theory, section 2: K = b² (1 - a)/(m (1 - a) - a b T), a = e^{-b T/m}, of a rigid device without delay.
TEST(Sensitivity, OfARigidDeviceIsThatOfTheClosedForm) {
  const DeviceParameters device = test::rigid_parameters();
  const double m = 5.4;
  const double b = 3.5;
  const double T = 1e-3;
  const double u = b * T / m;
  const double g = -std::expm1(-u);                       // 1 - a
  const double d = g - (1.0 - g) * u;                     // K = (b²/m) g/d
  const double by_u = (1.0 - g) / g - u * (1.0 - g) / d;  // d log(g/d)/du
  const auto sensitivities = stiffness_sensitivities(Device(device));
  // d loses 1e-16/u = 1.5e-13 of u² /2, by_u as much of 1/u: 1e-9.
  EXPECT_NEAR(*of(sensitivities, "body.body.mass").relative, -1.0 - u * by_u, 1e-9);
  EXPECT_NEAR(*of(sensitivities, "body.body.damping").relative, 2.0 + u * by_u, 1e-9);
  EXPECT_NEAR(*of(sensitivities, "loop.sampling_period").relative, u * by_u, 1e-9);
  EXPECT_FALSE(of(sensitivities, "loop.delay").relative);
}

TEST(Sensitivity, CoversEveryParameterThatMatters) {
  const DeviceParameters device = everything();
  std::set<std::string> expected;
  for (const std::string& key : parameter_keys(device)) {
    const bool is_for_simulation = key.ends_with(".coulomb") || key == "actuator.force_limit" ||
                                   key == "sensor.resolution" || key == "wall.stiffness" ||
                                   key == "sensor.tracking_bandwidth";  // 0: none
    const bool is_of_two_rates = key.starts_with("loop.damper.");
    if (!is_for_simulation && !is_of_two_rates) expected.insert(key);
  }
  std::set<std::string> found;
  for (const Sensitivity& each : stiffness_sensitivities(Device(device))) {
    found.insert(each.key);
    EXPECT_EQ(each.value, *parameter(device, each.key)) << each.key;
  }
  EXPECT_EQ(found, expected);
  for (const char* member : {"mass", "damping", "stiffness"}) expected.erase(std::string("operator.") + member);
  found.clear();
  for (const Sensitivity& each : absolute_stability_sensitivities(Device(device))) found.insert(each.key);
  EXPECT_EQ(found, expected);
}

// Four-point central differences; a second route for the filters of every kind at once.
TEST(Sensitivity, OfADeviceWithEverythingEqualsCentralDifferences) {
  const DeviceParameters device = everything();
  const auto critical = [](const DeviceParameters& moved) {
    return critical_stiffness(filtered_plant(Device(moved)), {moved.wall.damping, moved.wall.velocity_filter_hz})
        .stiffness;
  };
  constexpr double step = 1e-3;
  for (const Sensitivity& each : stiffness_sensitivities(Device(device))) {
    if (each.value == 0.0) continue;
    const auto at = [&](double share) {
      DeviceParameters moved = device;
      set_parameter(moved, each.key, each.value * (1.0 + share));
      return critical(moved);
    };
    const double difference = (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step);
    EXPECT_NEAR(*each.relative, difference / critical(device), 1e-8) << each.key;
  }
}

// One-sided, from 0 upwards: (4 f(h) - 3 f(0) - f(2h))/(2h) with one step of Richardson's extrapolation.
template <typename Limit>
double slope_from_zero(const DeviceParameters& device, const std::string& key, double step, const Limit& limit) {
  const auto at = [&](double value) {
    DeviceParameters moved = device;
    set_parameter(moved, key, value);
    return limit(Device(moved));
  };
  const auto rough = [&](double h) { return (4.0 * at(h) - 3.0 * at(0.0) - at(2.0 * h)) / (2.0 * h); };
  return (4.0 * rough(0.5 * step) - rough(step)) / 3.0;
}

TEST(Sensitivity, OfParametersThatAreZeroIsThatOfTheirGrowth) {
  const DeviceParameters device = test::lhifam_parameters();
  const auto sensitivities = stiffness_sensitivities(Device(device));
  const auto limit = [](const Device& moved) { return critical_stiffness(filtered_plant(moved)).stiffness; };
  const std::vector<std::pair<const char*, double>> steps = {
      {"loop.delay", 1e-6},    {"actuator.time_constant", 1e-6}, {"body.handle.stiffness", 1e-2},
      {"operator.mass", 1e-3}, {"operator.damping", 1e-3},       {"operator.stiffness", 1e-2}};
  for (const auto& [key, step] : steps) {
    const Sensitivity& each = of(sensitivities, key);
    EXPECT_FALSE(each.relative) << key;
    const double expected = slope_from_zero(device, key, step, limit);
    EXPECT_NEAR(each.slope / expected, 1.0, 1e-5) << key;
  }
}

// The absolute stability limit has a corner at a delay and a lag of 0: the sums over aliases fall like 1/k there.
TEST(Sensitivity, OfTheAnyUserLimitFollowsAGrowingDelayAndLag) {
  for (const DeviceParameters& device : {test::lhifam_parameters(), test::handle_sensed(test::lhifam_parameters())}) {
    const auto sensitivities = absolute_stability_sensitivities(Device(device));
    const auto limit = [](const Device& moved) { return absolute_stability_limit(moved).stiffness; };
    for (const char* key : {"loop.delay", "actuator.time_constant"}) {
      const double expected = slope_from_zero(device, key, 1e-5, limit);
      EXPECT_NEAR(of(sensitivities, key).slope / expected, 1.0, 1e-3) << key;
    }
  }
  // Held where it is driven and sensed, every term falls like 1/k².
  DeviceParameters held_at_motor = test::lhifam_parameters();
  held_at_motor.loop.held = 0;
  const auto sensitivities = absolute_stability_sensitivities(Device(held_at_motor));
  const auto limit = [](const Device& moved) { return absolute_stability_limit(moved).stiffness; };
  for (const char* key : {"loop.delay", "actuator.time_constant"}) {
    const double expected = slope_from_zero(held_at_motor, key, 1e-6, limit);
    EXPECT_NEAR(of(sensitivities, key).slope / expected, 1.0, 1e-3) << key;
  }
}

// Colgate & Schenkel: K = 2 b/T of a rigid device whoever holds it.
TEST(Sensitivity, OfTheAnyUserLimitOfARigidDeviceIsColgateAndSchenkels) {
  const auto sensitivities = absolute_stability_sensitivities(Device(test::rigid_parameters()));
  EXPECT_NEAR(*of(sensitivities, "body.body.damping").relative, 1.0, 1e-5);
  EXPECT_NEAR(*of(sensitivities, "body.body.mass").relative, 0.0, 1e-5);
  EXPECT_NEAR(*of(sensitivities, "loop.sampling_period").relative, -1.0, 1e-5);
}

// With a first-order low-pass K = b/(T/2 + d), d = T/2 cot(pi f T) what it delays. Within 0.1 % of Nyquist a longer period or
// a higher corner makes no device: it failed.
TEST(Sensitivity, OfTheAnyUserLimitWithALowPassNextToNyquist) {
  DeviceParameters device = test::rigid_parameters();
  for (const double frequency : {499.0, 499.6, 499.99}) {
    device.wall.filters = {{.kind = WallFilter::Kind::low_pass, .frequency_hz = frequency, .order = 1}};
    const double turn = std::numbers::pi * frequency * device.loop.sampling_period;
    const double by_filter = turn / (std::pow(std::sin(turn), 2) * (1.0 + 1.0 / std::tan(turn)));
    const auto sensitivities = absolute_stability_sensitivities(Device(device));
    EXPECT_NEAR(*of(sensitivities, "body.body.damping").relative, 1.0, 1e-4) << frequency;
    EXPECT_NEAR(*of(sensitivities, "loop.sampling_period").relative, by_filter - 1.0, 1e-4) << frequency;
    EXPECT_NEAR(*of(sensitivities, "wall.filter.0.frequency_hz").relative, by_filter, 1e-4) << frequency;
  }
}

// A damping ratio of 1e-15: K there is known by a hundred digits, and no double is near enough to the frequency for slopes.
TEST(Sensitivity, IsEmptyBesideAModeThatHardlyAnythingDamps) {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies = {
      {"b0", 0.1, 0, 0, 0}, {"b1", 1, 0, 0, 0}, {"b2", 0.2, 0, 0, 0}, {"b3", 1, 0.09, 0, 0}, {"b4", 2, 0, 0, 0}};
  device.links = {{0, 1, 6e5, 0}, {1, 2, 1e3, 0}, {2, 3, 2e5, 0}, {0, 4, 4e3, 0}};
  device.loop.actuated = device.loop.sensed = 4;
  device.loop.held = 0;
  device.loop.sampling_period = 2e-3;
  device.loop.delay = 0.0;
  const CriticalStiffness critical = critical_stiffness(Device(device));
  ASSERT_TRUE(critical.limit.has_value());
  EXPECT_TRUE(stiffness_sensitivities(Device(device), critical).empty());
}

TEST(Sensitivity, IsEmptyWithoutALimit) {
  EXPECT_TRUE(
      stiffness_sensitivities(Device(test::transfer_function_parameters({1.0}, {1.0, -8.0, 0.0}, 1.0))).empty());
  EXPECT_THROW(
      (void)absolute_stability_sensitivities(Device(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1.0))),
      Error);
}

TEST(Sensitivity, RefusesAnotherDevicesAnswer) {
  const CriticalStiffness other = critical_stiffness(filtered_plant(Device(test::rigid_parameters())));
  EXPECT_THROW((void)stiffness_sensitivities(Device(test::lhifam_parameters()), other), Error);
}

// A real pole at z = 1: K = 1/gain at rest, whatever the period.
TEST(Sensitivity, AtRestIsThatOfTheStaticResponse) {
  const auto sensitivities =
      stiffness_sensitivities(Device(test::transfer_function_parameters({-1.0}, {1.0, 1.0}, 0.1)));
  EXPECT_NEAR(of(sensitivities, "loop.sampling_period").slope, 0.0, 1e-12);
  EXPECT_NEAR(of(sensitivities, "loop.delay").slope, 0.0, 1e-12);
}

}  // namespace
}  // namespace zwidth
