#include "identification/verdict/profile.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/fit/bounded_step.hpp"

namespace zwidth::internal {
namespace {

/// By differences within a share of each coordinate's deviation.
Eigen::VectorXd gradient_of(const LogOf& number, const Eigen::VectorXd& z, Eigen::Index varied,
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

}  // namespace

ProfileEnd profile_end(const LeastSquaresProblem& problem, const Minimum& minimum, const LogOf& number,
                       Eigen::Index varied, double direction, double rise) {
  constexpr int most_steps = 12;
  constexpr double enough = 0.05;  // of the rise
  constexpr double better = 0.15;  // of the rise
  constexpr double still = 2e-4;   // of the logarithm
  const Eigen::VectorXd lowest = problem.lowest();
  ProfileEnd end{number(minimum.z).value_or(0.0), minimum.z, false, false};
  Eigen::VectorXd z = minimum.z;
  Picture here = minimum.picture;
  const double allowed = minimum.picture.cost + rise;
  for (int step = 0; step < most_steps; ++step) {
    const Eigen::VectorXd slope = -direction * gradient_of(number, z, varied, lowest);
    // min slope'd + w (g'd + d'H d / 2): w by bisection so that the promised cost is what is allowed.
    const auto move_at = [&](double weight) {
      return bounded_step(here.hessian, here.gradient + slope * weight, lowest - z);
    };
    const auto promised = [&](const Eigen::VectorXd& move) {
      return here.cost + here.gradient.dot(move) + 0.5 * move.dot(here.hessian * move);
    };
    double low = 0.0;
    double high = 1.0;
    while (promised(move_at(high)) < allowed && high < 1e12) high *= 4.0;
    for (int i = 0; i < 40 && high - low > 1e-4 * high; ++i) {
      const double middle = 0.5 * (low + high);
      (promised(move_at(middle)) < allowed ? low : high) = middle;
    }
    const Eigen::VectorXd move = move_at(0.5 * (low + high));
    double share = 1.0;
    std::optional<double> cost;
    const double worst = std::max(here.cost, allowed) + 2.0 * rise;
    for (; share > 1e-3; share *= 0.5) {
      cost = problem.cost(z + share * move);
      if (cost && *cost <= worst) break;
    }
    if (!cost || *cost > worst) break;
    const Eigen::VectorXd there = z + share * move;
    std::optional<Picture> picture = problem.picture(there);
    const auto value = number(there);
    if (!picture || !value) break;
    const double before = number(z).value_or(0.0);
    z = there;
    here = *std::move(picture);
    if (here.cost < minimum.picture.cost - rise * better) {
      end.found_better = true;
      end.z = z;
      return end;
    }
    const bool is_within = here.cost <= allowed + enough * rise;
    if (is_within && (*value - end.value) * direction > 0.0) {
      end.value = *value;
      end.z = z;
    }
    if (is_within && std::abs(*value - before) < still + 0.01 * std::abs(*value - number(minimum.z).value_or(0.0)) &&
        share == 1.0) {
      end.settled = true;
      break;
    }
  }
  return end;
}

}  // namespace zwidth::internal
