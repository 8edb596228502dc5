#include "zwidth/rig/force_guard.hpp"

#include <algorithm>
#include <cmath>

#include "counted.hpp"
#include "zwidth/error.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
namespace {

constexpr double velocity_bandwidth = 0.05;  // of the sampling rate
constexpr double longest_ramp = 10.0;        // s

constexpr double missed_duration = 0.025;  // s
constexpr unsigned least_missed = 3;
constexpr unsigned most_missed = 1000;

OptionProblem missed_cycles_problem(unsigned value, unsigned most) {
  return option_problem("missed_cycles", {.code = ProblemCode::no_whole_number,
                                          .evidence = {internal::counted("value", value), internal::counted("least", 1),
                                                       internal::counted("most", most)}});
}

const SafetyLimits& checked(const SafetyLimits& limits) {
  require_valid(find_problem(limits));
  return limits;
}

}  // namespace

std::optional<OptionProblem> find_problem(const SafetyLimits& limits) {
  const auto bad = [](const std::optional<double>& value) { return value && !(std::isfinite(*value) && *value > 0.0); };
  const auto problem = [](const char* member, double value, const char* measure) {
    return option_problem(member, {.code = ProblemCode::not_above,
                                   .evidence = {{"value", value}, {"bound", 0.0}},
                                   .subjects = {{"measure", measure}}});
  };
  if (bad(limits.force)) return problem("force", *limits.force, "force");
  if (bad(limits.position)) return problem("position", *limits.position, "distance");
  if (bad(limits.velocity)) return problem("velocity", *limits.velocity, "speed");
  if (bad(limits.saturation_duration)) {
    return problem("saturation_duration", limits.saturation_duration, "time");
  }
  if (limits.missed_cycles && (*limits.missed_cycles == 0 || *limits.missed_cycles > most_missed)) {
    return missed_cycles_problem(*limits.missed_cycles, most_missed);
  }
  if (!(limits.ramp >= 0.0 && limits.ramp <= longest_ramp)) {
    return option_problem("ramp", {.code = ProblemCode::not_between,
                                   .evidence = {{"value", limits.ramp}, {"least", 0.0}, {"most", longest_ramp}},
                                   .subjects = {{"unit", "s"}}});
  }
  return std::nullopt;
}

unsigned allowed_missed_cycles(double sampling_period) {
  const double cycles = std::ceil(missed_duration / sampling_period * (1.0 - 1e-9));
  return static_cast<unsigned>(std::clamp<double>(cycles, least_missed, most_missed));
}

std::optional<OptionProblem> find_problem(const SafetyLimits& limits, double sampling_period, double watchdog) {
  const double waits = std::floor(watchdog / sampling_period * (1.0 + 1e-9));
  const auto most = static_cast<unsigned>(std::clamp<double>(waits, least_missed, most_missed));
  const unsigned allowed = limits.missed_cycles.value_or(std::min(most, allowed_missed_cycles(sampling_period)));
  if (allowed <= most) return std::nullopt;
  return missed_cycles_problem(allowed, most);
}

ForceGuard::ForceGuard(const SafetyLimits& limits, double sampling_period)
    : limits_(checked(limits)),
      filter_(velocity_bandwidth / sampling_period, sampling_period),
      ramp_step_(limits.ramp > 0.0 ? std::min(1.0, sampling_period / limits.ramp) : 1.0),
      saturated_most_(limits.saturation_duration / sampling_period),
      missed_most_(limits.missed_cycles.value_or(allowed_missed_cycles(sampling_period))) {}

void ForceGuard::restart() noexcept { share_ = last_ = saturated_ = 0.0; }

void ForceGuard::stop(StopReason reason) noexcept {
  if (reason_ == StopReason::none) reason_ = reason;
  last_ = 0.0;
}

void ForceGuard::missed(unsigned cycles) noexcept {
  late_ = cycles == 0 ? 0 : late_ + cycles;
  if (late_ >= missed_most_) stop(StopReason::missed_cycles);
}

double ForceGuard::no_position() noexcept {
  if (++without_position_ >= missed_most_) stop(StopReason::lost_link);
  return reason_ == StopReason::none ? last_ : 0.0;
}

double ForceGuard::update(double position, double wanted) noexcept {
  without_position_ = 0;
  if (!std::isfinite(position) || !std::isfinite(wanted)) stop(StopReason::not_a_number);
  if (reason_ != StopReason::none) return 0.0;
  if (!started_) {
    started_ = true;
    origin_ = position;
  }
  velocity_ = filter_.update(position);
  if (limits_.position && std::abs(position - origin_) > *limits_.position) stop(StopReason::position_limit);
  if (limits_.velocity && std::abs(velocity_) > *limits_.velocity) stop(StopReason::velocity_limit);
  share_ = std::min(1.0, share_ + ramp_step_);
  double force = share_ * wanted;
  if (limits_.force && std::abs(force) > *limits_.force) {
    force = std::copysign(*limits_.force, force);
    if (++saturated_ > saturated_most_) stop(StopReason::saturation);
  } else {
    saturated_ = std::max(0.0, saturated_ - 1.0);
  }
  return last_ = reason_ == StopReason::none ? force : 0.0;
}

}  // namespace zwidth
