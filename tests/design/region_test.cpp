// region(): devices that earlier answers lost, refused without need, or never answered; every answer against
// closed-loop eigenvalues.

#include "zwidth/design/region.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

#include "design/random_chains.hpp"
#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

constexpr double on_circle = 1e-9;

/// Largest |z| - 1 of the closed loop.
class Eigenvalues {
 public:
  explicit Eigenvalues(const Device& device)
      : plant_(sample(state_space(device), {device.loop().sampling_period, device.loop().delay})),
        wall_(device.parameters().wall) {}
  [[nodiscard]] double excess(double stiffness, double damping) const {
    Wall wall = wall_;
    wall.stiffness = stiffness;
    wall.damping = damping;
    return stability_excess(plant_, wall);
  }
  /// Certainly on that side, here and 0.1 % away.
  [[nodiscard]] bool is_clearly(bool stable, double stiffness, double damping) const {
    const auto agrees = [&](double k, double b) {
      const double here = excess(k, b);
      return stable ? here < -on_circle : here > on_circle;
    };
    constexpr double step = 1e-3;
    return agrees(stiffness, damping) && agrees(stiffness * (1.0 - step), damping) &&
           agrees(stiffness * (1.0 + step), damping) && agrees(stiffness, damping * (1.0 - step)) &&
           agrees(stiffness, damping * (1.0 + step));
  }

 private:
  DiscreteStateSpace plant_;
  Wall wall_;
};

/// Inside and outside, evenly and by ratios, as the region says and as eigenvalues do.
void expect_confirmed(const Device& device, const WallRegion& walls) {
  if (!walls.region.stiffest) return;
  const Eigenvalues eigenvalues(device);
  const double stiffness = walls.region.stiffest->stiffness;
  const double damping = walls.region.most_damped->damping;
  const auto ask = [&](double k, double b) {
    const auto intervals = walls.walls->stable_stiffnesses(b);
    const bool stable = std::any_of(intervals.begin(), intervals.end(), [k](const StableInterval& interval) {
      return k > interval.lower && (!interval.upper || k < *interval.upper);
    });
    EXPECT_FALSE(eigenvalues.is_clearly(!stable, k, b)) << device.name() << ": K " << k << " B " << b;
  };
  for (int i = 1; i <= 9; ++i) {
    for (int j = 0; j <= 9; ++j) ask(1.2 * stiffness * i / 9.0, 1.2 * damping * j / 9.0);
  }
  for (int i = -5; i <= 4; ++i) {
    for (int j = -5; j <= 4; ++j) ask(stiffness * std::pow(10.0, i), damping * std::pow(10.0, j));
  }
}

/// Every arc begins where the last one ends, nowhere below K = 0 or B = 0.
void expect_closed(const WallRegion& walls) {
  for (const StableComponent& component : walls.region.components) {
    const auto& arcs = component.outline.arcs;
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      const BoundaryPoint& end = arcs[i].points.back();
      const BoundaryPoint& begin = arcs[(i + 1) % arcs.size()].points.front();
      EXPECT_EQ(end.stiffness, begin.stiffness);
      EXPECT_EQ(end.damping, begin.damping);
      for (const BoundaryPoint& point : arcs[i].points) {
        EXPECT_GE(point.stiffness, 0.0);
        EXPECT_GE(point.damping, 0.0);
      }
    }
  }
}

/// Two bodies, the second one actuated and sensed.
DeviceParameters far_body(double first, double second, double damping, Link link) {
  DeviceParameters device;
  device.name = "far body";
  device.bodies = {{"b0", first, 0.0, 0.0, 0.0}, {"b1", second, damping, 0.0, 0.0}};
  device.links = {link};
  device.loop.actuated = 1;
  device.loop.sensed = 1;
  device.loop.held = 1;
  device.loop.sampling_period = 1e-3;
  return device;
}

const RegionOptions walls_alone{.any_user = false, .approximations = false};

// Was "No wall is stable"; K_CR is 5714. The damper destabilises the undamped mode from 0.6835 N s/m on (the locus of B
// alone, gain_crossings).
TEST(Region, IsNotLostBesideAnUndampedStiffLink) {
  DeviceParameters parameters = far_body(0.06, 0.7, 0.4, {0, 1, 3e7, 0.0});
  parameters.loop.sampling_period = 1e-4;
  parameters.loop.delay = 20e-6;
  const Device device(parameters);
  const WallRegion walls = region(device, walls_alone);
  EXPECT_TRUE(walls.trust.sound());
  EXPECT_NEAR(walls.region.critical_stiffness, 5714.33, 0.01);
  EXPECT_NEAR(walls.region.most_damped->damping, 0.683521, 1e-5);
  expect_closed(walls);
  expect_confirmed(device, walls);
}

// Was 0.194.
TEST(Region, ReachesTheDampingAtWhichTheDamperAloneIsUnstable) {
  DeviceParameters parameters = far_body(0.06, 0.7, 0.4, {0, 1, 3e5, 0.0});
  parameters.loop.delay = 0.2e-3;
  const Device device(parameters);
  const WallRegion walls = region(device, walls_alone);
  EXPECT_NEAR(walls.region.most_damped->damping, 0.683556, 1e-5);
  expect_closed(walls);
  expect_confirmed(device, walls);
}

/// A boundary that runs within a few digits of the angle of a mode that hardly anything damps: two routes to one vertex
/// differ by rounding. Limits of K at B = 0 and of B at K = 0 with 200 digits (exact_closed_loop.hpp).
void expect_small_region(const Device& device, double stiffness, double damping) {
  const WallRegion walls = region(device, walls_alone);
  ASSERT_TRUE(walls.trust.sound());
  ASSERT_EQ(walls.region.components.size(), 1U);
  EXPECT_NEAR(walls.region.critical_stiffness, stiffness, 1e-8 * stiffness);
  EXPECT_NEAR(walls.region.most_damped->damping, damping, 1e-7 * damping);
  expect_closed(walls);
}

// Was refused: the outline did not close.
TEST(Region, ClosesBetweenTwoRoutesToOneLevel) {
  DeviceParameters two;
  two.bodies = {{"b0", 0.044203858732004185, 1.8247086356818882e-06, 0.0, 0.0},
                {"b1", 0.06165035349871628, 0.0, 0.0, 0.0}};
  two.links = {{0, 1, 415497.8513289496, 0.0}};
  two.loop.held = 1;
  two.loop.sampling_period = 0.002;
  two.loop.delay = 0.008;
  expect_small_region(Device(two), 0.000202745409271, 6.3548889204e-05);

  DeviceParameters one;
  one.bodies = {{"b0", 0.17708332084914377, 1.6893033048280137e-06, 1197.7990992252428, 0.0}};
  one.loop.sampling_period = 0.01;
  one.loop.delay = 0.03;
  expect_small_region(Device(one), 0.000549649158425, 1.80763682573e-06);
}

// Was refused. The damper alone is unstable from 0.000344571939318 N s/m on (200 digits): the angle of the mode at 0.71
// rad has too few digits for that, and the answer says how many.
TEST(Region, SaysWhereTheAngleHasTooFewDigits) {
  DeviceParameters parameters;
  parameters.bodies = {{"b0", 3.262834749750844, 0.00017807541589396023, 0.0, 0.0},
                       {"b1", 1.4579755868736346, 0.0, 0.0, 0.0},
                       {"b2", 0.6165554106140211, 0.0, 0.0, 0.0}};
  parameters.links = {{0, 1, 8382.16486038775, 0.0}, {1, 2, 219820.44023106087, 0.0}};
  parameters.loop.held = 2;
  parameters.loop.sampling_period = 0.001;
  parameters.loop.delay = 0.002;
  const WallRegion walls = region(Device(parameters), walls_alone);
  ASSERT_EQ(walls.trust.verdict, Trust::Verdict::doubtful);
  ASSERT_FALSE(walls.trust.findings.empty());
  EXPECT_EQ(walls.trust.findings[0].code, FindingCode::region_vertex_open);
  EXPECT_EQ(walls.trust.findings[0].evidence[0].value, walls.region.vertex_error);
  EXPECT_GT(walls.region.vertex_error, usual_vertex_error);
  EXPECT_LT(walls.region.vertex_error, 0.01);
  const double exact = 0.000344571939318;
  EXPECT_NEAR(walls.region.most_damped->damping, exact, walls.region.vertex_error * exact);
  expect_closed(walls);
}

// Nothing is damped; boundaries lie on one another to rounding, and with 200 digits walls are stable: "no wall is stable"
// would be wrong.
TEST(Region, DoesNotSayThatNothingIsStableWhereNothingIsToldApart) {
  DeviceParameters parameters;
  parameters.bodies = {{"b0", 0.022297093622062718, 0.0, 0.0, 0.0},
                       {"b1", 0.15863374159200502, 0.0, 0.0, 0.0},
                       {"b2", 2.8794376867123153, 0.0, 0.0, 0.0},
                       {"b3", 0.28480802857486326, 0.0, 0.0, 0.0}};
  parameters.links = {{0, 1, 532.8498337008842, 0.0}, {1, 2, 15853344.686550267, 0.0}, {2, 3, 1545077.1433355028, 0.0}};
  parameters.loop.held = 3;
  parameters.loop.sampling_period = 1e-4;
  parameters.loop.delay = 4.4757855184167884e-05;
  const WallRegion walls = region(Device(parameters), walls_alone);
  EXPECT_TRUE(walls.trust.refused() || walls.region.stiffest);
}

// Was without end.
TEST(Region, OfAModeBesideNyquistEnds) {
  DeviceParameters parameters = far_body(1.02706, 0.0847166, 0.0, {0, 1, 770862.0, 0.0049});
  parameters.loop.held = 0;
  parameters.loop.delay = 0.23314753407830435e-3;
  const Device device(parameters);
  const WallRegion walls = region(device);
  EXPECT_FALSE(walls.trust.refused());
  EXPECT_GT(walls.region.area, 0.0);
  expect_closed(walls);
  expect_confirmed(device, walls);
}

// z (z - a) - c (K z + B (z - 1)/T) with c > 0: the product of the poles is c B/T, which is 1 along one B, whatever K.
TEST(Region, HasAHorizontalBoundary) {
  const Device device(test::transfer_function_parameters({-0.143891}, {1.0, 356.8755}, 1e-3));
  const WallRegion walls = region(device);
  EXPECT_TRUE(walls.trust.sound());
  ASSERT_EQ(walls.region.components.size(), 1U);
  const double rate = 356.8755;
  const double top = 1e-3 * rate / (0.143891 * -std::expm1(-rate * 1e-3));
  EXPECT_NEAR(walls.region.most_damped->damping, top, 1e-9 * top);
  double along = 0.0;  // the length of boundary at that B
  for (const BoundaryArc& arc : walls.region.components[0].outline.arcs) {
    if (arc.kind != BoundaryKind::oscillation) continue;
    EXPECT_NEAR(arc.points.front().damping, top, 1e-9 * top);
    along += std::abs(arc.points.back().stiffness - arc.points.front().stiffness);
  }
  EXPECT_NEAR(along, rate / 0.143891, 1e-6 * rate / 0.143891);  // up to the static -1/P(1)
  EXPECT_NEAR(walls.region.area, top * rate / 0.143891, 1e-6 * top * rate / 0.143891);
  expect_closed(walls);
}

TEST(Region, OfExtremeCoefficientsEndsOneWayOrTheOther) {
  for (const double size : {1e-30, 1e-12, 1e12, 1e30}) {
    for (const double pole : {1e-9, 1e9}) {
      const WallRegion walls = region(Device(test::transfer_function_parameters({size}, {1.0, pole}, 1e-3)));
      if (!walls.trust.refused()) expect_closed(walls);
    }
  }
}

std::size_t cases() {
  const char* wish = std::getenv("ZWIDTH_REGION_CASES");
  return std::max<std::size_t>(1, (wish != nullptr ? std::strtoul(wish, nullptr, 10) : 200) / 4);
}

template <typename Make>
void expect_confirmed_family(std::size_t count, std::size_t most_refused, const Make& make) {
  std::size_t refused = 0;
  for (std::size_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomDevices random(7919 * seed + 13);
    const Device device(make(random));
    const WallRegion walls = region(device, walls_alone);
    if (walls.trust.refused()) {
      ++refused;
      EXPECT_TRUE(walls.region.components.empty());
      EXPECT_FALSE(walls.walls.has_value());
      continue;
    }
    expect_closed(walls);
    expect_confirmed(device, walls);
  }
  EXPECT_LE(refused, most_refused) << "of " << count;
}

TEST(RegionProperty, OfHardlyDampedDevices) { expect_confirmed_family(cases(), 1 + cases() / 60, test::hardly_damped); }
TEST(RegionProperty, OfBarelyDampedDevices) { expect_confirmed_family(cases(), 1 + cases() / 60, test::barely_damped); }

// The Nyquist line bounds many of these.
TEST(RegionProperty, OfEveryKindNoneIsRefused) {
  for (const std::string_view kind : test::device_kinds) {
    for (std::size_t seed = 0; seed < 1 + cases() / 10; ++seed) {
      SCOPED_TRACE(std::string(kind) + " seed " + std::to_string(seed));
      test::RandomDevices random(7919 * (1000 + seed) + 13);
      const Device device(random.device(kind));
      const WallRegion walls = region(device, walls_alone);
      EXPECT_FALSE(walls.trust.refused());
      if (walls.trust.refused()) continue;
      expect_closed(walls);
      expect_confirmed(device, walls);
    }
  }
}

TEST(RegionProperty, OfSevenToTenBodies) { expect_confirmed_family(1 + cases() / 5, 0, test::long_chain); }
TEST(RegionProperty, OfSevenToTenHardlyDampedBodies) {
  expect_confirmed_family(1 + cases() / 5, 0, test::hardly_damped_chain);
}

// Was refused: where B turns, far beyond every stable wall, rounding of second differences passed for a bend.
TEST(Region, OfAChainOfTenBodiesAlikeIsFollowed) {
  DeviceParameters parameters;
  for (std::size_t i = 0; i < 10; ++i) {
    parameters.bodies.push_back({"b" + std::to_string(i), 0.0522, 0.011, 0.0, 0.0});
    if (i > 0) parameters.links.push_back({i - 1, i, 82500.0, 0.187});
  }
  parameters.loop = {5, 4, 9, 0.10074e-3, 0.0};
  const Device device(parameters);
  const WallRegion walls = region(device, walls_alone);
  EXPECT_EQ(walls.trust.verdict, Trust::Verdict::sound);
  ASSERT_TRUE(walls.region.stiffest);
  EXPECT_NEAR(walls.region.critical_stiffness / critical_stiffness(device).stiffness, 1.0, 1e-9);
  expect_closed(walls);
  expect_confirmed(device, walls);
}

TEST(Region, IsTrustedNoMoreThanItsDevice) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.uncertainty = Uncertainty{{}, {}, "the limiting crossover lies above the excited band"};
  EXPECT_EQ(region(Device(parameters), walls_alone).trust.verdict, Trust::Verdict::doubtful);
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  const WallRegion refused = region(Device(parameters));
  EXPECT_TRUE(refused.trust.refused());
  EXPECT_FALSE(refused.walls.has_value());
  EXPECT_TRUE(refused.region.components.empty());
}

TEST(Region, ComputesWhatIsAskedFor) {
  const Device device(test::rigid_parameters());
  const WallRegion all = region(device);
  EXPECT_TRUE(all.any_user.has_value());
  EXPECT_EQ(all.approximations.size(), 3U);
  const WallRegion alone = region(device, walls_alone);
  EXPECT_FALSE(alone.any_user.has_value());
  EXPECT_TRUE(alone.approximations.empty());
  EXPECT_EQ(alone.region.area, all.region.area);
}

TEST(Region, OfADoubtfulDeviceIsDoubtfulWithTheSameNumbers) {
  DeviceParameters parameters = test::lhifam_parameters();
  const WallRegion sound = region(Device(parameters));
  parameters.uncertainty.emplace();
  parameters.uncertainty->reasons = {"weighed by hand"};
  const WallRegion doubtful = region(Device(parameters));
  EXPECT_EQ(doubtful.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_THAT(doubtful.trust.reasons, testing::Contains("weighed by hand"));
  EXPECT_EQ(doubtful.region.area, sound.region.area);
  EXPECT_EQ(doubtful.any_user->area, sound.any_user->area);
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  const WallRegion refused = region(Device(parameters));
  EXPECT_EQ(refused.status, WallRegion::Status::refused);
  EXPECT_FALSE(refused.walls || refused.region.stiffest || refused.any_user);
  EXPECT_TRUE(refused.approximations.empty());
}

TEST(RegionOptions, NameTheMember) {
  for (const double deviation : {0.0, 1.0, -1.0, std::nan("")}) {
    const auto problem = find_problem(RegionOptions{.outline = {deviation}});
    ASSERT_TRUE(problem.has_value());
    EXPECT_EQ(problem->member, "outline.deviation");
    EXPECT_THROW((void)region(Device(test::rigid_parameters()), {.outline = {deviation}}), Error);
  }
  EXPECT_FALSE(find_problem(RegionOptions{}).has_value());
}

}  // namespace
}  // namespace zwidth
