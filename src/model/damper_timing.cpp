#include "zwidth/model/damper_timing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/rate_ratio.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
namespace {

constexpr std::string_view of_damper = "loop.damper.";

/// What is uncertain or assumed under the keys that it has now; what new_key() has none for is left out.
template <typename NewKey>
void rename_uncertain(DeviceParameters& parameters, const NewKey& new_key) {
  if (!parameters.uncertainty) return;
  Uncertainty& uncertainty = *parameters.uncertainty;
  Uncertainty kept = uncertainty;
  kept.parameters.clear();
  kept.covariance.clear();
  kept.assumed.clear();
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < uncertainty.parameters.size(); ++i) {
    if (const std::optional<std::string> key = new_key(uncertainty.parameters[i])) {
      kept.parameters.push_back(*key);
      rows.push_back(i);
    }
  }
  for (const std::size_t i : rows) {
    std::vector<double>& row = kept.covariance.emplace_back();
    for (const std::size_t j : rows) row.push_back(uncertainty.covariance[i][j]);
  }
  for (const std::string& each : uncertainty.assumed) {
    if (const std::optional<std::string> key = new_key(each)) kept.assumed.push_back(*key);
  }
  const bool says_anything = !kept.parameters.empty() || !kept.assumed.empty() || !kept.warning.empty() ||
                             !kept.reasons.empty() || kept.verdict != Trust::Verdict::sound;
  uncertainty = std::move(kept);
  if (!says_anything) parameters.uncertainty.reset();
}

/// Where the damper runs in a loop of its own.
void refuse_damper_loop(const Device& device, ProblemCode code) {
  if (has_damper_loop(device.loop())) require_valid(std::optional(device_problem("loop.damper", {.code = code})));
}

}  // namespace

DamperTiming damper_timing(const Loop& loop) {
  if (!loop.damper) return {loop.sampling_period, loop.delay};
  return {loop.damper->sampling_period.value_or(loop.sampling_period), loop.damper->delay.value_or(loop.delay)};
}

bool runs_damper_apart(const DeviceParameters& parameters) {
  return parameters.wall.damping > 0.0 && has_damper_loop(parameters.loop);
}

bool has_damper_loop(const Loop& loop) {
  const DamperTiming damper = damper_timing(loop);
  return damper.delay != loop.delay || internal::rate_ratio(loop.sampling_period, damper.sampling_period) != 1.0;
}

Device with_one_rate(const Device& device) {
  DeviceParameters parameters = device.parameters();
  rename_uncertain(parameters, [](const std::string& key) {
    return key.starts_with(of_damper) ? std::nullopt : std::optional(key);
  });
  parameters.loop.damper.reset();
  return Device(std::move(parameters));
}

Device with_loop_of_damper(const Device& device) {
  DeviceParameters parameters = device.parameters();
  const auto [period, delay] = damper_timing(parameters.loop);
  rename_uncertain(parameters, [damper = parameters.loop.damper](const std::string& key) -> std::optional<std::string> {
    if (key.starts_with(of_damper)) return "loop." + key.substr(of_damper.size());
    if (key == "loop.sampling_period" && damper && damper->sampling_period) return std::nullopt;
    if (key == "loop.delay" && damper && damper->delay) return std::nullopt;
    return key;
  });
  parameters.loop.sampling_period = period;
  parameters.loop.delay = delay;
  parameters.loop.damper.reset();
  return Device(std::move(parameters));
}

Device at_slower_rate(const Device& device) {
  if (!has_damper_loop(device.loop())) return device;
  const bool is_damper_slower = damper_timing(device.loop()).sampling_period > device.loop().sampling_period;
  return is_damper_slower ? with_loop_of_damper(device) : with_one_rate(device);
}

double internal::rate_ratio(double loop_period, double damper_period) {
  if (damper_period >= loop_period) return 1.0 / std::round(damper_period / loop_period);
  const double fewer = std::floor(loop_period / damper_period);
  const double more = fewer + 1.0;
  return damper_period - loop_period / more < loop_period / fewer - damper_period ? more : fewer;
}

void require_one_rate(const Device& device) { refuse_damper_loop(device, ProblemCode::damper_loop_not_known); }

void require_open_damper(const Device& device) {
  refuse_damper_loop(device, ProblemCode::damper_closed_while_recorded);
}

}  // namespace zwidth
