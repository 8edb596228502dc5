#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "campaign.hpp"
#include "property/random_devices.hpp"
#include "zwidth/design/notch_design.hpp"
#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/worst_user.hpp"

namespace zwidth::test {
namespace {

constexpr std::uint64_t seed = 20261122;
constexpr std::array kinds = {"rigid",      "two_mass",         "user_side",     "three_mass",    "light_damping",
                              "grounded",   "fractional_delay", "slow_sampling", "fast_sampling", "operator",
                              "rotary",     "actuator_lag",     "overdamped",    "stiff_link",    "wall_filter",
                              "long_delay", "filtered_damper"};

/// The device held by this user, sampled: once for many walls.
DiscreteStateSpace plant_with(const Device& device, const User& user) {
  DeviceParameters parameters = device.parameters();
  parameters.user = user;
  const Device held(parameters);
  return sample(state_space(held), {held.loop().sampling_period, held.loop().delay});
}

/// The closed loop of the wall grown by these factors, by eigenvalues: largest |z| - 1.
double excess(const DiscreteStateSpace& plant, Wall wall, double spring, double damper) {
  *wall.stiffness *= spring;
  wall.damping *= damper;
  return stability_excess(plant, wall);
}

/// Least phase from -1 where |L| = 1, by a dense scan of the plant's state space.
double scanned_phase_margin(const DiscreteStateSpace& plant, const Wall& wall) {
  const double period = plant.period;
  const double a =
      wall.velocity_filter_hz > 0.0 ? std::exp(-2.0 * std::numbers::pi * wall.velocity_filter_hz * period) : 0.0;
  double least = std::numbers::pi;
  std::complex<double> last = 0.0;
  for (int i = 3000; i >= 0; --i) {
    const double angle = std::numbers::pi * std::pow(10.0, -i / 600.0);
    const std::complex<double> back = std::polar(1.0, -angle);
    std::complex<double> loop = *wall.stiffness + wall.damping / period * (1.0 - back) * (1.0 - a) / (1.0 - a * back);
    for (const WallFilter& filter : wall.filters) loop *= response(filter_section(filter, period), angle);
    loop *= response(plant, angle / period);
    if (last != 0.0 && (std::abs(loop) > 1.0) != (std::abs(last) > 1.0)) {
      const double share = std::log(std::abs(last)) / (std::log(std::abs(last)) - std::log(std::abs(loop)));
      const double phase = std::arg(-last) + share * std::arg(loop / last);
      least = std::min(least, std::abs(std::remainder(phase, 2.0 * std::numbers::pi)));
    }
    last = loop;
  }
  return least;
}

std::size_t cases() {
  const char* asked = std::getenv("ZWIDTH_PROPERTY_CASES");
  const std::size_t most = by_tier<std::size_t>(40, 300);
  return asked ? std::clamp<std::size_t>(std::strtoul(asked, nullptr, 10), 1, most) : most;
}

// ZWIDTH_CAMPAIGN_DEVICES=300 is the campaign: some minutes.
std::size_t cases_of_uncertain_modes() {
  if (const char* campaign = std::getenv("ZWIDTH_CAMPAIGN_DEVICES")) return std::strtoul(campaign, nullptr, 10);
  return std::min<std::size_t>(cases(), 3);
}

TEST(WallRecommendationProperty, RandomDevicesKeepTheMarginsAtEveryDrift) {
  constexpr int modal_shifts = 41;
  std::size_t found = 0;
  std::size_t notches = 0;
  std::size_t asked = 0;
  for (std::size_t i = 0; i < cases_of_uncertain_modes(); ++i) {
    RandomDevices random(seed + i);
    const char* kind = kinds[i % kinds.size()];
    const Device device(random.device(kind));
    const RecommendationOptions options{.modal_frequency_uncertainty =
                                            std::array{0.02, 0.05, 0.1, 0.2}[random.index(4)]};
    SCOPED_TRACE(testing::Message() << kind << ", seed " << seed + i << ", drift "
                                    << options.modal_frequency_uncertainty);
    if (find_problem(options, device)) continue;
    const WallRecommendation answer = recommend_wall(device, options);
    EXPECT_EQ(answer.modal_shifts_checked, static_cast<std::size_t>(modal_shifts));
    ++asked;
    if (!answer.wall) continue;
    ++found;
    const Wall& wall = answer.wall->wall;
    const double gain = options.gain_margin * (1.0 - 1e-5);
    for (int k = 0; k < modal_shifts; ++k) {
      const Device moved =
          with_modal_shift(device, options.modal_frequency_uncertainty * (2.0 * k / (modal_shifts - 1) - 1.0));
      SCOPED_TRACE(testing::Message() << "drift " << k);
      const DiscreteStateSpace own = plant_with(moved, device.parameters().user);
      EXPECT_LT(excess(own, wall, 1.0, 1.0), 0.0);
      EXPECT_LT(excess(own, wall, gain, 1.0), 0.0);
      EXPECT_LT(excess(own, wall, gain, gain), 0.0);
      EXPECT_GE(scanned_phase_margin(own, wall), options.phase_margin - 0.02);
      const User user{random.log_uniform(1e-3, 1e3), 0.0, *wall.stiffness * random.log_uniform(1e-3, 1e4)};
      EXPECT_LT(excess(plant_with(moved, user), wall, gain, gain), 1e-11) << user.mass << " " << user.stiffness;
      if (!answer.wall->notch) continue;
      ++notches;
      DeviceParameters notched = moved.parameters();
      notched.wall = wall;
      DeviceParameters plain = notched;
      plain.wall.filters.pop_back();
      const double with = absolute_stability_limit(Device(notched), virtual_damper(Device(notched))).stiffness;
      EXPECT_GE(with, absolute_stability_limit(Device(plain), virtual_damper(Device(plain))).stiffness * (1.0 - 1e-8));
    }
  }
  EXPECT_GE(found, asked / 3);
  std::printf("%zu devices, %zu walls, %zu with a notch\n", asked, found, notches / modal_shifts);
}

TEST(WallRecommendationProperty, RandomDevicesKeepWhatWasAsked) {
  std::size_t found = 0;
  std::size_t refused = 0;
  std::size_t doubted = 0;
  std::size_t notches = 0;
  for (std::size_t i = 0; i < cases(); ++i) {
    RandomDevices random(seed + i);
    const char* kind = kinds[i % kinds.size()];
    SCOPED_TRACE(std::string(kind) + ", seed " + std::to_string(seed + i));
    DeviceParameters parameters = random.device(kind);
    if (random.chance(0.7)) parameters.sensor.resolution = random.log_uniform(1e-7, 1e-4);
    const Device device(parameters);
    RecommendationOptions options;
    options.goal = std::array{WallGoal::stiffness, WallGoal::width, WallGoal::critical_damping}[random.index(3)];
    if (random.chance(0.5)) options.quantisation_force = random.log_uniform(1e-3, 1.0);
    if (random.chance(0.3)) options.gain_margin = random.uniform(1.2, 4.0);
    if (random.chance(0.3)) options.phase_margin = random.uniform(0.0, 1.0);
    const WallRecommendation answer = recommend_wall(device, options);
    if (answer.status == WallRecommendation::Status::refused) ++refused;
    if (!answer.trust.sound()) ++doubted;
    EXPECT_EQ(answer.wall.has_value(), answer.status == WallRecommendation::Status::found);
    if (!answer.wall) {
      EXPECT_TRUE(answer.reason || answer.trust.refused());
      continue;
    }
    ++found;
    const DiscreteStateSpace own = plant_with(device, device.parameters().user);
    std::vector<RecommendedWall> walls = answer.alternatives;
    walls.push_back(*answer.wall);
    for (const RecommendedWall& each : walls) {
      SCOPED_TRACE(words_of(each.kind));
      const Wall& wall = each.wall;
      const double gain = options.gain_margin;
      ASSERT_GT(*wall.stiffness, 0.0);
      if (each.notch) {
        ++notches;
        DeviceParameters without = device.parameters();
        without.wall.damping = wall.damping;
        without.wall.velocity_filter_hz = wall.velocity_filter_hz;
        const Device plain(without);
        // Not lowered by the notch.
        if (each.kind == RecommendedWall::Kind::recommended) {
          EXPECT_GE(*each.absolute_stability_limit,
                    absolute_stability_limit(plain, virtual_damper(plain)).stiffness * (1.0 - 1e-6));
        }
      }
      // Stable by eigenvalues, with the stiffness alone and the whole force grown by the margin.
      EXPECT_LT(excess(own, wall, 1.0, 1.0), 0.0);
      EXPECT_LT(excess(own, wall, 1.0 / gain, 1.0 / gain), 0.0);
      EXPECT_LT(excess(own, wall, gain, 1.0), 0.0);
      EXPECT_LT(excess(own, wall, gain, gain), 0.0);
      EXPECT_LT(excess(own, wall, std::sqrt(gain), std::sqrt(gain)), 0.0);
      EXPECT_GE(scanned_phase_margin(own, wall), options.phase_margin - 0.02);
      if (options.quantisation_force && device.parameters().sensor.resolution > 0.0) {
        ASSERT_TRUE(each.force_per_count);
        EXPECT_LE(each.force_per_count->largest, *options.quantisation_force * (1.0 + 1e-9));
      }
      // Any user: passive ones drawn at random, by eigenvalues, none of them destabilises the grown wall.
      for (int k = 0; k < 20; ++k) {
        const User user{random.chance(0.7) ? random.log_uniform(1e-3, 1e3) : 0.0,
                        random.chance(0.3) ? random.log_uniform(1e-3, 1e3) : 0.0,
                        random.chance(0.7) ? *wall.stiffness * random.log_uniform(1e-3, 1e4) : 0.0};
        const DiscreteStateSpace held = plant_with(device, user);
        // A heavy user's own pole is as near the circle as rounding.
        EXPECT_LT(excess(held, wall, gain, gain), 1e-11) << user.mass << " " << user.damping << " " << user.stiffness;
        EXPECT_LT(excess(held, wall, gain, 1.0), 1e-11) << user.mass << " " << user.damping << " " << user.stiffness;
      }
    }
  }
  RecordProperty("found", static_cast<int>(found));
  EXPECT_GT(found, cases() / 2);
  EXPECT_LE(refused, cases() / 50);
  EXPECT_LE(doubted, cases() / 10);
  std::printf("%zu of %zu found, %zu refused, %zu not sound, %zu walls with a notch\n", found, cases(), refused,
              doubted, notches);
}

}  // namespace
}  // namespace zwidth::test
