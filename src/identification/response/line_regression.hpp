#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace zwidth::internal {

/// Neighbouring lines of a spectrum, `first` up to before `last`.
struct LineBand {
  std::size_t first = 0;
  std::size_t last = 0;
  [[nodiscard]] std::size_t size() const { return last > first ? last - first : 0; }
};

/// From the excited frequencies `lowest` to twice `highest`, rad/s, of so many samples a `sampling_period` apart; without
/// the two lines that a Hann window fills from a constant.
[[nodiscard]] LineBand band_with_harmonics(double lowest, double highest, std::size_t samples, double sampling_period);

/// Those of a signal under a Hann window.
[[nodiscard]] Eigen::VectorXcd lines_of(std::span<const double> signal, LineBand band);

/// 1 / rms of the rest around each line.
[[nodiscard]] Eigen::VectorXd line_weights(const Eigen::VectorXcd& rest, std::span<const Eigen::Index> stretches);

/// target = columns values + rest, of real values.
struct LineRegression {
  Eigen::VectorXd values;
  Eigen::VectorXd deviations;  ///< one standard deviation each
};

/// Least squares, each line weighted by the rest around it, three times. `stretches`: how many rows each spectrum has.
/// Where columns are not told apart, the shortest values. Nothing where they are not finite.
[[nodiscard]] std::optional<LineRegression> regress_lines(const Eigen::MatrixXcd& columns,
                                                          const Eigen::VectorXcd& target,
                                                          std::span<const Eigen::Index> stretches);

/// The same of known columns and further ones behind them.
[[nodiscard]] std::optional<LineRegression> regress_lines(const Eigen::MatrixXcd& known,
                                                          const Eigen::MatrixXcd& further,
                                                          const Eigen::VectorXcd& target,
                                                          std::span<const Eigen::Index> stretches);

}  // namespace zwidth::internal
