#include "identification/crossover/phase_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

/// 95 % radius of a two-dimensional normal error over the standard deviation of one component.
const double radius_per_sigma = std::sqrt(-2.0 * std::log(0.05));
/// Beyond this share of the magnitude the 95 % radius leaves the phase open by more than 30 degrees.
constexpr double most_relative_radius = 0.5;
/// Single lines count no more than this, so that a run is judged by its own lines and not by a strong one beside it.
constexpr double most_evidence = 8.0;

bool is_nyquist(const FrequencyResponse& response, const ResponsePoint& point) {
  constexpr double rounding = 1e-9;
  return response.sampling_period && point.frequency * *response.sampling_period > std::numbers::pi * (1.0 - rounding);
}

/// Weights with which four frequencies interpolate a cubic at `at`.
std::array<double, 4> cubic_weights(const std::array<double, 4>& nodes, double at) {
  std::array<double, 4> weights{};
  for (std::size_t i = 0; i < 4; ++i) {
    weights[i] = 1.0;
    for (std::size_t j = 0; j < 4; ++j) {
      if (j != i) weights[i] *= (at - nodes[j]) / (nodes[i] - nodes[j]);
    }
  }
  return weights;
}

/// What lines are compared with their neighbours by. The logarithm of a response bends beside its resonances, where its inverse is
/// smooth.
using Compared = Complex (*)(Complex ratio);

/// Square of how far line i stands off the cubic through its four neighbours, relative to its magnitude, per component
/// and as it would be for independent errors. Nothing at the ends.
std::optional<double> squared_step(std::span<const ResponsePoint> points, std::size_t i, Compared compared) {
  if (i < 2 || i + 2 >= points.size()) return std::nullopt;
  const std::array<std::size_t, 4> neighbours{i - 2, i - 1, i + 1, i + 2};
  std::array<double, 4> nodes{};
  for (std::size_t j = 0; j < 4; ++j) nodes[j] = points[neighbours[j]].frequency;
  const auto weights = cubic_weights(nodes, points[i].frequency);
  Complex step;
  double gain = 1.0;
  for (std::size_t j = 0; j < 4; ++j) {
    const Complex ratio = points[neighbours[j]].value / points[i].value;
    if (ratio == 0.0 || !std::isfinite(std::abs(ratio))) return std::nullopt;
    step += weights[j] * compared(ratio);
    gain += weights[j] * weights[j];
  }
  return 0.5 * std::norm(step) / gain;
}

/// The median of the known ones among steps [first, last]; nothing where they are few.
std::optional<double> median_step(std::span<const std::optional<double>> steps) {
  constexpr std::size_t fewest = 4;
  std::vector<double> known;
  for (const auto& step : steps) {
    if (step) known.push_back(*step);
  }
  if (known.size() < fewest) return std::nullopt;
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  return *middle;
}

/// Relative standard deviation per component by the scatter among neighbours: the median over seven lines to one side,
/// the calmer one, since the other may hold a resonance, where a response bends more sharply than a cubic.
std::vector<double> neighbour_scatter(std::span<const ResponsePoint> points, Compared compared) {
  constexpr std::size_t reach = 6;
  constexpr double lesser_of_two = 1.15;  // as much lower the calmer one of two equal sides is by chance
  std::vector<std::optional<double>> steps(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) steps[i] = squared_step(points, i, compared);
  const std::span<const std::optional<double>> all(steps);
  std::vector<double> scatter(points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto below = median_step(all.subspan(i - std::min(i, reach), std::min(i, reach) + 1));
    const auto above = median_step(all.subspan(i, std::min(reach + 1, points.size() - i)));
    // The median of an exponential distribution is ln 2 times its mean.
    constexpr double none = std::numeric_limits<double>::infinity();
    const double calmer = std::min(below.value_or(none), above.value_or(none));
    if (calmer < none) scatter[i] = lesser_of_two * std::sqrt(calmer / std::numbers::ln2);
  }
  return scatter;
}

/// The scatter of its logarithm and of its inverse among its neighbours.
struct Scatter {
  double of_logarithm = 0.0;
  double of_inverse = 0.0;
};

PhaseLine phase_line(const ResponsePoint& point, double averages, const Scatter& scatter) {
  PhaseLine line;
  line.frequency = point.frequency;
  line.value = point.value;
  line.deviation = std::arg(-point.value);
  const double magnitude = std::abs(point.value);
  const double radius = confidence_radius(point, averages);
  // Where the noise is not known, the neighbours tell; where not even they do, nothing is.
  const bool unknown = !std::isfinite(radius);
  const auto sigma_with = [&](double relative) {
    if (averages > 0.0 && unknown) return std::numeric_limits<double>::infinity();
    return std::max(unknown ? 0.0 : radius / radius_per_sigma, relative * magnitude);
  };
  line.sigma = sigma_with(scatter.of_logarithm);
  // Where the logarithm bends beside a resonance, the inverse tells whether the line is one of a curve.
  const double least = sigma_with(std::min(scatter.of_logarithm, scatter.of_inverse));
  line.measured = magnitude > 0.0 && radius_per_sigma * least < most_relative_radius * magnitude;
  if (line.measured) {
    const double imaginary = -point.value.imag();
    line.evidence = line.sigma > 0.0 ? std::clamp(imaginary / line.sigma, -most_evidence, most_evidence)
                                     : std::copysign(imaginary == 0.0 ? 0.0 : most_evidence, imaginary);
  }
  return line;
}

}  // namespace

std::vector<PhaseLine> phase_lines(const FrequencyResponse& response) {
  std::vector<ResponsePoint> points = response.points;
  std::erase_if(points, [&](const ResponsePoint& point) { return is_nyquist(response, point); });
  const std::vector<double> of_logarithm = neighbour_scatter(points, [](Complex ratio) { return std::log(ratio); });
  const std::vector<double> of_inverse = neighbour_scatter(points, [](Complex ratio) { return 1.0 / ratio - 1.0; });
  std::vector<PhaseLine> lines;
  for (std::size_t i = 0; i < points.size(); ++i) {
    lines.push_back(phase_line(points[i], response.averages, {of_logarithm[i], of_inverse[i]}));
  }
  return lines;
}

std::optional<ResponsePoint> nyquist_point(const FrequencyResponse& response) {
  if (response.points.empty() || !is_nyquist(response, response.points.back())) return std::nullopt;
  return response.points.back();
}

}  // namespace zwidth::internal
