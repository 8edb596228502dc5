#include "identification/response/line_response.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "counted.hpp"
#include "identification/response/line_scatter.hpp"
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
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::lines_too_close_for_record,
                                              .evidence = {{"duration", static_cast<double>(samples) * sampling_period},
                                                           {"least", 2.0 * needed * sampling_period}}});
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

namespace {

double energy_of(std::span<const double> signal) {
  const auto n = static_cast<double>(signal.size());
  const double mean = std::accumulate(signal.begin(), signal.end(), 0.0) / n;
  return std::accumulate(signal.begin(), signal.end(), 0.0,
                         [&](double sum, double s) { return sum + (s - mean) * (s - mean); });
}

Complex amplitude_of(const FittedSine& sine) { return {sine.cosine, -sine.sine}; }

/// A sine of a few periods, in one piece. What its neighbours, half a period of the record and more away, have in what is
/// left of the motion is its noise: free motion that dies out, drift, rounding.
FrequencyResponse short_sine_response(std::span<const double> force, std::span<const double> output,
                                      double sampling_period, double angle) {
  const FittedSine of_force = fit_sine(force, angle);
  const FittedSine of_output = fit_sine(output, angle);
  const Complex f = amplitude_of(of_force);
  const Complex h = amplitude_of(of_output) / f;
  std::vector<double> rest = without(of_output, output);
  const std::vector<double> rest_of_force = without(of_force, force);
  const double step = turn / static_cast<double>(force.size());
  double noise = 0.0;
  double count = 0.0;
  for (const double away : {-2.0, -1.5, -1.0, -0.5, 0.5, 1.0, 1.5, 2.0}) {
    const double other = angle + away * step;
    if (!(other > 0.5 * step && other < std::numbers::pi)) continue;
    noise += std::norm(amplitude_of(fit_sine(rest, other)) - h * amplitude_of(fit_sine(rest_of_force, other)));
    count += 1.0;
  }
  constexpr double independent = 0.5;  // of neighbours half a line apart
  FrequencyResponse response;
  response.sampling_period = sampling_period;
  response.averages = 1.0 + std::max(1.0, std::floor(independent * count));
  ResponsePoint point;
  point.frequency = angle / sampling_period;
  point.value = h;
  point.variance = noise / (count * std::norm(f));
  point.coherence = std::norm(h) / (std::norm(h) + point.variance);
  point.force = std::abs(f);
  response.points.push_back(point);
  response.remarks.push_back(note({.code = FindingCode::sine_fitted_in_one_piece,
                                   .evidence = {{"frequency", point.frequency / turn},
                                                {"periods", angle * static_cast<double>(force.size()) / turn}}}));
  return response;
}

/// Whether two blocks of one sine do not fit.
bool is_short_for(double angle, std::size_t samples) {
  return 2.0 * std::max(std::ceil(least_beats * turn / std::min(angle, 2.0 * (std::numbers::pi - angle))), 6.0) >
         static_cast<double>(samples);
}

/// Of the lines asked for, the one that a force of a single sine holds; all of any other.
std::vector<double> lines_in(std::span<const double> force, const std::vector<double>& angles) {
  if (angles.size() < 2) return angles;
  const auto tone = only_tone(force);
  if (!tone) return angles;
  const double nearest = *std::ranges::min_element(angles, {}, [&](double each) { return std::abs(each - *tone); });
  const double resolved = 0.25 * turn / static_cast<double>(force.size());
  if (std::abs(nearest - *tone) > std::max(resolved, 1e-3 * *tone)) return angles;
  return {nearest};
}

/// A sine of one period to eight, which is all but nothing of the force: too slow for its power to stand out.
std::optional<double> short_tone(std::span<const double> force) {
  constexpr double nothing_is_left = 1e-3;
  constexpr double most_periods = 9.0;
  constexpr double periods_apart = 0.1;
  constexpr std::size_t fewest = 16;
  constexpr std::size_t enough = 300;  // samples for the search: the sine is slow
  constexpr int bits = 40;
  if (force.size() < fewest) return std::nullopt;
  const std::size_t thinning = (force.size() + enough - 1) / enough;
  std::vector<double> used;
  for (std::size_t i = 0; i < force.size(); i += thinning) used.push_back(force[i]);
  const auto n = static_cast<double>(used.size());
  const auto left = [&](double periods) { return energy_of(without(fit_sine(used, turn * periods / n), used)); };
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (double periods = 1.0 - periods_apart; periods <= most_periods && periods < 0.25 * n; periods += periods_apart) {
    const double energy = left(periods);
    if (energy < least) std::tie(least, best) = std::pair(energy, periods);
  }
  std::uintmax_t steps = 60;
  const auto [periods, energy] =
      boost::math::tools::brent_find_minima(left, best - periods_apart, best + periods_apart, bits, steps);
  constexpr double rounding = 0.01;
  if (periods < 1.0 - rounding || !(energy < nothing_is_left * energy_of(used))) return std::nullopt;
  const double angle = turn * periods / (n * static_cast<double>(thinning));
  // The samples between tell as well.
  return energy_of(without(fit_sine(force, angle), force)) < nothing_is_left * energy_of(force) ? std::optional(angle)
                                                                                                : std::nullopt;
}

}  // namespace

FrequencyResponse line_response(std::span<const double> force, std::span<const double> output, double sampling_period,
                                const std::vector<double>& asked, const FrequencyResponseOptions& options,
                                const Progress& progress) {
  const std::vector<double> angles = lines_in(force, asked);
  if (angles.size() == 1 && is_short_for(angles[0], force.size())) {
    return short_sine_response(force, output, sampling_period, angles[0]);
  }
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
  Finding fitted{.code = FindingCode::lines_fitted_in_blocks,
                 .evidence = {counted("lines", angles.size()),
                              counted("blocks", count),
                              {"duration", static_cast<double>(length) * sampling_period}}};
  if (angles.size() == 1) fitted.evidence.push_back({"frequency", angles[0] / (turn * sampling_period)});
  if (skipped > 0) fitted.evidence.push_back(counted("skipped", skipped));
  response.remarks.push_back(note(std::move(fitted)));
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
  if (!found || found->share < least_share) return short_tone(force);
  const std::span<const double> used = force.last(std::min(force.size(), most_samples));
  const auto left = [&](double angle) { return without(fit_sine(used, angle), used); };
  std::uintmax_t steps = most_steps;
  const double nearest = std::max(found->frequency - found->resolution, 0.5 * found->frequency);
  const double angle = boost::math::tools::brent_find_minima([&](double each) { return energy_of(left(each)); },
                                                             nearest, found->frequency + found->resolution, bits, steps)
                           .first;
  if (angle >= std::numbers::pi) return std::nullopt;
  const std::vector<double> rest = left(angle);
  if (energy_of(rest) < nothing_is_left * energy_of(used)) return angle;
  const auto next = dominant_oscillation(rest, 1.0);
  return !next || next->share < another_line ? std::optional(angle) : std::nullopt;
}

}  // namespace zwidth::internal
