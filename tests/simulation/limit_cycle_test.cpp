#include "zwidth/simulation/limit_cycle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;

// Gonçalves 2001, half-period as printed in the theory notes, section 6.
TEST(RelayLimitCycle, GoncalvesHalfPeriod) {
  const Device device(
      test::transfer_function_parameters({1, -5, -11, -5, 250, 250}, {1, 12, 57, 140, 195, 150, 50}, 1e-2));
  const auto cycles = relay_limit_cycles(state_space(device), {1.0, 0.25}, 0.05, 20.0);
  ASSERT_EQ(cycles.size(), 1u);
  EXPECT_NEAR(pi / cycles[0].frequency, 2.0941231, 5e-8);
}

// Khalil, example 7.9: exact values as printed in the theory notes, section 6.
TEST(RelayLimitCycle, KhalilExactFrequencyAndPeak) {
  const Device device(test::transfer_function_parameters({1}, {1, 3, 2, 0}, 1e-2));
  const auto cycles = relay_limit_cycles(state_space(device), {1.0, 0.0}, 0.05, 50.0);
  ASSERT_EQ(cycles.size(), 1u);
  EXPECT_NEAR(cycles[0].frequency, 1.380595, 5e-7);
  EXPECT_NEAR(cycles[0].amplitude, 0.220037, 5e-7);
}

// The same by first harmonics: sqrt 2 and 2/(3 pi); sampled so fast that the hold's half sample is below the tolerance.
TEST(RelayLimitCycle, KhalilDescribingFunction) {
  const Device device(test::transfer_function_parameters({1}, {1, 3, 2, 0}, 1e-7));
  const auto cycles = describing_function_limit_cycles(device, {1.0, 0.0});
  ASSERT_FALSE(cycles.empty());
  EXPECT_NEAR(cycles[0].frequency, std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(cycles[0].amplitude, 2.0 / (3.0 * pi), 1e-6);
}

TEST(RelayLimitCycle, DelayOfTheContinuousRelayMovesTheSwitchOnly) {
  // A sampled relay of tiny period is a continuous relay with half a sample of delay.
  const DeviceParameters parameters = test::transfer_function_parameters({1}, {1, 3, 2, 0}, 1e-3, 0.4);
  const Device device(parameters);
  const auto exact = relay_limit_cycles(state_space(device), {1.0, 0.0}, 0.5, 20.0, 0.4);
  ASSERT_EQ(exact.size(), 1u);
  HybridLoopOptions options;
  options.controller.kind = ControllerOptions::Kind::relay;
  options.controller.amplitude = 1.0;
  HybridLoop loop(device, options);
  double previous = 0.0;
  std::size_t first = 0;
  std::size_t last = 0;
  int periods = -1;
  for (std::size_t k = 0; k < 200000; ++k) {
    loop.step();
    if (k > 100000 && loop.sensed_position() > 0.0 && previous <= 0.0) {
      if (periods++ < 0) first = k;
      last = k;
    }
    previous = loop.sensed_position();
  }
  const double period = static_cast<double>(last - first) * 1e-3 / periods;
  EXPECT_NEAR(2.0 * pi / period, exact[0].frequency, 1e-3 * exact[0].frequency);
}

TEST(SampledRelayLimitCycle, SimulationStaysOnOneOfThem) {
  for (const double delay : {0.0, 0.03, 0.05}) {
    SCOPED_TRACE(delay);
    const Device device(test::transfer_function_parameters({1}, {1, 3, 2, 0}, 0.02, delay));
    const Relay relay{1.0, 0.0};
    const auto cycles = sampled_relay_limit_cycles(sample(state_space(device), {0.02, delay}), relay, 400);
    HybridLoopOptions options;
    options.controller.kind = ControllerOptions::Kind::relay;
    options.controller.amplitude = relay.amplitude;
    HybridLoop loop(device, options);
    double largest = 0.0;
    for (int k = 0; k < 30000; ++k) {
      loop.step();
      if (k > 20000) largest = std::max(largest, std::abs(loop.sensed_position()));
    }
    EXPECT_TRUE(std::any_of(cycles.begin(), cycles.end(), [&](const LimitCycle& each) {
      return std::abs(each.amplitude - largest) < 1e-9 * largest;
    })) << largest;
  }
}

/// The rigid device of Table I with friction, sampled so fast that only `delay` is left.
Device rubbing_device(double friction, double delay) {
  DeviceParameters parameters = test::with_delay(test::rigid_parameters(), delay);
  parameters.loop.sampling_period = 1e-6;
  parameters.bodies[0].coulomb = friction;
  return Device(parameters);
}

// Theory, section 4: sin(w t) = F_c/d + (b/(m w)) cos(w t), t the delay and half a period; derived for a rigid device.
TEST(DescribingFunction, FrictionBalanceOfARigidDevice) {
  constexpr double d = 5.0;
  for (const double level : {0.01, 0.08, 0.3, 0.6}) {
    for (const double delay : {1e-3, 8e-3}) {
      SCOPED_TRACE(testing::Message() << level << " at " << delay << " s");
      const auto cycles = describing_function_limit_cycles(rubbing_device(level * d, delay), {d, 0.0});
      ASSERT_FALSE(cycles.empty());
      const double w = cycles.front().frequency;
      const double late = delay + 0.5e-6;
      EXPECT_NEAR(std::sin(w * late), level + 3.5 / (5.4 * w) * std::cos(w * late), 1e-7);
      EXPECT_NEAR(cycles.front().amplitude, 4.0 * d * std::cos(w * late) / (pi * 5.4 * w * w),
                  1e-6 * cycles.front().amplitude);
    }
  }
}

// With hysteresis h the relay is late by asin(h/X) more.
TEST(DescribingFunction, FrictionBalanceWithHysteresis) {
  constexpr double d = 5.0;
  constexpr double late = 4e-3 + 0.5e-6;
  const double hysteresis = 1e-3;
  const auto cycles = describing_function_limit_cycles(rubbing_device(0.1 * d, 4e-3), {d, hysteresis});
  ASSERT_FALSE(cycles.empty());
  const double w = cycles.front().frequency;
  const double angle = w * late + std::asin(hysteresis / cycles.front().amplitude);
  EXPECT_NEAR(std::sin(angle), 0.1 + 3.5 / (5.4 * w) * std::cos(angle), 1e-6);
  EXPECT_NEAR(cycles.front().amplitude, 4.0 * d * std::cos(angle) / (pi * 5.4 * w * w),
              1e-6 * cycles.front().amplitude);
}

TEST(DescribingFunction, FrictionStrongerThanTheRelayLeavesNothing) {
  EXPECT_TRUE(describing_function_limit_cycles(rubbing_device(5.5, 1e-3), {5.0, 0.0}).empty());
}

TEST(DescribingFunction, VanishingFrictionIsNone) {
  DeviceParameters parameters = test::with_delay(test::reduced_pretension_parameters(), 4.25e-3);
  const auto frictionless = describing_function_limit_cycles(Device(parameters), {5.0, 0.0});
  parameters.bodies[0].coulomb = 1e-9;
  parameters.bodies[1].coulomb = 1e-9;
  const auto rubbing = describing_function_limit_cycles(Device(parameters), {5.0, 0.0});
  ASSERT_EQ(rubbing.size(), frictionless.size());
  for (std::size_t i = 0; i < rubbing.size(); ++i) {
    EXPECT_NEAR(rubbing[i].frequency, frictionless[i].frequency, 1e-6 * frictionless[i].frequency);
  }
}

// A handle that friction holds is a handle that is locked, for the oscillations far above the resonance.
TEST(DescribingFunction, ABodyThatSticksIsLocked) {
  DeviceParameters parameters = test::with_delay(test::reduced_pretension_parameters(), 4.25e-3);
  parameters.bodies[1].coulomb = 2.0;
  const auto sticking = describing_function_limit_cycles(Device(parameters), {5.0, 0.0});
  parameters.bodies[1].coulomb = 0.0;
  parameters.bodies[1].damping = 1e9;
  const auto locked = describing_function_limit_cycles(Device(parameters), {5.0, 0.0});
  ASSERT_GE(sticking.size(), 2U);
  ASSERT_GE(locked.size(), 2U);
  for (std::size_t i = 1; i <= 2; ++i) {
    EXPECT_NEAR(sticking[sticking.size() - i].frequency, locked[locked.size() - i].frequency,
                1e-4 * locked[locked.size() - i].frequency);
  }
}

TEST(RelayLimitCycle, CyclesRiseInFrequency) {
  const Device device(test::with_delay(test::reduced_pretension_parameters(), 4.25e-3));
  const auto continuous = relay_limit_cycles(state_space(device), {5.0, 0.0}, 1e-3, 1.0, 4.75e-3);
  const auto sampled = sampled_relay_limit_cycles(sample(state_space(device), {1e-3, 4.25e-3}), {5.0, 0.0}, 1000);
  ASSERT_GE(continuous.size(), 2U);
  ASSERT_GE(sampled.size(), 2U);
  const auto slower = [](const LimitCycle& a, const LimitCycle& b) { return a.frequency < b.frequency; };
  EXPECT_TRUE(std::is_sorted(continuous.begin(), continuous.end(), slower));
  EXPECT_TRUE(std::is_sorted(sampled.begin(), sampled.end(), slower));
}

// An ideal relay on a rigid device has force and position in opposite phase: first harmonics are related by the
// response, whatever the waveform.
TEST(RelayLimitCycle, StiffnessIsTheInverseResponseAtTheFrequency) {
  const Device device(test::with_delay(test::reduced_pretension_parameters(), 4.25e-3));
  const ModalForm form = modal_form(device);
  for (const LimitCycle& cycle : relay_limit_cycles(state_space(device), {5.0, 0.0}, 1e-3, 1.0, 4.75e-3)) {
    const double expected = 1.0 / std::abs(response(form, cycle.frequency));
    EXPECT_NEAR(cycle.stiffness, expected, 2e-3 * expected) << cycle.frequency;
  }
  const SampledPlant plant = sampled_plant(device);
  for (const LimitCycle& cycle :
       sampled_relay_limit_cycles(sample(state_space(device), {1e-3, 4.25e-3}), {5.0, 0.0}, 1000)) {
    const double expected = 1.0 / std::abs(response(plant, cycle.frequency));
    EXPECT_NEAR(cycle.stiffness, expected, 1e-8 * expected) << cycle.frequency;
  }
}

// Work of the late force over half a period h against what damping takes, for little damping: w^2 = (pi^2/12) b/(m t),
// where the linear loop has w^2 = b/(m t).
TEST(RelayLimitCycle, TheSquareWaveSlowsALightlyDampedRigidDevice) {
  DeviceParameters parameters = test::rigid_parameters();
  constexpr double delay = 1e-3;
  for (const double damping : {1e-2, 1e-3}) {
    parameters.bodies[0].damping = damping;
    const double linear = std::sqrt(damping / (5.4 * delay));
    const auto cycles =
        relay_limit_cycles(state_space(Device(parameters)), {5.0, 0.0}, 0.2 * pi / linear, 5.0 * pi / linear, delay);
    ASSERT_EQ(cycles.size(), 1U);
    EXPECT_NEAR(cycles[0].frequency, pi / std::sqrt(12.0) * linear, 2e-3 * linear);
    EXPECT_NEAR(cycles[0].stiffness, 5.4 * cycles[0].frequency * cycles[0].frequency, 2e-3 * cycles[0].stiffness);
  }
}

TEST(RelayLimitCycle, RefusesAnImpossibleRelay) {
  const Device device(test::lhifam_parameters());
  EXPECT_THROW((void)relay_limit_cycles(state_space(device), {0.0, 0.0}, 0.1, 1.0), Error);
  EXPECT_THROW((void)relay_limit_cycles(state_space(device), {1.0, 0.0}, 1.0, 0.1), Error);
  EXPECT_THROW((void)sampled_relay_limit_cycles(sample(state_space(device), {1e-3, 0.0}), {1.0, -1.0}, 10), Error);
}

}  // namespace
}  // namespace zwidth
