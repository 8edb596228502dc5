// Devices on which the limit over all passive users is hard to find: hardly coupled to the user, with long delays, or
// reached by very heavy users. The users named were found by other means; none may be worse than the limit.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "campaign.hpp"
#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "stability/loop/damper_response.hpp"
#include "stability/users/termination_discs.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth {
using namespace internal;
namespace {

VirtualDamper damper_of(const DeviceParameters& parameters) {
  return {parameters.wall.damping, parameters.wall.velocity_filter_hz};
}

double limit_of(const DeviceParameters& parameters) {
  return absolute_stability_limit(Device(parameters), damper_of(parameters)).stiffness;
}

double with_user(DeviceParameters parameters, User user) {
  parameters.user = user;
  return critical_stiffness(filtered_plant(Device(parameters)), damper_of(parameters)).stiffness;
}

TEST(AbsoluteStabilityLimit, IsNeverAboveTheFreeDevice) {
  DeviceParameters loose = test::lhifam_parameters();
  loose.links[0].stiffness = 0.1;
  loose.links[0].damping = 0.001;
  loose.wall.damping = 10.0;
  const AbsoluteStabilityLimit limit = absolute_stability_limit(Device(loose), damper_of(loose));
  EXPECT_EQ(limit.stiffness, with_user(loose, {}));
  EXPECT_TRUE(limit.needs_no_user);

  DeviceParameters chain;
  chain.bodies = {{"motor", 0.3, 0.5, 0.0, 0.0}, {"mid", 1.0, 0.5, 0.0, 0.0}, {"grip", 0.5, 0.5, 0.0, 0.0}};
  chain.links = {{0, 1, 100.0, 0.01}, {1, 2, 100.0, 0.01}};
  chain.loop = {0, 0, 2, 1e-3, 0.0};
  chain.wall.damping = 20.0;
  EXPECT_LE(limit_of(chain), with_user(chain, {}));
}

TEST(AbsoluteStabilityLimit, IsNeverAboveTheFreeDeviceAtRandom) {
  for (std::size_t seed = 0; seed < test::by_tier(105U, 420U); ++seed) {
    test::RandomDevices random(seed + 52000);
    const auto kind = test::device_kinds[seed % test::device_kinds.size()];
    DeviceParameters parameters = random.device(kind);
    if (parameters.transfer_function) continue;
    if (random.chance(0.5)) {
      for (Link& link : parameters.links) link.stiffness *= 1e-4, link.damping *= 1e-4;
    }
    parameters.user = {};
    EXPECT_LE(limit_of(parameters), with_user(parameters, {})) << kind << ", seed " << seed;
  }
}

TEST(AbsoluteStabilityLimit, IsFoundBetweenTheTurnsOfALongDelay) {
  DeviceParameters device;
  device.bodies = {{"b0", 1.5295326724968648, 0.0013156331966640098, 0.0, 0.0},
                   {"b1", 0.04077926558920716, 0.01655143403533463, 0.0, 0.0},
                   {"b2", 2.6742888302306187, 3.2980268589834005, 0.0, 0.0}};
  device.links = {{0, 1, 6398.958577618818, 0.1411971606521172}, {1, 2, 385.8848282529044, 0.04696904701478196}};
  device.loop = {0, 0, 0, 0.002426012052237747, 0.07350816518280374};
  EXPECT_LE(limit_of(device), with_user(device, {0.0523, 0.0, 1111.0}));

  device.bodies = {{"b0", 0.10012221750544761, 0.044647319829528444, 0.0, 0.0},
                   {"b1", 0.4223279310884913, 0.010140949593993712, 0.0, 0.0},
                   {"b2", 0.21293198201901278, 9.388290874101862, 0.0, 0.0}};
  device.links = {{0, 1, 25.87535356960956, 0.00910502206101117}, {1, 2, 8618.886726934583, 5.841878190775464}};
  device.loop = {0, 0, 0, 1e-3, 0.12230145663743265};
  EXPECT_LE(limit_of(device), with_user(device, {100.0, 0.0, 396774.0}));
}

TEST(AbsoluteStabilityLimit, HoldsForVeryHeavyUsers) {
  DeviceParameters device;
  device.bodies = {{"b0", 0.044647319829528444, 0.001018837290140851, 0.0, 0.0},
                   {"b1", 0.03795322115405727, 0.0, 0.0, 0.0},
                   {"b2", 2.2951065134164987, 0.007999912941547503, 0.0, 0.0}};
  device.links = {{0, 1, 4269538.964147103, 6.171618788152397}, {1, 2, 35.28546210415129, 0.05233275682671157}};
  device.loop = {0, 1, 0, 0.00010014380080098681, 0.0002373110193472817};
  const double limit = limit_of(device);
  for (const double mass : {1e3, 1e5, 1e7, 1e9}) EXPECT_LE(limit, with_user(device, {mass, 0.0, 0.0}) * (1.0 + 1e-8));

  DeviceParameters delayed = test::lhifam_parameters();
  delayed.loop.sampling_period = 1e-4;
  delayed.loop.delay = 0.100037;
  delayed.loop.held = 0;
  EXPECT_LE(limit_of(delayed), with_user(delayed, {1e5, 0.0, 0.0}) * (1.0 + 1e-8));
}

// Only the motor is damped, held two springs away: far above its modes the held body hardly moves it, and at 81.34 rad/s
// not at all (an undamped body there absorbs). Values by 50 digits at 3362.6108 rad/s, Nyquist.
TEST(AbsoluteStabilityLimit, OfAChainThatOnlyItsMotorDamps) {
  DeviceParameters device;
  device.bodies = {{"b0", 0.03431438631269368, 0.07394725824682534, 0.0, 0.0},
                   {"b1", 7.535880186559966, 0.0, 0.0, 0.0},
                   {"b2", 2.137837522572063, 0.0, 0.0, 0.0},
                   {"b3", 0.02332093646085895, 0.0, 0.0, 0.0}};
  device.links = {{0, 1, 7187.992899200791, 0.0}, {1, 2, 136156.3386349951, 0.0}, {1, 3, 154.3144575324455, 0.0}};
  device.loop = {0, 0, 2, 0.0009342718492376095, 0.0};
  const AbsoluteStabilityLimit limit = absolute_stability_limit(Device(device), {0.02976663780784853, 0.0});
  EXPECT_FALSE(limit.needs_no_user);  // alone it bears 218.6
  EXPECT_LE(limit.truncation, 0.01);
  EXPECT_NEAR(limit.stiffness, 94.57765526 * (1.0 - limit.truncation), 1e-6);
  const TerminationDiscs discs{Device(device)};
  EXPECT_LT(discs.truncation(), 1e-12);
  const TerminationDiscs::Disc at_zero = discs.at(81.344897337015396);
  EXPECT_NEAR(at_zero.centre.imag(), -0.0830823, 1e-7);
  EXPECT_NEAR(at_zero.radius, 0.0831423, 1e-7);
  EXPECT_TRUE(std::isfinite(discs.at(2500.0).radius));
}

// Below clear_angle another formula takes over.
TEST(TerminationDiscs, TheFormulaNearZeroAgreesWithTheSums) {
  for (const std::size_t sensed : {0u, 1u}) {
    for (const std::size_t held : {0u, 1u}) {
      for (const double delay : {0.0, 0.25e-3, 1e-3}) {
        DeviceParameters parameters = test::lhifam_parameters();
        parameters.loop = {0, sensed, held, 1e-3, delay};
        parameters.actuator.time_constant = 1e-3;
        WallFilter filter;
        filter.frequency_hz = 50.0;
        parameters.wall.filters = {filter};
        const TerminationDiscs discs{Device(parameters)};
        const double at = clear_angle / 1e-3;
        const TerminationDiscs::Disc below = discs.at(at * (1.0 - 1e-12));
        const TerminationDiscs::Disc above = discs.at(at * (1.0 + 1e-12));
        EXPECT_LT(std::abs(below.centre - above.centre), 1e-8 * above.radius);
        EXPECT_NEAR(below.radius, above.radius, 1e-8 * above.radius);
        // |c|² - r² of the sums has lost digits by subtraction.
        EXPECT_NEAR(below.power, above.power, 1e-14 * above.radius * above.radius + 1e-7 * std::abs(above.power));
      }
    }
  }
}

}  // namespace
}  // namespace zwidth
