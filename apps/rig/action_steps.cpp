#include "rig/action_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "zwidth/quantity.hpp"

namespace zwidth::rig {
namespace {

constexpr double fallback_hz = 10.0;  // where theory has no frequency

}  // namespace

std::size_t cycles_of(double duration, const Device& device) {
  return static_cast<std::size_t>(std::max(1.0, std::round(duration / device.loop().sampling_period)));
}

double frequency_of(const CriticalStiffness& predicted) {
  return predicted.limit && predicted.limit->frequency > 0.0 ? predicted.limit->frequency
                                                             : radians_per_second(fallback_hz);
}

Recording recording_of(Played played, const Device& device, const Driver& driver) {
  Recording recording;
  recording.source = fmt::format("rig ({})", driver.facts().name);
  recording.sampling_period = device.loop().sampling_period;
  recording.channels.push_back({"force", std::move(played.force)});
  recording.channels.push_back({"position", std::move(played.position)});
  return recording;
}

RigSession ended(RigRun& run, const RigOptions& options, StopReason otherwise) {
  RigSession session = run.end();
  if (options.record) options.record(run.recorder(), session.stop != StopReason::none ? session.stop : otherwise);
  return session;
}

double part(std::size_t done, std::size_t all) { return static_cast<double>(done) / static_cast<double>(all); }

void report(const Progress& progress, double done) {
  if (progress) progress(done);
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace zwidth::rig
