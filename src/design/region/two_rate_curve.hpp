#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "design/region/boundary_branch.hpp"
#include "design/region/response_and_slope.hpp"
#include "stability/limit/gain_crossings.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// The walls (K, B) of a device whose damper runs in a loop of its own that put a pole pair on the unit circle, z = e^{j angle}
// of the longer period. The part of the wall that runs the oftener, spring or damper, is inside, its gain q; the other one,
// of gain g, sees the plant of docs/theory.md, "Two rates": with the N aliases z_k = e^{j(angle + 2 pi k)/N} of the shorter period,
//
//     g = -1/(C_out P),   P = (1/N) sum_k h(z_k) P_out(z_k)/(1 + q C_in(z_k) P_in(z_k)),   h(z) = (1 - z^-N)/(1 - z^-1)
//
// which two reals (K, B) and one angle fulfil along curves.
class TwoRateCurve {
 public:
  using Node = BoundaryBranch::Node;

  explicit TwoRateCurve(const Device& device);

  [[nodiscard]] bool is_damper_inside() const { return loop_.is_damper_inside(); }
  [[nodiscard]] bool is_seen() const { return !outer_.terms.empty() && !inner_.terms.empty(); }
  [[nodiscard]] double period() const { return outer_period_; }
  [[nodiscard]] double velocity_filter_hz() const { return loop_.damper().velocity_filter_hz; }

  // Every crossing of the gain outside at this one inside, q > 0, by the plant that is sampled behind the closed loop inside.
  [[nodiscard]] GainCrossings crossings(double inside) const;
  // The gains inside that put a pole on the circle with nothing outside.
  [[nodiscard]] GainCrossings crossings_alone() const;

  // With that gain outside and inside.
  [[nodiscard]] WallPoint wall(double outside, double inside) const {
    return is_damper_inside() ? WallPoint{outside, inside} : WallPoint{inside, outside};
  }
  [[nodiscard]] double outside(const WallPoint& wall) const {
    return is_damper_inside() ? wall.stiffness : wall.damping;
  }
  [[nodiscard]] double inside(const WallPoint& wall) const {
    return is_damper_inside() ? wall.damping : wall.stiffness;
  }

  // The gain inside at which the loop inside is about 1 at this angle a sample.
  [[nodiscard]] double usual_inside(double angle) const;

  // The angle in the longer period, 0 to pi, of one in the shorter.
  [[nodiscard]] double seen_angle(double angle) const;
  // Im[1/(C_out P)]: 0 where a pole pair is at that angle for some gain outside.
  [[nodiscard]] double phase(double angle, double inside) const { return seen(angle, inside).gain.imag(); }
  // Re[-1/(C_out P)]: that gain. At pi that of a pole at z = -1; not finite where there is none.
  [[nodiscard]] double gain(double angle, double inside) const { return -seen(angle, inside).gain.real(); }
  [[nodiscard]] double nyquist_gain(double inside) const { return gain(std::numbers::pi, inside); }
  // K of a pole at z = 1, where > 0.
  [[nodiscard]] std::optional<double> drift_stiffness() const;

  // The gain inside of a pole of the shorter period at z = -1, where the other gain does not move it: N is even, so that a
  // held force does not reach it.
  [[nodiscard]] std::optional<double> unreached_gain() const;
  // Its angle in the longer period. Such angles above pi stand for straight lines.
  [[nodiscard]] double unreached_angle() const { return static_cast<double>(steps_) * std::numbers::pi; }

  [[nodiscard]] static Eigen::Vector3d place(const Node& node) {
    return {node.angle, node.wall.stiffness, node.wall.damping};
  }
  [[nodiscard]] static bool is_straight(const Node& node) { return node.angle == 0.0 || node.angle > std::numbers::pi; }

  // What is one along each of angle, K and B: all steps are in shares of it.
  Eigen::Vector3d scales = Eigen::Vector3d::Ones();

  // The direction of the curve at a point of it, of length 1 in shares of the scales.
  [[nodiscard]] Eigen::Vector3d tangent(const Node& node) const;
  // The curve's point nearest to that guess in the plane through it that is normal to `normal`, in shares; nothing where
  // Newton's method does not find it.
  [[nodiscard]] std::optional<Node> solve(const Node& guess, const Eigen::Vector3d& normal) const;

  // How the loop oscillates there. Of the aliases of the longer period it is the one that moves the position most, where
  // the spring runs the oftener.
  [[nodiscard]] double frequency(const Node& node) const;
  // The device alone, at the spring's period: what modes are named by.
  [[nodiscard]] const SampledPlant& modes() const { return modes_; }
  [[nodiscard]] double spring_period() const { return loop_.spring().period; }

 private:
  using Complex = std::complex<double>;
  struct Seen {
    Complex gain;       // 1/(C_out P)
    Complex by_inside;  // its slope over q
    Complex by_angle;
  };
  [[nodiscard]] Seen seen(double angle, double inside) const;
  // A sample of the shorter period turns by (angle + 2 pi k)/N.
  [[nodiscard]] HalfTurn alias_of(const HalfTurn& first, std::size_t k) const;
  struct Alias {
    Complex moved;      // h P_out/(1 + q C_in P_in)
    Complex by_inside;  // its slope over q
    Complex by_angle;
  };
  [[nodiscard]] Alias alias(const HalfTurn& longer, const HalfTurn& shorter, double inside) const;
  // Two rows: of the real and the imaginary part of g + 1/(C_out P), and the slopes over angle, K and B.
  struct Equations {
    Eigen::Vector2d value;
    Eigen::Matrix<double, 2, 3> slopes;
  };
  [[nodiscard]] Equations equations(const Node& node) const;

  TwoRateDevice loop_;
  PlantBehindLoop behind_;
  std::size_t steps_ = 1;  // N
  double outer_period_ = 0.0;
  double inner_period_ = 0.0;
  std::vector<HalfTurn> turns_;  // by 2 pi k/N
  SampledPlant outer_;           // both at the shorter period
  SampledPlant inner_;
  bool same_delay_ = false;
  double inner_filter_ = 0.0;  // the pole of the velocity's low-pass, where the damper runs at that period
  double outer_filter_ = 0.0;
  SampledPlant modes_;
};

}  // namespace zwidth::internal
