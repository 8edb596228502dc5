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

/// A place on the way from a minimum, and what it costs.
struct Place {
  Eigen::VectorXd z;
  std::optional<double> cost;
};

/// z, drawn back towards the minimum while it costs more than `most`: on that way the cost rises by the square of the distance.
/// What costs many times more is left for a step that is damped.
Place drawn_back(const LeastSquaresProblem& problem, const Minimum& minimum, Eigen::VectorXd z, double rise,
                 double most) {
  constexpr int most_backs = 3;
  constexpr double many = 30.0;
  std::optional<double> cost = problem.cost(z);
  for (int back = 0; back < most_backs && cost && *cost > most; ++back) {
    const double rises = (*cost - minimum.picture.cost) / rise;
    if (!(rises < many)) break;
    z = minimum.z + (z - minimum.z) / std::sqrt(rises);
    cost = problem.cost(z);
  }
  return {std::move(z), cost};
}

}  // namespace

ProfileEnd profile_end(const LeastSquaresProblem& problem, const Minimum& minimum, const LogOf& number,
                       Eigen::Index varied, double direction, double rise) {
  constexpr int most_steps = 12;
  constexpr double within = 0.05;      // of the rise: so much more is allowed
  constexpr double near = 0.1;         // of the rise: from so much less on, a place is at the boundary
  constexpr double better = 0.15;      // of the rise: so much below the minimum, that was none
  constexpr double still = 2e-4;       // of the logarithm
  constexpr double notable = 0.01;     // of the way
  constexpr int most_in_vain = 4;      // steps from the boundary that lead no further
  constexpr double most_damping = 10;  // of the curvature
  const Eigen::VectorXd lowest = problem.lowest();
  const double middle = number(minimum.z).value_or(0.0);
  const double floor = minimum.picture.cost;
  ProfileEnd end{middle, minimum.z, 0.0, false};
  Picture here = minimum.picture;
  double damping = 0.0;
  double promised = 0.0;  // by the first step
  int in_vain = 0;
  bool rests = false;
  const auto slope_at_end = [&] { return Eigen::VectorXd(-direction * slope_of(number, end.z, varied, lowest)); };
  Eigen::VectorXd slope = slope_at_end();
  for (int step = 0; step < most_steps && damping < most_damping && !rests;) {
    const Eigen::VectorXd move = step_to_cost(here, slope, lowest - end.z, damping, floor + rise);
    if (step == 0 && damping == 0.0) promised = std::abs(slope.dot(move));
    Place place = drawn_back(problem, minimum, end.z + move, rise, floor + (1.0 + within) * rise);
    const std::optional<double> value = number(place.z);
    const bool is_allowed = place.cost && value && *place.cost <= floor + (1.0 + within) * rise;
    if (is_allowed && *place.cost < floor - better * rise) {
      end.found_better = true;
      end.z = std::move(place.z);
      return end;
    }
    const double gain = is_allowed ? (*value - end.value) * direction : 0.0;
    if (!(gain > 0.0)) {  // too far for what the data hardly tell: less of it
      if (here.cost >= floor + (1.0 - near) * rise) rests = ++in_vain == most_in_vain;
      damping = std::max(1e-6, 30.0 * damping);
      continue;
    }
    std::optional<Picture> picture;
    rests = gain < still + notable * std::abs(*value - middle) && *place.cost >= floor + (1.0 - near) * rise;
    if (!rests) picture = problem.picture(place.z);
    if (!rests && !picture) break;
    ++step;
    in_vain = 0;
    end.value = *value;
    end.z = std::move(place.z);
    end.last_change = gain;
    if (rests) break;
    here = *std::move(picture);
    slope = slope_at_end();
    damping *= 0.1;
    if (damping < 1e-6) damping = 0.0;
  }
  if (rests) {
    end.last_change = 0.0;
    return end;
  }
  // Stopped on its way: as far again, or where the cost, which rises by the square, would be what is allowed.
  constexpr double least_rises = 0.01;
  const double rises = std::clamp((here.cost - floor) / rise, least_rises, 1.0);
  const double missing =
      end.last_change > 0.0 ? std::abs(end.value - middle) * (1.0 / std::sqrt(rises) - 1.0) : promised;
  end.last_change = std::max(end.last_change, missing);
  end.value += direction * end.last_change;
  return end;
}

std::optional<ProfileRange> profile_range(const LeastSquaresProblem& problem, Minimum& minimum,
                                          const NumberAt& number_at, Eigen::Index varied, double rise,
                                          const MinimiseOptions& options) {
  constexpr int most_begins = 4;
  for (int begins = 1;; ++begins) {
    const std::optional<LogOf> number = number_at(minimum);
    const std::optional<double> middle = number ? (*number)(minimum.z) : std::nullopt;
    if (!middle) return std::nullopt;
    const auto end = [&](double direction) { return profile_end(problem, minimum, *number, varied, direction, rise); };
    ProfileRange range{*middle, end(-1.0), {*middle, minimum.z}};
    const bool is_last = begins == most_begins;
    if (!range.low.found_better || is_last) range.high = end(1.0);
    const ProfileEnd& better = range.low.found_better ? range.low : range.high;
    if (!better.found_better) return range;
    auto again = is_last ? std::nullopt : minimise(problem, better.z, options);
    if (again && number_at(*again)) {
      minimum = *std::move(again);
      continue;
    }
    // It still gave way: the better place is not the best either.
    if (!is_last) range.high = end(1.0);
    const double moved = std::abs((*number)(better.z).value_or(*middle) - *middle);
    for (ProfileEnd* each : {&range.low, &range.high}) {
      if (each->found_better) each->last_change = std::max(each->last_change, moved);
    }
    return range;
  }
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
