// The drive that tracks the position, (2 w s + w²)/(s + w)²: by routes that know it in other states than the library.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "campaign.hpp"
#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "stability/random_mechanism.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/filter_section.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/grasp_limit.hpp"
#include "zwidth/stability/point_wall.hpp"
#include "zwidth/stability/worst_user.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

Device without_tracking(DeviceParameters parameters) {
  parameters.sensor.tracking_bandwidth = 0.0;
  return Device(std::move(parameters));
}

DeviceParameters tracked(DeviceParameters parameters, double bandwidth) {
  parameters.sensor.tracking_bandwidth = bandwidth;
  return parameters;
}

Complex tracking_at(double bandwidth, double frequency) {
  const Complex s(0.0, frequency);
  return (2.0 * bandwidth * s + bandwidth * bandwidth) / ((s + bandwidth) * (s + bandwidth));
}

/// The device sampled with its delay, and behind it the tracking as two states of a chain, x1 = y/(s/w + 1), x2 = x1/(s/w + 1):
/// y + (y - x1)... = 2 x1 - x2.
struct OwnLoop {
  Eigen::MatrixXd F;
  Eigen::VectorXd g;
  Eigen::RowVectorXd c;
};

OwnLoop own_loop(const DeviceParameters& parameters) {
  const ContinuousStateSpace device = state_space(without_tracking(parameters));
  const double w = parameters.sensor.tracking_bandwidth;
  const double period = parameters.loop.sampling_period;
  const double delay = parameters.loop.delay / period;
  const auto whole = static_cast<Eigen::Index>(delay);
  const double part = (delay - static_cast<double>(whole)) * period;
  const Eigen::Index n = device.A.rows() + 2;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + 1, n + 1);
  a.topLeftCorner(n - 2, n - 2) = device.A;
  a.block(0, n, n - 2, 1) = device.B;
  a.block(n - 2, 0, 1, n - 2) = w * device.C;
  a(n - 2, n - 2) = a(n - 1, n - 1) = -w;
  a(n - 1, n - 2) = w;
  const Eigen::MatrixXd old = (a * part).exp();
  const Eigen::MatrixXd fresh = (a * (period - part)).exp();
  // x+ = F x + G1 u[k-whole] + G2 u[k-whole-1], the older force first
  const Eigen::MatrixXd f = fresh.topLeftCorner(n, n) * old.topLeftCorner(n, n);
  const Eigen::VectorXd g1 = fresh.topRightCorner(n, 1);
  const Eigen::VectorXd g2 = fresh.topLeftCorner(n, n) * old.topRightCorner(n, 1);
  const Eigen::Index kept = whole + 1;
  OwnLoop loop{Eigen::MatrixXd::Zero(n + kept, n + kept), Eigen::VectorXd::Zero(n + kept),
               Eigen::RowVectorXd::Zero(n + kept)};
  loop.F.topLeftCorner(n, n) = f;
  if (whole == 0) {
    loop.g.head(n) = g1;
  } else {
    loop.F.block(0, n + whole - 1, n, 1) = g1;
  }
  loop.F.block(0, n + whole, n, 1) = g2;
  loop.g(n) = 1.0;
  for (Eigen::Index i = 1; i < kept; ++i) loop.F(n + i, n + i - 1) = 1.0;
  loop.c(n - 2) = 2.0;
  loop.c(n - 1) = -1.0;
  return loop;
}

/// |z| - 1 of the largest closed-loop pole at a spring K beside B on the filtered difference.
double excess(const OwnLoop& loop, const Wall& wall, double period, double stiffness) {
  const Eigen::Index n = loop.F.rows();
  const double pole = velocity_filter_pole(wall.velocity_filter_hz, period);
  // States: the loop, y[k-1], v[k-1].
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n + 2, n + 2);
  Eigen::RowVectorXd v = Eigen::RowVectorXd::Zero(n + 2);
  v.head(n) = (1.0 - pole) / period * loop.c;
  v(n) = -(1.0 - pole) / period;
  v(n + 1) = pole;
  Eigen::RowVectorXd force = -wall.damping * v;
  force.head(n) -= stiffness * loop.c;
  m.topLeftCorner(n, n) = loop.F;
  m.topRows(n) += loop.g * force;
  m.row(n).head(n) = loop.c;
  m.row(n + 1) = v;
  const Eigen::VectorXcd poles = test::balanced(m).eigenvalues();
  return poles.cwiseAbs().maxCoeff() - 1.0;
}

/// The stiffness nearby at which a pole crosses the circle.
double crossing_near(const OwnLoop& loop, const Wall& wall, double period, double stiffness, double share) {
  double below = stiffness * (1.0 - share);
  double above = stiffness * (1.0 + share);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (below + above);
    (excess(loop, wall, period, middle) > 0.0 ? above : below) = middle;
  }
  return 0.5 * (below + above);
}

}  // namespace

TEST(Tracking, ModalFormIsTheDevicesTimesTheFilter) {
  test::RandomDevices random(471);
  for (int i = 0; i < 200; ++i) {
    const bool is_crowded = i % 10 == 0;  // by exact arithmetic
    const std::string_view kind = is_crowded ? test::crowded_kinds[random.index(test::crowded_kinds.size())]
                                             : test::device_kinds[random.index(test::device_kinds.size())];
    const DeviceParameters parameters =
        tracked(is_crowded ? random.crowded_device(kind) : random.device(kind), random.log_uniform(30.0, 3e4));
    const double w = parameters.sensor.tracking_bandwidth;
    const ModalForm with = modal_form(Device(parameters));
    const ModalForm without = modal_form(without_tracking(parameters));
    const double nyquist = pi / parameters.loop.sampling_period;
    const double size = std::abs(response(without, 1e-3 * nyquist));  // beside which what cancels above is nothing
    for (const double share : {1e-3, 0.03, 0.3, 1.0}) {
      const double frequency = share * nyquist;
      const Complex expected = response(without, frequency) * tracking_at(w, frequency);
      EXPECT_LE(std::abs(response(with, frequency) - expected), 1e-9 * std::abs(expected) + 1e-14 * size)
          << kind << " " << i;
    }
  }
}

TEST(Tracking, ModalFormNearAPoleOfTheDevice) {
  for (const double beside : {0.0, 1e-12, 1e-7, 1e-4, 3e-3, 0.02, 0.1}) {
    DeviceParameters parameters = test::rigid_parameters();
    parameters.bodies[0].stiffness = parameters.bodies[0].mass * 40.0 * 900.0;  // poles near -40 and -900
    parameters.bodies[0].damping = parameters.bodies[0].mass * 940.0;
    parameters.actuator.time_constant = 1.0 / 41.0;
    parameters = tracked(parameters, 900.0 * (1.0 + beside));
    const ModalForm with = modal_form(Device(parameters));
    const ModalForm without = modal_form(without_tracking(parameters));
    for (const double frequency : {1.0, 30.0, 900.0, 3000.0}) {
      const Complex expected = response(without, frequency) * tracking_at(900.0 * (1.0 + beside), frequency);
      EXPECT_LE(std::abs(response(with, frequency) - expected), 1e-11 * std::abs(expected))
          << beside << " " << frequency;
    }
  }
}

TEST(Tracking, CriticalStiffnessIsWhereOwnStatesCrossTheCircle) {
  test::RandomDevices random(472);
  int compared = 0;
  for (int i = 0; compared < 100 && i < 400; ++i) {
    const std::string_view kind = test::device_kinds[random.index(19)];
    const DeviceParameters parameters = tracked(random.device(kind), random.log_uniform(200.0, 2e4));
    if (!parameters.wall.filters.empty()) continue;
    const CriticalStiffness critical = critical_stiffness(Device(parameters));
    if (critical.status != StiffnessStatus::finite) continue;
    const OwnLoop own = own_loop(parameters);
    const double period = parameters.loop.sampling_period;
    const double found = crossing_near(own, parameters.wall, period, critical.stiffness, 1e-4);
    // Of a stiff link eigenvalues in double know fewer digits.
    const double known = kind == "stiff_link" ? 1e-8 : 1e-9;
    EXPECT_NEAR(found, critical.stiffness, 100.0 * known * critical.stiffness) << kind << " " << i;
    EXPECT_LE(std::abs(excess(own, parameters.wall, period, critical.stiffness)), known) << kind << " " << i;
    EXPECT_LE(excess(own, parameters.wall, period, 0.5 * critical.stiffness), known) << kind << " " << i;
    ++compared;
  }
  EXPECT_EQ(compared, 100);
}

TEST(Tracking, AFastDriveIsNone) {
  test::RandomDevices random(473);
  for (int i = 0; i < 40; ++i) {
    const std::string_view kind = test::device_kinds[random.index(19)];
    const DeviceParameters parameters = random.device(kind);
    const CriticalStiffness none = critical_stiffness(Device(parameters));
    const CriticalStiffness fast = critical_stiffness(Device(tracked(parameters, 1e9)));
    EXPECT_EQ(none.status, fast.status) << kind;
    EXPECT_NEAR(fast.stiffness, none.stiffness, 1e-6 * none.stiffness) << kind << " " << i;
  }
  const double none = absolute_stability_limit(Device(test::lhifam_parameters())).stiffness;
  const double fast = absolute_stability_limit(Device(tracked(test::lhifam_parameters(), 1e9))).stiffness;
  EXPECT_NEAR(fast, none, 1e-6 * none);
}

TEST(Tracking, WhatLimitsIsNamedAsWithoutIt) {
  for (const double bandwidth : {500.0, 1000.0, 1e4}) {
    const CriticalStiffness critical = critical_stiffness(Device(tracked(test::lhifam_parameters(), bandwidth)));
    ASSERT_TRUE(critical.limit);
    // Modes' parts of the sampled plant, each by itself, at the crossover.
    EXPECT_EQ(critical.limit->limited_by.kind, Oscillator::Kind::rigid_body) << bandwidth;
  }
}

// Sums of discs alias by alias, in which the filter stands beside each density.
TEST(Tracking, AnyUserLimitTouchesTheSumOfDiscs) {
  for (const double bandwidth : {300.0, 1000.0, 5000.0}) {
    const DeviceParameters parameters = tracked(test::with_delay(test::lhifam_parameters(), 0.25e-3), bandwidth);
    const Device device(parameters);
    const AbsoluteStabilityLimit limit = absolute_stability_limit(device);
    const double period = parameters.loop.sampling_period;
    const auto motion = [&](Path path, double w) {
      return response(modal_form(device, path, ActuatorLag::left_out), w);
    };
    Complex centre = 0.0;
    double radius = 0.0;
    for (int k = -3000; k <= 3000; ++k) {
      const double w = limit.frequency + 2.0 * pi * k / period;
      const double size = std::abs(w);
      const auto facing = [&](Complex z) { return w < 0.0 ? std::conj(z) : z; };
      const Loop& loop = parameters.loop;
      const Complex through = motion({loop.actuated, loop.sensed}, size);
      const Complex sensed = motion({loop.held, loop.sensed}, size);
      const Complex actuated = motion({loop.actuated, loop.held}, size);
      const double r = (Complex(0.0, size) * motion({loop.held, loop.held}, size)).real();
      const Complex drive = tracking_at(bandwidth, size);
      const Complex c = (through - Complex(0.0, size) * sensed * actuated / (2.0 * r)) * drive;
      const Complex s(0.0, w);
      const Complex hold = (1.0 - std::polar(1.0, -w * period)) / s;
      centre += hold * std::polar(1.0, -w * loop.delay) * facing(c) / period;
      radius += std::abs(hold) * size * std::abs(sensed * actuated * drive) / (2.0 * r) / period;
    }
    EXPECT_NEAR(std::abs(1.0 + limit.stiffness * centre) / (limit.stiffness * radius), 1.0, 2e-5) << bandwidth;
  }
}

TEST(Tracking, NoPassiveUserBeatsTheLimitOfAllOfThem) {
  test::RandomDevices random(474);
  for (int i = 0; i < 25; ++i) {
    const std::string_view kind = test::device_kinds[random.index(18)];
    DeviceParameters parameters = tracked(random.device(kind), random.log_uniform(200.0, 2e4));
    parameters.user = {};
    const Device device(parameters);
    const VirtualDamper damper = virtual_damper(device);
    const AbsoluteStabilityLimit limit = absolute_stability_limit(device, damper);
    ASSERT_LE(limit.stiffness, critical_stiffness(device).stiffness * (1.0 + 1e-9)) << kind << " " << i;
    for (int user = 0; user < 60; ++user) {
      DeviceParameters held = parameters;
      const double mass = parameters.bodies[parameters.loop.held].mass;
      held.user.mass = random.chance(0.5) ? 0.0 : mass * random.log_uniform(1e-3, 1e2);
      held.user.stiffness = random.chance(0.3) ? 0.0 : random.log_uniform(1e-2, 1e2) * limit.stiffness;
      held.user.damping = random.chance(0.7) ? 0.0 : random.log_uniform(1e-2, 1e2);
      const CriticalStiffness critical = critical_stiffness(Device(held));
      if (critical.status == StiffnessStatus::unbounded) continue;
      EXPECT_GE(critical.stiffness, limit.stiffness * (1.0 - 1e-7)) << kind << " " << i << " " << user;
    }
  }
}

TEST(Tracking, TheWorstUserIsAsBadAsSaid) {
  for (const double bandwidth : {500.0, 1000.0, 5000.0}) {
    const DeviceParameters parameters = tracked(test::lhifam_parameters(), bandwidth);
    const Device device(parameters);
    const AbsoluteStabilityLimit limit = absolute_stability_limit(device);
    const auto worst = worst_user(device, limit, {});
    ASSERT_TRUE(worst) << bandwidth;
    EXPECT_NEAR(worst->critical_stiffness, limit.stiffness, 1e-4 * limit.stiffness) << bandwidth;
    const OwnLoop own = own_loop(held_by(device, worst->user).parameters());
    EXPECT_GT(excess(own, {}, parameters.loop.sampling_period, 1.001 * limit.stiffness), 1e-12) << bandwidth;
  }
}

// Of mechanisms: along a normal the states of the tip and the device's own modal form say the same.
TEST(Tracking, TipsOfMechanisms) {
  const int mechanisms = test::by_tier(4, 20);
  int compared = 0;
  for (unsigned seed = 1; compared < mechanisms && seed < 80; ++seed) {
    test::RandomMechanism mechanism = test::random_mechanism(seed);
    test::Draws draws(seed + 1000);
    mechanism.loop.sensor.tracking_bandwidth = draws.decades(300.0, 1e4);
    const double w = mechanism.loop.sensor.tracking_bandwidth;
    const Eigen::Vector3d normal = mechanism.motion.tip * draws.normal(mechanism.motion.tip.cols(), 1);
    const std::vector<Eigen::Vector3d> normals{normal.normalized()};
    const NormalLimits limits = limits_along(mechanism.motion, mechanism.loop, normals).front();
    if (limits.status != StiffnessStatus::finite || !limits.any_grasp) continue;
    const PointWallLimit alone = normal_wall_limit(mechanism.motion, mechanism.loop, normals.front());
    EXPECT_NEAR(limits.stiffness, alone.stiffness, 1e-6 * alone.stiffness) << seed << " " << w;
    for (int i = 0; i < 20; ++i) {
      const TipMotion held = test::randomly_held(mechanism.motion, limits.frequency, draws);
      const PointWallLimit critical = normal_wall_limit(held, mechanism.loop, normals.front());
      if (critical.status != StiffnessStatus::finite) continue;
      EXPECT_GE(critical.stiffness, limits.any_grasp->stiffness * (1.0 - 1e-4)) << seed << " " << i;
    }
    ++compared;
  }
  EXPECT_EQ(compared, mechanisms);
}

}  // namespace zwidth
