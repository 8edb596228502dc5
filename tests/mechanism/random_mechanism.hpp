#pragma once

// Mechanisms of one to three driven joints, at a pose and with a normal, each with the rigid kinematics that its controller knows.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace zwidth::test {

/// Joint positions, by the names of the joints.
using Positions = std::map<std::string, double>;

struct RandomMechanism {
  std::string xml;                    ///< MJCF with a site "tip", in a pose of its own
  Positions pose;                     ///< of the arm's joints that are given
  std::vector<std::string> motors;    ///< joints that actuators drive, in their order
  std::vector<double> gears;          ///< of the actuators
  std::vector<std::string> encoders;  ///< joints that are read; empty: the motors
  /// Positions of all joints where the driven ones are there and no cable is stretched.
  std::function<Positions(const Positions& driven)> joints_of_motors;
  /// The same where those are the arm's joints that are given.
  std::function<Positions(const Positions& given)> joints_of_pose;
  Eigen::Vector3d normal;  ///< of the wall
  double delay = 0.0;      ///< s, a multiple of 10 us
};

/// Draws them, and collects the file's sections.
class MechanismDraw {
 public:
  explicit MechanismDraw(unsigned seed) : random_(seed) {}

  double uniform(double least, double most) { return std::uniform_real_distribution<double>(least, most)(random_); }
  double spread(double least, double most) { return least * std::pow(most / least, uniform(0.0, 1.0)); }
  bool chance(double of_one) { return uniform(0.0, 1.0) < of_one; }
  Eigen::Vector3d direction() {
    std::normal_distribution<double> normal;
    Eigen::Vector3d drawn;
    for (double& each : drawn) each = normal(random_);
    return drawn.normalized();
  }

  /// The rigid body of a link of that length along x.
  std::string inertial(double length) {
    const double x = spread(1e-5, 1e-4);
    const double y = spread(1e-5, 4e-4);
    const double z = spread(1e-5, 4e-4);
    return fmt::format(R"(<inertial pos="{} {} {}" mass="{}" diaginertia="{} {} {}"/>)", uniform(0.2, 0.8) * length,
                       uniform(-0.02, 0.02), uniform(-0.02, 0.02), spread(0.03, 0.3), y + z, x + z, x + y);
  }

  /// A motor at the joint itself, by a gear, with its inertia as the joint's armature.
  void drive_directly(RandomMechanism& mechanism, const std::string& joint, double gear) {
    actuators_ += fmt::format(R"(<motor joint="{}" gear="{}"/>)", joint, gear);
    mechanism.motors.push_back(joint);
    mechanism.gears.push_back(gear);
  }

  /// A rotor and a cable to the joint, of which it is `ratio`; other joints may bend the cable by `others`.
  std::string drive_by_cable(RandomMechanism& mechanism, const std::string& joint, double ratio,
                             const Positions& others, double stiffness, double damping) {
    const std::string motor = "motor of " + joint;
    const double inertia = spread(2e-5, 2e-4);
    rotors_ += fmt::format(R"(<body pos="0 0 -0.1"><joint name="{}" axis="0 0 1" damping="{}"/>)"
                           R"(<inertial pos="0 0 0" mass="0.1" diaginertia="{} {} {}"/></body>)",
                           motor, spread(5e-5, 5e-4), 0.6 * inertia, 0.6 * inertia, inertia);
    tendons_ += fmt::format(R"(<fixed springlength="0" stiffness="{}" damping="{}"><joint joint="{}" coef="{}"/>)",
                            stiffness, damping, motor, ratio);
    for (const auto& [other, coefficient] : others) {
      tendons_ += fmt::format(R"(<joint joint="{}" coef="{}"/>)", other, coefficient);
    }
    tendons_ += fmt::format(R"(<joint joint="{}" coef="-1"/></fixed>)", joint);
    drive_directly(mechanism, motor, 1.0);
    return motor;
  }

  [[nodiscard]] std::string file(const std::string& arm, const std::string& loops = "") const {
    const std::string cables = tendons_.empty() ? "" : "<tendon>" + tendons_ + "</tendon>";
    return R"(<mujoco><compiler angle="radian" autolimits="true"/><option gravity="0 0 0"/><worldbody>)" + arm +
           rotors_ + "</worldbody>" + cables + loops + "<actuator>" + actuators_ + "</actuator></mujoco>";
  }

 private:
  std::mt19937 random_;
  std::string rotors_;
  std::string tendons_;
  std::string actuators_;
};

/// One to three hinges and slides in a row, in space or in a plane, with cables or without.
inline RandomMechanism serial_mechanism(unsigned seed, int joints) {
  MechanismDraw draw(seed);
  RandomMechanism result;
  struct Driven {
    std::string joint;
    std::string motor;  // the joint itself where there is no cable
    double ratio = 1.0;
    Positions others;
  };
  std::vector<Driven> driven;
  const bool in_a_plane = draw.chance(0.4);
  std::string arm;
  std::string ends;
  for (int i = 0; i < joints; ++i) {
    const std::string name = fmt::format("joint {}", i + 1);
    const bool slides = draw.chance(0.2);
    const double length = i == 0 ? 0.0 : draw.uniform(0.08, 0.25);
    const Eigen::Vector3d axis =
        in_a_plane ? (slides ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ()) : draw.direction();
    const bool by_cable = draw.chance(0.65);
    const double damping = slides ? draw.spread(0.2, 2.0) : draw.spread(1e-3, 1e-2);
    const double armature = by_cable ? 0.0 : (slides ? draw.spread(0.02, 0.2) : draw.spread(5e-4, 5e-3));
    arm += fmt::format(
        R"(<body pos="{} 0 0"><joint name="{}" type="{}" axis="{} {} {}" damping="{}" armature="{}"/>{})", length, name,
        slides ? "slide" : "hinge", axis.x(), axis.y(), axis.z(), damping, armature, draw.inertial(0.2));
    ends += "</body>";
    result.pose[name] = slides ? draw.uniform(-0.05, 0.05) : draw.uniform(-1.2, 1.2);
    if (!by_cable) {
      draw.drive_directly(result, name, draw.chance(0.5) ? 1.0 : draw.uniform(-20.0, -2.0));
      driven.push_back({name, name, 1.0, {}});
      continue;
    }
    Positions others;
    if (i > 0 && draw.chance(0.4)) others["joint 1"] = draw.uniform(-0.5, 0.5) * (slides ? 0.02 : 1.0);
    const double ratio = (slides ? draw.spread(0.005, 0.02) : draw.spread(0.05, 0.2)) * (draw.chance(0.5) ? 1.0 : -1.0);
    const double stiffness = slides ? draw.spread(2e4, 2e5) : draw.spread(100.0, 1000.0);
    const double of_cable = slides ? draw.spread(5.0, 20.0) : draw.spread(0.03, 0.1);
    driven.push_back({name, draw.drive_by_cable(result, name, ratio, others, stiffness, of_cable), ratio, others});
  }
  arm += fmt::format(R"(<site name="tip" pos="{} {} {}"/>)", draw.uniform(0.1, 0.25), draw.uniform(-0.03, 0.03),
                     draw.uniform(-0.03, 0.03)) +
         ends;
  result.xml = draw.file(arm);
  if (draw.chance(0.3)) {
    for (const Driven& each : driven) result.encoders.push_back(each.joint);
  }
  result.joints_of_motors = [driven](const Positions& motors) {
    Positions all = motors;
    for (const Driven& each : driven) {
      double position = each.ratio * motors.at(each.motor);
      for (const auto& [other, coefficient] : each.others) position += coefficient * all.at(other);
      all[each.joint] = position;
    }
    return all;
  };
  result.joints_of_pose = [driven](const Positions& given) {
    Positions all = given;
    for (const Driven& each : driven) {
      double position = given.at(each.joint);
      for (const auto& [other, coefficient] : each.others) position -= coefficient * given.at(other);
      all[each.motor] = position / each.ratio;
    }
    return all;
  };
  result.normal = draw.direction();
  if (in_a_plane) result.normal = Eigen::Vector3d(result.normal.x(), result.normal.y(), 0.0).normalized();
  result.delay = draw.chance(0.5) ? 0.0 : std::round(draw.uniform(0.0, 1500.0) / 10.0) * 1e-5;
  return result;
}

/// Two driven cranks and two rods that meet: a five-bar linkage in any plane, its tip beyond the meeting point.
inline RandomMechanism five_bar_mechanism(unsigned seed) {
  MechanismDraw draw(seed);
  RandomMechanism result;
  struct Bars {
    double left_crank, left_rod, right_rod, right_crank, base;
  };
  const Bars bars{.left_crank = draw.uniform(0.08, 0.12),
                  .left_rod = draw.uniform(0.12, 0.16),
                  .right_rod = draw.uniform(0.12, 0.16),
                  .right_crank = draw.uniform(0.08, 0.12),
                  .base = draw.uniform(0.02, 0.06)};
  struct Angles {  // of the bars in the plane
    double left_crank, left_rod, right_rod, right_crank;
  };
  // The rods meet above the line between the ends of the cranks.
  const auto meet = [bars](double left, double right) {
    using std::atan2;
    const Eigen::Vector2d from = bars.left_crank * Eigen::Vector2d(std::cos(left), std::sin(left));
    const Eigen::Vector2d to =
        Eigen::Vector2d(-bars.base, 0.0) + bars.right_crank * Eigen::Vector2d(std::cos(right), std::sin(right));
    const double apart = (to - from).norm();
    const double along =
        (bars.left_rod * bars.left_rod - bars.right_rod * bars.right_rod + apart * apart) / (2.0 * apart);
    const double across = std::sqrt(bars.left_rod * bars.left_rod - along * along);
    const Eigen::Vector2d e = (to - from) / apart;
    const Eigen::Vector2d at = from + along * e + across * Eigen::Vector2d(e.y(), -e.x());
    return Angles{.left_crank = left,
                  .left_rod = atan2(at.y() - from.y(), at.x() - from.x()),
                  .right_rod = atan2(at.y() - to.y(), at.x() - to.x()),
                  .right_crank = right};
  };
  const Angles zero = meet(draw.uniform(0.3, 0.8), std::numbers::pi - draw.uniform(0.3, 0.8));
  const Eigen::AngleAxisd tilt(draw.uniform(0.0, 3.0), draw.direction());
  const Eigen::Quaterniond q(tilt);
  const auto bar = [&](const char* joint, double x, double angle, double length, double damping, double armature) {
    return fmt::format(R"(<body name="{0}" pos="{1} 0 0" euler="0 0 {2}"><joint name="{0}" axis="0 0 1" damping="{3}" )"
                       R"(armature="{4}"/>{5})",
                       joint, x, angle, damping, armature, draw.inertial(length));
  };
  const bool by_cable = draw.chance(0.7);
  const auto crank = [&](const char* joint, double x, double angle, double length) {
    return bar(joint, x, angle, length, draw.spread(1e-3, 5e-3), by_cable ? 0.0 : draw.spread(5e-4, 5e-3));
  };
  std::string arm = fmt::format(R"(<body quat="{} {} {} {}">)", q.w(), q.x(), q.y(), q.z());
  arm += crank("left", 0.0, zero.left_crank, bars.left_crank);
  arm +=
      bar("left elbow", bars.left_crank, zero.left_rod - zero.left_crank, bars.left_rod, draw.spread(1e-4, 1e-3), 0.0);
  arm += fmt::format(R"(<site name="tip" pos="{} {} 0"/></body></body>)", bars.left_rod + draw.uniform(0.0, 0.04),
                     draw.uniform(-0.02, 0.02));
  arm += crank("right", -bars.base, zero.right_crank, bars.right_crank);
  arm += bar("right elbow", bars.right_crank, zero.right_rod - zero.right_crank, bars.right_rod,
             draw.spread(1e-4, 1e-3), 0.0);
  arm += "</body></body></body>";
  const std::string loops = fmt::format(
      R"(<equality><connect body1="left elbow" body2="right elbow" anchor="{} 0 0" solref="2e-5 1" solimp="0.9999 0.9999 1"/>)"
      "</equality>",
      bars.left_rod);
  Positions ratios;
  for (const char* joint : {"left", "right"}) {
    result.pose[joint] = draw.uniform(-0.3, 0.3);
    if (by_cable) {
      ratios[joint] = draw.spread(0.05, 0.2);
      draw.drive_by_cable(result, joint, ratios[joint], {}, draw.spread(100.0, 1000.0), draw.spread(0.03, 0.1));
    } else {
      draw.drive_directly(result, joint, draw.uniform(1.0, 10.0));
    }
  }
  result.xml = draw.file(arm, loops);
  if (draw.chance(0.3)) result.encoders = {"left", "right"};
  const auto closed = [meet, zero](Positions all) {
    const Angles at = meet(zero.left_crank + all.at("left"), zero.right_crank + all.at("right"));
    all["left elbow"] = at.left_rod - at.left_crank - (zero.left_rod - zero.left_crank);
    all["right elbow"] = at.right_rod - at.right_crank - (zero.right_rod - zero.right_crank);
    for (const char* joint : {"left elbow", "right elbow"})
      all[joint] = std::remainder(all[joint], 2.0 * std::numbers::pi);
    return all;
  };
  result.joints_of_motors = [ratios, closed](const Positions& motors) {
    Positions all = motors;
    for (const auto& [joint, ratio] : ratios) all[joint] = ratio * motors.at("motor of " + joint);
    return closed(all);
  };
  result.joints_of_pose = [ratios, closed](const Positions& given) {
    Positions all = given;
    for (const auto& [joint, ratio] : ratios) all["motor of " + joint] = given.at(joint) / ratio;
    return closed(all);
  };
  const double across = draw.uniform(0.0, 2.0 * std::numbers::pi);
  result.normal = tilt * Eigen::Vector3d(std::cos(across), std::sin(across), 0.0);
  result.delay = draw.chance(0.5) ? 0.0 : std::round(draw.uniform(0.0, 1500.0) / 10.0) * 1e-5;
  return result;
}

/// Every fourth is a closed chain.
inline RandomMechanism random_mechanism(unsigned seed) {
  return seed % 4 == 3 ? five_bar_mechanism(seed) : serial_mechanism(seed, 1 + static_cast<int>(seed % 4));
}

}  // namespace zwidth::test
