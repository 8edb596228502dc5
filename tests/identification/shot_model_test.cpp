// The slopes of a played record, against differences of high order.
#include "identification/shot_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "zwidth/identification/excitation.hpp"

namespace zwidth::internal {
namespace {

struct Played {
  std::string name;
  double delay = 0.0;
  double lag = 0.0;
  std::size_t sensed = 0;
  std::vector<double> friction;
  User user = {};
};

class ShotModelSlopes : public testing::TestWithParam<Played> {
 protected:
  ShotModelSlopes() {
    DeviceParameters device;
    device.name = "two bodies";
    device.bodies = {{"motor", 0.4, 1.3, 0.0, GetParam().friction[0]},
                     {"handle", 0.25, 0.7, 30.0, GetParam().friction[1]}};
    device.links = {{0, 1, 8e3, 1.5}};
    device.loop = {0, GetParam().sensed, 1, 1e-3, GetParam().delay};
    device.actuator.time_constant = GetParam().lag;
    device.user = GetParam().user;
    structure = device;
    ExcitationOptions excitation;
    excitation.kind = ExcitationKind::noise;
    excitation.amplitude = 4.0;
    excitation.lowest_hz = 0.5;
    excitation.highest_hz = 120.0;
    excitation.duration = 1.0;
    excitation.seed = 5;
    force = excite(excitation).samples;
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    for (std::size_t k = 0; k < force.size(); ++k) position.push_back(1e-4 * normal(random));
  }

  DeviceParameters structure;
  std::vector<double> force;
  std::vector<double> position;
};

TEST_P(ShotModelSlopes, AreThoseOfTheMotion) {
  std::vector<Coordinate> coordinates;
  for (const char* key : {"body.motor.mass", "body.handle.mass", "link.0.stiffness"}) {
    coordinates.push_back({key, Coordinate::Kind::logarithmic, 0.5});
  }
  for (const char* key : {"body.motor.damping", "body.handle.damping", "body.handle.stiffness", "link.0.damping",
                          "body.motor.coulomb", "body.handle.coulomb"}) {
    coordinates.push_back({key, Coordinate::Kind::not_negative, 0.5});
  }
  coordinates.push_back({"loop.delay", Coordinate::Kind::not_negative, 1e-3});
  if (GetParam().lag > 0.0) coordinates.push_back({"actuator.time_constant", Coordinate::Kind::not_negative, 1e-3});
  const ShotModel model(Device(structure), {{force, position, 1e-3}}, coordinates, {});
  const std::vector<Shot> shots{{0, 50, 300}, {0, 350, 300}};
  const Eigen::VectorXd x = model.position_of(structure);
  std::vector<Eigen::VectorXd> states;
  for (const double size : {1.0, -0.7}) {
    states.push_back(size * Eigen::VectorXd::LinSpaced(model.states(), 0.3, 1.1));
  }
  const auto played = model.play(x, shots, states, ShotModel::Slopes::exact);
  ASSERT_TRUE(played);
  const auto plain = model.play(x, shots, states, ShotModel::Slopes::none);
  ASSERT_TRUE(plain);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    EXPECT_LE(((*plain)[i].positions - (*played)[i].positions).norm(), 1e-6 * (*plain)[i].positions.norm());
  }
  for (Eigen::Index column = 0; column < model.parameters() + model.states(); ++column) {
    SCOPED_TRACE("column " + std::to_string(column));
    const auto moved = [&](double step) {
      Eigen::VectorXd at = x;
      std::vector<Eigen::VectorXd> from = states;
      if (column < model.parameters()) {
        at(column) += step;
      } else {
        for (Eigen::VectorXd& each : from) each(column - model.parameters()) += step;
      }
      return *model.play(at, shots, from, ShotModel::Slopes::none);
    };
    // Fourth order: (8 (y(h) - y(-h)) - (y(2h) - y(-2h))) / 12h; one-sided of third order at a bound, and for the delay,
    // which bends where it is a whole number of samples.
    constexpr double h = 2e-5;
    const bool at_bound = column < model.parameters() && model.is_bounded(column) && x(column) < 2.0 * h;
    const bool is_one_sided = at_bound || column == 9;
    const std::vector<double> steps =
        is_one_sided ? std::vector{0.0, 1.0, 2.0, 3.0} : std::vector{-2.0, -1.0, 1.0, 2.0};
    const std::vector<double> weights = is_one_sided ? std::vector{-11.0 / 6.0, 3.0, -1.5, 1.0 / 3.0}
                                                     : std::vector{1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};
    std::vector<Eigen::VectorXd> slopes(shots.size(), Eigen::VectorXd::Zero(300));
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const auto there = moved(steps[k] * h);
      for (std::size_t i = 0; i < shots.size(); ++i) slopes[i] += weights[k] / h * there[i].positions;
    }
    for (std::size_t i = 0; i < shots.size(); ++i) {
      const Eigen::VectorXd own = (*played)[i].slopes.row(column).transpose();
      const double size = slopes[i].norm();
      EXPECT_GT(size, 0.0);
      EXPECT_LE((own - slopes[i]).norm(), 1e-5 * size) << "shot " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, ShotModelSlopes,
                         testing::Values(Played{"Smooth", 0.0, 0.0, 0, {0.0, 0.0}},
                                         Played{"DelayWithin", 0.3e-3, 0.0, 0, {0.5, 0.3}},
                                         Played{"LagAndDelay", 1.4e-3, 0.8e-3, 1, {0.5, 0.3}},
                                         Played{"OneRubs", 1.0e-3, 0.0, 1, {0.6, 0.0}},
                                         Played{"Stiction", 0.6e-3, 0.5e-3, 0, {1.5, 1.0}},
                                         Played{"InAHand", 0.3e-3, 0.0, 0, {0.0, 0.0}, {1.5, 4.0, 200.0}}),
                         [](const auto& each) { return each.param.name; });

// A body with dry friction by the leapfrog rule, 500 steps a sample.
constexpr double length = 3e-3;
std::vector<double> played_in_steps(const std::vector<double>& force, double drag, double more_as_it_turns) {
  constexpr int steps = 500;
  constexpr double step = 1e-3 / steps;
  constexpr double mass = 0.4;
  double x = 0.0;
  double v = 0.0;
  double turned = std::numeric_limits<double>::infinity();  // not yet
  double direction = 0.0;
  std::vector<double> positions;
  for (const double each : force) {
    positions.push_back(x);
    for (int i = 0; i < steps; ++i) {
      x += 0.5 * step * v;
      v += step / mass * (each - 1.3 * v - drag * v * std::abs(v));
      const double slid = step / mass * (0.3 + more_as_it_turns * std::exp(-std::abs(x - turned) / length));
      v = v > slid ? v - slid : v < -slid ? v + slid : 0.0;
      if (v != 0.0 && std::copysign(1.0, v) != direction) {
        if (direction != 0.0) turned = x;
        direction = std::copysign(1.0, v);
      }
      x += 0.5 * step * v;
    }
  }
  return positions;
}

// By differences of the motion itself; the speed is held over each sampling period.
TEST(ShotModelWeakForces, ChangeTheMotionAsTheForcesDo) {
  ExcitationOptions excitation;
  excitation.kind = ExcitationKind::noise;
  excitation.amplitude = 4.0;
  excitation.lowest_hz = 0.5;
  excitation.highest_hz = 30.0;
  excitation.duration = 2.0;
  excitation.seed = 5;
  const std::vector<double> force = excite(excitation).samples;
  const std::vector<double> position = played_in_steps(force, 0.0, 0.0);
  DeviceParameters structure;
  structure.bodies = {{"body", 0.4, 1.3, 0.0, 0.3}};
  structure.loop = {0, 0, 0, 1e-3, 0.0};
  const ShotModel model =
      ShotModel(Device(structure), {{force, position, 1e-3}}, {}, {}).with_weak_forces({{"body"}, {"body", length}});
  const std::vector<Shot> shots{{0, 0, force.size()}};
  const auto played = model.play(Eigen::VectorXd::Zero(3), shots, {Eigen::VectorXd::Zero(2)}, ShotModel::Slopes::exact);
  ASSERT_TRUE(played);
  for (const Eigen::Index force_of : {0, 1}) {
    constexpr double size = 2e-2;
    const auto moved = [&](double by) {
      return played_in_steps(force, force_of == 0 ? by : 0.0, force_of == 1 ? by : 0.0);
    };
    const std::vector<double> more = moved(size);
    const std::vector<double> less = moved(-size);
    Eigen::VectorXd difference(static_cast<Eigen::Index>(force.size()));
    for (std::size_t k = 0; k < force.size(); ++k) {
      difference(static_cast<Eigen::Index>(k)) = (more[k] - less[k]) / (2.0 * size);
    }
    const Eigen::VectorXd own = (*played)[0].slopes.row(force_of).transpose();
    EXPECT_GT(difference.norm(), 0.0);
    EXPECT_LE((own - difference).norm(), 0.02 * difference.norm()) << "force " << force_of;
  }
}

}  // namespace
}  // namespace zwidth::internal
