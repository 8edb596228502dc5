#pragma once

// Random mechanisms behind cables, random passive grasps of their tips, and a second route to their poles. What Eigen's
// solvers are compiled for is in the source: once, not in each test.

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "zwidth/model/device.hpp"
#include "zwidth/model/tip_motion.hpp"

namespace zwidth::test {

struct RandomMechanism {
  TipMotion motion;
  DeviceParameters loop;
};

class Draws {
 public:
  explicit Draws(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double decades(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }
  bool happens(double share) { return between(0.0, 1.0) < share; }
  Eigen::MatrixXd normal(Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd result(rows, columns);
    for (double& each : result.reshaped()) each = std::normal_distribution<double>()(random_);
    return result;
  }

 private:
  std::mt19937 random_;
};

void add_element(TipMotion& motion, const Eigen::VectorXd& along, double stiffness, double damping);

/// One to four joints, motors behind cables or on the joints, encoders on motors or joints.
RandomMechanism random_mechanism(unsigned seed);

/// Held by masses, springs and dampers in random directions, and by bodies on springs.
TipMotion randomly_held(const TipMotion& motion, double frequency, Draws& draws);

/// The same eigenvalues, rows as large as columns (Parlett & Reinsch 1969): positions, velocities and forces differ
/// in size, and Eigen's solver does not scale.
Eigen::MatrixXd balanced(Eigen::MatrixXd a);

/// Closed-loop poles in z of a wall along directions, one column each: nothing of the library is in it.
class SecondRoute {
 public:
  SecondRoute(const TipMotion& motion, const DeviceParameters& loop, const Eigen::MatrixXd& directions);

  /// The largest |z| but of poles at z = 1, which positions have that nothing holds.
  [[nodiscard]] double radius(double stiffness) const;
  /// The same of a wall whose whole force turns by e^{-j phase}, and is so many times as large.
  [[nodiscard]] double radius_turned(double stiffness, double phase, double factor = 1.0) const;

 private:
  Eigen::MatrixXd base_;
  Eigen::MatrixXd slope_;
  Eigen::MatrixXd damped_;
};

}  // namespace zwidth::test
