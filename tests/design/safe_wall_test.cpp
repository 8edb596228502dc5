#include "zwidth/design/safe_wall.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "stability/device_draws.hpp"
#include "zwidth/design/stable_walls.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

/// Largest |z| - 1 of the closed loop by eigenvalues. With K = 0 a free device has its place at z = 1: that pole,
/// the nearest, is left out.
double excess(const Device& device, double stiffness, double damping) {
  const DiscreteStateSpace plant = sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
  Wall wall = device.parameters().wall;
  wall.stiffness = stiffness;
  wall.damping = damping;
  if (stiffness > 0.0) return stability_excess(plant, wall);
  std::vector<std::complex<double>> poles = closed_loop_poles_minus_one(plant, wall);
  poles.erase(std::ranges::min_element(poles, {}, [](const auto& d) { return std::abs(d); }));
  double largest = -1.0;
  for (const auto& d : poles) largest = std::max(largest, std::abs(1.0 + d) - 1.0);
  return largest;
}

void expect_stable_rectangle(const Device& device, const SafeWall& ceilings) {
  for (const double k : {1e-3, 0.1, 0.35, 0.7, 1.0}) {
    for (const double b : {0.0, 0.2, 0.5, 0.8, 1.0}) {
      EXPECT_LT(excess(device, k * ceilings.stiffness, b * ceilings.damping), 0.0) << k << " " << b;
    }
  }
}

std::optional<SafeWall> ceilings_of(const Device& device, double factor) {
  SafeWall wall = safe_wall(device, {.safety_factor = factor, .damping = SafeWallOptions::Damping::ceiling});
  EXPECT_FALSE(wall.trust.refused());
  if (wall.status != SafeWall::Status::chosen) return std::nullopt;
  return wall;
}

Device held_by(const Device& device, User user) {
  DeviceParameters parameters = device.parameters();
  parameters.user = user;
  return Device(parameters);
}

TEST(SafeWallCeilings, HoldTogetherAndAlone) {
  std::vector<DeviceParameters> devices{test::lhifam_parameters(), test::rigid_parameters(),
                                        test::reduced_pretension_parameters(),
                                        test::with_delay(test::lhifam_parameters(), 0.25e-3)};
  devices.push_back(test::lhifam_parameters());
  devices.back().wall.velocity_filter_hz = 60.0;
  devices.back().wall.filters = {{.kind = WallFilter::Kind::notch, .frequency_hz = 84.0},
                                 {.kind = WallFilter::Kind::low_pass, .frequency_hz = 150.0}};
  for (const DeviceParameters& parameters : devices) {
    const Device device(parameters);
    for (const double factor : {0.5, 0.95}) {
      SCOPED_TRACE(parameters.name + " " + std::to_string(factor));
      const auto ceilings = ceilings_of(device, factor);
      ASSERT_TRUE(ceilings.has_value());
      EXPECT_EQ(ceilings->basis, SafeWall::Basis::any_user);
      EXPECT_EQ(ceilings->stiffness, factor * ceilings->limit);
      EXPECT_EQ(ceilings->damping, factor * *ceilings->damping_limit);
      EXPECT_EQ(ceilings->limit, absolute_stability_limit(device, {0.0, parameters.wall.velocity_filter_hz}).stiffness);
      EXPECT_GT(ceilings->damping, 0.0);
      expect_stable_rectangle(device, *ceilings);
      EXPECT_LT(excess(device, 0.0, ceilings->damping), 0.0);  // damping alone
      for (const User& user :
           {User{0.5, 0.0, 0.0}, User{2.0, 0.0, 1000.0}, User{0.0, 0.0, 3e4}, User{0.1, 20.0, 500.0}}) {
        expect_stable_rectangle(held_by(device, user), *ceilings);
      }
    }
  }
}

// Where a user destabilises every wall the device itself sets the ceilings; random devices of every kind.
TEST(SafeWallCeilings, RandomDevices) {
  test::RandomDevices random(77);
  std::size_t by_device = 0;
  std::size_t by_any_user = 0;
  for (const std::string_view kind : test::device_kinds) {
    if (kind == "long_delay" || kind == "fast_sampling" || kind == "everything" || kind == "chain") continue;  // slow
    SCOPED_TRACE(kind);
    const Device device(random.device(kind));
    const auto ceilings = ceilings_of(device, 0.7);
    if (!ceilings) continue;
    (ceilings->basis == SafeWall::Basis::device ? by_device : by_any_user) += 1;
    expect_stable_rectangle(device, *ceilings);
    if (ceilings->basis == SafeWall::Basis::any_user) continue;
    // The limit of the damping is one: just beyond it some wall up to the stiffness is not stable.
    const StableWalls walls(filtered_plant(device), device.parameters().wall.velocity_filter_hz);
    const auto beyond = walls.stable_stiffnesses(1.001 * *ceilings->damping_limit);
    EXPECT_TRUE(beyond.empty() || beyond.front().lower > 0.0 ||
                beyond.front().upper.value_or(1e300) < 1.001 * ceilings->stiffness);
  }
  EXPECT_GT(by_device, 0U);
  EXPECT_GT(by_any_user, 5U);
}

// One body without delay: K + 2 B/T < 2 b/T is Colgate & Schenkel's, for any user: at K = S 2 b/T, B = (1 - S) b.
TEST(SafeWallCeilings, OfARigidDeviceAreColgateAndSchenkels) {
  const auto ceilings = ceilings_of(Device(test::rigid_parameters()), 0.4);
  ASSERT_TRUE(ceilings.has_value());
  EXPECT_NEAR(ceilings->limit, 7000.0, 7000.0 * 1e-6);
  EXPECT_NEAR(*ceilings->damping_limit, 0.6 * 3.5, 1e-5);
}

TEST(SafeWallCeilings, NoneWithoutAStableWall) {
  DeviceParameters undamped = test::rigid_parameters();
  undamped.bodies[0].damping = 0.0;
  EXPECT_FALSE(ceilings_of(Device(undamped), 0.5).has_value());
  EXPECT_EQ(safe_wall(Device(undamped)).status, SafeWall::Status::none_stable);
}

TEST(SafeWallCeilings, RefusedFactors) {
  for (const double factor : {0.0, 1.0, -1.0, std::nan("")}) {
    EXPECT_THROW((void)safe_wall(Device(test::rigid_parameters()), {.safety_factor = factor}), Error);
  }
}

TEST(SafeWall, IsAShareOfTheAnyUserLimitWithTheOwnDamperClosed) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.wall.damping = 1.5;
  const Device device(parameters);
  const SafeWall wall = safe_wall(device, {.safety_factor = 0.6});
  ASSERT_EQ(wall.status, SafeWall::Status::chosen);
  EXPECT_EQ(wall.basis, SafeWall::Basis::any_user);
  EXPECT_EQ(wall.damping, 1.5);
  EXPECT_FALSE(wall.damping_limit.has_value());
  EXPECT_EQ(wall.stiffness, 0.6 * absolute_stability_limit(device, {1.5, 0.0}).stiffness);
  EXPECT_TRUE(wall.trust.sound());
}

// Where there is no limit for any user that with the file's user was taken, of which nothing is left once it lets go.
TEST(SafeWall, IsAShareOfTheLesserLimitOfNobodyAndTheFilesUser) {
  DeviceParameters chain;
  chain.name = "more bodies than the limit for any user is computed of";
  for (std::size_t i = 0; i <= most_bodies_for_absolute_stability; ++i) {
    chain.bodies.push_back({"b" + std::to_string(i), 0.02, 0.05, 0.0, 0.0});
    if (i > 0) chain.links.push_back({i - 1, i, 1e7, 20.0});
  }
  chain.loop = {0, 0, chain.bodies.size() - 1, 1e-3, 0.0};
  const Device alone(chain);
  const double with_nobody = critical_stiffness(alone).stiffness;
  const Device held = held_by(alone, {0.0, 20.0, 0.0});
  ASSERT_GT(critical_stiffness(held).stiffness, 2.0 * with_nobody);
  const SafeWall wall = safe_wall(held, {.safety_factor = 0.9});
  ASSERT_EQ(wall.status, SafeWall::Status::chosen);
  EXPECT_EQ(wall.basis, SafeWall::Basis::device);
  EXPECT_EQ(wall.limit, with_nobody);
  for (const Device& each : {alone, held}) EXPECT_LT(excess(each, wall.stiffness, wall.damping), 0.0);
  // And the other way round: a user who leaves less.
  const Device worse = held_by(alone, {2.0, 0.0, 3e4});
  const double with_user = critical_stiffness(worse).stiffness;
  ASSERT_LT(with_user, with_nobody);
  EXPECT_EQ(safe_wall(worse, {.safety_factor = 0.9}).limit, with_user);
}

// A transfer function has no user.
TEST(SafeWall, IsAShareOfTheCriticalStiffnessWhereThereIsNoUser) {
  const SafeWall wall = safe_wall(Device(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1.0)));
  EXPECT_EQ(wall.basis, SafeWall::Basis::device);
  EXPECT_NEAR(wall.stiffness, 0.5 * 2.16395341373865, 1e-12);  // of 1/(s + 1), T = 1 s: (e + 1)/(e - 1)
}

TEST(SafeWall, TakesTheLowerEndOfTheInterval) {
  DeviceParameters parameters = test::lhifam_parameters();
  const SafeWall certain = safe_wall(Device(parameters));
  parameters.uncertainty = Uncertainty{{"body.motor.damping"}, {{0.04}}};
  const SafeWall uncertain = safe_wall(Device(parameters), {.draws = 200});
  ASSERT_TRUE(uncertain.interval.has_value());
  EXPECT_LT(uncertain.uncertainty_share, 1.0);
  EXPECT_NEAR(uncertain.stiffness / (certain.stiffness * uncertain.uncertainty_share), 1.0, 1e-12);
  EXPECT_FALSE(uncertain.remarks.empty());
}

// The critical stiffness hardly hangs on the handle's damping here, the limit with any user does: a half of it was more than
// 2.5 % of the devices drawn bear.
TEST(SafeWall, TakesTheLowerEndOfTheLimitThatItIsAShareOf) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.links[0].stiffness = 12e3;
  parameters.uncertainty = Uncertainty{{"body.handle.damping"}, {{1.5}}};
  const Device device(parameters);
  for (const auto damping : {SafeWallOptions::Damping::own, SafeWallOptions::Damping::ceiling}) {
    const SafeWall wall = safe_wall(device, {.safety_factor = 0.95, .damping = damping});
    ASSERT_EQ(wall.status, SafeWall::Status::chosen);
    ASSERT_EQ(wall.basis, SafeWall::Basis::any_user);
    ASSERT_TRUE(wall.interval && wall.absolute_stability_interval);
    EXPECT_LT(wall.uncertainty_share, 0.8 * wall.interval->lower / 22e3);
    constexpr std::uint64_t another_seed = 77;
    internal::DeviceDraws drawn(device, another_seed);
    constexpr int draws = 300;
    int failed = 0;
    for (int i = 0; i < draws; ++i) {
      failed += absolute_stability_limit(drawn.next(), {wall.damping, 0.0}).stiffness < wall.stiffness;
    }
    EXPECT_LE(failed, draws / 20) << "2.5 % of 300, and what chance adds";
  }
}

// The rectangle of a damper on the drive, whoever holds it; a draw of an uncertain device keeps it but for 2.5 %.
TEST(SafeWall, CeilingsOfAFasterDamperHoldForAnyUser) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.damper = LoopDamper{1e-4, 0.0};
  const auto limit_with = [&](double damping) {
    DeviceParameters damped = parameters;
    damped.wall.damping = damping;
    return analyze(Device(damped), {.critical_damping = false, .draws = 0}).any_user->stiffness;
  };
  const SafeWallOptions ceilings{.damping = SafeWallOptions::Damping::ceiling, .draws = 50, .any_user_draws = 20};
  const SafeWall wall = safe_wall(Device(parameters), ceilings);
  ASSERT_EQ(wall.status, SafeWall::Status::chosen);
  EXPECT_TRUE(wall.trust.sound());
  EXPECT_EQ(wall.basis, SafeWall::Basis::any_user);
  EXPECT_NEAR(wall.limit / absolute_stability_limit(with_one_rate(Device(parameters))).stiffness, 1.0, 1e-12);
  EXPECT_EQ(wall.stiffness, 0.5 * wall.limit);
  EXPECT_EQ(wall.damping, 0.5 * *wall.damping_limit);
  EXPECT_GT(limit_with(*wall.damping_limit * (1.0 - 1e-4)), wall.stiffness);
  EXPECT_LT(limit_with(*wall.damping_limit * (1.0 + 1e-4)), wall.stiffness);
  for (const double share : {0.01, 0.2, 0.6, 1.0}) EXPECT_GT(limit_with(share * wall.damping), wall.stiffness);
  parameters.wall.damping = 50.0;
  parameters.uncertainty = Uncertainty{.parameters = {"link.0.stiffness"}, .covariance = {{1e6}}};
  for (const auto damping : {SafeWallOptions::Damping::own, SafeWallOptions::Damping::ceiling}) {
    SafeWallOptions options = ceilings;
    options.damping = damping;
    const SafeWall lower = safe_wall(Device(parameters), options);
    ASSERT_EQ(lower.status, SafeWall::Status::chosen);
    ASSERT_TRUE(lower.absolute_stability_interval.has_value());
    EXPECT_LT(lower.uncertainty_share, 1.0);
    EXPECT_GT(lower.uncertainty_share, 0.9);
  }
}

TEST(SafeWall, WhereNoUserIsKnownAtTwoRatesIsAnError) {
  for (const LoopDamper& damper : {LoopDamper{2e-3, 0.0}, LoopDamper{1e-4, 0.3e-4}}) {
    DeviceParameters parameters = test::lhifam_parameters();
    parameters.loop.damper = damper;
    EXPECT_THROW((void)safe_wall(Device(parameters), {.damping = SafeWallOptions::Damping::ceiling}), Error);
  }
}

TEST(SafeWall, IsTrustedNoMoreThanTheDevice) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.uncertainty = Uncertainty{{}, {}, "the limiting crossover lies above the excited band"};
  const SafeWall doubtful = safe_wall(Device(parameters));
  EXPECT_EQ(doubtful.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_GT(doubtful.stiffness, 0.0);
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  const SafeWall refused = safe_wall(Device(parameters));
  EXPECT_EQ(refused.status, SafeWall::Status::refused);
  EXPECT_EQ(refused.stiffness, 0.0);
}

}  // namespace
}  // namespace zwidth
