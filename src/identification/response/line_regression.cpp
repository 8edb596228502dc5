#include "identification/response/line_regression.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "linear_systems.hpp"
#include "signal/fourier.hpp"

namespace zwidth::internal {
Eigen::VectorXd line_weights(const Eigen::VectorXcd& rest, std::span<const Eigen::Index> stretches) {
  constexpr Eigen::Index reach = 12;
  const double least = 1e-12 * rest.squaredNorm() / static_cast<double>(rest.size());
  Eigen::VectorXd weights(rest.size());
  Eigen::Index first = 0;
  for (const Eigen::Index size : stretches) {
    const Eigen::Index end = first + size;
    for (Eigen::Index i = first; i < end; ++i) {
      const Eigen::Index begin = std::max(first, i - reach);
      const Eigen::Index count = std::min(end, i + reach + 1) - begin;
      weights(i) = 1.0 / std::sqrt(rest.segment(begin, count).squaredNorm() / static_cast<double>(count) + least);
    }
    first = end;
  }
  return weights;
}

LineBand band_with_harmonics(double lowest, double highest, std::size_t samples, double sampling_period) {
  const double step = 2.0 * std::numbers::pi / (sampling_period * static_cast<double>(samples));
  return {std::max<std::size_t>(2, static_cast<std::size_t>(lowest / step)),
          std::min(samples / 2, static_cast<std::size_t>(std::ceil(2.0 * highest / step)) + 1)};
}

Eigen::VectorXcd lines_of(std::span<const double> signal, LineBand band) {
  std::vector<double> windowed(signal.size());
  const double turn = 2.0 * std::numbers::pi / static_cast<double>(signal.size());
  for (std::size_t k = 0; k < signal.size(); ++k) {
    windowed[k] = signal[k] * 0.5 * (1.0 - std::cos(turn * static_cast<double>(k)));
  }
  const auto all = spectrum(windowed);
  Eigen::VectorXcd lines(static_cast<Eigen::Index>(band.size()));
  for (std::size_t i = 0; i < band.size(); ++i) lines(static_cast<Eigen::Index>(i)) = all[band.first + i];
  return lines;
}

std::optional<LineRegression> regress_lines(const Eigen::MatrixXcd& columns, const Eigen::VectorXcd& target,
                                            std::span<const Eigen::Index> stretches) {
  const Eigen::Index n = target.size();
  Eigen::MatrixXd left(2 * n, columns.cols());
  Eigen::VectorXd right(2 * n);
  Eigen::VectorXcd rest = target;
  LineRegression found;
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    const Eigen::VectorXd weights = line_weights(rest, stretches);
    left << (weights.asDiagonal() * columns.real()), (weights.asDiagonal() * columns.imag());
    right << weights.cwiseProduct(target.real()), weights.cwiseProduct(target.imag());
    const Eigen::VectorXd scale = left.colwise().norm().cwiseMax(1e-300).cwiseInverse();
    left = left * scale.asDiagonal();
    const auto [solution, deviations] = shortest_least_squares(left, right);
    found.values = scale.cwiseProduct(solution);
    const double left_over = (right - left * solution).squaredNorm();
    const double freedom = std::max(1.0, static_cast<double>(2 * n - columns.cols()));
    // A Hann window makes neighbouring lines share: 1.94 times the variance of independent ones.
    constexpr double shared = 1.94;
    found.deviations = scale.cwiseProduct(deviations) * std::sqrt(shared * left_over / freedom);
    if (!found.values.allFinite() || !found.deviations.allFinite()) return std::nullopt;
    rest = target - columns * found.values;
  }
  return found;
}

std::optional<LineRegression> regress_lines(const Eigen::MatrixXcd& known, const Eigen::MatrixXcd& further,
                                            const Eigen::VectorXcd& target, std::span<const Eigen::Index> stretches) {
  Eigen::MatrixXcd columns(known.rows(), known.cols() + further.cols());
  columns << known, further;
  return regress_lines(columns, target, stretches);
}

}  // namespace zwidth::internal
