#include "zwidth/stability/force_per_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth {
namespace {

constexpr double time_constants = 40.0;
constexpr double fewest_samples = 64.0;
constexpr double most_samples = 1e6;

/// A section running in the states w, delta w of
///
///     delta^degree w + ... + d[0] w = input,  output = n[0] w + n[1] delta w + ...
class RunningSection {
 public:
  explicit RunningSection(const FilterSection& section) : section_(section), numerator_(whole_numerator(section)) {}

  double step(double input) {
    std::array<double, 3> w{states_[0], states_[1], 0.0};
    double highest = input;
    for (std::size_t i = 0; i < section_.degree; ++i) highest -= section_.denominator[i] * w[i];
    w[section_.degree] = highest;
    double output = 0.0;
    for (std::size_t i = 0; i <= section_.degree; ++i) output += numerator_[i] * w[i];
    for (std::size_t i = 0; i < section_.degree; ++i) states_[i] += w[i + 1];
    return output;
  }

  /// |z| of its slowest pole.
  [[nodiscard]] double radius() const {
    if (section_.degree == 1) return std::abs(1.0 - section_.denominator[0]);
    const std::complex<double> half = -0.5 * section_.denominator[1];
    const std::complex<double> root = std::sqrt(half * half - section_.denominator[0]);
    return std::max(std::abs(1.0 + half + root), std::abs(1.0 + half - root));
  }

 private:
  FilterSection section_;
  std::array<double, 3> numerator_;
  std::array<double, 2> states_{};
};

/// max |y| of F(z) (spring + damper a^k), k = 0, 1, ...
double largest_after_step(const Wall& wall, double period, double spring, double damper) {
  if (wall.filters.empty()) return spring + damper;
  std::vector<RunningSection> sections;
  const double pole = velocity_filter_pole(wall.velocity_filter_hz, period);
  double slowest = pole;
  for (const WallFilter& filter : wall.filters) {
    sections.emplace_back(filter_section(filter, period));
    slowest = std::max(slowest, sections.back().radius());
  }
  const double samples = slowest > 0.0 ? -time_constants / std::log(slowest) : 0.0;
  const auto count = static_cast<std::size_t>(std::clamp(samples, fewest_samples, most_samples));
  double largest = 0.0;
  for (std::size_t k = 0; k < count; ++k, damper *= pole) {
    double force = spring + damper;
    for (RunningSection& section : sections) force = section.step(force);
    largest = std::max(largest, std::abs(force));
  }
  return largest;
}

}  // namespace

ForcePerCount force_per_count(const Wall& wall, double period, double resolution) {
  if (!(period > 0.0) || !(resolution >= 0.0)) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::force_per_count_undefined});
  }
  ForcePerCount force;
  force.stiffness = wall.stiffness.value_or(0.0) * resolution;
  force.damping = wall.damping * (1.0 - velocity_filter_pole(wall.velocity_filter_hz, period)) * resolution / period;
  force.largest = largest_after_step(wall, period, force.stiffness, force.damping);
  return force;
}

std::optional<ForcePerCount> force_per_count(const Device& device) {
  const DeviceParameters& parameters = device.parameters();
  if (!(parameters.sensor.resolution > 0.0) || !parameters.wall.stiffness) return std::nullopt;
  // A damper in a loop of its own takes its difference over its own period, and no filters stand beside it.
  const double period = damper_timing(parameters.loop).sampling_period;
  return force_per_count(parameters.wall, period, parameters.sensor.resolution);
}

ForcePerCountRates force_per_count_rates(const Wall& wall, double period, double resolution) {
  Wall spring = wall;
  spring.stiffness = 1.0;
  spring.damping = 0.0;
  Wall damper = wall;
  damper.stiffness = 0.0;
  damper.damping = 1.0;
  return {force_per_count(spring, period, resolution).largest, force_per_count(damper, period, resolution).largest};
}

}  // namespace zwidth
