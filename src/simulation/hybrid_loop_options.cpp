#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth {
namespace {

bool is_probability(double value) { return value >= 0.0 && value <= 1.0; }

bool is_duration(double value) { return std::isfinite(value) && value >= 0.0; }

bool is_finite(double value) { return std::isfinite(value); }

std::optional<OptionProblem> user_force_problem(const UserForce& force) {
  if (!is_finite(force.amplitude)) {
    return OptionProblem{"user_force.amplitude", fmt::format("is {}", force.amplitude), "a finite force"};
  }
  if (!is_duration(force.start)) {
    return OptionProblem{"user_force.start", fmt::format("is {} s", force.start), "a number of s >= 0"};
  }
  if (force.kind == UserForce::Kind::sine && !(is_finite(force.frequency) && force.frequency > 0.0)) {
    return OptionProblem{"user_force.frequency", fmt::format("is {} rad/s", force.frequency), "a number of rad/s > 0"};
  }
  if (force.kind != UserForce::Kind::recorded) return std::nullopt;
  if (!(is_finite(force.period) && force.period > 0.0)) {
    return OptionProblem{"user_force.period", fmt::format("is {} s", force.period), "a number of s > 0"};
  }
  if (force.samples.empty()) return OptionProblem{"user_force.samples", "are none", "at least one"};
  if (!std::all_of(force.samples.begin(), force.samples.end(), is_finite)) {
    return OptionProblem{"user_force.samples", "are not all finite", "finite forces"};
  }
  return std::nullopt;
}

std::optional<OptionProblem> faults_problem(const Faults& faults, double period) {
  constexpr const char* share = "a share from 0 to 1";
  if (!is_probability(faults.lost_sample_probability)) {
    return OptionProblem{"faults.lost_sample_probability", fmt::format("is {}", faults.lost_sample_probability), share};
  }
  if (!is_duration(faults.sampling_jitter)) {
    return OptionProblem{"faults.sampling_jitter", fmt::format("is {}", faults.sampling_jitter), "a number of s >= 0"};
  }
  if (faults.sampling_jitter >= period) {
    return OptionProblem{"faults.sampling_jitter", fmt::format("is {} s", faults.sampling_jitter),
                         fmt::format("below the sampling period, {} s", period)};
  }
  if (!is_probability(faults.overrun_probability)) {
    return OptionProblem{"faults.overrun_probability", fmt::format("is {}", faults.overrun_probability), share};
  }
  if (!is_duration(faults.overrun_delay)) {
    return OptionProblem{"faults.overrun_delay", fmt::format("is {}", faults.overrun_delay), "a number of s >= 0"};
  }
  if (faults.overrun_delay > max_delay_samples * period) {
    return OptionProblem{
        "faults.overrun_delay", fmt::format("is {} s", faults.overrun_delay),
        fmt::format("at most {} s, {} sampling periods", max_delay_samples * period, max_delay_samples)};
  }
  return std::nullopt;
}

std::optional<OptionProblem> motion_problem(const char* member, const std::vector<double>& values,
                                            const Device& device) {
  if (values.empty()) return std::nullopt;
  if (values.size() != device.bodies().size()) {
    return OptionProblem{member, fmt::format("has {} values", values.size()),
                         fmt::format("one for each of {} bodies, or none", device.bodies().size())};
  }
  if (std::all_of(values.begin(), values.end(), is_finite)) return std::nullopt;
  return OptionProblem{member, "is not finite", "a finite number for every body"};
}

}  // namespace

std::optional<OptionProblem> find_problem(const HybridLoopOptions& options, const Device& device) {
  const double period = device.loop().sampling_period;
  if (auto problem = find_problem(options.controller, period)) {
    problem->member.insert(0, "controller.");
    return problem;
  }
  if (auto problem = faults_problem(options.faults, period)) return problem;
  if (!device.has_bodies() && options.user_force.kind != UserForce::Kind::none) {
    return OptionProblem{"user_force", "needs a body that a user could hold", "none on a transfer function"};
  }
  if (auto problem = user_force_problem(options.user_force)) return problem;
  if (auto problem = motion_problem("initial_position", options.initial_position, device)) return problem;
  return motion_problem("initial_velocity", options.initial_velocity, device);
}

}  // namespace zwidth
