#include "zwidth/design/parameter_sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <mutex>

#include "lhifam.hpp"
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
      const CriticalStiffness expected = critical_stiffness(filtered_plant(Device(moved)));
      EXPECT_EQ(sweep.points[i * 11 + j].stiffness, expected.stiffness);
      EXPECT_TRUE(sweep.points[i * 11 + j].crossovers.empty());
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
