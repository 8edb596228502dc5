// The search over frequency for the least wall that some grasp destabilises, against a dense grid of the discs themselves.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "campaign.hpp"
#include "stability/random_mechanism.hpp"
#include "zwidth/sampling/filter_section.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// B v(e^{jwT}), by the textbook's recursion.
std::complex<double> damper_at(const DeviceParameters& loop, double frequency) {
  const double period = loop.loop.sampling_period;
  const std::complex<double> back = std::polar(1.0, -frequency * period);
  const double pole = velocity_filter_pole(loop.wall.velocity_filter_hz, period);
  return loop.wall.damping / period * (1.0 - pole) * (1.0 - back) / (1.0 - pole * back);
}

// The least K > 0 with |1 + (K + d) c| = |K + d| r, by both roots; 0 where the damper alone is beaten.
double least_at(const GraspedPlant& plant, const DeviceParameters& loop, double frequency) {
  const auto [centre, radius] = plant.at(frequency);
  const std::complex<double> damper = damper_at(loop, frequency);
  const double power = (std::abs(centre) - radius) * (std::abs(centre) + radius);
  const double constant = 1.0 + 2.0 * (damper * centre).real() + power * std::norm(damper);
  if (constant < 0.0) return 0.0;
  const double half = centre.real() + power * damper.real();
  const double square = half * half - power * constant;
  if (square < 0.0) return infinity;
  // Neither root is a difference of what is nearly alike.
  const double larger = half > 0.0 ? -half - std::sqrt(square) : -half + std::sqrt(square);
  double least = infinity;
  for (const double root : {constant / larger, larger / power}) {
    if (root > 0.0) least = std::min(least, root);
  }
  return least;
}

// Evenly in the logarithm and evenly, then golden section beside what is low.
double least_of_grid(const GraspedPlant& plant, const DeviceParameters& loop, int count) {
  const double nyquist = std::numbers::pi / loop.loop.sampling_period;
  std::vector<double> frequencies;
  for (int i = 0; i <= count; ++i) {
    frequencies.push_back(nyquist * std::pow(1e-3 / std::numbers::pi, 1.0 - static_cast<double>(i) / count));
    if (i > 0) frequencies.push_back(nyquist * i / count);
  }
  std::ranges::sort(frequencies);
  std::vector<double> gains;
  for (const double each : frequencies) gains.push_back(least_at(plant, loop, std::min(each, nyquist)));
  const double scanned = std::ranges::min(gains);
  double least = scanned;
  for (std::size_t i = 1; i + 1 < gains.size(); ++i) {
    if (gains[i] > gains[i - 1] || gains[i] > gains[i + 1] || !(gains[i] < 1.05 * scanned)) continue;
    double first = frequencies[i - 1];
    double last = frequencies[i + 1];
    for (int step = 0; step < 40; ++step) {
      const double a = last - 0.618 * (last - first);
      const double b = first + 0.618 * (last - first);
      const double at_a = least_at(plant, loop, a);
      const double at_b = least_at(plant, loop, b);
      least = std::min({least, at_a, at_b});
      (at_a < at_b ? last : first) = at_a < at_b ? b : a;
    }
  }
  return least;
}

// Property: no frequency of the grid leaves less than the search says, with dampers and without.
TEST(GraspSearch, NoFrequencyLeavesLess) {
  const int count = test::by_tier(700, 10000);
  for (unsigned seed = 0; seed < test::by_tier(8U, 100U); ++seed) {
    SCOPED_TRACE(seed);
    auto [motion, loop] = test::random_mechanism(seed);
    test::Draws draws(5000 + seed);
    const Eigen::Vector3d normal = (motion.tip * draws.normal(motion.tip.cols(), 1)).normalized();
    if (seed % 2 == 1) loop.wall.damping = draws.decades(0.05, 20.0);
    const GraspLimit limit = any_grasp_limit(motion, loop, normal);
    const double least = least_of_grid(GraspedPlant(motion, loop, normal), loop, count);
    EXPECT_LE(limit.stiffness, least * (1.0 + 1e-6));
    const double quick = limits_along(motion, loop, {normal}).front().any_grasp->stiffness;
    EXPECT_TRUE(quick == limit.stiffness || std::abs(quick / limit.stiffness - 1.0) < 1e-4) << quick;
  }
}

// Three joints and two directions: the arm's own motion, which the tip does not see, has a corner far below the sampling rate. Towards
// w = 0 damping and the hold alone count, and K is in proportion to 1/T, whatever the masses.
TEST(GraspSearch, FollowsSlowCornersToRest) {
  TipMotion motion;
  motion.mass.resize(3, 3);
  motion.mass << 0.0606, 0.0291, 0.0085, 0.0291, 0.0172, 0.0055, 0.0085, 0.0055, 0.005;
  const double dampings[] = {2e-3, 2e-4, 1e-3};
  for (int i = 0; i < 3; ++i) test::add_element(motion, Eigen::Vector3d::Unit(i), 0.0, dampings[i]);
  motion.tip = Eigen::MatrixXd::Zero(3, 3);
  motion.tip.row(0) << -0.28, -0.24, -0.1;
  motion.tip.row(1) << 0.35, 0.16, 0.08;
  motion.sensed = motion.pushed = motion.tip;
  const Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  const auto limit_times_period = [&](double period) {
    DeviceParameters loop;
    loop.loop.sampling_period = period;
    const double limit = any_grasp_limit(motion, loop, normal).stiffness;
    EXPECT_NEAR(limits_along(motion, loop, {normal}).front().any_grasp->stiffness / limit, 1.0, 1e-4);
    return limit * period;
  };
  const double slow = limit_times_period(1e-3);
  EXPECT_NEAR(limit_times_period(1e-4) / slow, 1.0, 2e-3);
  EXPECT_NEAR(limit_times_period(4e-5) / slow, 1.0, 2e-3);
  // Slower yet it is not known; however slow, it is no motion at rest.
  for (double period = 2e-6; period > 1e-12; period *= 0.3) {
    SCOPED_TRACE(period);
    DeviceParameters loop;
    loop.loop.sampling_period = period;
    EXPECT_TRUE(std::isnan(any_grasp_limit(motion, loop, normal).stiffness));
  }
}

// Some grasp reaches the wall in a range of frequencies narrower than the search's points.
TEST(GraspSearch, SeesWhatFewFrequenciesLeave) {
  for (const unsigned seed : {473U, 582U}) {
    SCOPED_TRACE(seed);
    auto [motion, loop] = test::random_mechanism(seed);
    test::Draws draws(5000 + seed);
    loop.wall.damping = draws.decades(0.05, 20.0);
    const Eigen::Vector3d normal = (motion.tip * draws.normal(motion.tip.cols(), 1)).normalized();
    const double least = least_of_grid(GraspedPlant(motion, loop, normal), loop, 3000);
    ASSERT_TRUE(std::isfinite(least));
    EXPECT_LE(any_grasp_limit(motion, loop, normal).stiffness, least * (1.0 + 1e-6));
    EXPECT_LE(limits_along(motion, loop, {normal}).front().any_grasp->stiffness, least * (1.0 + 1e-4));
  }
}

}  // namespace
}  // namespace zwidth
