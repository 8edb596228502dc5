#include "zwidth/stability/absolute_stability.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lhifam.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using test::handle_sensed;
using test::lhifam_parameters;
using test::reduced_pretension_parameters;
using test::rigid_parameters;
using test::with_delay;

// Theory notes, section 5: printed to 1e-5 relative.
TEST(AbsoluteStability, LhifamValuesOfTheTheoryNotes) {
  const auto expect = [](const DeviceParameters& parameters, double stiffness) {
    EXPECT_NEAR(absolute_stability_limit(Device(parameters)).stiffness, stiffness, 1e-5 * stiffness);
  };
  expect(lhifam_parameters(), 5776.09);
  expect(handle_sensed(lhifam_parameters()), 6370.26);
  expect(with_delay(lhifam_parameters(), 0.25e-3), 3860.39);
  expect(with_delay(handle_sensed(lhifam_parameters()), 0.25e-3), 4330.85);
  expect(reduced_pretension_parameters(), 5354.62);
  expect(handle_sensed(reduced_pretension_parameters()), 5620.82);
  expect(with_delay(reduced_pretension_parameters(), 0.25e-3), 3573.88);
  expect(with_delay(handle_sensed(reduced_pretension_parameters()), 0.25e-3), 3976.82);
}

TEST(AbsoluteStability, LhifamFrequenciesOfTheTheoryNotes) {
  EXPECT_NEAR(absolute_stability_limit(Device(lhifam_parameters())).frequency, 259.9, 0.05);
  EXPECT_NEAR(absolute_stability_limit(Device(handle_sensed(lhifam_parameters()))).frequency, 184.8, 0.1);
}

// Rigid, whole samples of delay, exact: K (T/2 + t_d) + |B| <= b + ... of Colgate & Schenkel 1997 and Diolaiti 2006.
TEST(AbsoluteStability, RigidEqualsColgateSchenkelAndDiolaiti) {
  const double b = 3.5;
  const double period = 1e-3;
  for (const double damping : {0.0, 1.0, 2.5}) {
    EXPECT_NEAR(absolute_stability_limit(Device(rigid_parameters()), {damping, 0.0}).stiffness,
                2.0 * (b - damping) / period, 1e-9 * 2.0 * b / period);
  }
  for (const double samples : {0.0, 1.0, 2.0, 8.0}) {
    const double limit = b / (period / 2.0 + samples * period);
    EXPECT_NEAR(absolute_stability_limit(Device(with_delay(rigid_parameters(), samples * period))).stiffness, limit,
                1e-9 * limit);
  }
}

TEST(AbsoluteStability, StiffDampedLinkApproachesTheRigidLimit) {
  DeviceParameters parameters = lhifam_parameters();
  parameters.links[0] = {0, 1, 1e9, 1e4};
  EXPECT_NEAR(absolute_stability_limit(Device(parameters)).stiffness, 7000.0, 1.0);
}

TEST(AbsoluteStability, NoDampingMeansNoLimitAboveZero) {
  DeviceParameters parameters = rigid_parameters();
  parameters.bodies[0].damping = 0.0;
  EXPECT_EQ(absolute_stability_limit(Device(parameters)).stiffness, 0.0);
}

TEST(AbsoluteStability, DampingBeyondTheDevicesOwnLeavesNothing) {
  EXPECT_EQ(absolute_stability_limit(Device(rigid_parameters()), {4.0, 0.0}).stiffness, 0.0);
}

TEST(AbsoluteStability, TheDevicesOwnOperatorDoesNotMatter) {
  DeviceParameters held = lhifam_parameters();
  held.user = {2.0, 10.0, 500.0};
  EXPECT_EQ(absolute_stability_limit(Device(held)).stiffness,
            absolute_stability_limit(Device(lhifam_parameters())).stiffness);
}

TEST(AbsoluteStability, TruncationIsFarBelowThePrintedDigits) {
  for (const double delay : {0.0, 1e-7, 0.25e-3, 0.5e-3, 3.3e-3}) {
    EXPECT_LE(absolute_stability_limit(Device(with_delay(lhifam_parameters(), delay))).truncation, 1e-7) << delay;
  }
}

TEST(AbsoluteStability, ATransferFunctionHasNobodyToHold) {
  EXPECT_THROW((void)absolute_stability_limit(Device(test::transfer_function_parameters({1}, {1, 1}, 1e-3))), Error);
}

}  // namespace
}  // namespace zwidth
