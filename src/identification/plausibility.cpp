#include "identification/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/implausible_numbers.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/model/parameter.hpp"
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

const char* counts_of(const std::vector<double>& samples) {
  return samples.front() == std::round(samples.front()) ? "whole numbers" : "numbers that are whole ones apart";
}

/// "ms" for a ratio of about 1000, "us" for a million, ...; nothing for a ratio that no unit explains.
std::string prefix_of(double ratio) {
  struct Prefix {
    double ratio;
    const char* name;
  };
  constexpr double close = 0.3;  // decades
  for (const Prefix& each : {Prefix{1e3, "milli"}, Prefix{1e6, "micro"}, Prefix{1e9, "nano"}, Prefix{1e-3, "kilo"}}) {
    if (std::abs(std::log10(ratio / each.ratio)) < close) return each.name;
  }
  return "";
}

/// A fitted mass beside the structure's.
struct OddMass {
  std::string key;
  double ratio;  ///< fitted over given
};

/// Those that are a power of ten off; a fit finds it a little less than ten.
std::vector<OddMass> odd_masses(const Device& fitted, const Device& known) {
  constexpr double far = 9.0;
  std::vector<OddMass> found;
  for (const std::string& key : parameter_keys(known.parameters())) {
    if (!key.starts_with("body.") || !key.ends_with(".mass")) continue;
    const double ratio =
        parameter(fitted.parameters(), key).value_or(1.0) / parameter(known.parameters(), key).value_or(1.0);
    if (ratio >= far || ratio <= 1.0 / far) found.push_back({key, ratio});
  }
  return found;
}

std::string odd_mass_text(const OddMass& odd) {
  return fmt::format("{} comes out {:.3g} times the structure's", odd.key, odd.ratio);
}

}  // namespace

std::vector<Remark> implausible_recording(const Recording& recording) {
  std::vector<Remark> remarks;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    const Channel& channel = recording.channels[i];
    if (!is_in_counts(channel.samples)) continue;
    remarks.push_back({Remark::Severity::warning,
                       fmt::format("{} holds {} only", channel.name, counts_of(channel.samples)),
                       i == 0 ? "counts of a converter, or millinewtons? Every number below is then in that unit"
                              : "encoder counts? Every number below is then per count, not per m or rad",
                       "scale it to SI units (metres or radians per count)"});
  }
  if (has_two_values(recording.channels.front().samples)) {
    remarks.push_back({Remark::Severity::note,
                       fmt::format("{} takes two values only: an amplifier that gives less shows in nothing",
                                   recording.channels.front().name),
                       "every number would come out as if it gave all, and the critical stiffness too high by as much",
                       "stay well below the amplifier's limit, or record noise, a sweep or a multisine"});
  }
  if (auto remark = implausible_period(recording.sampling_period, "the sampling period of the recording")) {
    remarks.push_back(*std::move(remark));
  }
  return remarks;
}

namespace {
/// The position is whole numbers only, or these and a half, as an encoder counts.
std::optional<std::string> doubt_of_counts(const Recording& recording) {
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    const Channel& channel = recording.channels[i];
    if (!is_in_counts(channel.samples)) continue;
    return fmt::format("{} holds {} only, as {}: every number is then per count; give the {} per count", channel.name,
                       counts_of(channel.samples), i == 0 ? "a converter gives" : "an encoder counts",
                       i == 0 ? "newtons (or newton metres)" : "metres or radians");
  }
  return std::nullopt;
}

std::optional<Motion> motion_of(const Channel& channel) {
  Recording alone;
  alone.channels.push_back({.name = "", .samples = {}, .base_unit = channel.base_unit});
  return stated_motion(std::span(&alone, 1));
}

/// A torque beside a length, or a force beside an angle.
std::optional<std::string> doubt_of_mixed_motion(const Recording& recording) {
  const Channel& force = recording.channels[0];
  const Channel& motion = recording.channels[1];
  const auto of_force = motion_of(force);
  const auto of_motion = motion_of(motion);
  if (!of_force || !of_motion || *of_force == *of_motion) return std::nullopt;
  return fmt::format(
      "{} is in {} and {} in {} by their names, of a {} motion and of a {}: give the scale that makes them "
      "of one, by the radius",
      force.name, force.base_unit, motion.name, motion.base_unit, *of_force == Motion::rotary ? "rotary" : "linear",
      *of_force == Motion::rotary ? "linear" : "rotary");
}
}  // namespace

std::optional<std::string> doubt_of_units(const Recording& recording, OutputQuantity output) {
  if (!recording.doubts.empty()) return recording.doubts.front();
  using enum StatedQuantity;
  const StatedQuantity motion = output == OutputQuantity::velocity       ? velocity
                                : output == OutputQuantity::acceleration ? acceleration
                                                                         : position;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    const Channel& channel = recording.channels[i];
    if (channel.quantity == nothing || channel.quantity == (i == 0 ? force : motion)) continue;
    const char* wanted = i == 0 ? "a force or torque" : "the motion";
    if (channel.quantity != other) {
      return fmt::format("{} is in {} by its name, and is taken for {}: name the right column, or give its scale",
                         channel.name, channel.unit, wanted);
    }
    return fmt::format(
        "{} is in {} by its name, which is no unit of {} that is known: every number is then in that unit; give its "
        "scale, {} per unit of it (1 says that it is in SI units)",
        channel.name, channel.unit, wanted, i == 0 ? "newtons or newton metres" : "metres or radians");
  }
  if (auto doubt = doubt_of_mixed_motion(recording)) return doubt;
  return doubt_of_counts(recording);
}

namespace {
std::optional<std::string> doubt_of_force_limit(const Recording& recording, const Device& fitted) {
  const DeviceParameters& device = fitted.parameters();
  if (!device.actuator.force_limit) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(recording.channels[0].samples);
  const double strongest = std::max(most, -least);
  constexpr double beyond = 1.01;  // of the limit: rounding, and what a load cell's noise adds
  if (!(strongest > beyond * *device.actuator.force_limit)) return std::nullopt;
  const std::string_view unit = units_of(device.motion).force;
  return fmt::format(
      "{} reaches {} where the structure's actuator.force_limit is {}: less acted than the record says; "
      "record with less, or correct the limit",
      recording.channels[0].name, quantity(strongest, unit), quantity(*device.actuator.force_limit, unit));
}

std::optional<std::string> doubt_of_motion(const Recording& recording, const Device& fitted) {
  const auto of_force = motion_of(recording.channels[0]);
  const auto of_motion = motion_of(recording.channels[1]);
  const bool is_rotary = fitted.parameters().motion == Motion::rotary;
  const std::optional<Motion> stated = of_force ? of_force : of_motion;
  if (!stated || (*stated == Motion::rotary) == is_rotary) return std::nullopt;
  const Channel& stating = recording.channels[of_force ? 0 : 1];
  return fmt::format(
      "{} is in {} by its name, of a {} motion, and the structure's is {}: every number has the wrong unit; "
      "set the structure's motion, or give the scale from one to the other",
      stating.name, stating.base_unit, is_rotary ? "linear" : "rotary", is_rotary ? "rotary" : "linear");
}

/// Where another recording has a row for each period, the two disagree if force is missing in this one.
std::optional<std::string> doubt_of_thinned_rows(const Recording& recording, std::span<const Recording> all,
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
  return fmt::format(
      "a row stands for {:.0f} periods of the loop, {} and {}: where rows were left out of the log, so is the force "
      "between them, and the fit lacks delay; log every period, or, where the force was held from row to row, identify "
      "with the rows' period and set loop.sampling_period in the device file",
      whole, quantity(recording.sampling_period, "s"), quantity(period, "s"));
}
}  // namespace

std::vector<std::string> doubts_of_recording(const Recording& recording, std::span<const Recording> all,
                                             OutputQuantity output, const Device& fitted) {
  std::vector<std::string> doubts;
  for (auto& doubt : {doubt_of_units(recording, output), doubt_of_motion(recording, fitted),
                      doubt_of_force_limit(recording, fitted), doubt_of_thinned_rows(recording, all, fitted)}) {
    if (doubt) doubts.push_back(*doubt);
  }
  return doubts;
}

std::optional<std::string> doubt_of_weight(const Device& fitted) {
  const double heaviest = fitted.parameters().motion == Motion::rotary ? 10.0 : 100.0;
  const std::vector<Remark> heavy = implausible_masses(fitted, heaviest);
  if (heavy.empty()) return std::nullopt;
  return fmt::format("{}: {}; are force and motion in SI units?", heavy.front().what, heavy.front().consequence);
}

std::optional<std::string> doubt_of_lag(const std::vector<ParameterEstimate>& estimates, double recorded_period) {
  const auto lag = std::ranges::find(estimates, "actuator.time_constant", &ParameterEstimate::key);
  if (lag == estimates.end() || lag->value <= many_periods * recorded_period) return std::nullopt;
  return fmt::format(
      "the actuator's lag comes out as {:.4g} s, {:.3g} sampling periods: it was probably exchanged with the time that "
      "a body's mass takes on its damping, or friction or a spring hides it; name what is free without the lag",
      lag->value, lag->value / recorded_period);
}

std::vector<Remark> implausible_device(const Device& fitted, const Device* known,
                                       std::optional<double> recorded_period) {
  std::vector<Remark> remarks;
  const double period = fitted.loop().sampling_period;
  if (auto remark = implausible_period(period, "the sampling period of the structure")) {
    remarks.push_back(*std::move(remark));
  } else if (recorded_period) {
    const double ratio = period / *recorded_period;
    if (ratio > 100.0 || ratio < 0.01) {
      const std::string prefix = prefix_of(ratio);
      remarks.push_back(
          {Remark::Severity::warning,
           fmt::format("the structure's sampling period, {:.4g} s, is {:.3g} times the record's", period, ratio),
           "the critical stiffness is that of the structure's period",
           prefix.empty() ? "give the period of the loop to judge in seconds"
                          : fmt::format("is one of them in {}seconds?", prefix)});
    }
  }
  if (auto remark = implausible_lateness(fitted, recorded_period.value_or(period))) {
    remark->remedy = "are force and motion of the same instant, and the time in seconds? Else, " + remark->remedy;
    remarks.push_back(*std::move(remark));
  }
  if (!known) return remarks;
  for (const OddMass& each : odd_masses(fitted, *known)) {
    const std::string prefix = prefix_of(1.0 / each.ratio);
    remarks.push_back(
        {Remark::Severity::warning, odd_mass_text(each),
         "one of force, motion and structure is probably not in SI units",
         prefix.empty() ? "check their units" : fmt::format("is the motion or the force in {} of its unit?", prefix)});
  }
  return remarks;
}

std::optional<std::string> doubt_of_masses(const Device& fitted, const Device& known) {
  constexpr double beyond_belief = 90.0;
  for (const OddMass& each : odd_masses(fitted, known)) {
    if (each.ratio < beyond_belief && each.ratio > 1.0 / beyond_belief) continue;
    return odd_mass_text(each) + ": force, motion or structure is not in SI units; check their units";
  }
  return std::nullopt;
}

}  // namespace zwidth::internal
