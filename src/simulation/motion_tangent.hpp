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

  /// By rows, each filled up with zeros to whole blocks: a row of S is what one state's change adds to at once.
  using Slopes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// S and, beyond columns(), zeros; to be set before set_motion().
  [[nodiscard]] Slopes& slopes() noexcept { return slopes_; }
  [[nodiscard]] const Slopes& slopes() const noexcept { return slopes_; }
  [[nodiscard]] Eigen::Index columns() const noexcept { return columns_; }

  /// The parameter's dA/dp and dF_c/dp count this many times from then on: a force that is not linear, held from step to
  /// step.
  void weigh(std::size_t parameter, double weight) noexcept;

  // What ContinuousMotion tells; x: its state before.
  void step(unsigned stuck, std::size_t which, const double* x) noexcept;
  /// Over a fraction of the length of x's series, of which `known` terms are not 0.
  void move(const ContinuousMotion::Pattern& pattern, unsigned stuck, const Eigen::MatrixXd& series, std::size_t known,
            double length, double fraction) noexcept;
  void turn(std::size_t velocity, double ratio) noexcept;
  void slide(std::size_t body, std::size_t force, int direction) noexcept;
  void start(std::size_t velocity, double acceleration) noexcept;
  void switch_command(const Eigen::MatrixXd& matrix, std::size_t command, double fall) noexcept;

 private:
  struct Entry {
    std::size_t row = 0;
    std::size_t column = 0;
    double value = 0.0;
  };
  /// Of a matrix, by rows: what is not 0. Most of A is.
  struct Sparse {
    std::vector<Entry> entries;
    std::vector<std::size_t> begins;  ///< of each row, and the end
  };
  /// A parameter that A hangs on.
  struct Varied {
    std::size_t column = 0;  // of S
    double weight = 1.0;
    std::vector<std::vector<Entry>> entries;          // of dA/dp, by pattern
    std::vector<std::vector<Eigen::MatrixXd>> steps;  // de^{Ah}/dp, by pattern and recurring step
  };

  [[nodiscard]] static Sparse sparse(const Eigen::MatrixXd& matrix);
  void make_steps(Varied& varied, const ContinuousMotion::Pattern& pattern, const Eigen::MatrixXd& slope,
                  const ContinuousMotion& motion) const;
  /// out = factor * matrix * in.
  void multiply(const Sparse& matrix, double factor, const Slopes& in, Slopes& out) const noexcept;

  struct Sliding {
    std::size_t force = 0;  // row of its friction force
    int direction = 0;      // the last
  };

  std::vector<MotionParameter> parameters_;
  std::vector<double> limit_weights_;  // by parameter
  std::vector<Sliding> sliding_;       // by body
  std::vector<Varied> varied_;
  std::vector<Sparse> matrices_;                  // A, by pattern
  std::vector<std::vector<Sparse>> transitions_;  // e^{Ah}, by pattern and recurring step
  MatrixVector multiply_ = nullptr;
  std::size_t size_ = 0;
  Eigen::Index columns_ = 0;  // of S, without the zeros that fill its rows up
  std::vector<double> change_;
  Slopes slopes_;
  Slopes next_;
  Slopes term_;
};

}  // namespace zwidth::internal
