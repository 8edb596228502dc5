// Values for Díaz & Gil's LHIfAM, computed elsewhere with 100 digits: to 1e-9 relative, or to half a unit of the last
// digit where fewer are given.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "continuous_margins.hpp"
#include "lhifam.hpp"
#include "zwidth/model/two_mass.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

using test::handle_sensed;
using test::lhifam_parameters;
using test::reduced_pretension_parameters;
using test::rigid_parameters;
using test::with_delay;

constexpr double tolerance = 1e-9;

CriticalStiffness critical(DeviceParameters parameters) {
  return critical_stiffness(filtered_plant(Device(std::move(parameters))));
}

double decibels(double stiffness) { return 20.0 * std::log10(stiffness); }

// A number as printed; half a unit of its last digit where that is more than 1e-9 relative.
struct Printed {
  double value;
  double last_digit;
};

void expect_printed(double ours, Printed printed) {
  EXPECT_NEAR(ours, printed.value, std::max(tolerance * std::abs(printed.value), 0.5001 * printed.last_digit));
}

struct Row {
  friend std::ostream& operator<<(std::ostream& out, const Row& row) { return out << row.name; }

  std::string name;
  DeviceParameters device;
  std::vector<std::pair<Printed, Printed>> crossovers;  // frequency, stiffness
  Printed decibels;
};

const double nyquist = std::numbers::pi / 1e-3;

const Row rows[] = {
    {"rigid", rigid_parameters(), {{{36.0021706, 1e-7}, {7000.75625452837, 1e-11}}}, {76.9029, 1e-4}},
    {"motor_sensed",
     lhifam_parameters(),
     {{{38.5965268731856, 1e-13}, {8848.70869499712, 1e-11}},
      {{99.3973988782, 1e-10}, {140372.949098511, 1e-9}},
      {{618.073421799962, 1e-12}, {33895.4748192464, 1e-10}},
      {{nyquist, 0.0}, {135171032.89, 1e-2}}},
     {78.937598, 1e-6}},
    {"handle_sensed",
     handle_sensed(lhifam_parameters()),
     {{{35.9256621583905, 1e-13}, {6938.97435107544, 1e-11}}},
     {76.825906, 1e-6}},
    {"motor_sensed_250us",
     with_delay(lhifam_parameters(), 0.25e-3),
     {{{30.5463970177, 1e-10}, {5342.97877445573, 1e-11}},
      {{107.629, 1e-3}, {232562.929, 1e-3}},
      {{588.228885, 1e-6}, {23126.0794, 1e-4}}},
     {74.5557, 1e-4}},
    {"handle_sensed_250us",
     with_delay(handle_sensed(lhifam_parameters()), 0.25e-3),
     // the published list leaves out the one at Nyquist: by matrix exponential in double precision
     {{{29.3588752477, 1e-10}, {4641.4956115197, 1e-10}}, {{nyquist, 0.0}, {5181786978.0, 10.0}}},
     {73.3332, 1e-4}},
    {"rigid_250us", with_delay(rigid_parameters(), 0.25e-3), {{{29.3947, 1e-4}, {4667.17075, 1e-5}}}, {73.381, 1e-3}},
    {"rigid_1ms", with_delay(rigid_parameters(), 1e-3), {{{20.7836, 1e-4}, {2333.75334768, 1e-8}}}, {67.361, 1e-3}},
    {"rigid_2ms", with_delay(rigid_parameters(), 2e-3), {{{16.0972, 1e-4}, {1400.39307, 1e-5}}}, {62.925, 1e-3}},
    {"rigid_8ms", with_delay(rigid_parameters(), 8e-3), {{{8.7243, 1e-4}, {412.143648, 1e-6}}}, {52.301, 1e-3}},
};

class TheoryTable : public testing::TestWithParam<Row> {};

TEST_P(TheoryTable, AsPrinted) {
  const Row& row = GetParam();
  const CriticalStiffness result = critical(row.device);
  ASSERT_EQ(result.status, StiffnessStatus::finite);
  // A rigid device crosses at higher frequencies too when its delay is long; the table has the first only.
  if (row.device.bodies.size() > 1) {
    ASSERT_EQ(result.crossovers.size(), row.crossovers.size());
  }
  for (std::size_t i = 0; i < row.crossovers.size(); ++i) {
    expect_printed(result.crossovers[i].frequency, row.crossovers[i].first);
    expect_printed(result.crossovers[i].stiffness, row.crossovers[i].second);
  }
  EXPECT_EQ(result.stiffness, result.crossovers[0].stiffness);
  expect_printed(decibels(result.stiffness), row.decibels);
}

INSTANTIATE_TEST_SUITE_P(Rows, TheoryTable, testing::ValuesIn(rows), [](const auto& test) { return test.param.name; });

// Jury's conditions for z² + (c1 K - 1 - a) z + (a + c0 K), a = e^{-bT/m}, c0 = (m (1 - a) - a b T)/b²,
// c1 = (b T - m (1 - a))/b²: K < (1 - a)/c0 = b² (1 - a)/(m (1 - a) - a b T) and, at z = -1 with much damping,
// K < 2 (1 + a)/(c1 - c0). In long double, whose digits make up for the cancellation down to bT/m = 1e-3.
TEST(Theory, RigidClosedForms) {
  for (const double period : {1e-5, 1e-3, 1e-2}) {
    for (const double mass : {0.01, 0.2, 5.4}) {
      for (const double damping_ratio : {1e-3, 0.02, 0.3, 2.0, 5.0, 9.0}) {
        SCOPED_TRACE(testing::Message() << "T " << period << ", m " << mass << ", bT/m " << damping_ratio);
        DeviceParameters device = rigid_parameters();
        device.bodies[0].mass = mass;
        device.bodies[0].damping = damping_ratio * mass / period;
        device.loop.sampling_period = period;
        const long double b{static_cast<long double>(device.bodies[0].damping)};
        const auto m = static_cast<long double>(mass);
        const long double bt = b * static_cast<long double>(period);
        const long double a = std::exp(-bt / m);
        const long double one_minus_a = -std::expm1(-bt / m);
        const long double c0 = (m * one_minus_a - a * bt) / (b * b);
        const long double c1 = (bt - m * one_minus_a) / (b * b);
        long double exact = one_minus_a / c0;
        if (c1 > c0) exact = std::min(exact, 2.0L * (1.0L + a) / (c1 - c0));
        const CriticalStiffness result = critical(device);
        ASSERT_EQ(result.status, StiffnessStatus::finite);
        EXPECT_NEAR(result.stiffness / static_cast<double>(exact), 1.0, tolerance);
      }
    }
  }
}

TEST(Theory, QCriterion) {
  const Analysis analysis = analyze(Device(lhifam_parameters()));
  ASSERT_TRUE(analysis.q_criterion.has_value());
  expect_printed(decibels(analysis.q_criterion->stiffness), {78.5565, 1e-4});
  expect_printed(analysis.q_criterion->stiffness, {8468.9, 0.1});
  EXPECT_EQ(analysis.q_criterion->mode_matters, false);
}

TEST(Theory, FactorisedFormErrorOnTableOne) {
  const auto two = as_two_mass(Device(lhifam_parameters()));
  ASSERT_TRUE(two.has_value());
  EXPECT_NEAR(two_mass_factors(*two).relative_error, 2.1e-8, 0.05e-8);
}

// One crossing within the figures' range; another, far above, at Nyquist (by matrix exponential in double precision).
TEST(Theory, ReducedPretensionCrossesOnce) {
  const CriticalStiffness result = critical(reduced_pretension_parameters());
  ASSERT_EQ(result.crossovers.size(), 2U);
  EXPECT_EQ(result.crossovers[1].frequency, nyquist);
  expect_printed(result.crossovers[1].stiffness, {199859895.8, 1.0});
  expect_printed(result.crossovers[0].frequency, {411.2257, 1e-4});
  expect_printed(decibels(result.stiffness), {87.2116, 1e-4});
  EXPECT_EQ(result.limit->limited_by.kind, Oscillator::Kind::vibration_mode);
  EXPECT_EQ(result.limit->limited_by.mode, 1);
}

TEST(Theory, ReducedPretensionHandleSensed) {
  const CriticalStiffness result = critical(handle_sensed(reduced_pretension_parameters()));
  ASSERT_EQ(result.status, StiffnessStatus::finite);
  expect_printed(result.stiffness, {6790.5752652799, 1e-10});
  expect_printed(result.limit->frequency, {35.692, 1e-3});
  expect_printed(decibels(result.stiffness), {76.638, 1e-3});
}

// 250 us of delay: the measured margin appears on the newly born rigid-body crossing, not on the resonance.
TEST(Theory, ReducedPretensionWithDelay) {
  const CriticalStiffness result = critical(with_delay(reduced_pretension_parameters(), 0.25e-3));
  ASSERT_EQ(result.status, StiffnessStatus::finite);
  expect_printed(decibels(result.stiffness), {80.216, 1e-3});
  expect_printed(result.limit->frequency, {37.7, 0.1});
  EXPECT_EQ(result.limit->limited_by.kind, Oscillator::Kind::rigid_body);
  ASSERT_EQ(result.crossovers.size(), 3U);
  const Crossover& resonance = result.crossovers[2];
  expect_printed(resonance.frequency / (2.0 * std::numbers::pi), {60.5, 0.1});
  expect_printed(decibels(resonance.stiffness), {83.83, 0.01});
  EXPECT_EQ(resonance.limited_by.kind, Oscillator::Kind::vibration_mode);
}

// A spring of 363025 N/m in the user's hand, passive, and yet below the rigid bound 2b/T = 7000 N/m.
TEST(Theory, SpringUser) {
  DeviceParameters device = lhifam_parameters();
  device.user.stiffness = 363025.0;
  const CriticalStiffness result = critical(device);
  ASSERT_EQ(result.status, StiffnessStatus::finite);
  expect_printed(result.stiffness, {5776.115, 1e-3});
}

// MathWorks' documentation of allmargin.
TEST(Theory, AllmarginExample) {
  const LoopMargins margins = test::continuous_margins({{25.0}, {1.0, 10.0, 10.0, 10.0}});
  ASSERT_TRUE(margins.stable);
  EXPECT_NEAR(margins.gain_margin.value(), 3.6, 1e-12);
  EXPECT_FALSE(margins.lower_gain_margin.has_value());
  expect_printed(margins.phase_margin.value() * 180.0 / std::numbers::pi, {29.1104, 1e-4});
  expect_printed(margins.delay_margin.value(), {0.2847, 1e-4});
}

// The hold of 1/(s + 1), T = 1, is (1 - e^-1)/(z - e^-1): the only crossover is at Nyquist, K = (1 + e^-1)/(1 - e^-1).
TEST(Theory, CrossoverAtNyquistAlone) {
  const CriticalStiffness result = critical(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1.0));
  ASSERT_EQ(result.crossovers.size(), 1U);
  EXPECT_EQ(result.crossovers[0].frequency, std::numbers::pi);
  EXPECT_EQ(result.crossovers[0].poles_leaving, 1);
  expect_printed(result.stiffness, {2.16395, 1e-5});
  EXPECT_NEAR(result.stiffness, (1.0 + std::exp(-1.0)) / (1.0 - std::exp(-1.0)), 1e-14);
}

}  // namespace
}  // namespace zwidth
