#include "zwidth/model/damper_timing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "model/one_rate.hpp"
#include "zwidth/error.hpp"

namespace zwidth {

DamperTiming damper_timing(const Loop& loop) {
  if (!loop.damper) return {loop.sampling_period, loop.delay};
  return {loop.damper->sampling_period.value_or(loop.sampling_period), loop.damper->delay.value_or(loop.delay)};
}

bool has_damper_loop(const Loop& loop) {
  const DamperTiming damper = damper_timing(loop);
  return damper.delay != loop.delay || internal::rate_ratio(loop.sampling_period, damper.sampling_period) != 1.0;
}

Device with_one_rate(const Device& device) {
  DeviceParameters parameters = device.parameters();
  parameters.loop.damper.reset();
  return Device(std::move(parameters));
}

Device with_loop_of_damper(const Device& device) {
  DeviceParameters parameters = device.parameters();
  const auto [period, delay] = damper_timing(parameters.loop);
  parameters.loop.sampling_period = period;
  parameters.loop.delay = delay;
  parameters.loop.damper.reset();
  return Device(std::move(parameters));
}

double internal::rate_ratio(double loop_period, double damper_period) {
  if (damper_period >= loop_period) return 1.0 / std::round(damper_period / loop_period);
  const double fewer = std::floor(loop_period / damper_period);
  const double more = fewer + 1.0;
  return damper_period - loop_period / more < loop_period / fewer - damper_period ? more : fewer;
}

void require_one_rate(const Device& device) {
  if (!has_damper_loop(device.loop())) return;
  const DeviceProblem problem = device_problem("loop.damper", {.code = ProblemCode::damper_loop_not_known});
  InputProblem told{{}, problem.what, problem.allowed, {}};
  told.problem = problem.problem;
  told.place.key = problem.key;
  throw Error(ErrorCode::invalid_argument, problem.key + ": " + problem.what + "; " + problem.allowed,
              {std::move(told)});
}

}  // namespace zwidth
