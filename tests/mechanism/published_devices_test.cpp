// Devices of the literature as MuJoCo reads them, beside the closed forms of their papers.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "zwidth/io/device_file.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double rounding = 1e-9;  // relative, of loops that close to 1e-13 m

MechanismFile published(const std::string& name) {
  return {.path = ZWIDTH_SOURCE_DIR "/devices/mechanisms/" + name + ".xml",
          .tip = "tip",
          .encoders = {},
          .pose = {},
          .transmissions = {}};
}

/// Mass matrix and Jacobian in the coordinates of the motors, each turned by its ratio.
struct OfMotors {
  Eigen::MatrixXd mass;
  Eigen::MatrixXd tip;
};

OfMotors of_motors(const MechanismAtPose& mechanism, const Eigen::VectorXd& ratios) {
  const Eigen::MatrixXd joints = ratios.cwiseInverse().asDiagonal() * mechanism.motors;  // joint speeds of q'
  const Eigen::MatrixXd back = joints.inverse();
  return {.mass = back.transpose() * mechanism.mass * back, .tip = mechanism.tip * back};
}

// Cavusoglu, Feygin and Tendick 2002: position, and mass matrix, of theta_1 to theta_3.
namespace phantom {

constexpr double l1 = 0.215;
constexpr double l2 = 0.170;
constexpr double l3 = 0.0325;

Eigen::Matrix3d jacobian(const Eigen::Vector3d& q) {
  const double out = l1 * std::cos(q(1)) + l2 * std::sin(q(2));
  Eigen::Matrix3d result;
  result << std::cos(q(0)) * out, -l1 * std::sin(q(0)) * std::sin(q(1)), l2 * std::sin(q(0)) * std::cos(q(2)),  //
      0.0, l1 * std::cos(q(1)), l2 * std::sin(q(2)),                                                            //
      -std::sin(q(0)) * out, -l1 * std::cos(q(0)) * std::sin(q(1)), l2 * std::cos(q(0)) * std::cos(q(2));
  return result;
}

Eigen::Matrix3d mass(const Eigen::Vector3d& q) {
  constexpr double a = 0.0202;
  constexpr double c = 0.0249;
  const Eigen::Vector3d of_a(0.4864e-4, 0.001843e-4, 0.4864e-4);
  const Eigen::Vector3d of_c(0.959e-4, 0.959e-4, 0.0051e-4);
  const Eigen::Vector3d of_be(11.09e-4, 10.06e-4, 0.591e-4);
  const Eigen::Vector3d of_df(7.11e-4, 0.629e-4, 6.246e-4);
  constexpr double of_base = 11.87e-4;
  const auto sum = [](const Eigen::Vector3d& of) { return of(1) + of(2); };
  const auto difference = [](const Eigen::Vector3d& of) { return of(1) - of(2); };
  const double coupling = l1 * (l2 * a + l3 * c);
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  result(0, 0) =
      0.5 * (sum(of_a) + 2.0 * of_base + sum(of_be) + sum(of_c) + sum(of_df)) +
      0.125 * (4.0 * l1 * l1 * a + l2 * l2 * a + l1 * l1 * c + 4.0 * l3 * l3 * c) +
      0.125 * (4.0 * difference(of_be) + 4.0 * difference(of_c) + l1 * l1 * (4.0 * a + c)) * std::cos(2.0 * q(1)) +
      0.125 * (4.0 * difference(of_a) + 4.0 * difference(of_df) - l2 * l2 * a - 4.0 * l3 * l3 * c) *
          std::cos(2.0 * q(2)) +
      coupling * std::cos(q(1)) * std::sin(q(2));
  result(1, 1) = of_be(0) + of_c(0) + l1 * l1 * a + 0.25 * l1 * l1 * c;
  result(1, 2) = result(2, 1) = -0.5 * coupling * std::sin(q(1) - q(2));
  result(2, 2) = of_a(0) + of_df(0) + 0.25 * l2 * l2 * a + l3 * l3 * c;
  return result;
}

}  // namespace phantom

TEST(PublishedDevices, phantom_premium_has_the_jacobian_and_the_mass_matrix_of_its_paper) {
  const Eigen::Vector3d ratios(13.3, 11.2, 11.2);
  constexpr double rotor = 1.03e-6;
  for (const Eigen::Vector3d& pose : {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.35, 0.26, 0.17),
                                      Eigen::Vector3d(-0.5, 0.6, -0.3), Eigen::Vector3d(0.8, -0.2, 0.9)}) {
    SCOPED_TRACE(pose.transpose());
    MechanismFile file = published("phantom_premium");
    file.pose = {{"base", pose(0)}, {"upper", pose(1)}, {"fore", pose(2)}};
    file.transmissions = {{.joint = "base", .ratio = ratios(0), .inertia = rotor},
                          {.joint = "upper", .ratio = ratios(1), .inertia = rotor},
                          {.joint = "fore", .ratio = ratios(2), .inertia = rotor}};
    const OfMotors found = of_motors(at_pose(file), ratios);
    const Eigen::Matrix3d mass = phantom::mass(pose) + rotor * Eigen::Matrix3d(ratios.cwiseAbs2().asDiagonal());
    EXPECT_LT((found.mass - mass).norm(), rounding * mass.norm()) << found.mass << "\n\n" << mass;
    EXPECT_LT((found.tip - phantom::jacobian(pose)).norm(), rounding * found.tip.norm()) << found.tip;
  }
}

// Campion, Wang and Hayward 2005, equations (1) to (7), and their derivatives.
namespace pantograph {

constexpr double a1 = 0.063;
constexpr double a2 = 0.075;
constexpr double a5 = 0.025;

struct Linkage {
  Eigen::Vector2d p2;
  Eigen::Vector2d p3;
  Eigen::Vector2d p4;
};

Linkage linkage(const Eigen::Vector2d& q) {
  const Eigen::Vector2d p2 = a1 * Eigen::Vector2d(std::cos(q(0)), std::sin(q(0)));
  const Eigen::Vector2d p4 = a1 * Eigen::Vector2d(std::cos(q(1)), std::sin(q(1))) - Eigen::Vector2d(a5, 0.0);
  const double apart = (p4 - p2).norm();
  const double half = 0.5 * apart;  // a2 = a3
  const Eigen::Vector2d e = (p4 - p2) / apart;
  return {.p2 = p2, .p3 = p2 + half * e + std::sqrt(a2 * a2 - half * half) * Eigen::Vector2d(e.y(), -e.x()), .p4 = p4};
}

Eigen::Vector2d across(const Eigen::Vector2d& arm) { return {-arm.y(), arm.x()}; }

/// Speeds of unit speed of one motor: of the tip, and of the rods.
struct Speeds {
  Eigen::Vector2d p2, p3, p4;
  double rod2 = 0.0, rod3 = 0.0;
};

Speeds speeds(const Eigen::Vector2d& q, Eigen::Index motor) {
  const Linkage at = linkage(q);
  Speeds result;
  const Eigen::Vector2d unit = a1 * Eigen::Vector2d(-std::sin(q(motor)), std::cos(q(motor)));
  result.p2 = motor == 0 ? unit : Eigen::Vector2d::Zero();
  result.p4 = motor == 0 ? Eigen::Vector2d::Zero() : unit;
  // The rods keep their lengths: (p3 - p2)'(v3 - v2) = 0 and (p3 - p4)'(v3 - v4) = 0.
  Eigen::Matrix2d rods;
  rods << (at.p3 - at.p2).transpose(), (at.p3 - at.p4).transpose();
  const Eigen::Vector2d sides((at.p3 - at.p2).dot(result.p2), (at.p3 - at.p4).dot(result.p4));
  result.p3 = rods.inverse() * sides;
  result.rod2 = across(at.p3 - at.p2).dot(result.p3 - result.p2) / (a2 * a2);
  result.rod3 = across(at.p3 - at.p4).dot(result.p3 - result.p4) / (a2 * a2);
  return result;
}

}  // namespace pantograph

TEST(PublishedDevices, pantograph_has_the_kinematics_of_its_paper_and_the_mass_matrix_of_its_bars) {
  for (const Eigen::Vector2d& pose :
       {Eigen::Vector2d(0.8, 2.4), Eigen::Vector2d(0.5, 2.0), Eigen::Vector2d(1.3, 2.9), Eigen::Vector2d(0.2, 2.2)}) {
    SCOPED_TRACE(pose.transpose());
    MechanismFile file = published("pantograph");
    file.pose = {{"theta1", pose(0)}, {"theta5", pose(1)}};
    const OfMotors found = of_motors(at_pose(file), Eigen::Vector2d::Ones());
    Eigen::Matrix2d mass = Eigen::Matrix2d::Identity() * (0.012 * pantograph::a1 * pantograph::a1 / 3.0 + 1.03e-6);
    Eigen::MatrixXd tip = Eigen::MatrixXd::Zero(3, 2);
    pantograph::Speeds by[2];
    for (Eigen::Index i = 0; i < 2; ++i) {
      by[i] = pantograph::speeds(pose, i);
      tip.col(i).head(2) = by[i].p3;
    }
    for (Eigen::Index i = 0; i < 2; ++i) {
      for (Eigen::Index k = 0; k < 2; ++k) {
        const auto rod = [](const auto& a, const auto& b, double turn_a, double turn_b) {
          return 0.25 * 0.010 * a.dot(b) + 4.6875e-6 * turn_a * turn_b;
        };
        mass(i, k) += rod(by[i].p2 + by[i].p3, by[k].p2 + by[k].p3, by[i].rod2, by[k].rod2) +
                      rod(by[i].p4 + by[i].p3, by[k].p4 + by[k].p3, by[i].rod3, by[k].rod3);
      }
    }
    EXPECT_LT((found.tip - tip).norm(), rounding * tip.norm()) << found.tip << "\n\n" << tip;
    EXPECT_LT((found.mass - mass).norm(), rounding * mass.norm()) << found.mass << "\n\n" << mass;
  }
}

TEST(PublishedDevices, are_read_from_their_device_files) {
  for (const char* name : {"phantom_premium", "pantograph"}) {
    SCOPED_TRACE(name);
    const auto device = read_device_file(ZWIDTH_SOURCE_DIR "/devices/mechanisms/" + std::string(name) + ".toml",
                                         std::vector<std::string>{});
    ASSERT_TRUE(device) << device.error().str();
    const CriticalStiffness limit = critical_stiffness(*device);
    EXPECT_EQ(limit.status, StiffnessStatus::finite);
    EXPECT_TRUE(limit.trust.sound());
  }
}

// From either side of the wall, and however long its normal is.
TEST(PublishedDevices, have_the_same_limit_on_both_sides_of_a_wall) {
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  MechanismFile arm = published("phantom_premium");
  for (const auto& [joint, ratio] : {std::pair{"base", 13.3}, std::pair{"upper", 11.2}, std::pair{"fore", 11.2}}) {
    arm.transmissions.push_back({.joint = joint,
                                 .ratio = ratio,
                                 .inertia = 1.03e-6,
                                 .motor_damping = 1e-6,
                                 .stiffness = 100.0,
                                 .damping = 0.02});
  }
  for (const MechanismFile& file : {arm, published("pantograph")}) {
    for (const Eigen::Vector3d& normal : {Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d(0.6, 0.8, 0.0)}) {
      const MechanismAtPose at = at_pose(file);
      const CriticalStiffness limit = critical_stiffness(device_along(at, normal, loop));
      EXPECT_EQ(limit.status, StiffnessStatus::finite);
      EXPECT_TRUE(limit.trust.sound());
      const CriticalStiffness behind = critical_stiffness(device_along(at, -3.0 * normal, loop));
      EXPECT_NEAR(behind.stiffness / limit.stiffness, 1.0, rounding);
    }
  }
}

}  // namespace
}  // namespace zwidth
