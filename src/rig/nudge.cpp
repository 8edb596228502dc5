#include "zwidth/rig/nudge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "zwidth/model/damper_timing.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double nudge_hz = 10.0;         // where theory has no frequency
constexpr std::size_t least_quarter = 2;  // samples
constexpr std::size_t most_quarter = 4096;
constexpr double least_correlation = 0.7;
constexpr double least_motion = 0.01;  // of what the file expects
constexpr double most_left = 0.5;      // of all that it moved
constexpr double least_push = 0.25;    // the same
constexpr double least_steps = 4.0;    // of the encoder

double frequency_of_nudge(const Device& device) {
  const CriticalStiffness predicted = critical_stiffness(device);
  return predicted.limit && predicted.limit->frequency > 0.0 ? predicted.limit->frequency
                                                             : radians_per_second(nudge_hz);
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

double largest_of(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double each : values) largest = std::max(largest, std::abs(each));
  return largest;
}

/// Without the straight line through them.
std::vector<double> without_drift(std::vector<double> values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  double moment = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double time = static_cast<double>(k) - 0.5 * (n - 1.0);
    mean += values[k] / n;
    moment += time * values[k];
    squares += time * time;
  }
  const double slope = squares > 0.0 ? moment / squares : 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] -= mean + slope * (static_cast<double>(k) - 0.5 * (n - 1.0));
  }
  return values;
}

/// The device alone, as its file has it, without what may hold it: no encoder, no dry friction, and one rate.
std::vector<double> expected_motion(const Device& device, std::span<const double> force) {
  DeviceParameters parameters = device.parameters();
  parameters.sensor.resolution = 0.0;
  for (Body& body : parameters.bodies) body.coulomb = 0.0;
  if (has_damper_loop(device.loop())) parameters.loop.damper.reset();
  HybridLoop loop(Device(std::move(parameters)), {});
  std::vector<double> positions;
  positions.reserve(force.size());
  for (const double each : force) {
    positions.push_back(loop.measure());
    loop.move(each);
  }
  return positions;
}

/// Of the encoder, m or rad, where the file has it too small.
double step_of(const Device& device, std::span<const double> position) {
  double step = 0.0;
  for (std::size_t k = 1; k < position.size(); ++k) {
    const double change = std::abs(position[k] - position[k - 1]);
    if (change > 0.0 && (step == 0.0 || change < step)) step = change;
  }
  return std::max(step, device.parameters().sensor.resolution);
}

/// At the end of the pushes it is about where it was, and the first push was a part of what it moved: nothing else did it.
bool comes_back(std::span<const double> position) {
  double largest = 0.0;
  for (const double each : position) largest = std::max(largest, std::abs(each - position[0]));
  return std::abs(position[position.size() / 2] - position[0]) <= most_left * largest &&
         std::abs(position[position.size() / 8] - position[0]) >= least_push * largest;
}

NudgeReading reading_of(double moved) { return moved > 0.0 ? NudgeReading::with_force : NudgeReading::against_force; }

}  // namespace

std::vector<double> nudge_force(const Device& device, double force) {
  const double cycle = 2.0 * std::numbers::pi / (frequency_of_nudge(device) * device.loop().sampling_period);
  const auto quarter =
      std::clamp(static_cast<std::size_t>(std::lround(std::min(0.25 * cycle, 1e6))), least_quarter, most_quarter);
  std::vector<double> samples(8 * quarter, 0.0);
  for (std::size_t k = 0; k < 4 * quarter; ++k) {
    samples[k] = k < quarter || k >= 3 * quarter ? force : -force;
  }
  return samples;
}

Nudge read_nudge(const Device& device, std::span<const double> force, std::span<const double> position) {
  Nudge nudge;
  for (const double each : force) nudge.force = std::max(nudge.force, std::abs(each));
  const std::size_t size = std::min(force.size(), position.size());
  if (size < 8 * least_quarter) return nudge;
  const std::vector<double> expected = without_drift(expected_motion(device, force.first(size)));
  const std::vector<double> moved =
      without_drift({position.begin(), position.begin() + static_cast<std::ptrdiff_t>(size)});
  const double of_expected = product(expected, expected);
  const double of_moved = product(moved, moved);
  if (!(of_expected > 0.0 && of_moved > 0.0)) return nudge;
  const double along = product(expected, moved);
  const double largest = largest_of(expected);
  nudge.moved = along / of_expected * largest;
  const double least = least_steps * step_of(device, position.first(size));
  const double first_push = position[size / 8] - position[0];
  if (!(largest_of(moved) >= least_motion * largest)) return nudge;  // nothing but rounding, or stuck
  if (std::abs(along) >= least_correlation * std::sqrt(of_expected * of_moved)) {
    if (std::abs(nudge.moved) >= least) nudge.reading = reading_of(along);
  } else if (std::abs(first_push) >= least && comes_back(position.first(size))) {
    nudge.moved = first_push;
    nudge.reading = reading_of(first_push);
  }
  return nudge;
}

}  // namespace zwidth
