// The frequency responses as one call: against the plant's own response, with the wall's damper closed by hand; the
// crossovers lie on the curve.
#include "zwidth/stability/bode.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lhifam.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;

DeviceParameters damped_lhifam() {
  DeviceParameters device = test::with_delay(test::lhifam_parameters(), 2.25e-3);
  device.wall.damping = 20.0;
  device.wall.velocity_filter_hz = 60.0;
  device.wall.filters = {{.kind = WallFilter::Kind::low_pass, .frequency_hz = 200.0}};
  return device;
}

TEST(Bode, IsThePlantsResponseWithTheDamperClosed) {
  const Device device(damped_lhifam());
  const FilteredPlant plant = filtered_plant(device);
  const double period = device.loop().sampling_period;
  const double pole = std::exp(-2.0 * pi * 60.0 * period);
  const Bode found = bode(device);
  ASSERT_GT(found.sampled.size(), 400U);
  for (const BodePoint& point : found.sampled) {
    const std::complex<double> shift = std::polar(1.0, -point.frequency * period);
    const std::complex<double> damper = 20.0 * (1.0 - shift) / period * (1.0 - pole) / (1.0 - pole * shift);
    const std::complex<double> open = response(plant, point.frequency);
    const std::complex<double> closed = open / (1.0 + damper * open);
    const std::complex<double> given =
        std::polar(std::pow(10.0, point.magnitude_db / 20.0), point.phase_deg * pi / 180.0);
    // Rounding of angles near z = 1 (1 - shift loses digits) and of decibels.
    EXPECT_LT(std::abs(given - closed), 1e-9 * std::abs(closed)) << point.frequency;
  }
}

TEST(Bode, PhaseAtEachCrossoverIsHalfATurnAndItsGainTheStiffness) {
  const Device device(damped_lhifam());
  const Bode whole = bode(device);
  int met = 0;
  for (const Crossover& crossover : whole.analysis.critical.crossovers) {
    if (crossover.frequency >= pi / device.loop().sampling_period) continue;
    const Bode from_there = bode(device, {.from = crossover.frequency});
    ASSERT_FALSE(from_there.sampled.empty());
    const BodePoint& point = from_there.sampled.front();
    EXPECT_EQ(point.frequency, crossover.frequency);
    EXPECT_NEAR(std::remainder(point.phase_deg - 180.0, 360.0), 0.0, 1e-6) << crossover.frequency;
    EXPECT_NEAR(point.magnitude_db, -20.0 * std::log10(crossover.stiffness), 1e-8) << crossover.frequency;
    ++met;
  }
  EXPECT_GE(met, 3);
}

TEST(Bode, AnAnalysisAtHandGivesTheSame) {
  const Device device(damped_lhifam());
  const Bode own = bode(device, {.from = 10.0, .to = 1000.0, .points = 50});
  const Bode given = bode(device, analyze(device), {.from = 10.0, .to = 1000.0, .points = 50});
  ASSERT_EQ(own.sampled.size(), given.sampled.size());
  for (std::size_t i = 0; i < own.sampled.size(); ++i) {
    EXPECT_EQ(own.sampled[i].magnitude_db, given.sampled[i].magnitude_db);
    EXPECT_EQ(own.sampled[i].phase_deg, given.sampled[i].phase_deg);
  }
  EXPECT_FALSE(own.analysis.any_user.has_value());
}

TEST(Bode, SampledEndsAtNyquistContinuousGoesOn) {
  const Bode found = bode(Device(test::lhifam_parameters()), {.to = 5000.0});
  EXPECT_LE(found.sampled.back().frequency, pi / 1e-3);
  EXPECT_EQ(found.continuous.back().frequency, 5000.0);
  ASSERT_GT(found.continuous.size(), found.sampled.size());
  for (std::size_t i = 0; i < found.sampled.size(); ++i) {
    EXPECT_EQ(found.sampled[i].frequency, found.continuous[i].frequency);
  }
}

// P(-1) of a delay of whole samples is real and continues the curve; its sign was the other one where they are odd.
TEST(Bode, PhaseGoesOnUpToNyquist) {
  for (const double samples : {0.0, 1.0, 2.0, 3.0}) {
    const Device device(test::with_delay(
        test::transfer_function_parameters({94.896}, {1.0, 62.0, 1833.0, 94896.0}, 1e-3), 1e-3 * samples));
    const Bode found = bode(device);
    ASSERT_GE(found.sampled.size(), 2U);
    const BodePoint& last = found.sampled.back();
    EXPECT_NEAR(last.frequency, pi / 1e-3, 1e-6);
    EXPECT_NEAR(last.phase_deg, found.sampled[found.sampled.size() - 2].phase_deg, 15.0) << samples;
    EXPECT_NEAR(last.phase_deg, -360.0 - 180.0 * samples, 1e-6) << samples;
  }
}

TEST(Bode, RangeHoldsEverythingThatMatters) {
  const Device device(test::lhifam_parameters());
  Analysis analysis = analyze(device, limit_and_wall_only());
  analysis.modes.push_back({0.7, 0.1});
  EXPECT_EQ(bode_range(device, analysis).from, 0.1);
  EXPECT_EQ(bode_range(device, analysis).to, pi / 1e-3);
  // An end below its own beginning moves that.
  EXPECT_LT(bode_range(device, analysis, {.to = 0.05}).from, 0.05);
  EXPECT_EQ(bode(device, {.to = 0.05}).sampled.back().frequency, 0.05);
}

TEST(Bode, ProblemsNameTheMember) {
  const Device device(test::lhifam_parameters());
  EXPECT_FALSE(find_problem(BodeOptions{}).has_value());
  EXPECT_EQ(find_problem(BodeOptions{.from = 0.0})->member, "from");
  EXPECT_EQ(find_problem(BodeOptions{.to = std::nan("")})->member, "to");
  EXPECT_EQ(find_problem(BodeOptions{.from = 100.0, .to = 10.0})->member, "to");
  EXPECT_EQ(find_problem(BodeOptions{.points = 1})->member, "points");
  EXPECT_FALSE(find_problem(BodeOptions{.from = 4000.0}).has_value());
  EXPECT_EQ(find_problem(BodeOptions{.from = 4000.0}, device)->member, "from");
  EXPECT_THROW(static_cast<void>(bode(device, {.from = 4000.0})), Error);
}

// Numbers that nobody determined: the curve is shown, no crossover.
TEST(Bode, RefusedDevicesHaveNoCrossover) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.uncertainty.emplace().warning = "nothing is determined";
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  const Bode found = bode(Device(parameters));
  EXPECT_TRUE(found.analysis.trust.refused());
  EXPECT_TRUE(found.analysis.critical.crossovers.empty());
  EXPECT_FALSE(found.sampled.empty());
}

}  // namespace
}  // namespace zwidth
