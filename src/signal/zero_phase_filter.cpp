#include "signal/zero_phase_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

/// b (1 + 2 z^-1 + z^-2) / (1 + a1 z^-1 + a2 z^-2), of gain 1 at rest, in transposed direct form II.
struct Section {
  double b = 0.0;
  double a1 = 0.0;
  double a2 = 0.0;
  double s1 = 0.0;
  double s2 = 0.0;

  /// The state in which a constant `input` has always been there.
  void settle(double input) {
    s2 = (b - a2) * input;
    s1 = (2.0 * b - a1) * input + s2;
  }

  double step(double input) {
    const double output = b * input + s1;
    s1 = 2.0 * b * input - a1 * output + s2;
    s2 = b * input - a2 * output;
    return output;
  }
};

/// s^2 + 2 cos(angle) s + 1 for the pole pairs at pi/8 and 3 pi/8, by the bilinear transform prewarped at the cutoff.
std::array<Section, 2> butterworth(double cutoff) {
  const double warped = std::tan(std::numbers::pi * cutoff);
  std::array<Section, 2> sections;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const double angle = std::numbers::pi / 8.0 * static_cast<double>(2 * i + 1);
    const double damping = 2.0 * std::cos(angle) * warped;
    const double leading = 1.0 + damping + warped * warped;
    sections[i].b = warped * warped / leading;
    sections[i].a1 = 2.0 * (warped * warped - 1.0) / leading;
    sections[i].a2 = (1.0 - damping + warped * warped) / leading;
  }
  return sections;
}

void run(std::array<Section, 2> sections, std::vector<double>& signal) {
  for (Section& section : sections) section.settle(signal.front());
  for (double& sample : signal) {
    for (Section& section : sections) sample = section.step(sample);
  }
}

}  // namespace

std::vector<double> zero_phase_low_pass(std::span<const double> signal, double cutoff) {
  if (!(cutoff > 0.0 && cutoff < 0.5)) {
    throw Error(ErrorCode::invalid_argument,
                {.code = ProblemCode::cutoff_not_possible, .evidence = {{"value", cutoff}}});
  }
  if (signal.empty()) return {};
  constexpr double reflected_periods = 6.0;
  const auto margin =
      static_cast<std::size_t>(std::min(static_cast<double>(signal.size() - 1), std::ceil(reflected_periods / cutoff)));
  std::vector<double> extended;
  extended.reserve(signal.size() + 2 * margin);
  for (std::size_t i = margin; i > 0; --i) extended.push_back(2.0 * signal.front() - signal[i]);
  extended.insert(extended.end(), signal.begin(), signal.end());
  for (std::size_t i = 1; i <= margin; ++i) extended.push_back(2.0 * signal.back() - signal[signal.size() - 1 - i]);

  const std::array<Section, 2> sections = butterworth(cutoff);
  run(sections, extended);
  std::reverse(extended.begin(), extended.end());
  run(sections, extended);
  std::reverse(extended.begin(), extended.end());
  const auto first = extended.begin() + static_cast<std::ptrdiff_t>(margin);
  return {first, first + static_cast<std::ptrdiff_t>(signal.size())};
}

}  // namespace zwidth::internal
