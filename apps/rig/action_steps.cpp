#include "rig/action_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "zwidth/model/damper_timing.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/rig/wall_verdict.hpp"

namespace zwidth::rig {
namespace {

constexpr double fallback_hz = 10.0;                               // where theory has no frequency
constexpr std::array nudge_shares{0.0625, 0.125, 0.25, 0.5, 1.0};  // of the force that an action may take

/// The device with the damper that its drive closes as one of its own, N s/m or N m s/rad.
Device damped_by_drive(const Device& device, double damping) {
  if (!device.has_bodies() || !has_damper_loop(device.loop())) return device;
  DeviceParameters parameters = device.parameters();
  parameters.loop.damper.reset();
  parameters.wall.damping = 0.0;
  parameters.bodies[parameters.loop.actuated].damping += damping;
  return Device(std::move(parameters));
}

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

SessionStart nudged(RigRun& run, const Device& device, const Driver& driver, const RigOptions& options,
                    const NudgeRequest& request) {
  SessionStart start{device};
  const Device moved = damped_by_drive(device, request.damping);
  if (driver.facts().is_simulated || !options.nudge) return start;
  const double by_default = default_force(device, options.limits.force);
  const double most = std::min(by_default, request.most_force.value_or(by_default));
  Segment ramped;  // a nudge whose force still grows would not come back
  ramped.cycles = cycles_of(options.limits.ramp, device);
  (void)run.play(ramped);
  for (const double share : nudge_shares) {
    Segment segment;
    segment.force = nudge_force(moved, share * most);
    segment.cycles = segment.force.size();
    const Played played = run.play(segment);
    if (run.is_stopped()) return start;
    start.nudge = read_nudge(moved, played.force, played.position);
    if (start.nudge->reading != NudgeReading::not_told) break;
  }
  if (start.nudge->reading == NudgeReading::with_force) return start;
  if (start.nudge->reading == NudgeReading::not_told) {
    if (request.need == SignNeed::for_wall) run.stop(StopReason::unknown_sign);
    return start;
  }
  if (driver.facts().byte_rate) {  // a drive on a serial line, whose signs are the file's, stated or not
    start.nudge->mending_force_sign = -device.parameters().driver.value_or(MotorDrive{}).force_sign;
  }
  run.stop(StopReason::wrong_sign);
  return start;
}

RigSession ended(RigRun& run, const SessionStart& start, const RigOptions& options, StopReason otherwise) {
  RigSession session = run.end();
  session.motion = start.device.parameters().motion;
  session.nudge = start.nudge;
  remark(session, start.device);
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
