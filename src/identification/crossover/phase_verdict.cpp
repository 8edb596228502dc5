#include "identification/crossover/phase_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "identification/crossover/student_t.hpp"

namespace zwidth::internal {
namespace {

/// Beyond this a phase is no matter of noise (a measured line is known within 30 degrees), and not on a smooth curve
/// with what happens at -180 degrees.
constexpr double near = std::numbers::pi / 3.0;
/// Exact data are given the rounding of doubles, so that weights stay finite.
constexpr double least_sigma = 1e-14;

/// The stretch of lines around `index` without far ones.
struct Stretch {
  std::size_t first = 0;
  std::size_t last = 0;
};
Stretch stretch_around(std::span<const PhaseLine> lines, std::size_t index) {
  Stretch stretch{index, index};
  while (stretch.first > 0 && !is_far(lines[stretch.first - 1])) --stretch.first;
  while (stretch.last + 1 < lines.size() && !is_far(lines[stretch.last + 1])) ++stretch.last;
  return stretch;
}

double relative_sigma(const PhaseLine& line) {
  return line.measured ? std::max(line.sigma / std::abs(line.value), least_sigma) : 1.0;
}

}  // namespace

bool is_far(const PhaseLine& line) { return line.measured && std::abs(line.deviation) >= near; }

CurveSample phase_sample(const PhaseLine& line) {
  return {std::log(line.frequency), line.deviation, relative_sigma(line), line.measured};
}

std::vector<PhaseVerdict> phase_verdicts(std::span<const PhaseLine> lines, double line_correlation) {
  std::vector<CurveSample> phases;
  std::vector<CurveSample> magnitudes;
  for (const PhaseLine& line : lines) {
    phases.push_back(phase_sample(line));
    magnitudes.push_back(
        {line.frequency, line.measured ? std::log(std::abs(line.value)) : 0.0, relative_sigma(line), line.measured});
  }
  std::vector<PhaseVerdict> verdicts(lines.size());
  Stretch stretch{1, 0};  // none yet
  for (std::size_t i = 0; i < lines.size(); ++i) {
    PhaseVerdict& verdict = verdicts[i];
    if (!lines[i].measured) continue;
    verdict.deviation = {phases[i].y, phases[i].sigma};
    verdict.log_magnitude = {magnitudes[i].y, magnitudes[i].sigma};
    const int own_sign = lines[i].deviation > 0.0 ? 1 : -1;
    if (is_far(lines[i])) {
      verdict.sign = own_sign;
      continue;
    }
    if (i < stretch.first || i > stretch.last) stretch = stretch_around(lines, i);
    const auto within = [&](const std::vector<CurveSample>& samples) {
      return local_estimate(std::span(samples).subspan(stretch.first, stretch.last - stretch.first + 1),
                            i - stretch.first, line_correlation);
    };
    verdict.deviation = within(phases);
    verdict.log_magnitude = within(magnitudes);
    if (std::abs(verdict.deviation.value) > two_sided_95 * verdict.deviation.sigma) {
      verdict.sign = verdict.deviation.value > 0.0 ? 1 : -1;
    }
  }
  return verdicts;
}

}  // namespace zwidth::internal
