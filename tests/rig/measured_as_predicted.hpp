#pragma once

#include <gtest/gtest.h>

#include "rig/rig_actions.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::rig {

/// A limit measured through any driver in lock step lies within 2 % of the prediction, in stiffness and in frequency.
inline void expect_limit(const Device& device, Driver& driver) {
  const RigLimit limit = measure_limit(device, driver, {}, default_limit(device), {});
  ASSERT_EQ(limit.predicted.status, StiffnessStatus::finite);
  ASSERT_TRUE(limit.measured.stiffness) << explanation(limit.session.stop);
  EXPECT_NEAR(*limit.measured.stiffness / limit.predicted.stiffness, 1.0, 0.02);
  EXPECT_NEAR(limit.measured.frequency / limit.predicted.limit->frequency, 1.0, 0.02);
  EXPECT_LE(limit.measured.lower, *limit.measured.stiffness);
  EXPECT_GE(limit.measured.upper, *limit.measured.stiffness);
  EXPECT_EQ(limit.session.stop, StopReason::none);
}

/// The device identified through any driver in lock step has the critical stiffness of the true one, within 3 %.
inline void expect_identified(const Device& device, Driver& driver) {
  const RigIdentification found = identify_on_rig(device, driver, {}, default_measurement(device), {});
  ASSERT_TRUE(found.identification);
  const double expected = critical_stiffness(device).stiffness;
  EXPECT_NEAR(found.identification->analysis.critical.stiffness / expected, 1.0, 0.03);
}

/// One trial of a relay through any driver in lock step reads what the simulation reads, within 5 %.
inline void expect_relay(const Device& device, Driver& driver) {
  RelayTrialsOptions trials;
  trials.relay.amplitude = default_force(device);
  trials.trials = 1;
  trials.duration = 10.0;
  const RigRelay measured = relay_on_rig(device, driver, {}, trials, {});
  RelayOptions options;
  options.relay = trials.relay;
  options.trials = 1;
  options.duration = trials.duration;
  options.variation = 0.0;
  const RelayResult simulated = relay(device, options);
  ASSERT_TRUE(measured.relay && measured.relay->mean && simulated.mean);
  EXPECT_NEAR(measured.relay->mean->frequency / simulated.mean->frequency, 1.0, 0.05);
  EXPECT_NEAR(measured.relay->mean->stiffness / simulated.mean->stiffness, 1.0, 0.05);
}

}  // namespace zwidth::rig
