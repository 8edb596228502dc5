#include "zwidth/design/parameter_sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <mutex>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

constexpr auto logarithmic = SweepAxis::Spacing::logarithmic;

TEST(ParameterSweep, ValuesReachBothEndsExactly) {
  const auto linear = values_of({"loop.delay", 0.1, 0.7, 7});
  EXPECT_EQ(linear.front(), 0.1);
  EXPECT_EQ(linear.back(), 0.7);
  EXPECT_NEAR(linear[3], 0.4, 1e-15);
  const auto falling = values_of({"loop.delay", 1e3, 1e-3, 7, logarithmic});
  EXPECT_EQ(falling.back(), 1e-3);
  EXPECT_NEAR(falling[3], 1.0, 1e-12);
}

TEST(ParameterSweep, EveryPointIsTheCriticalStiffnessOfItsDevice) {
  const DeviceParameters parameters = test::lhifam_parameters();
  const ParameterSweep sweep = parameter_sweep(
      Device(parameters), {{"link.stiffness", 2e4, 2e5, 9, logarithmic}, {"loop.delay", 0.0, 8e-3, 11}});
  ASSERT_EQ(sweep.points.size(), 99U);
  for (std::size_t i = 0; i < 9; ++i) {
    for (std::size_t j = 0; j < 11; ++j) {
      DeviceParameters moved = parameters;
      moved.links[0].stiffness = sweep.values[0][i];
      moved.loop.delay = sweep.values[1][j];
      const CriticalStiffness expected = critical_stiffness(Device(moved));
      const SweepPoint& point = sweep.points[i * 11 + j];
      EXPECT_NEAR(point.stiffness / expected.stiffness, 1.0, 1e-12);  // the kernel's promise
      EXPECT_NEAR(point.limit->frequency / expected.limit->frequency, 1.0, 1e-12);
      EXPECT_EQ(point.limit->stiffness, point.stiffness);
      EXPECT_EQ(point.limit->limited_by.mode, expected.limit->limited_by.mode);
      EXPECT_EQ(point.limit->poles_leaving, expected.limit->poles_leaving);
      EXPECT_EQ(point.trust, expected.trust);
      EXPECT_TRUE(point.crossovers.empty());
    }
  }
}

// Whatever is asked for beside it, through the kernel or not, a limit is the same.
TEST(ParameterSweep, LimitsDoNotDependOnWhatElseIsAskedFor) {
  test::RandomDevices random(20261123);
  for (const char* kind : {"two_mass", "user_side", "long_delay", "fractional_delay", "virtual_damper", "grounded",
                           "filtered_damper", "actuator_lag", "overdamped", "stiff_link"}) {
    SCOPED_TRACE(kind);
    const Device device(random.device(kind));
    const double mass = device.bodies()[0].mass;
    const std::vector<SweepAxis> axes{{"body." + device.bodies()[0].name + ".mass", 0.2 * mass, 5.0 * mass, 30},
                                      {"wall.damping", 0.0, mass / device.loop().sampling_period, 30}};
    const ParameterSweep alone = parameter_sweep(device, axes);
    const ParameterSweep whole = parameter_sweep(device, axes, {.crossovers = true});
    ASSERT_EQ(alone.points.size(), whole.points.size());
    for (std::size_t i = 0; i < alone.points.size(); ++i) {
      const SweepPoint& a = alone.points[i];
      const SweepPoint& b = whole.points[i];
      ASSERT_EQ(a.status, b.status) << i;
      ASSERT_EQ(a.trust, b.trust) << i;
      ASSERT_EQ(a.limit.has_value(), b.limit.has_value()) << i;
      if (!a.limit) continue;
      ASSERT_NEAR(a.stiffness / b.stiffness, 1.0, 1e-12) << i;
      ASSERT_NEAR(a.limit->frequency, b.limit->frequency, 1e-12 * b.limit->frequency) << i;
      ASSERT_EQ(a.limit->limited_by.mode, b.limit->limited_by.mode) << i;
      ASSERT_EQ(a.limit->poles_leaving, b.limit->poles_leaving) << i;
    }
  }
}

TEST(ParameterSweep, KeepsWhatIsAskedFor) {
  const ParameterSweep sweep = parameter_sweep(Device(test::lhifam_parameters()), {{"loop.delay", 0.0, 1e-3, 3}},
                                               {.any_user = true, .crossovers = true});
  EXPECT_EQ(sweep.points[0].crossovers.size(), 4U);
  EXPECT_NEAR(sweep.points[0].any_user->stiffness, 5776.09, 0.01);
}

TEST(ParameterSweep, IsTrustedNoMoreThanItsDevice) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.uncertainty = Uncertainty{};
  parameters.uncertainty->warning = "measured by a guess";
  const std::vector<SweepAxis> axes{{"loop.delay", 0.0, 1e-3, 3}};
  const ParameterSweep doubtful = parameter_sweep(Device(parameters), axes, {.any_user = true});
  EXPECT_EQ(doubtful.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_EQ(doubtful.points[1].trust.reasons.front(), "measured by a guess");
  EXPECT_GT(doubtful.points[1].stiffness, 0.0);
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  const ParameterSweep refused = parameter_sweep(Device(parameters), axes, {.any_user = true});
  EXPECT_TRUE(refused.trust.refused());
  EXPECT_EQ(refused.trust.findings[0].severity, Finding::Severity::refusal);
  for (const SweepPoint& point : refused.points) {
    EXPECT_EQ(point.status, StiffnessStatus::refused);
    EXPECT_TRUE(std::isnan(point.stiffness));
    EXPECT_FALSE(point.limit || point.any_user);
  }
}

TEST(ParameterSweep, ProgressNeverFallsAndEndsAtOne) {
  double last = 0.0;
  (void)parameter_sweep(Device(test::lhifam_parameters()), {{"loop.delay", 0.0, 1e-3, 200}}, {}, [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  });
  EXPECT_EQ(last, 1.0);
}

TEST(ParameterSweep, RefusesWhatCannotBe) {
  const Device device(test::lhifam_parameters());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::vector<std::vector<SweepAxis>> wrong = {
      {},
      {{"loop.delay", 0.0, 1e-3, 2}, {"body.motor.mass", 0.1, 1.0, 2}, {"body.handle.mass", 0.1, 1.0, 2}},
      {{"loop.delays", 0.0, 1e-3, 2}},
      {{"wall.stiffness", 0.0, 1e3, 2}},
      {{"body.motor.coulomb", 0.0, 1.0, 2}},
      {{"loop.delay", 0.0, 1e-3, 1}},
      {{"loop.delay", 0.0, infinity, 3}},
      {{"loop.delay", 1e-3, 1e-3, 3}},
      {{"loop.delay", 0.0, 1e-3, 3, logarithmic}},
      {{"body.motor.mass", -1.0, 1.0, 3}},
      {{"loop.sampling_period", 1e-9, 1e-3, 3, logarithmic}, {"loop.delay", 0.0, 1e-2, 3}},
      {{"loop.delay", 0.0, 1e-3, 3}, {"loop.delay", 0.0, 1e-3, 3}},
      {{"loop.delay", 0.0, 1e-3, 1001}, {"body.motor.mass", 0.1, 1.0, 1000}},
  };
  for (const auto& axes : wrong) {
    const auto problem = find_sweep_problem(device, axes);
    ASSERT_TRUE(problem) << axes.size();
    EXPECT_FALSE(problem->allowed.empty());
    EXPECT_THROW((void)parameter_sweep(device, axes), Error);
  }
}

}  // namespace
}  // namespace zwidth
