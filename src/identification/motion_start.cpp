#include "identification/motion_start.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "identification/model/device_numbers.hpp"
#include "identification/response/encoder_step.hpp"
#include "model/loop_keys.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

bool holds(const std::vector<std::string>& keys, const char* key) { return std::ranges::count(keys, key) > 0; }

/// A delay that the file gives; where the lag is a number too, that of both (DeviceFamily).
Number given_delay(const DeviceParameters& device, bool frees_lag, double period) {
  return {.key = key_of_delay,
          .unit = period,
          .expected = (device.loop.delay + (frees_lag ? device.actuator.time_constant : 0.0)) / period,
          .prior_deviation = deviation_of_given_delay};
}

}  // namespace

MotionStart motion_start(std::span<const Recording> recordings, const FrequencyResponse& response,
                         const Device& structure, const FreeNumbers& free) {
  MotionStart start{.device = structure.parameters()};
  start.device.uncertainty.reset();
  start.positions.reserve(recordings.size());
  for (const Recording& each : recordings) {
    std::vector<double>& position = start.positions.emplace_back(each.channels[1].samples);
    const double mean = std::accumulate(position.begin(), position.end(), 0.0) / static_cast<double>(position.size());
    for (double& sample : position) sample -= mean;
    start.records.push_back({each.channels[0].samples, position, each.sampling_period});
    start.encoder_steps.push_back(encoder_step(each.channels[1].samples));
  }
  const double period = recordings.front().sampling_period;
  std::vector<std::string> keys = free_parameters(structure, free.keys, free.locked);
  if (free.lateness && !holds(keys, key_of_delay)) keys.emplace_back(key_of_delay);
  constexpr double typical_delay = 0.5;  // sampling periods
  if (free.lateness && start.device.loop.delay == 0.0) start.device.loop.delay = typical_delay * period;
  ParameterFitOptions linear{.free = keys, .locked = free.locked};
  // Few lines tell of few numbers: masses come first, and the motion tells the rest.
  const std::size_t most = std::max<std::size_t>(2, response.points.size()) - 1;
  if (linear.free.size() >= most) std::erase(linear.free, key_of_delay);
  if (linear.free.size() > most) linear.free.resize(most);
  if (free.is_start) linear.start = ParameterFitOptions::Start::from_structure;
  start.device = fit_parameters(Device(start.device), response, linear).device.parameters();
  start.device.uncertainty.reset();

  RivalSetting setting = rival_setting(start.device, free.locked, start.records);
  setting.frees_lag = free.lateness || holds(keys, key_of_lag);
  const TypicalSizes typical{period, typical_damping(setting), typical_stiffness(setting)};
  for (const std::string& key : keys) {
    if (key != key_of_lag) start.parts.numbers.push_back(device_number(key, start.device, typical));
  }
  if (!holds(keys, key_of_delay))
    start.parts.numbers.push_back(given_delay(structure.parameters(), setting.frees_lag, period));
  start.rivals = add_rivals(setting, start.parts);
  if (free.is_known) start.known = structure.parameters();
  return start;
}

}  // namespace zwidth::internal
