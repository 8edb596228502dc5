#include "zwidth/control/sampled_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

constexpr double period = 1e-3;

ControllerOptions wall(double stiffness, double damping = 0.0, double filter_hz = 0.0) {
  return wall_controller({.stiffness = stiffness, .damping = damping, .velocity_filter_hz = filter_hz});
}

TEST(SampledController, ASpringPullsFromBothSides) {
  ControllerOptions options = wall(2000.0);
  options.position = 0.5;
  SampledController controller(options, period);
  EXPECT_EQ(controller.update(0.503), -2000.0 * (0.503 - 0.5));
  EXPECT_EQ(controller.update(0.25), 500.0);
}

TEST(SampledController, TheFirstCallKnowsNoVelocity) {
  SampledController controller(wall(0.0, 3.0), period);
  EXPECT_EQ(controller.update(0.7), 0.0);
  EXPECT_NEAR(controller.update(0.701), -3.0 * 1.0, 1e-12);
  controller.reset();
  EXPECT_EQ(controller.update(0.2), 0.0);
}

// v[k] = a v[k-1] + (1 - a)(y[k] - y[k-1])/T under a steady motion: 1 - a^k of its velocity.
TEST(SampledController, TheVelocityFilterApproachesASteadyVelocity) {
  const double filter_hz = 40.0;
  const double a = std::exp(-2.0 * std::numbers::pi * filter_hz * period);
  SampledController controller(wall(0.0, 5.0, filter_hz), period);
  for (int k = 0; k < 200; ++k) {
    EXPECT_NEAR(controller.update(0.2 * k * period), -5.0 * 0.2 * (1.0 - std::pow(a, k)), 1e-12) << k;
  }
}

TEST(SampledController, AOneSidedWallNeverPullsAndNeverActsOutside) {
  ControllerOptions options = wall(1000.0, 50.0);
  options.contact = ControllerOptions::Contact::unilateral;
  SampledController controller(options, period);
  EXPECT_EQ(controller.update(-1e-3), 0.0);
  EXPECT_LT(controller.update(1e-3), 0.0);
  EXPECT_EQ(controller.update(0.9e-3), 0.0);  // leaves so fast that the damper would pull
  EXPECT_EQ(controller.update(-1e-4), 0.0);
  EXPECT_EQ(controller.update(0.0), 0.0);
}

TEST(SampledController, ARelaySwitchesBeyondItsHysteresisOnly) {
  ControllerOptions options;
  options.kind = ControllerOptions::Kind::relay;
  options.amplitude = 2.0;
  options.hysteresis = 0.1;
  SampledController controller(options, period);
  EXPECT_EQ(controller.update(0.05), 2.0);  // undecided: starts at +d
  EXPECT_EQ(controller.update(0.1), 2.0);   // exactly at the threshold: not beyond
  EXPECT_EQ(controller.update(0.11), -2.0);
  EXPECT_EQ(controller.update(-0.1), -2.0);
  EXPECT_EQ(controller.update(-0.11), 2.0);
  controller.reset();
  EXPECT_EQ(controller.update(0.0), 2.0);
}

ControllerOptions filtered_wall(double stiffness, std::vector<WallFilter> filters) {
  ControllerOptions options = wall(stiffness);
  options.filters = std::move(filters);
  return options;
}

const WallFilter slow_average{.kind = WallFilter::Kind::digital, .numerator = {0.25, 0.0}, .denominator = {1.0, -0.75}};

// The filters against their difference equation in past values, as textbooks write it.
TEST(SampledController, FiltersRunAsTheirDifferenceEquations) {
  const std::vector<double> b{0.2, -0.3, 0.15};
  const std::vector<double> a{1.0, -1.5, 0.7};
  SampledController controller(
      filtered_wall(100.0, {slow_average, {.kind = WallFilter::Kind::digital, .numerator = b, .denominator = a}}),
      period);
  double first = 0.0;
  std::vector<double> in(3, 0.0);
  std::vector<double> out(3, 0.0);
  for (int k = 0; k < 500; ++k) {
    const double measured = 1e-3 * std::sin(0.37 * k * k);
    first = 0.25 * -100.0 * measured + 0.75 * first;
    in = {first, in[0], in[1]};
    out = {b[0] * in[0] + b[1] * in[1] + b[2] * in[2] - a[1] * out[0] - a[2] * out[1], out[0], out[1]};
    EXPECT_NEAR(controller.update(measured), out[0], 1e-14) << k;
  }
}

// Gain and phase of every section under a sine, at rest: response().
TEST(SampledController, FiltersHaveTheirResponse) {
  using enum WallFilter::Kind;
  for (const WallFilter& filter :
       {WallFilter{.kind = low_pass, .frequency_hz = 60.0},
        WallFilter{.kind = low_pass, .frequency_hz = 60.0, .order = 2}, WallFilter{.kind = notch, .frequency_hz = 70.0},
        WallFilter{.kind = lead_lag, .frequency_hz = 40.0, .ratio = 0.3}}) {
    SampledController controller(filtered_wall(1.0, {filter}), period);
    const double angle = 0.3;
    const std::complex<double> gain = response(filter_section(filter, period), angle);
    for (int k = 0; k < 3000; ++k) {
      const double force = controller.update(std::cos(angle * k));
      if (k > 2000) {
        EXPECT_NEAR(-force, (gain * std::polar(1.0, angle * k)).real(), 1e-11);
      }
    }
  }
}

TEST(SampledController, AFilteredOneSidedWallNeverPulls) {
  // A lead: its output swings to the other side when the force ends.
  ControllerOptions options =
      filtered_wall(1000.0, {{.kind = WallFilter::Kind::lead_lag, .frequency_hz = 40.0, .ratio = 9.0}, slow_average});
  options.contact = ControllerOptions::Contact::unilateral;
  SampledController controller(options, period);
  EXPECT_EQ(controller.update(-1e-3), 0.0);
  EXPECT_LT(controller.update(1e-3), 0.0);
  EXPECT_LT(controller.update(1e-3), 0.0);
  for (int k = 0; k < 100; ++k) EXPECT_LE(controller.update(-1e-3), 0.0);  // what is left in the filters, never a pull
  ControllerOptions average = filtered_wall(1000.0, {slow_average});
  average.contact = ControllerOptions::Contact::unilateral;
  SampledController fading(average, period);
  EXPECT_DOUBLE_EQ(fading.update(1e-3), -0.25);
  EXPECT_DOUBLE_EQ(fading.update(-1e-3), -0.1875);  // outside the wall the force fades
}

TEST(SampledController, ResetEmptiesTheFilters) {
  SampledController controller(filtered_wall(100.0, {slow_average}), period);
  const double first = controller.update(1e-3);
  EXPECT_NE(controller.update(1e-3), first);
  controller.reset();
  EXPECT_EQ(controller.update(1e-3), first);
}

TEST(SampledController, NoneIsNone) {
  SampledController controller({}, period);
  EXPECT_EQ(controller.update(123.0), 0.0);
}

TEST(SampledController, RefusedOutsideItsDomain) {
  const double nan = std::nan("");
  EXPECT_THROW(SampledController(wall(-1.0), period), Error);
  EXPECT_THROW(SampledController(wall(nan), period), Error);
  EXPECT_THROW(SampledController(wall(1.0, -1.0), period), Error);
  EXPECT_THROW(SampledController(wall(1.0, 1.0, -1.0), period), Error);
  EXPECT_THROW(SampledController(wall(1.0), 0.0), Error);
  EXPECT_THROW(SampledController(wall(1.0), nan), Error);
  EXPECT_THROW(
      SampledController(filtered_wall(1.0, {{.kind = WallFilter::Kind::notch, .frequency_hz = 600.0}}), period), Error);
  EXPECT_THROW(SampledController(filtered_wall(1.0, std::vector<WallFilter>(21, slow_average)), period), Error);
  ControllerOptions relay;
  relay.kind = ControllerOptions::Kind::relay;
  EXPECT_THROW(SampledController(relay, period), Error);
  relay.amplitude = 1.0;
  relay.position = std::numeric_limits<double>::infinity();
  EXPECT_THROW(SampledController(relay, period), Error);
}

}  // namespace
}  // namespace zwidth
