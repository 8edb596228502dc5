#include "identification/response_start.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "identification/model/device_numbers.hpp"
#include "identification/model/rivals/catalogue.hpp"
#include "model/loop_keys.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {
constexpr double known_to = 0.2;  // a number of a file that says nothing more

bool is_named(const std::vector<std::string>& keys, const std::string& key) {
  return std::ranges::find(keys, key) != keys.end();
}

/// How large numbers are that show in a response.
RivalSetting setting_of_lines(const DeviceParameters& device, const ResponseFitSetting& setting) {
  RivalSetting sizes{.device = device, .locked = setting.locked, .rms_force = 1.0};
  for (const ResponsePoint& point : setting.response->points) {
    sizes.rms_position = std::max(sizes.rms_position, std::abs(point.value));
    sizes.rms_speed = std::max(sizes.rms_speed, std::abs(point.value) * point.frequency);
  }
  sizes.largest_speed = sizes.rms_speed;
  const double highest = setting.response->points.back().frequency;
  sizes.sampling_period = setting.response->sampling_period.value_or(1.0 / highest);
  return sizes;
}

/// A number of a device file as it is fitted to limits, whose prior is elsewhere.
Number given_number(const std::string& key, double value, double deviation) {
  const double open = std::numeric_limits<double>::infinity();
  if (key.ends_with(".mass") || (key.starts_with("link.") && key.ends_with(".stiffness"))) {
    return number_about(key, value, open);
  }
  return {.key = key, .unit = std::max(value, deviation)};
}

/// The part of an uncertainty that is of these numbers.
Uncertainty part_of(const Uncertainty& all, const std::vector<std::size_t>& kept) {
  Uncertainty part;
  for (const std::size_t i : kept) {
    part.parameters.push_back(all.parameters[i]);
    part.covariance.emplace_back();
    for (const std::size_t j : kept) part.covariance.back().push_back(all.covariance[i][j]);
  }
  return part;
}

/// Numbers of the file's [uncertainty] that are not open: fitted too, which it alone limits.
void add_given(ResponseStart& start, const Uncertainty& file, const std::vector<std::string>& open) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < file.parameters.size(); ++i) {
    const std::string key = full_parameter_key(start.device, file.parameters[i]);
    const std::optional<double> value = parameter(start.device, key);
    if (!value || !(file.covariance[i][i] > 0.0) || is_named(open, key)) continue;
    kept.push_back(i);
    start.numbers.push_back(given_number(key, *value, std::sqrt(file.covariance[i][i])));
  }
  if (!kept.empty()) start.given = part_of(file, kept);
}

/// A named number is open, one of a file that says nothing more is known to 20 %.
Number number_of_limits(const std::string& key, const DeviceParameters& start, bool is_named_open) {
  const std::optional<double> value = parameter(start, key);
  if (!value) {
    throw Error(ErrorCode::invalid_argument,
                Problem{.code = ProblemCode::no_number_of_structure, .subjects = {{"key", key}}});
  }
  if (*value > 0.0) return number_about(key, *value, is_named_open ? deviation_of_logarithm : known_to);
  const double period = start.loop.sampling_period;
  double damping = 0.0;
  for (const Body& body : start.bodies) damping += body.mass / period;
  Number open = device_number(key, start, {period, damping, damping / period});
  open.prior_deviation = 1.0;
  return open;
}

/// A limit tells of a lag what it tells of a delay: a lag alone is fitted as a delay, both by their sum (DeviceFamily).
void fit_lag_as_delay(ResponseStart& start) {
  const auto lag = std::ranges::find(start.numbers, key_of_lag, &Number::key);
  if (lag == start.numbers.end()) return;
  const double value = start.device.actuator.time_constant;
  const auto delay = std::ranges::find(start.numbers, key_of_delay, &Number::key);
  if (delay != start.numbers.end()) {
    if (delay->scale == Number::Scale::logarithmic) delay->unit += value;
    return;
  }
  const bool is_open = lag->prior_deviation > 1.0 || value == 0.0;
  double deviation = is_open ? start.device.loop.sampling_period : known_to * value;
  if (start.given) {
    const auto place = std::ranges::find(start.given->parameters, key_of_lag) - start.given->parameters.begin();
    const auto i = static_cast<std::size_t>(place);
    if (i < start.given->parameters.size()) {
      deviation = std::sqrt(start.given->covariance[i][i]);
      std::vector<std::size_t> others;
      for (std::size_t j = 0; j < start.given->parameters.size(); ++j) {
        if (j != i) others.push_back(j);
      }
      start.given = others.empty() ? std::nullopt : std::optional(part_of(*start.given, others));
    }
  }
  *lag = {
      .key = key_of_delay, .unit = deviation, .expected = start.device.loop.delay / deviation, .prior_deviation = 1.0};
}

}  // namespace

ResponseStart start_of_response(const ResponseFitSetting& setting) {
  constexpr double typical_delay = 0.5;  // sampling periods
  ResponseStart start{setting.structure.parameters(), {}};
  const std::vector<std::string> asked = free_parameters(setting.structure, setting.free, setting.locked);
  std::vector<std::string> free = asked;
  if ((setting.frees_lateness || is_named(free, key_of_lag)) && !is_named(free, key_of_delay)) {
    const double period = setting.response->sampling_period.value_or(start.device.loop.sampling_period);
    if (start.device.loop.delay == 0.0) start.device.loop.delay = typical_delay * period;
    free.emplace_back(key_of_delay);
  }
  ParameterFitOptions linear;
  linear.free = free;
  linear.locked = setting.locked;
  start.device = fit_parameters(Device(start.device), *setting.response, linear).device.parameters();
  start.device.uncertainty.reset();

  RivalSetting sizes = setting_of_lines(start.device, setting);
  sizes.frees_lag = setting.frees_lateness || is_named(free, key_of_lag);
  const TypicalSizes typical{sizes.sampling_period, typical_damping(sizes), sizes.rms_force / sizes.rms_position};
  ModelParts parts;
  for (const std::string& key : free) {
    if (key != key_of_lag) parts.numbers.push_back(device_number(key, start.device, typical));
  }
  start.rivals = add_linear_rivals(sizes, parts);
  start.numbers = std::move(parts.numbers);
  const std::optional<Uncertainty>& file = setting.structure.parameters().uncertainty;
  if (file && setting.known) {
    for (const Number& each : start.numbers) free.push_back(each.key);
    add_given(start, *file, free);
    fit_lag_as_delay(start);
  }
  std::erase_if(start.rivals, [&](const AddedRival& rival) {
    return std::ranges::any_of(rival.keys, [&](const std::string& key) {
      return is_named(asked, key) || std::ranges::count(start.numbers, key, &Number::key) == 0;
    });
  });
  return start;
}

ResponseStart start_of_limits(const ResponseFitSetting& setting) {
  ResponseStart start{setting.structure.parameters(), {}};
  const std::optional<Uncertainty> file = std::exchange(start.device.uncertainty, {});
  const bool names_none = frees_all(setting.free);
  std::vector<std::string> keys;
  if (!names_none || !file) keys = free_parameters(setting.structure, setting.free);
  if (file && setting.known) add_given(start, *file, keys);
  for (const std::string& key : keys) {
    Number number = number_of_limits(key, start.device, !names_none);
    if (names_none && number.scale != Number::Scale::logarithmic) continue;  // a file that gives 0 means none
    start.numbers.push_back(std::move(number));
  }
  const bool has_delay = std::ranges::find(start.numbers, key_of_delay, &Number::key) != start.numbers.end();
  if (setting.frees_lateness && start.device.loop.delay == 0.0 && !has_delay) {
    start.numbers.push_back({.key = key_of_delay, .unit = start.device.loop.sampling_period, .prior_deviation = 1.0});
  }
  fit_lag_as_delay(start);
  return start;
}

}  // namespace zwidth::internal
