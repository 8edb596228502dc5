#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "simulation/continuous_motion.hpp"
#include "simulation/matrix_vector.hpp"

namespace zwidth::internal {

/// What the motion's slopes are taken by.
struct MotionParameter {
  Eigen::MatrixXd matrix = {};      ///< dA/dp, nothing sticking; empty: 0
  double switching = 0.0;           ///< s per p: how late switch_command() acts
  std::vector<double> limits = {};  ///< dF_c/dp by body; empty: 0
};

/// How the motion of a ContinuousMotion changes with parameters, S = dx/dp, exact along it.
///
///     S' = A S + [dA/dp_j x]_j      between two events, by the same steps and series as x
///     S+ = S + (x'- - x'+) dt/dp    where an event's instant t hangs on p
///
/// The velocity's row of S becomes 0 where a body comes to rest, and times x'+ / x'- where it slides back at once; where
/// a body breaks away x' does not jump, but for a switched command. Nothing allocates or throws after construction.
/// Source: Leine & Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004, ch. 7.
class MotionTangent {
 public:
  /// `motion`'s device at p; the parameters come first among the columns of S, `others` (initial states, constants) next.
  MotionTangent(const ContinuousMotion& motion, std::vector<MotionParameter> parameters, std::size_t others);

  /// S, to be set before set_motion().
  [[nodiscard]] Eigen::MatrixXd& slopes() noexcept { return slopes_; }
  [[nodiscard]] const Eigen::MatrixXd& slopes() const noexcept { return slopes_; }

  // What ContinuousMotion tells; x: its state before.
  void step(const ContinuousMotion::RecurringStep& step, unsigned stuck, std::size_t which, const double* x) noexcept;
  /// Over a fraction of the length of x's series, of which `known` terms are not 0.
  void move(const ContinuousMotion::Pattern& pattern, unsigned stuck, const Eigen::MatrixXd& series, std::size_t known,
            double length, double fraction) noexcept;
  void turn(std::size_t velocity, double ratio) noexcept { slopes_.row(static_cast<Eigen::Index>(velocity)) *= ratio; }
  void slide(std::size_t body, std::size_t force, int direction) noexcept;
  void start(std::size_t velocity, double acceleration) noexcept;
  void switch_command(const Eigen::MatrixXd& matrix, std::size_t command, double fall) noexcept;

 private:
  struct Entry {
    std::size_t row = 0;
    std::size_t column = 0;
    double value = 0.0;
  };
  /// A parameter that A hangs on.
  struct Varied {
    std::size_t column = 0;                           // of S
    std::vector<std::vector<Entry>> entries;          // of dA/dp, by pattern
    std::vector<std::vector<Eigen::MatrixXd>> steps;  // de^{Ah}/dp, by pattern and recurring step
  };

  void make_steps(Varied& varied, const ContinuousMotion::Pattern& pattern, const Eigen::MatrixXd& slope,
                  const std::vector<double>& lengths) const;

  std::vector<MotionParameter> parameters_;
  std::vector<Varied> varied_;
  MatrixVector multiply_ = nullptr;
  std::size_t size_ = 0;
  Eigen::MatrixXd slopes_;
  Eigen::MatrixXd next_;
  Eigen::MatrixXd term_;
};

}  // namespace zwidth::internal
