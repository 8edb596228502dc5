#include "identification/verdict/profile.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/optimiser/bounded_step.hpp"
#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

/// The move d that changes a number most, by slope'd, at a cost of `allowed`:
///
///     min w slope'd + g'd + d'(H + damping diag H) d / 2,    w by bisection
Eigen::VectorXd step_to_cost(const Picture& here, const Eigen::VectorXd& slope, const Eigen::VectorXd& lowest,
                             double damping, double allowed) {
  Eigen::MatrixXd hessian = here.hessian;
  hessian.diagonal() *= 1.0 + damping;
  const auto move_at = [&](double weight) { return bounded_step(hessian, here.gradient + slope * weight, lowest); };
  const auto promised = [&](const Eigen::VectorXd& move) {
    return here.cost + here.gradient.dot(move) + 0.5 * move.dot(here.hessian * move);
  };
  double low = 0.0;
  double high = 1.0;
  constexpr double most = 1e12;
  while (promised(move_at(high)) < allowed && high < most) high *= 4.0;
  for (int i = 0; i < 40 && high - low > 1e-3 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (promised(move_at(middle)) < allowed ? low : high) = middle;
  }
  return move_at(0.5 * (low + high));
}

}  // namespace

ProfileEnd profile_end(const LeastSquaresProblem& problem, const Minimum& minimum, const LogOf& number,
                       Eigen::Index varied, double direction, double rise) {
  constexpr int most_steps = 12;
  constexpr int most_backs = 3;
  constexpr double enough = 0.05;      // of the rise
  constexpr double better = 0.15;      // of the rise
  constexpr double spent = 0.5;        // of the rise: a step that costs less was shortened, and tells of no end
  constexpr double still = 2e-4;       // of the logarithm
  constexpr double notable = 0.01;     // of the way
  constexpr int most_poor = 2;         // steps in a row that lead no further
  constexpr double most_damping = 10;  // of the curvature
  constexpr double most_rises = 30;    // of a step that is shortened; one that costs more is damped
  const Eigen::VectorXd lowest = problem.lowest();
  const double middle = number(minimum.z).value_or(0.0);
  ProfileEnd end{middle, minimum.z, 0.0, false};
  Eigen::VectorXd z = minimum.z;
  Picture here = minimum.picture;
  double before = middle;
  double damping = 0.0;
  int poor = 0;
  const double allowed = minimum.picture.cost + rise;
  const double most = allowed + enough * rise;
  for (int step = 0; step < most_steps;) {
    const Eigen::VectorXd slope = -direction * slope_of(number, z, varied, lowest);
    Eigen::VectorXd there = z + step_to_cost(here, slope, lowest - z, damping, allowed);
    std::optional<double> cost = problem.cost(there);
    for (int back = 0; back < most_backs && cost && *cost > most; ++back) {  // from the minimum it rises by the square
      const double rises = (*cost - minimum.picture.cost) / rise;
      if (rises > most_rises) break;
      there = minimum.z + (there - minimum.z) / std::sqrt(rises);
      cost = problem.cost(there);
    }
    const std::optional<double> value = number(there);
    if (!cost || !value || *cost > most) {  // what the data hardly tell goes too far: less of it
      damping = std::max(1e-6, 30.0 * damping);
      if (damping > most_damping) break;
      continue;
    }
    ++step;
    z = there;
    if (*cost < minimum.picture.cost - rise * better) {
      end.found_better = true;
      end.z = z;
      return end;
    }
    const double least = still + notable * std::abs(*value - middle);
    const double gain = (*value - end.value) * direction;
    const bool is_spent = *cost > minimum.picture.cost + spent * rise;
    poor = is_spent && gain < least ? poor + 1 : 0;
    if (gain > 0.0) {
      end.value = *value;
      end.z = z;
    }
    end.last_change = std::abs(*value - before);
    before = *value;
    if (is_spent && (end.last_change < least || poor == most_poor)) {
      end.last_change = 0.0;
      break;
    }
    std::optional<Picture> picture = problem.picture(z);
    if (!picture) break;
    here = *std::move(picture);
    damping *= 0.1;
    if (damping < 1e-6) damping = 0.0;
  }
  // One that was stopped on its way may lie as far again.
  end.value += direction * end.last_change;
  return end;
}

Eigen::VectorXd slope_of(const LogOf& number, const Eigen::VectorXd& z, Eigen::Index varied,
                         const Eigen::VectorXd& lowest) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(z.size());
  for (Eigen::Index i = 0; i < varied; ++i) {
    const double step = 1e-4 * std::max(1e-2, std::abs(z(i)));
    Eigen::VectorXd above = z;
    Eigen::VectorXd below = z;
    above(i) += step;
    below(i) = std::max(lowest(i), z(i) - step);
    const auto high = number(above);
    const auto low = number(below);
    if (high && low) gradient(i) = (*high - *low) / (above(i) - below(i));
  }
  return gradient;
}

double last_change(const Minimum& minimum, const Eigen::VectorXd& slope) {
  if (minimum.settled || minimum.last_step.size() == 0) return 0.0;
  return std::abs(slope.dot(minimum.last_step));
}

Eigen::VectorXd covariance_times(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& vector) {
  return covariance_of(hessian) * vector;
}

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& hessian) {
  constexpr double least = 1e-13;
  const Eigen::VectorXd unit = hessian.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = unit.asDiagonal() * hessian * unit.asDiagonal();
  scaled.diagonal().array() += least;
  return unit.asDiagonal() * inverse_of_symmetric(scaled) * unit.asDiagonal();
}

}  // namespace zwidth::internal
