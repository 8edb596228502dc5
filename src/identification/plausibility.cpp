#include "identification/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

constexpr double many_periods = 20.0;  // of delay or lag: few drives are as slow

/// Many different whole numbers, as counters and converters give them.
bool is_in_counts(const std::vector<double>& samples) {
  constexpr double least_range = 100.0;
  if (samples.empty()) return false;
  const auto [lowest, highest] = std::minmax_element(samples.begin(), samples.end());
  if (*highest - *lowest < least_range) return false;
  if (!std::ranges::all_of(samples, [](double x) { return x == std::round(x); })) return false;
  constexpr std::ptrdiff_t least_values = 20;
  std::vector<double> values = samples;
  std::ranges::sort(values);
  return std::unique(values.begin(), values.end()) - values.begin() >= least_values;
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

/// A sampling period of a haptic loop lies between a microsecond and a tenth of a second.
std::optional<Remark> implausible_period(double period, const std::string& whose) {
  constexpr double longest = 0.1;
  constexpr double shortest = 1e-6;
  if (period >= shortest && period <= longest) return std::nullopt;
  // 0.2 to 400: milliseconds or microseconds given as seconds.
  std::string likely;
  if (period > longest) {
    likely = period > 30.0 ? "microseconds" : "milliseconds";
    likely = fmt::format("is it in {}? It must be in seconds: {:.4g}", likely, period * (period > 30.0 ? 1e-6 : 1e-3));
  } else {
    likely = "is the time in the unit that was stated? It must be in seconds";
  }
  return Remark{Remark::Severity::warning, fmt::format("{} is {:.4g} s", whose, period),
                "every delay, damping and critical stiffness depends on it", likely};
}

}  // namespace

std::vector<Remark> implausible_recording(const Recording& recording) {
  std::vector<Remark> remarks;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    const Channel& channel = recording.channels[i];
    if (!is_in_counts(channel.samples)) continue;
    remarks.push_back({Remark::Severity::warning, fmt::format("{} holds whole numbers only", channel.name),
                       i == 0 ? "counts of a converter, or millinewtons? Every number below is then in that unit"
                              : "encoder counts? Every number below is then per count, not per m or rad",
                       "scale it to SI units (metres or radians per count)"});
  }
  if (auto remark = implausible_period(recording.sampling_period, "the sampling period of the recording")) {
    remarks.push_back(*std::move(remark));
  }
  return remarks;
}

std::optional<std::string> doubt_of_counts(const Recording& recording) {
  if (recording.channels.size() < 2 || !is_in_counts(recording.channels[1].samples)) return std::nullopt;
  return fmt::format(
      "{} holds whole numbers only, as an encoder counts: every number is then per count; give the "
      "metres or radians per count",
      recording.channels[1].name);
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
  const double record = recorded_period.value_or(period);
  const double late = fitted.loop().delay + fitted.parameters().actuator.time_constant;
  if (late > many_periods * record) {
    remarks.push_back({Remark::Severity::warning,
                       fmt::format("delay and lag come to {:.4g} s, {:.3g} sampling periods", late, late / record),
                       "few drives are as slow as that",
                       "are force and motion of the same instant, and the time in seconds?"});
  }
  if (!known) return remarks;
  constexpr double far = 30.0;
  for (const std::string& key : parameter_keys(known->parameters())) {
    if (!key.starts_with("body.") || !key.ends_with(".mass")) continue;
    const double ratio =
        parameter(fitted.parameters(), key).value_or(1.0) / parameter(known->parameters(), key).value_or(1.0);
    if (ratio < far && ratio > 1.0 / far) continue;
    const std::string prefix = prefix_of(1.0 / ratio);
    remarks.push_back(
        {Remark::Severity::warning, fmt::format("{} comes out {:.3g} times the structure's", key, ratio),
         "one of force, motion and structure is probably not in SI units",
         prefix.empty() ? "check their units" : fmt::format("is the motion or the force in {} of its unit?", prefix)});
  }
  return remarks;
}

}  // namespace zwidth::internal
