#include "identification/response/plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "counted.hpp"
#include "model/implausible_numbers.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

/// Many different numbers, all a whole number apart, as counters and converters give them: 0.5 may be added, so that
/// they stand in the middle of their steps.
bool is_in_counts(const std::vector<double>& samples) {
  constexpr double least_range = 100.0;
  if (samples.empty()) return false;
  const auto [lowest, highest] = std::minmax_element(samples.begin(), samples.end());
  if (*highest - *lowest < least_range) return false;
  const double offset = samples.front() - std::round(samples.front());
  if (!std::ranges::all_of(samples, [&](double x) { return x - offset == std::round(x - offset); })) return false;
  constexpr std::ptrdiff_t least_values = 20;
  std::vector<double> values = samples;
  std::ranges::sort(values);
  return std::unique(values.begin(), values.end()) - values.begin() >= least_values;
}

/// But for rests without a force.
bool has_two_values(const std::vector<double>& samples) {
  if (samples.empty()) return false;
  const double least = std::ranges::min(samples);
  const double most = std::ranges::max(samples);
  if (least == most) return false;
  constexpr double share = 0.9;
  const auto extreme = std::ranges::count_if(samples, [&](double each) { return each == least || each == most; });
  const auto moving = std::ranges::count_if(samples, [](double each) { return each != 0.0; });
  return static_cast<double>(extreme) > share * static_cast<double>(moving);
}

/// Of the channel at this place: the force is the first.
Finding counts_finding(const Channel& channel, std::size_t place) {
  const bool is_whole = channel.samples.front() == std::round(channel.samples.front());
  return {.code = FindingCode::channel_in_counts,
          .evidence = {counted("channel_index", place)},
          .subjects = {{"channel", channel.name},
                       {"role", place == 0 ? "force" : "motion"},
                       {"counts", is_whole ? "whole" : "half"}}};
}

}  // namespace

std::vector<Remark> implausible_recording(const Recording& recording) {
  std::vector<Remark> remarks;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    const Channel& channel = recording.channels[i];
    if (!is_in_counts(channel.samples)) continue;
    remarks.push_back(warning(counts_finding(channel, i)));
  }
  if (has_two_values(recording.channels.front().samples)) {
    remarks.push_back(
        note({.code = FindingCode::force_of_two_values, .subjects = {{"channel", recording.channels.front().name}}}));
  }
  if (auto remark = implausible_period(recording.sampling_period, "recording")) {
    remarks.push_back(*std::move(remark));
  }
  return remarks;
}

namespace {
/// The position is whole numbers only, or these and a half, as an encoder counts.
std::optional<Finding> doubt_of_counts(const Recording& recording) {
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    const Channel& channel = recording.channels[i];
    if (!is_in_counts(channel.samples)) continue;
    return counts_finding(channel, i);
  }
  return std::nullopt;
}

std::optional<Motion> motion_of(const Channel& channel) {
  Recording alone;
  alone.channels.push_back({.name = "", .samples = {}, .base_unit = channel.base_unit});
  return stated_motion(std::span(&alone, 1));
}

/// A torque beside a length, or a force beside an angle.
std::optional<Finding> doubt_of_mixed_motion(const Recording& recording) {
  const Channel& force = recording.channels[0];
  const Channel& motion = recording.channels[1];
  const auto of_force = motion_of(force);
  const auto of_motion = motion_of(motion);
  if (!of_force || !of_motion || *of_force == *of_motion) return std::nullopt;
  return Finding{.code = FindingCode::channels_of_two_motions,
                 .subjects = {{"force", force.name},
                              {"force_unit", force.base_unit},
                              {"channel", motion.name},
                              {"unit", motion.base_unit},
                              {"of_force", *of_force == Motion::rotary ? "rotary" : "linear"},
                              {"of_motion", *of_force == Motion::rotary ? "linear" : "rotary"}}};
}
}  // namespace

std::optional<Finding> doubt_of_units(const Recording& recording, OutputQuantity output) {
  if (!recording.doubts.empty()) return recording.doubts.front();
  using enum StatedQuantity;
  const StatedQuantity motion = output == OutputQuantity::velocity       ? velocity
                                : output == OutputQuantity::acceleration ? acceleration
                                                                         : position;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    const Channel& channel = recording.channels[i];
    if (channel.quantity == nothing || channel.quantity == (i == 0 ? force : motion)) continue;
    return Finding{
        .code = channel.quantity != other ? FindingCode::channel_of_other_quantity : FindingCode::channel_unit_unknown,
        .subjects = {{"channel", channel.name}, {"unit", channel.unit}, {"role", i == 0 ? "force" : "motion"}}};
  }
  if (auto doubt = doubt_of_mixed_motion(recording)) return doubt;
  return doubt_of_counts(recording);
}

namespace {
std::optional<Finding> doubt_of_force_limit(const Recording& recording, const Device& fitted) {
  const DeviceParameters& device = fitted.parameters();
  if (!device.actuator.force_limit) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(recording.channels[0].samples);
  const double strongest = std::max(most, -least);
  constexpr double beyond = 1.01;  // of the limit: rounding, and what a load cell's noise adds
  if (!(strongest > beyond * *device.actuator.force_limit)) return std::nullopt;
  const std::string_view unit = units_of(device.motion).force;
  return Finding{.code = FindingCode::force_beyond_limit,
                 .evidence = {{"force", strongest, unit}, {"limit", *device.actuator.force_limit, unit}},
                 .subjects = {{"channel", recording.channels[0].name}},
                 .key = "actuator.force_limit"};
}

std::optional<Finding> doubt_of_motion(const Recording& recording, const Device& fitted) {
  const auto of_force = motion_of(recording.channels[0]);
  const auto of_motion = motion_of(recording.channels[1]);
  const bool is_rotary = fitted.parameters().motion == Motion::rotary;
  const std::optional<Motion> stated = of_force ? of_force : of_motion;
  if (!stated || (*stated == Motion::rotary) == is_rotary) return std::nullopt;
  const Channel& stating = recording.channels[of_force ? 0 : 1];
  return Finding{.code = FindingCode::channel_of_other_motion,
                 .subjects = {{"channel", stating.name},
                              {"unit", stating.base_unit},
                              {"of_channel", is_rotary ? "linear" : "rotary"},
                              {"of_structure", is_rotary ? "rotary" : "linear"}},
                 .key = "motion"};
}

/// Where another recording has a row for each period, the two disagree if force is missing in this one.
std::optional<Finding> doubt_of_thinned_rows(const Recording& recording, std::span<const Recording> all,
                                             const Device& fitted) {
  const double period = fitted.loop().sampling_period;
  const double ratio = recording.sampling_period / period;
  constexpr double close = 0.01;
  if (std::ranges::any_of(
          all, [&](const Recording& each) { return std::abs(each.sampling_period - period) <= close * period; })) {
    return std::nullopt;
  }
  const double whole = std::round(ratio);
  if (whole < 2.0 || std::abs(ratio - whole) > close * whole) return std::nullopt;
  return Finding{
      .code = FindingCode::rows_thinned,
      .evidence = {{"periods", whole}, {"row_period", recording.sampling_period, "s"}, {"loop_period", period, "s"}},
      .key = "loop.sampling_period"};
}
}  // namespace

std::vector<Finding> doubts_of_recording(const Recording& recording, std::span<const Recording> all,
                                         OutputQuantity output, const Device& fitted) {
  std::vector<Finding> doubts;
  for (auto& doubt : {doubt_of_units(recording, output), doubt_of_motion(recording, fitted),
                      doubt_of_force_limit(recording, fitted), doubt_of_thinned_rows(recording, all, fitted)}) {
    if (doubt) doubts.push_back(*doubt);
  }
  return doubts;
}

}  // namespace zwidth::internal
