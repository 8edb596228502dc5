// The region of a wall in every direction. Second routes share nothing with it: the equation of its boundary by a response from
// other matrices, and closed-loop eigenvalues (tests/stability/random_mechanism.hpp).

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "campaign.hpp"
#include "reference/planar_arm.hpp"
#include "stability/matrix_products.hpp"
#include "stability/random_mechanism.hpp"
#include "zwidth/design/region.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/point_wall.hpp"

namespace zwidth {
namespace {

Coordinates::Tip tip_of(const TipMotion& motion) {
  const auto by_rows = [](const Eigen::MatrixXd& matrix) {
    const Eigen::MatrixXd turned = matrix.transpose();
    return std::vector<double>(turned.data(), turned.data() + turned.size());
  };
  return {by_rows(motion.tip), by_rows(motion.sensed), by_rows(motion.pushed)};
}

/// That motion with a wall in every direction. No file says it.
Device point_device(const TipMotion& motion, DeviceParameters parameters) {
  const Eigen::MatrixXd mass = 0.5 * (motion.mass + motion.mass.transpose());
  const Eigen::VectorXd along = test::product(motion.tip.transpose(), tip_directions(motion).col(0)).col(0);
  parameters.name = "point";
  Coordinates& coordinates = parameters.coordinates.emplace();
  coordinates.mass.assign(mass.data(), mass.data() + mass.size());
  coordinates.elements = motion.elements;
  coordinates.points.push_back({"tip", {along.begin(), along.end()}});
  coordinates.tip = tip_of(motion);
  MechanismDirection& mechanism = parameters.mechanism.emplace();
  mechanism.mechanism.path = "none";
  mechanism.mechanism.tip = "tip";
  mechanism.is_point = true;
  return Device(std::move(parameters));
}

Device planar_arm_at(double elbow, double delay = 0.0) {
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  loop.loop.delay = delay;
  return point_device(planar_arm::tip_motion({0.3, elbow}), loop);
}

/// P on the unit circle, m x m: aliases of the continuous response, which no sampled model is in.
class AliasedResponse {
 public:
  AliasedResponse(const TipMotion& motion, const DeviceParameters& loop)
      : loop_(loop),
        mass_(test::complex_of(motion.mass)),
        pushed_(test::complex_of(test::product(motion.pushed.transpose(), tip_directions(motion)))),
        sensed_(test::complex_of(test::product(tip_directions(motion).transpose(), motion.sensed))) {
    const Eigen::Index n = motion.mass.rows();
    Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd damping = stiffness;
    for (const Coordinates::Element& each : motion.elements) {
      const Eigen::Map<const Eigen::VectorXd> along(each.weights.data(), n);
      test::add_square(stiffness, each.stiffness, along);
      test::add_square(damping, each.damping, along);
    }
    stiffness_ = test::complex_of(stiffness);
    damping_ = test::complex_of(damping);
  }

  /// How far an eigenvalue of (K + B v) P is from -1.
  [[nodiscard]] double off(const BoundaryPoint& point) const {
    const double period = loop_.loop.sampling_period;
    const std::complex<double> z = std::polar(1.0, *point.frequency * period);
    const double pole = loop_.wall.velocity_filter_hz > 0.0
                            ? std::exp(-2.0 * std::numbers::pi * loop_.wall.velocity_filter_hz * period)
                            : 0.0;
    const std::complex<double> velocity = (1.0 - pole) / period * (z - 1.0) / (z - pole);
    const Eigen::MatrixXcd open = (point.stiffness + point.damping * velocity) * at(*point.frequency);
    double least = 1e300;
    for (const std::complex<double>& each : test::eigenvalues_of(open)) least = std::min(least, std::abs(each + 1.0));
    return least;
  }

 private:
  [[nodiscard]] Eigen::MatrixXcd continuous(double frequency) const {
    const std::complex<double> s(0.0, frequency);
    Eigen::MatrixXcd impedance = stiffness_;
    impedance += s * damping_;
    impedance += s * s * mass_;
    Eigen::MatrixXcd response = test::complex_product(sensed_, test::solution(impedance, pushed_));
    if (loop_.actuator.time_constant > 0.0) response /= 1.0 + s * loop_.actuator.time_constant;
    const double period = loop_.loop.sampling_period;
    return response * std::exp(-s * loop_.loop.delay) * (1.0 - std::exp(-s * period)) / (s * period);
  }
  // Two aliases on either side leave 1/k^4: what is beyond is 1e-10 of it.
  [[nodiscard]] Eigen::MatrixXcd at(double frequency) const {
    constexpr int aliases = 1000;
    const double turn = 2.0 * std::numbers::pi / loop_.loop.sampling_period;
    Eigen::MatrixXcd sum = continuous(frequency);
    for (int k = 1; k <= aliases; ++k) sum += continuous(frequency + k * turn) + continuous(frequency - k * turn);
    return sum;
  }

  DeviceParameters loop_;
  Eigen::MatrixXcd mass_;
  Eigen::MatrixXcd damping_;
  Eigen::MatrixXcd stiffness_;
  Eigen::MatrixXcd pushed_;  // n x m
  Eigen::MatrixXcd sensed_;  // m x n
};

void for_each_vertex(const StableRegion& region, const auto& look) {
  for (const StableComponent& component : region.components) {
    for (const BoundaryArc& arc : component.outline.arcs) {
      for (const BoundaryPoint& point : arc.points) {
        if (point.frequency) look(point);
      }
    }
  }
}

TEST(PointRegion, PlanarArmMeetsTheEquationOfItsBoundaryAtEveryVertex) {
  constexpr double tolerance = 1e-8;
  const int looked_at = test::by_tier(16, 1);
  for (const double elbow : {0.4, 1.2}) {
    for (const double delay : {0.0, 7e-4}) {
      SCOPED_TRACE(testing::Message() << elbow << ' ' << delay);
      const Device device = planar_arm_at(elbow, delay);
      const WallRegion found = region(device);
      ASSERT_EQ(found.status, WallRegion::Status::bounded);
      EXPECT_EQ(found.trust.verdict, Trust::Verdict::sound);
      EXPECT_FALSE(found.any_user);
      EXPECT_TRUE(found.approximations.empty());
      const TipMotion motion = planar_arm::tip_motion({0.3, elbow});
      EXPECT_NEAR(found.region.critical_stiffness / point_wall_limit(motion, device.parameters()).stiffness, 1.0, 1e-8);
      const AliasedResponse response(motion, device.parameters());
      int vertices = 0;
      for_each_vertex(found.region, [&](const BoundaryPoint& point) {
        if (vertices++ % looked_at == 0) {
          EXPECT_LT(response.off(point), tolerance);
        }
      });
      EXPECT_GT(vertices, 50);
    }
  }
}

// Where the tip moves along one direction, a wall in every direction is a wall along it.
TEST(PointRegion, AlongOneDirectionIsThatOfOneAxis) {
  TipMotion motion;
  motion.mass = Eigen::Vector2d(0.4, 0.1).asDiagonal();
  test::add_element(motion, Eigen::Vector2d(1.0, -1.0), 2e4, 2.0);
  test::add_element(motion, Eigen::Vector2d::UnitX(), 0.0, 3.0);
  motion.tip = motion.sensed = motion.pushed = Eigen::MatrixXd::Zero(3, 2);
  motion.tip(0, 1) = 1.0;
  motion.sensed(0, 0) = motion.pushed(0, 0) = 1.0;
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  loop.loop.delay = 3e-4;
  loop.wall.velocity_filter_hz = 200.0;
  DeviceParameters axis = loop;
  axis.name = "axis";
  axis.bodies = {{"motor", 0.4, 3.0}, {"handle", 0.1, 0.0}};
  axis.links = {{0, 1, 2e4, 2.0}};
  axis.loop.held = 1;
  const WallRegion point = region(point_device(motion, loop));
  const WallRegion one = region(Device(axis), {.any_user = false});
  ASSERT_EQ(point.status, WallRegion::Status::bounded);
  ASSERT_EQ(one.status, WallRegion::Status::bounded);
  EXPECT_NEAR(point.region.critical_stiffness / one.region.critical_stiffness, 1.0, 1e-9);
  EXPECT_NEAR(point.region.stiffest->stiffness / one.region.stiffest->stiffness, 1.0, 1e-9);
  EXPECT_NEAR(point.region.most_damped->damping / one.region.most_damped->damping, 1.0, 1e-9);
  EXPECT_NEAR(point.region.area / one.region.area, 1.0, 1e-3);
  for (int i = 0; i < 40; ++i) {
    const double damping = one.region.most_damped->damping * (i + 0.5) / 40.0;
    const std::vector<StableInterval> a = point.walls->stable_stiffnesses(damping);
    const std::vector<StableInterval> b = one.walls->stable_stiffnesses(damping);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(*a[k].upper / *b[k].upper, 1.0, 1e-8);
  }
}

// Property: walls of a grid are stable by closed-loop eigenvalues where the region says so, and nowhere else.
TEST(PointRegion, WallsOfAGridAreThoseOfClosedLoopEigenvalues) {
  constexpr double clear = 1e-7;  // |z| - 1 that is rounding
  constexpr int rows = 12;
  const unsigned mechanisms = test::by_tier(3U, 200U);
  unsigned bounded = 0;
  for (unsigned seed = 0; seed < mechanisms; ++seed) {
    SCOPED_TRACE(seed);
    auto [motion, loop] = test::random_mechanism(seed);
    const WallRegion found = region(point_device(motion, loop));
    EXPECT_NE(found.status, WallRegion::Status::refused) << (found.trust.reasons.empty() ? "" : found.trust.reasons[0]);
    if (found.status != WallRegion::Status::bounded) continue;
    ++bounded;
    for (int i = 0; i < rows; ++i) {
      loop.wall.damping = 1.15 * found.region.most_damped->damping * (i + 0.4) / rows;
      const test::SecondRoute route(motion, loop, tip_directions(motion));
      const std::vector<StableInterval> intervals = found.walls->stable_stiffnesses(loop.wall.damping);
      for (int j = 0; j < 2 * rows; ++j) {
        const double stiffness =
            1.15 * found.region.stiffest->stiffness * (j < rows ? (j + 0.6) / rows : std::pow(0.5, j - rows + 0.3));
        const double excess = route.radius(stiffness) - 1.0;
        if (std::abs(excess) < clear) continue;
        const bool is_stable = std::ranges::any_of(intervals, [&](const StableInterval& each) {
          return stiffness > each.lower && (!each.upper || stiffness < *each.upper);
        });
        EXPECT_EQ(is_stable, excess < 0.0) << stiffness << ' ' << loop.wall.damping << ' ' << excess;
      }
    }
  }
  EXPECT_GT(bounded, mechanisms * 4 / 5);
}

TEST(PointRegion, WithAUserBothRegionsAndWhatTheyShare) {
  DeviceParameters parameters = planar_arm_at(1.2).parameters();
  parameters.user = {0.1, 2.0, 100.0};
  const WallRegion found = region(Device(parameters), {.any_user = false});
  ASSERT_EQ(found.status, WallRegion::Status::bounded);
  ASSERT_TRUE(found.nobody);
  ASSERT_TRUE(found.shared);
  const TipMotion motion = planar_arm::tip_motion({0.3, 1.2});
  EXPECT_NEAR(found.region.critical_stiffness / point_wall_limit(motion, parameters).stiffness, 1.0, 1e-8);
  parameters.user = {};
  EXPECT_NEAR(found.nobody->region.critical_stiffness / point_wall_limit(motion, parameters).stiffness, 1.0, 1e-8);
  EXPECT_LE(found.shared->area, std::min(found.region.area, found.nobody->region.area) * (1.0 + 1e-9));
}

TEST(PointRegion, RefusesADamperInALoopOfItsOwn) {
  DeviceParameters parameters = planar_arm_at(1.2).parameters();
  parameters.loop.damper.emplace().sampling_period = 1e-4;
  EXPECT_THROW((void)region(Device(parameters)), Error);
}

TEST(PointRegion, TellsItsProgressAndEndsByIt) {
  struct Ended {};
  double told = 0.0;
  const Device device = planar_arm_at(1.2);
  (void)region(device, {.progress = [&](double fraction) {
                 EXPECT_GE(fraction, told);
                 told = fraction;
               }});
  EXPECT_EQ(told, 1.0);
  EXPECT_THROW((void)region(device, {.progress =
                                         [](double fraction) {
                                           if (fraction > 0.3) throw Ended{};
                                         }}),
               Ended);
}

}  // namespace
}  // namespace zwidth
