#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <string_view>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/transfer_function.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

Device as_transfer_function(const Device& device, const ContinuousStateSpace& system) {
  DeviceParameters made;
  made.transfer_function = transfer_function(system);
  made.loop.sampling_period = device.loop().sampling_period;
  made.loop.delay = device.loop().delay;
  return Device(made);
}

// By hand: G = (m2 s² + (b2 + b) s + k) / (s (...)), the LHIfAM without dampers to ground.
TEST(TransferFunctionOfStates, OfTwoBodies) {
  DeviceParameters parameters = test::lhifam_parameters();
  for (Body& body : parameters.bodies) body.damping = 0.0;
  const TransferFunction made = transfer_function(state_space(Device(parameters)));
  const double m1 = 0.3;
  const double m2 = 5.1;
  const double b = 15.0;
  const double k = 79.5e3;
  ASSERT_EQ(made.numerator.size(), 4U);
  ASSERT_EQ(made.denominator.size(), 5U);
  const double numerator[] = {0.0, 1.0 / m1, b / (m1 * m2), k / (m1 * m2)};
  const double denominator[] = {1.0, b / m1 + b / m2, k / m1 + k / m2, 0.0, 0.0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(made.numerator[i], numerator[i], 1e-14 * numerator[i]) << i;
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(made.denominator[i], denominator[i], 1e-14 * denominator[i]) << i;
}

// The states may be any: mixed by a random matrix, the zeros of A are zeros no more, and its pole at 0 is none.
TEST(TransferFunctionOfStates, GivesTheLimitOfTheDevice) {
  constexpr std::uint64_t seed = 20261124;
  test::RandomDevices random(seed);
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    for (const std::string_view kind :
         {"rigid", "two_mass", "user_side", "three_mass", "grounded", "fractional_delay"}) {
      DeviceParameters parameters = random.device(kind);
      parameters.wall = {};
      const Device device(parameters);
      const ContinuousStateSpace system = state_space(device);
      const Eigen::Index n = system.A.rows();
      Eigen::MatrixXd mixing(n, n);
      for (double& entry : mixing.reshaped()) entry = random.uniform(-1.0, 1.0);
      const Eigen::MatrixXd T = Eigen::HouseholderQR<Eigen::MatrixXd>(mixing).householderQ();
      const ContinuousStateSpace mixed{T * system.A * T.transpose(), T * system.B, system.C * T.transpose()};
      const CriticalStiffness expected = critical_stiffness(device);
      const auto difference = [&](const ContinuousStateSpace& each) {
        const CriticalStiffness found = critical_stiffness(as_transfer_function(device, each));
        EXPECT_EQ(found.status, expected.status) << kind << " " << i << ", seed " << seed;
        return std::abs(found.stiffness / expected.stiffness - 1.0);
      };
      if (expected.status != StiffnessStatus::finite) continue;
      EXPECT_LE(difference(system), 1e-9) << kind << " " << i << ", seed " << seed;
      EXPECT_LE(difference(mixed), 1e-6) << kind << " " << i << ", seed " << seed;
      ++compared;
    }
  }
  EXPECT_GT(compared, 300);
}

TEST(TransferFunctionOfStates, RefusesWhatIsNone) {
  const ContinuousStateSpace good = state_space(Device(test::lhifam_parameters()));
  ContinuousStateSpace bad = good;
  bad.B.resize(3);
  EXPECT_THROW(static_cast<void>(transfer_function(bad)), Error);
  EXPECT_THROW(static_cast<void>(transfer_function({})), Error);
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200, 1e-300}) {
    bad = good;
    bad.A(2, 1) = value;
    EXPECT_THROW(static_cast<void>(transfer_function(bad)), Error) << value;
  }
  const Eigen::Index many = static_cast<Eigen::Index>(max_exact_states) + 1;
  EXPECT_THROW(static_cast<void>(transfer_function(
                   {Eigen::MatrixXd::Zero(many, many), Eigen::VectorXd::Zero(many), Eigen::RowVectorXd::Zero(many)})),
               Error);
}

TEST(TransferFunctionOfStates, ADeviceThatRoundingMadeUnstableIsDoubtful) {
  DeviceParameters parameters;
  parameters.loop.sampling_period = 1e-3;
  // a rigid body's pole at 0, moved by rounding as a conversion in double precision does it
  parameters.transfer_function = {{17.97, 768.656457, 7.85597819e6},
                                  {1.0, 708.053108, 7.14353096e6, 6.65446018e6, -2e-4}};
  const CriticalStiffness moved = critical_stiffness(Device(parameters));
  EXPECT_EQ(moved.status, StiffnessStatus::none_stable);
  EXPECT_EQ(moved.trust.verdict, Trust::Verdict::doubtful);
  parameters.transfer_function->denominator.back() = 0.0;
  const CriticalStiffness right = critical_stiffness(Device(parameters));
  EXPECT_TRUE(right.trust.sound());
  ASSERT_EQ(right.status, StiffnessStatus::finite);
  ASSERT_EQ(moved.stable_intervals.size(), 1U);
  EXPECT_NEAR(*moved.stable_intervals[0].upper / right.stiffness, 1.0, 1e-8);
  parameters.transfer_function->denominator.back() = -2e6;  // a device that does fall over stays what it is
  EXPECT_TRUE(critical_stiffness(Device(parameters)).trust.sound());
}

}  // namespace
}  // namespace zwidth
