#include "identification/response/local_polynomial.hpp"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "identification/response/encoder_rounding.hpp"
#include "signal/fourier.hpp"

namespace zwidth::internal {
namespace {

using Lines = std::vector<std::complex<double>>;

constexpr Eigen::Index terms = 3;             // of a parabola
constexpr Eigen::Index unknowns = 2 * terms;  // of a window

/// Less the line through its ends, which leaks into all lines.
Lines levelled_spectrum(std::span<const double> signal) {
  std::vector<double> level(signal.begin(), signal.end());
  const double slope = (level.back() - level.front()) / static_cast<double>(level.size() - 1);
  for (std::size_t k = 0; k < level.size(); ++k) level[k] -= signal.front() + slope * static_cast<double>(k);
  return spectrum(level);
}

double power_of_falling(OutputQuantity output) {
  switch (output) {
    case OutputQuantity::velocity:
      return 1.0;
    case OutputQuantity::acceleration:
      return 0.0;
    case OutputQuantity::position:
      break;
  }
  return 2.0;
}

/// The lines of a record around one of them.
struct LocalWindow {
  std::size_t first = 0;
  std::size_t count = 0;
  double middle = 0.0;  ///< lines
};

class WholeRecord {
 public:
  WholeRecord(std::span<const double> force, std::span<const double> output, double falling)
      : force_(levelled_spectrum(force)), output_(levelled_spectrum(output)), falling_(falling) {}

  [[nodiscard]] std::size_t lines() const { return force_.size(); }

  /// Of the force, over a window's lines.
  [[nodiscard]] double mean_power(const LocalWindow& window) const {
    double sum = 0.0;
    for (std::size_t k = window.first; k < window.first + window.count; ++k) sum += std::norm(force_[k]);
    return sum / static_cast<double>(window.count);
  }

  /// Value, variance and coherence at a window's middle.
  [[nodiscard]] std::optional<ResponsePoint> estimated(const LocalWindow& window) const {
    const auto count = static_cast<Eigen::Index>(window.count);
    Eigen::MatrixXcd basis(count, unknowns);
    Eigen::VectorXcd motion(count);
    const double reach = 0.5 * static_cast<double>(window.count - 1);
    const double force = std::sqrt(mean_power(window));
    for (Eigen::Index i = 0; i < count; ++i) {
      const std::size_t k = window.first + static_cast<std::size_t>(i);
      const double x = (static_cast<double>(k) - window.middle) / reach;
      const double fall = std::pow(window.middle / static_cast<double>(k), falling_);
      const std::complex<double> driven = fall * force_[k] / force;
      basis.row(i) << driven, x * driven, x * x * driven, fall, x * fall, x * x * fall;
      motion(i) = output_[k];
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXcd> solver(basis);
    if (solver.rank() < unknowns) return std::nullopt;
    const Eigen::VectorXcd found = solver.solve(motion);
    const double rest = (motion - basis * found).squaredNorm() / static_cast<double>(count - unknowns);
    // (B^H B)^-1 of the value, by the triangle R of B P = Q R.
    Eigen::VectorXcd unit = Eigen::VectorXcd::Zero(unknowns);
    unit(0) = 1.0;
    const Eigen::VectorXcd permuted = solver.colsPermutation().transpose() * unit;
    const Eigen::VectorXcd column =
        solver.matrixR().topLeftCorner(unknowns, unknowns).triangularView<Eigen::Upper>().adjoint().solve(permuted);
    ResponsePoint point;
    point.value = found(0) / force;
    point.variance = rest * column.squaredNorm() / (force * force);
    const double driven = std::norm(found(0));
    point.coherence = driven > 0.0 ? driven / (driven + rest) : 0.0;
    if (point.value == 0.0 || !std::isfinite(std::abs(point.value)) || !std::isfinite(point.variance))
      return std::nullopt;
    return point;
  }

 private:
  Lines force_;
  Lines output_;
  double falling_;
};

}  // namespace

FrequencyResponse local_polynomial_response(std::span<const double> force, std::span<const double> output,
                                            double sampling_period, double spacing,
                                            const FrequencyResponseOptions& options) {
  // The share of the strongest window's power below which the force excites nothing (-50 dB).
  constexpr double excited_power_share = 1e-5;
  constexpr double least_middle = 4.0;  // half widths: lower, a rigid body's own pole bends a window
  const WholeRecord record(force, output, power_of_falling(options.output));
  const double line = 2.0 * std::numbers::pi / (static_cast<double>(force.size()) * sampling_period);
  const double reach = spacing / line;  // lines
  std::vector<LocalWindow> windows;
  double strongest = 0.0;
  for (double middle = least_middle * reach; middle + reach < static_cast<double>(record.lines()); middle += reach) {
    const auto first = static_cast<std::size_t>(std::ceil(middle - reach - 1e-6));
    const auto last = static_cast<std::size_t>(std::floor(middle + reach + 1e-6));
    windows.push_back({std::max<std::size_t>(first, 1), last + 1 - std::max<std::size_t>(first, 1), middle});
    strongest = std::max(strongest, record.mean_power(windows.back()));
  }
  const SweepRounding rounding =
      options.output == OutputQuantity::position ? SweepRounding(force, output) : SweepRounding({}, {});
  FrequencyResponse response;
  response.sampling_period = sampling_period;
  for (const LocalWindow& window : windows) {
    const double power = record.mean_power(window);
    if (power < excited_power_share * strongest) continue;
    auto point = record.estimated(window);
    if (!point) continue;
    point->frequency = window.middle * line;
    point->variance += rounding.variance(point->value);
    point->force = 2.0 * std::sqrt(power) / static_cast<double>(force.size());
    response.points.push_back(*point);
  }
  response.remarks.push_back(note(
      {.code = FindingCode::lines_of_whole_record, .evidence = {{"spacing", spacing / (2.0 * std::numbers::pi)}}}));
  const double rows = 2.0 * std::floor(reach) + 1.0;
  response.averages = 1.0 + rows - static_cast<double>(unknowns);
  // Windows hold half of their neighbours' lines.
  constexpr double correlation_of_halves = 1.3;
  response.line_correlation = correlation_of_halves;
  return response;
}

}  // namespace zwidth::internal
