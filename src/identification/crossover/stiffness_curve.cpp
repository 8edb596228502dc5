#include "identification/crossover/stiffness_curve.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "identification/crossover/student_t.hpp"

namespace zwidth::internal {
namespace {

using Numbers = StiffnessCurve::Numbers;
using Half = Eigen::Vector3d;

constexpr std::array<std::size_t, 14> curve_reaches{4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384};
/// A wider fit curve_agrees with a narrower one within this many of the narrower one's standard deviations.
constexpr double curve_agreement = 2.0;
/// Standard deviations by which the misfit may exceed its expectation.
constexpr double most_curve_misfit = 2.0;
/// The lines are chosen by the same data, which costs certainty: by this much, as simulated.
constexpr double cost_of_curve = 1.2;

/// 1, t, t^2 with t from -1 to 1 over the curve's squares of w.
Half powers_at(const StiffnessCurve& curve, double frequency) {
  const double low = curve.lowest * curve.lowest;
  const double high = curve.highest * curve.highest;
  const double t = (2.0 * frequency * frequency - low - high) / (high - low);
  return {1.0, t, t * t};
}

struct CurveFit {
  StiffnessCurve curve;
  double misfit = 0.0;
  double freedom = 0.0;
};

std::optional<CurveFit> fitted_curve(std::span<const PhaseLine> lines, std::size_t first, std::size_t last,
                                     double correlation) {
  CurveFit fit;
  fit.curve.first = first;
  fit.curve.last = last;
  fit.curve.lowest = lines[first].frequency;
  fit.curve.highest = lines[last].frequency;
  std::size_t count = 0;
  for (std::size_t i = first; i <= last; ++i) {
    if (std::isfinite(lines[i].sigma) && lines[i].sigma > 0.0) ++count;
  }
  constexpr std::size_t fewest = 6;
  if (count < fewest) return std::nullopt;
  fit.freedom = 2.0 * static_cast<double>(count) - 6.0;
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    StiffnessCurve::Covariance normal = StiffnessCurve::Covariance::Zero();
    Numbers right = Numbers::Zero();
    fit.misfit = 0.0;
    double squares = 0.0;
    for (std::size_t i = first; i <= last; ++i) {
      const PhaseLine& line = lines[i];
      if (!std::isfinite(line.sigma) || !(line.sigma > 0.0)) continue;
      const Half powers = powers_at(fit.curve, line.frequency);
      const double odd = line.frequency / fit.curve.highest;
      const double size = round == 0 ? 1.0 / std::abs(line.value)
                                     : std::hypot(fit.curve.numbers.head<3>().dot(powers),
                                                  odd * fit.curve.numbers.tail<3>().dot(powers));
      const double weight = 1.0 / (line.sigma * size);
      Eigen::Matrix<double, 2, 6> rows;
      rows.row(0) << line.value.real() * powers.transpose(), -odd * line.value.imag() * powers.transpose();
      rows.row(1) << line.value.imag() * powers.transpose(), odd * line.value.real() * powers.transpose();
      rows *= weight;
      normal += rows.transpose() * rows;
      right += weight * rows.row(0).transpose();
      squares += weight * weight;
    }
    const Numbers scale = normal.diagonal().cwiseSqrt().cwiseInverse();
    if (!scale.allFinite()) return std::nullopt;
    const Eigen::LDLT<StiffnessCurve::Covariance> solver(scale.asDiagonal() * normal * scale.asDiagonal());
    constexpr double singular = 1e-11;
    if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > singular)) return std::nullopt;
    fit.curve.numbers = scale.cwiseProduct(solver.solve(scale.cwiseProduct(right)));
    fit.curve.covariance =
        scale.asDiagonal() * solver.solve(StiffnessCurve::Covariance::Identity()) * scale.asDiagonal();
    fit.misfit = std::max(0.0, squares - fit.curve.numbers.dot(right));
  }
  fit.curve.covariance *= std::min(static_cast<double>(count), correlation);
  return fit;
}

bool curve_agrees(Estimate wider, Estimate narrower) {
  return std::abs(wider.value - narrower.value) <= curve_agreement * narrower.sigma;
}

}  // namespace

Estimate StiffnessCurve::real_at(double frequency) const {
  const Half powers = powers_at(*this, frequency);
  return {numbers.head<3>().dot(powers), std::sqrt(powers.dot(covariance.topLeftCorner<3, 3>() * powers))};
}

Estimate StiffnessCurve::imaginary_at(double frequency) const {
  const Half powers = powers_at(*this, frequency);
  return {numbers.tail<3>().dot(powers), std::sqrt(powers.dot(covariance.bottomRightCorner<3, 3>() * powers))};
}

double StiffnessCurve::covariance_at(double frequency) const {
  const Half powers = powers_at(*this, frequency);
  return powers.dot(covariance.topRightCorner<3, 3>() * powers);
}

std::optional<StiffnessCurve> stiffness_curve(std::span<const PhaseLine> lines, std::size_t index, std::size_t first,
                                              std::size_t last, double correlation) {
  std::optional<StiffnessCurve> best;
  std::array<std::pair<Estimate, Estimate>, curve_reaches.size()> accepted;
  std::size_t count = 0;
  const double at = lines[index].frequency;
  for (const std::size_t reach : curve_reaches) {
    const std::size_t begin = std::max(first, index - std::min(index, reach));
    const std::size_t end = std::min(last, index + reach);
    if (auto fit = fitted_curve(lines, begin, end, correlation)) {
      const std::pair own{fit->curve.real_at(at), fit->curve.imaginary_at(at)};
      bool fits = fit->misfit <= fit->freedom + most_curve_misfit * std::sqrt(2.0 * fit->freedom * correlation);
      for (std::size_t i = 0; i < count; ++i)
        fits = fits && curve_agrees(own.first, accepted[i].first) && curve_agrees(own.second, accepted[i].second);
      if (!fits) break;
      accepted[count++] = own;
      best = fit->curve;
    }
    if (begin == first && end == last) break;
  }
  if (best) best->covariance *= cost_of_curve * cost_of_curve;
  return best;
}

std::optional<MeasuredCrossover> crossing_of(const StiffnessCurve& curve, double frequency, int sign) {
  const auto value = [&](double w) { return sign * curve.imaginary_at(w).value; };
  // The passage nearest to `frequency`, then exactly.
  constexpr int steps = 400;
  std::optional<double> found;
  const double ratio = curve.highest / curve.lowest;
  for (int i = 0; i < steps; ++i) {
    double low = curve.lowest * std::pow(ratio, static_cast<double>(i) / steps);
    double high = curve.lowest * std::pow(ratio, static_cast<double>(i + 1) / steps);
    if (!(value(low) > 0.0 && value(high) <= 0.0)) continue;
    constexpr int halvings = 60;
    for (int half = 0; half < halvings; ++half) {
      const double middle = 0.5 * (low + high);
      (value(middle) > 0.0 ? low : high) = middle;
    }
    if (!found || std::abs(low - frequency) < std::abs(*found - frequency)) found = low;
  }
  if (!found) return std::nullopt;
  const auto surprise = [&](double w) {
    const Estimate b = curve.imaginary_at(w);
    return b.value / b.sigma;
  };
  // Outwards to where the passage is excluded.
  const auto end_towards = [&](double limit) -> std::optional<double> {
    double inner = *found;
    double outer = *found;
    for (int i = 1; i <= steps; ++i) {
      outer = *found * std::pow(limit / *found, std::pow(static_cast<double>(i) / steps, 3));
      if (std::abs(surprise(outer)) > two_sided_95) break;
      if (i == steps) return std::nullopt;
      inner = outer;
    }
    constexpr int halvings = 40;
    for (int half = 0; half < halvings; ++half) {
      const double middle = 0.5 * (inner + outer);
      (std::abs(surprise(middle)) > two_sided_95 ? outer : inner) = middle;
    }
    return outer;
  };
  const auto lower = end_towards(curve.lowest);
  const auto upper = end_towards(curve.highest);
  if (!lower || !upper) return std::nullopt;
  MeasuredCrossover crossing;
  crossing.frequency = *found;
  crossing.stiffness = -curve.real_at(*found).value;
  crossing.frequency_interval = {*lower, *upper};
  crossing.stiffness_interval = {crossing.stiffness, crossing.stiffness};
  crossing.poles_leaving = sign > 0 ? 2 : -2;
  for (int i = 0; i <= steps; ++i) {
    const double w = *lower + (*upper - *lower) * static_cast<double>(i) / steps;
    const Estimate a = curve.real_at(w);
    const Estimate b = curve.imaginary_at(w);
    const double common = curve.covariance_at(w) / (b.sigma * b.sigma);
    const double stiffness = -(a.value - common * b.value);
    const double left = two_sided_95 * two_sided_95 - std::pow(b.value / b.sigma, 2);
    const double own = a.sigma * a.sigma - common * common * b.sigma * b.sigma;
    const double radius = std::sqrt(std::max(0.0, left) * std::max(0.0, own));
    crossing.stiffness_interval.lower = std::min(crossing.stiffness_interval.lower, stiffness - radius);
    crossing.stiffness_interval.upper = std::max(crossing.stiffness_interval.upper, stiffness + radius);
  }
  crossing.stiffness_interval.lower = std::max(0.0, crossing.stiffness_interval.lower);
  if (!(crossing.stiffness > 0.0)) return std::nullopt;
  return crossing;
}

}  // namespace zwidth::internal
