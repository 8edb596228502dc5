#include "identification/line_response.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "identification/line_scatter.hpp"
#include "signal/fitted_sine.hpp"
#include "zwidth/error.hpp"
#include "zwidth/signal/dominant_oscillation.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

constexpr double turn = 2.0 * std::numbers::pi;
/// Blocks hold this many beats of neighbouring lines: enough that each is told from the next.
constexpr double least_beats = 1.5;
constexpr std::size_t most_blocks = 16;

/// The least distance between lines, and from 0 and half the rate.
double least_spacing(const std::vector<double>& angles) {
  double spacing = std::min(angles.front(), 2.0 * (std::numbers::pi - angles.back()));
  for (std::size_t i = 1; i < angles.size(); ++i) spacing = std::min(spacing, angles[i] - angles[i - 1]);
  return spacing;
}

/// Samples of a block. Throws where not even two fit into the record.
std::size_t block_length(std::size_t samples, const std::vector<double>& angles, double sampling_period) {
  const double least = std::ceil(least_beats * turn / least_spacing(angles));
  const double needed = std::max(least, static_cast<double>(2 * angles.size() + 4));
  if (2.0 * needed > static_cast<double>(samples)) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("the record of {:.4g} s is too short to tell the lines apart; at least {:.4g} s, or fewer "
                            "lines",
                            static_cast<double>(samples) * sampling_period, 2.0 * needed * sampling_period));
  }
  return std::max(static_cast<std::size_t>(needed), samples / most_blocks);
}

/// Amplitudes of lines in blocks of one length.
class BlockFit {
 public:
  BlockFit(std::size_t length, const std::vector<double>& angles, bool detrend)
      : angles_(angles), lines_(static_cast<Eigen::Index>(angles.size())) {
    const auto rows = static_cast<Eigen::Index>(length);
    shapes_.resize(rows, 2 * lines_ + (detrend ? 2 : 0));
    const Eigen::ArrayXd k = Eigen::ArrayXd::LinSpaced(rows, 0.0, static_cast<double>(length - 1));
    for (Eigen::Index i = 0; i < lines_; ++i) {
      shapes_.col(2 * i) = (angles[static_cast<std::size_t>(i)] * k).cos();
      shapes_.col(2 * i + 1) = -(angles[static_cast<std::size_t>(i)] * k).sin();
    }
    if (detrend) {
      shapes_.col(2 * lines_).setOnes();
      shapes_.col(2 * lines_ + 1) = 2.0 * k / static_cast<double>(length - 1) - 1.0;
    }
    gram_ = (shapes_.transpose() * shapes_).ldlt();
  }

  /// Z of  s[k] = Re sum Z e^{j angle k}, k counted from the record's begin, of the block that starts at `start`.
  [[nodiscard]] std::vector<Complex> amplitudes(std::span<const double> signal, std::size_t start) const {
    const Eigen::Map<const Eigen::VectorXd> block(signal.data() + start, shapes_.rows());
    const Eigen::VectorXd weights = gram_.solve(shapes_.transpose() * block);
    std::vector<Complex> result;
    for (Eigen::Index i = 0; i < lines_; ++i) {
      const double angle = angles_[static_cast<std::size_t>(i)] * static_cast<double>(start);
      result.push_back(Complex(weights(2 * i), weights(2 * i + 1)) * std::polar(1.0, -angle));
    }
    return result;
  }

 private:
  const std::vector<double>& angles_;
  Eigen::Index lines_;
  Eigen::MatrixXd shapes_;
  Eigen::LDLT<Eigen::MatrixXd> gram_;
};

struct Blocks {
  std::vector<std::vector<Complex>> force;
  std::vector<std::vector<Complex>> output;

  /// Power by which each block but the last differs from it, as a share of the strongest line.
  [[nodiscard]] std::vector<double> distances() const {
    std::vector<double> result;
    const auto between = [](const std::vector<std::vector<Complex>>& all, std::size_t block) {
      double apart = 0.0;
      double size = 0.0;
      for (std::size_t i = 0; i < all[block].size(); ++i) {
        apart += std::norm(all[block][i] - all.back()[i]);
        size += std::norm(all.back()[i]);
      }
      return size > 0.0 ? apart / size : 0.0;
    };
    for (std::size_t b = 0; b + 1 < force.size(); ++b) result.push_back(between(force, b) + between(output, b));
    return result;
  }
};

Blocks fitted_blocks(std::span<const double> force, std::span<const double> output, const BlockFit& fit,
                     std::size_t length, const Progress& progress) {
  Blocks blocks;
  // What does not fill a block is left out at the beginning, where the transient is.
  for (std::size_t start = force.size() % length; start < force.size(); start += length) {
    if (progress) progress(static_cast<double>(start) / static_cast<double>(force.size()));
    blocks.force.push_back(fit.amplitudes(force, start));
    blocks.output.push_back(fit.amplitudes(output, start));
  }
  return blocks;
}

}  // namespace

FrequencyResponse line_response(std::span<const double> force, std::span<const double> output, double sampling_period,
                                const std::vector<double>& angles, const FrequencyResponseOptions& options,
                                const Progress& progress) {
  const std::size_t length = block_length(force.size(), angles, sampling_period);
  const Blocks blocks = fitted_blocks(force, output, BlockFit(length, angles, options.detrend), length, progress);
  const std::size_t skipped = transient_repetitions(blocks.distances());
  const std::size_t count = blocks.force.size() - skipped;
  FrequencyResponse response;
  response.sampling_period = sampling_period;
  response.averages = static_cast<double>(count);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    LineScatter line;
    line.last_force = blocks.force.back()[i];
    line.last_output = blocks.output.back()[i];
    for (std::size_t b = skipped; b + 1 < blocks.force.size(); ++b) {
      line.add(blocks.force[b][i] - line.last_force, blocks.output[b][i] - line.last_output);
    }
    if (mean_force(line, response.averages).value == 0.0) continue;
    response.points.push_back(response_point(line, response.averages, angles[i] / sampling_period));
  }
  response.remarks.push_back(
      {Remark::Severity::note,
       fmt::format("{} fitted in {} blocks of {:.4g} s{}",
                   angles.size() == 1 ? fmt::format("a sine of {:.6g} Hz", angles[0] / (turn * sampling_period))
                                      : fmt::format("{} lines", angles.size()),
                   count, static_cast<double>(length) * sampling_period,
                   skipped > 0 ? fmt::format(", {} before them left out as transient", skipped) : ""),
       ""});
  return response;
}

std::optional<double> only_tone(std::span<const double> force) {
  constexpr double least_share = 0.5;
  constexpr double another_line = 0.3;      // share of what is left
  constexpr double nothing_is_left = 1e-3;  // of the force's power
  constexpr int bits = 40;
  constexpr std::uintmax_t most_steps = 100;
  constexpr std::size_t most_samples = std::size_t{1} << 16U;
  const auto found = dominant_oscillation(force, 1.0);
  if (!found || found->share < least_share) return std::nullopt;
  const std::span<const double> used = force.last(std::min(force.size(), most_samples));
  const auto left = [&](double angle) { return without(fit_sine(used, angle), used); };
  const auto energy = [](const std::vector<double>& signal) {
    const auto n = static_cast<double>(signal.size());
    const double mean = std::accumulate(signal.begin(), signal.end(), 0.0) / n;
    return std::accumulate(signal.begin(), signal.end(), 0.0,
                           [&](double sum, double s) { return sum + (s - mean) * (s - mean); });
  };
  std::uintmax_t steps = most_steps;
  const double nearest = std::max(found->frequency - found->resolution, 0.5 * found->frequency);
  const double angle = boost::math::tools::brent_find_minima([&](double each) { return energy(left(each)); }, nearest,
                                                             found->frequency + found->resolution, bits, steps)
                           .first;
  if (angle >= std::numbers::pi) return std::nullopt;
  const std::vector<double> rest = left(angle);
  if (energy(rest) < nothing_is_left * energy(std::vector<double>(used.begin(), used.end()))) return angle;
  const auto next = dominant_oscillation(rest, 1.0);
  return !next || next->share < another_line ? std::optional(angle) : std::nullopt;
}

}  // namespace zwidth::internal
