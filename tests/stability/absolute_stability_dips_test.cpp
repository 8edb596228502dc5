// Limits over all passive users of devices that are damped on one body only, the others not at all or hardly: where that
// body does not move, below Nyquist or far above, a user who resonates is not damped.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "stability/second_route/pole_count.hpp"
#include "stability/users/dissipation_zeros.hpp"
#include "stability/users/termination_discs.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/worst_user.hpp"

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;

/// y hangs on x and holds it still at sqrt(2.2e6/0.13) rad/s, 1.17 times Nyquist; x alone is damped.
DeviceParameters four_bodies() {
  DeviceParameters device;
  device.bodies = {
      {"m", 1.6, 0.0, 0.0, 0.0}, {"x", 0.45, 15.0, 0.0, 0.0}, {"y", 0.13, 0.0, 0.0, 0.0}, {"h", 2.1, 0.0, 0.0, 0.0}};
  device.links = {{0, 1, 9.3e5, 0.0}, {1, 3, 1.1e5, 0.0}, {1, 2, 2.2e6, 0.0}};
  device.loop = {0, 3, 3, 0.89e-3, 1.1e-3};
  return device;
}

DeviceParameters three_bodies() {
  DeviceParameters device;
  device.bodies = {{"m", 0.56, 1e-4, 0.0, 0.0}, {"x", 1.3, 26.0, 0.0, 0.0}, {"y", 0.057, 0.0, 0.0, 0.0}};
  device.links = {{0, 1, 4.77e6, 0.0}, {1, 2, 1.53e6, 0.0}};
  device.loop = {0, 0, 0, 1e-3, 0.0};
  return device;
}

/// The critical stiffness with the mass or spring that resonates with the device at that frequency.
DeviceParameters held_by_resonant_user(DeviceParameters device, double frequency) {
  const std::size_t held = device.loop.held;
  const ModalForm motion = modal_form(Device(device), {held, held}, ActuatorLag::left_out);
  const double reactance = 1.0 / (frequency * response(motion, frequency).real());
  if (reactance > 0.0) device.user.mass = reactance / frequency;
  if (reactance < 0.0) device.user.stiffness = -reactance * frequency;
  return device;
}

int unstable_poles(const DeviceParameters& held, double stiffness) {
  return PoleCount(Device(held)).in_digits(stiffness).value_or(-1);
}

// The spring of the issue leaves 180.1 N/m; beside it any wall is unstable with some spring: there the damped body moves as
// the distance from its antiresonance, so damping falls with its square and the wall's drive in proportion.
TEST(AbsoluteStabilityDips, SomeSpringDestabilisesAnyWallWhereTheDampedBodyStandsStill) {
  DeviceParameters device = four_bodies();
  const AbsoluteStabilityLimit limit = absolute_stability_limit(Device(device));
  EXPECT_TRUE(limit.trust.sound());
  EXPECT_EQ(limit.stiffness, 0.0);
  const double antiresonance = std::sqrt(2.2e6 / 0.13);
  // Poles outside the unit circle, counted with a hundred digits.
  EXPECT_EQ(unstable_poles(held_by_resonant_user(device, antiresonance * (1.0 - 1e-8)), 170.0), 2);
  EXPECT_EQ(unstable_poles(held_by_resonant_user(device, antiresonance * (1.0 - 1e-8)), 1.0), 2);
  EXPECT_EQ(unstable_poles(held_by_resonant_user(device, antiresonance * (1.0 - 1e-9)), 0.01), 2);
  EXPECT_EQ(unstable_poles(held_by_resonant_user(device, antiresonance * (1.0 + 1e-9)), 0.01), 0);
  device.user.stiffness = 35425631.533672065;
  EXPECT_GE(critical_stiffness(filtered_plant(Device(device)), {}).stiffness, limit.stiffness);
  EXPECT_NEAR(critical_stiffness(filtered_plant(Device(device)), {}).stiffness, 180.0, 1.5);
}

/// The least K at one frequency, from the discs of 2 N + 1 aliases of three_bodies() in long double and the series' rest.
long double stiffness_of_discs(long double w) {
  using Complex = std::complex<long double>;
  constexpr int aliases = 20000;
  constexpr long double period = 1e-3L;
  constexpr long double spacing = 2.0L * std::numbers::pi_v<long double> / period;
  const Complex hold = (1.0L - std::exp(Complex(0.0L, -w * period))) / period;
  Complex plant = 0.0L;
  Complex shift = 0.0L;
  long double radius = 0.0L;
  for (int k = -aliases; k <= aliases; ++k) {
    const Complex s(0.0L, w + spacing * k);
    const Complex y = 0.057L * s * s + 1.53e6L;
    const Complex x = 1.3L * s * s + 26.0L * s + 4.77e6L + 1.53e6L - 1.53e6L * 1.53e6L / y;
    const Complex motor = 1.0L / (0.56L * s * s + 1e-4L * s + 4.77e6L - 4.77e6L * 4.77e6L / x);
    const Complex middle = motor * 4.77e6L / x;
    const long double conductance = std::norm(s) * (1e-4L * std::norm(motor) + 26.0L * std::norm(middle));
    const Complex disc = motor * motor / (2.0L * conductance) * s;
    plant += hold / s * motor;
    shift += hold / s * disc;
    radius += std::abs(hold / s * disc);
  }
  // Far up D/(jw) is 1/(2 w² d).
  const long double rest = 2.0L / (2.0L * 1e-4L * spacing * spacing * (aliases + 0.5L));
  shift += hold * rest;
  radius += std::abs(hold) * rest;
  const long double half = (plant - shift).real();
  const long double power = std::norm(plant) - 2.0L * (plant * std::conj(shift)).real() +
                            (std::abs(shift) - radius) * (std::abs(shift) + radius);
  return 1.0L / (std::sqrt(half * half - power) - half);
}

// Without the dip 6.139; a spring reaches 4.895, users with absorbers what the discs allow.
TEST(AbsoluteStabilityDips, ADipFarNarrowerThanItsFrequencyIsSeenAboveNyquist) {
  const DeviceParameters device = three_bodies();
  const AbsoluteStabilityLimit limit = absolute_stability_limit(Device(device));
  EXPECT_TRUE(limit.trust.sound());
  EXPECT_NEAR(limit.stiffness, 4.016853013, 1e-8);
  EXPECT_NEAR(static_cast<double>(stiffness_of_discs(static_cast<long double>(limit.frequency))), limit.stiffness,
              1e-8);
  const DeviceParameters held = held_by_resonant_user(device, std::sqrt(1.53e6 / 0.057) * (1.0 - 1e-6));
  EXPECT_NEAR(critical_stiffness(filtered_plant(Device(held)), {}).stiffness, 4.895, 1e-3);
  const auto worst = worst_user(Device(device), limit);
  ASSERT_TRUE(worst);
  EXPECT_LE(worst->critical_stiffness, 4.8951);
  EXPECT_GE(worst->critical_stiffness, limit.stiffness);
  EXPECT_EQ(unstable_poles(held_by(Device(device), worst->user).parameters(), worst->critical_stiffness * 1.001), 2);
}

// With no damping at the held body at all the discs of high frequencies grow without bound.
TEST(AbsoluteStabilityDips, DiscsWhoseSumOverAliasesDivergesLeaveNothing) {
  DeviceParameters device = three_bodies();
  device.bodies[0].damping = 0.0;
  const AbsoluteStabilityLimit limit = absolute_stability_limit(Device(device));
  EXPECT_EQ(limit.stiffness, 0.0);
  EXPECT_TRUE(limit.trust.sound());
  device.user.stiffness = 1e17;
  EXPECT_EQ(unstable_poles(device, 1e-3), 2);
}

TEST(DissipationZeros, AreTheAntiresonancesOfTheBranchesOnTheWayToTheDamper) {
  const DeviceParameters device = four_bodies();
  const DissipationZeros zeros(Device(device), pi / device.loop.sampling_period);
  ASSERT_EQ(zeros.sharp.size(), 2U);
  // m on its link with x standing still; neither it nor the held body's own force moves x.
  EXPECT_NEAR(zeros.sharp[0].frequency, std::sqrt(9.3e5 / 1.6), 1e-9);
  EXPECT_EQ(zeros.sharp[0].depth, 0.0);
  EXPECT_EQ(zeros.sharp[0].order, 2);
  EXPECT_NEAR(zeros.sharp[1].frequency, std::sqrt(2.2e6 / 0.13), 1e-9);
  EXPECT_EQ(zeros.sharp[1].depth, 0.0);
  EXPECT_EQ(zeros.sharp[1].order, 1);  // the motor does not move the held body there
  EXPECT_FALSE(zeros.discs_diverge);
  EXPECT_FALSE(zeros.is_unknown);
}

// The Taylor polynomials against the sums over modes, where those still have digits.
TEST(DissipationZeros, DiscsBesideThemAreThoseOfTheDirectSums) {
  const DeviceParameters device = three_bodies();
  const TerminationDiscs discs{Device(device)};
  ASSERT_EQ(discs.zeros().sharp.size(), 1U);
  const SharpZero& zero = discs.zeros().sharp[0];
  EXPECT_NEAR(zero.frequency, std::sqrt(1.53e6 / 0.057), 1.0);
  EXPECT_GT(zero.depth, 1e-5);
  EXPECT_LT(zero.depth, 1e-3);
  const double image = 2.0 * pi / 1e-3 - zero.frequency;
  for (const double away : {-0.02, -1e-3, -1e-6, 0.0, 1e-6, 1e-3, 0.02}) {
    const double at = image * (1.0 + away);
    const TerminationDiscs::Disc disc = discs.at(at);
    const double least = 1.0 / (std::sqrt(disc.centre.real() * disc.centre.real() - disc.power) - disc.centre.real());
    EXPECT_NEAR(static_cast<double>(stiffness_of_discs(static_cast<long double>(at))), least, 1e-8 * least) << away;
  }
}

// Beyond the bodies whose polynomials a hundred digits hold a limit is sound only where all are damped alike.
TEST(AbsoluteStabilityDips, AreDoubtOfLongChainsThatOneBodyDamps) {
  DeviceParameters device;
  for (int i = 0; i < 14; ++i) {
    device.bodies.push_back({"b" + std::to_string(i), 0.3, 0.5, 0.0, 0.0});
    if (i > 0) device.links.push_back({static_cast<std::size_t>(i - 1), static_cast<std::size_t>(i), 2e5, 0.0});
  }
  device.loop = {0, 0, 13, 1e-3, 0.0};
  EXPECT_TRUE(absolute_stability_limit(Device(device)).trust.sound());
  for (int i = 1; i < 14; ++i) device.bodies[static_cast<std::size_t>(i)].damping = 1e-7;
  EXPECT_FALSE(absolute_stability_limit(Device(device)).trust.sound());
}

}  // namespace
}  // namespace zwidth
