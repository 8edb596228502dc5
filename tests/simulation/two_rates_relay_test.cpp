// A relay in the place of the spring, beside a damper in a loop of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulation/simulated_devices.hpp"
#include "zwidth/simulation/relay.hpp"

namespace zwidth {
namespace {

RelayOptions two_trials(double duration) {
  RelayOptions options;
  options.relay.amplitude = 5.0;
  options.start_offset = 1e-3;
  options.duration = duration;
  options.trials = 2;
  return options;
}

// A mass on a spring to ground, whose resonance leaves little of the relay's harmonics.
DeviceParameters resonant(double damper_period) {
  DeviceParameters device = test::with_delay(test::rigid_parameters(), 1e-3);
  device.bodies[0].mass = 1.0;
  device.bodies[0].stiffness = 1e5;
  device.bodies[0].damping = 1.0;
  device.loop.damper = LoopDamper{damper_period, 0.0};
  device.wall.damping = 5.0;
  return device;
}

bool has(const std::vector<Remark>& remarks, FindingCode code) {
  return std::ranges::any_of(remarks,
                             [code](const Remark& each) { return each.finding && each.finding->code == code; });
}

TEST(TwoRateRelay, ReadsTheCriticalStiffnessBesideTheDamper) {
  for (const double damper_period : {1e-4, 3e-3}) {
    SCOPED_TRACE(damper_period);
    const Device device(resonant(damper_period));
    const RelayResult result = relay(device, two_trials(20.0));
    ASSERT_TRUE(result.mean && result.prediction);
    const double limit = critical_stiffness(device).stiffness;
    EXPECT_EQ(result.prediction->linear.stiffness, limit);
    EXPECT_NEAR(result.mean->stiffness / limit, 1.0, 0.04);
    EXPECT_EQ(result.limit_reading, LimitReading::confirms);
    EXPECT_TRUE(result.trust.sound());
    // Without the damper the limit is far lower.
    DeviceParameters undamped = device.parameters();
    undamped.wall = {};
    EXPECT_LT(critical_stiffness(Device(undamped)).stiffness, 0.4 * limit);
    // What is recorded is the relay's force alone.
    for (const double force : result.trials.front().force) ASSERT_EQ(std::abs(force), 5.0);
    EXPECT_TRUE(has(result.remarks, FindingCode::left_out_beside_damper_loop));
    EXPECT_FALSE(has(result.remarks, FindingCode::relay_without_wall));
    EXPECT_TRUE(result.prediction->sampled_relay.empty());
    EXPECT_TRUE(result.prediction->continuous_relay.empty());
  }
}

// Without hysteresis and friction first harmonics balance at every crossover of the loop with the damper closed.
TEST(TwoRateRelay, FirstHarmonicsOfADamperOnTheDrive) {
  const Relay relay{5.0, 0.0};
  const RelayPrediction prediction = relay_prediction(Device(resonant(1e-4)), relay);
  std::vector<Crossover> crossovers = prediction.linear.crossovers;
  std::erase_if(crossovers, [](const Crossover& each) { return each.frequency <= 0.0; });
  ASSERT_FALSE(crossovers.empty());
  ASSERT_EQ(prediction.describing_function.size(), crossovers.size());
  for (std::size_t i = 0; i < crossovers.size(); ++i) {
    EXPECT_NEAR(prediction.describing_function[i].frequency / crossovers[i].frequency, 1.0, 1e-12);
    EXPECT_NEAR(prediction.describing_function[i].stiffness / crossovers[i].stiffness, 1.0, 1e-12);
  }
  const RelayPrediction narrow = relay_prediction(Device(resonant(1e-4)), {5.0, 1e-9});
  ASSERT_FALSE(narrow.describing_function.empty());
  EXPECT_NEAR(narrow.describing_function.front().stiffness / crossovers.front().stiffness, 1.0, 1e-3);
  // A slower damper, or friction beside it, leaves none.
  EXPECT_TRUE(relay_prediction(Device(resonant(3e-3)), relay).describing_function.empty());
  DeviceParameters rubbing = resonant(1e-4);
  rubbing.bodies[0].coulomb = 0.1;
  EXPECT_TRUE(relay_prediction(Device(rubbing), relay).describing_function.empty());
}

TEST(TwoRateRelay, ADamperThatDoesNothingLeavesTheRelayItsRate) {
  DeviceParameters together = resonant(1e-4);
  together.wall = {};
  together.loop.damper.reset();
  DeviceParameters apart = together;
  apart.loop.damper = LoopDamper{1e-4, 0.0};
  const RelayResult first = relay(Device(together), two_trials(5.0));
  const RelayResult second = relay(Device(apart), two_trials(5.0));
  EXPECT_EQ(first.trials.front().position, second.trials.front().position);
  EXPECT_EQ(first.prediction->sampled_relay.size(), second.prediction->sampled_relay.size());
  EXPECT_EQ(first.prediction->linear.stiffness, second.prediction->linear.stiffness);
}

}  // namespace
}  // namespace zwidth
