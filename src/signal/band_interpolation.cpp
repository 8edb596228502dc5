#include "signal/band_interpolation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace zwidth::internal {
namespace {

constexpr std::size_t rows_aside = 8;

double covariance(double angle) { return std::abs(angle) < 1e-6 ? 1.0 : std::sin(angle) / angle; }

}  // namespace

double RowWeights::of(std::span<const double> signal) const {
  // About one of them, which keeps the digits of a signal far from 0.
  const double about = signal[before.end > before.first ? before.first : after.first];
  double sum = about;
  Eigen::Index k = 0;
  for (const RowRange& range : {before, after}) {
    for (std::size_t i = range.first; i < range.end; ++i) sum += weights(k++) * (signal[i] - about);
  }
  return sum;
}

RowWeights weights_around(std::span<const double> places, double at, SignalBand band, RowRange without) {
  const auto next = static_cast<std::size_t>(std::ranges::lower_bound(places, at) - places.begin());
  RowWeights result;
  const bool leaves_out = without.end > without.first;
  const std::size_t left = leaves_out ? without.first : next;
  const std::size_t right = leaves_out ? without.end : next;
  std::size_t before = std::min(left, rows_aside);
  std::size_t after = std::min(places.size() - right, rows_aside);
  before = std::min(left, 2 * rows_aside - after);
  after = std::min(places.size() - right, 2 * rows_aside - before);
  result.before = {left - before, left};
  result.after = {right, right + after};
  std::array<double, 2 * rows_aside> around{};
  std::size_t rows = 0;
  for (const RowRange& range : {result.before, result.after}) {
    for (std::size_t i = range.first; i < range.end; ++i) around[rows++] = places[i];
  }
  const auto count = static_cast<Eigen::Index>(rows);
  constexpr int most = 2 * static_cast<int>(rows_aside);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most> between(count, count);
  Eigen::Matrix<double, Eigen::Dynamic, 2, 0, most, 2> right_sides(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double place = around[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j <= i; ++j) {
      between(i, j) = covariance(band.width * (place - around[static_cast<std::size_t>(j)]));
    }
    between(i, i) += band.noise;
    right_sides(i, 0) = covariance(band.width * (place - at));
    right_sides(i, 1) = 1.0;
  }
  const Eigen::Matrix<double, Eigen::Dynamic, 2, 0, most, 2> solved =
      between.selfadjointView<Eigen::Lower>().ldlt().solve(right_sides);
  const double lacking = (1.0 - solved.col(0).sum()) / solved.col(1).sum();
  result.weights = solved.col(0) + lacking * solved.col(1);
  return result;
}

}  // namespace zwidth::internal
