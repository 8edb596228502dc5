#pragma once

#include <complex>
#include <vector>

#include "design/region/boundary_branch.hpp"
#include "stability/loop/damper_response.hpp"
#include "stability/tip/tip_response.hpp"
#include "stability/tip/tip_states.hpp"

namespace zwidth::internal {

// The point walls (K, B) that put a pole pair on the unit circle at z = e^{j angle}, one for each eigenvalue l of P, m x m:
//
//     det(1 + (K + B v) P) = 0:   B = Im(-1/l)/Im v,   K = Re(-1/l) - B Re v
//
// which are m curves over the angle. At z = -1 and z = 1, where l and v are real, they are straight lines.
class PointCurve {
 public:
  using Node = BoundaryBranch::Node;
  using Curve = std::vector<Node>;  // by rising angle

  PointCurve(const SampledTip& plant, double velocity_filter_hz);

  // Whether a force moves what the wall senses.
  [[nodiscard]] bool is_seen() const;
  // Of every eigenvalue, in no order; infinite where it is 0. 0 < angle < pi.
  [[nodiscard]] std::vector<WallPoint> walls(double angle) const;
  // The one of them near to a wall, where one K and one B are these.
  [[nodiscard]] WallPoint wall_near(double angle, const WallPoint& guess, const WallPoint& one) const;

  // All of them, at angles so near that each is nearly straight between two; these angles too.
  [[nodiscard]] std::vector<Curve> curves(const std::vector<double>& angles) const;

  // K + B velocity_at_nyquist() of a pole at z = -1, and K of a pole at z = 1, where > 0.
  [[nodiscard]] std::vector<double> nyquist_stiffnesses() const;
  [[nodiscard]] std::vector<double> drift_stiffnesses() const;
  [[nodiscard]] double velocity_at_nyquist() const;

  [[nodiscard]] double period() const { return period_; }

  // rad from z = 1 and from z = -1: nearer, curves are known by their ends.
  static constexpr double least_angle = 1e-6;
  static constexpr double beside_nyquist = 1e-5;

 private:
  struct Sample {
    double angle = 0.0;
    std::vector<WallPoint> walls;  // of one curve each
  };
  [[nodiscard]] Sample sample(double angle) const { return {angle, walls(angle)}; }
  [[nodiscard]] double apart(const WallPoint& a, const WallPoint& b) const;
  void arrange(std::vector<WallPoint>& walls, const std::vector<WallPoint>& before) const;
  [[nodiscard]] bool is_nearly_straight(const Sample& first, const Sample& middle, const Sample& last) const;
  void refine(std::vector<Sample>& samples, Sample last, int depth) const;
  [[nodiscard]] std::vector<double> real_gains(double angle) const;

  TipResponse response_;
  DamperResponse velocity_;
  double period_ = 0.0;
  double unit_ = 1.0;  // N/m: loops of stiffer walls are beyond all that is stable by orders
};

}  // namespace zwidth::internal
