#include "identification/optimiser/minimise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "identification/optimiser/bounded_step.hpp"

namespace zwidth::internal {

std::optional<Minimum> minimise(const LeastSquaresProblem& problem, Eigen::VectorXd start,
                                const MinimiseOptions& options) {
  std::optional<Picture> here = problem.picture(start);
  if (!here) return std::nullopt;
  Minimum found{std::move(start), *std::move(here), false};
  constexpr double next_to_none = 1e-10;
  constexpr double most_damping = 1e10;
  double damping = 1e-4;
  constexpr double first_growth = 2.0;
  constexpr double less = 1e-3;
  double growth = first_growth;
  constexpr int most_poor = 3;  // steps in a row that keep less than the least gain
  int poor = 0;
  std::vector<bool> held(static_cast<std::size_t>(found.z.size()), false);
  std::fill_n(held.begin(), options.held, true);
  const auto least_gain = [&] {
    return options.least_gain * (options.residuals > 0.0 ? 2.0 * found.picture.cost / options.residuals : 1.0);
  };
  for (int step = 0; step < options.most_steps && damping < most_damping;) {
    Eigen::MatrixXd damped = found.picture.hessian;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::VectorXd move = bounded_step(damped, found.picture.gradient, problem.lowest() - found.z, held);
    const double promised = -found.picture.gradient.dot(move) - 0.5 * move.dot(found.picture.hessian * move);
    if (!(promised > least_gain())) {
      const bool tried_less_damped = growth > first_growth || damping <= next_to_none;
      if (tried_less_damped) {
        found.settled = true;
        break;
      }
      damping = std::max(next_to_none, less * damping);  // what is damped promises little anywhere
      growth = 2.0 * first_growth;
      continue;
    }
    const Eigen::VectorXd there = found.z + move;
    const std::optional<double> cost = problem.cost(there);
    const double kept = cost ? (found.picture.cost - *cost) / promised : -1.0;
    if (kept > 1e-3) {
      std::optional<Picture> picture = problem.picture(there);
      if (!picture) return std::nullopt;
      poor = found.picture.cost - picture->cost < least_gain() ? poor + 1 : 0;
      found.z = there;
      found.last_step = move;
      found.picture = *std::move(picture);
      damping = std::max(next_to_none, damping * std::max(0.1, 1.0 - std::pow(2.0 * kept - 1.0, 3)));
      growth = first_growth;
      ++step;
      if (poor == most_poor) break;
      found.ran_out = step == options.most_steps;
    } else {
      damping *= growth;
      growth *= 2.0;
    }
  }
  return found;
}

}  // namespace zwidth::internal
