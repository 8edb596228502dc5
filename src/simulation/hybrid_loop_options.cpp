#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "counted.hpp"
#include "simulation/loop_schedule.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth {
namespace {

bool is_probability(double value) { return value >= 0.0 && value <= 1.0; }

bool is_duration(double value) { return std::isfinite(value) && value >= 0.0; }

bool is_finite(double value) { return std::isfinite(value); }

// Of a number in this unit, which stands behind its value too where it is `shown`.
Problem number_in(const char* unit, ProblemCode code, double value, bool shown) {
  Problem problem{.code = code, .evidence = {{"value", value}}, .subjects = {{"in", unit}}};
  if (shown) problem.subjects.push_back({"unit", unit});
  return problem;
}

std::optional<OptionProblem> user_force_problem(const UserForce& force) {
  if (!is_finite(force.amplitude)) {
    return option_problem("user_force.amplitude",
                          {.code = ProblemCode::not_finite, .evidence = {{"value", force.amplitude}}});
  }
  if (!is_duration(force.start)) {
    return option_problem("user_force.start", number_in("s", ProblemCode::negative, force.start, true));
  }
  if (force.kind == UserForce::Kind::sine && !(is_finite(force.frequency) && force.frequency > 0.0)) {
    return option_problem("user_force.frequency",
                          number_in("rad/s", ProblemCode::not_finite_and_positive, force.frequency, true));
  }
  if (force.kind != UserForce::Kind::recorded) return std::nullopt;
  if (!(is_finite(force.period) && force.period > 0.0)) {
    return option_problem("user_force.period",
                          number_in("s", ProblemCode::not_finite_and_positive, force.period, true));
  }
  if (force.samples.empty()) return option_problem("user_force.samples", {.code = ProblemCode::no_values});
  if (!std::all_of(force.samples.begin(), force.samples.end(), is_finite)) {
    return option_problem("user_force.samples", {.code = ProblemCode::not_finite, .evidence = {{"values", 1.0}}});
  }
  return std::nullopt;
}

std::optional<OptionProblem> faults_problem(const Faults& faults, double period) {
  const auto no_share = [](const char* member, double value) {
    return option_problem(member, {.code = ProblemCode::no_share, .evidence = {{"value", value}}});
  };
  if (!is_probability(faults.lost_sample_probability)) {
    return no_share("faults.lost_sample_probability", faults.lost_sample_probability);
  }
  if (!is_duration(faults.sampling_jitter)) {
    return option_problem("faults.sampling_jitter",
                          number_in("s", ProblemCode::negative, faults.sampling_jitter, false));
  }
  if (faults.sampling_jitter >= period) {
    return option_problem(
        "faults.sampling_jitter",
        {.code = ProblemCode::not_below_period, .evidence = {{"value", faults.sampling_jitter}, {"period", period}}});
  }
  if (!is_probability(faults.overrun_probability)) {
    return no_share("faults.overrun_probability", faults.overrun_probability);
  }
  if (!is_duration(faults.overrun_delay)) {
    return option_problem("faults.overrun_delay", number_in("s", ProblemCode::negative, faults.overrun_delay, false));
  }
  if (faults.overrun_delay > max_delay_samples * period) {
    return option_problem("faults.overrun_delay", {.code = ProblemCode::too_long,
                                                   .evidence = {{"value", faults.overrun_delay},
                                                                {"most", max_delay_samples * period},
                                                                {"periods", max_delay_samples}}});
  }
  return std::nullopt;
}

std::optional<OptionProblem> motion_problem(const char* member, const std::vector<double>& values,
                                            const Device& device) {
  if (values.empty()) return std::nullopt;
  if (values.size() != device.bodies().size()) {
    return option_problem(member, {.code = ProblemCode::values_not_one_a_body,
                                   .evidence = {internal::counted("values", values.size()),
                                                internal::counted("bodies", device.bodies().size())}});
  }
  if (std::all_of(values.begin(), values.end(), is_finite)) return std::nullopt;
  return option_problem(member, {.code = ProblemCode::value_not_finite});
}

}  // namespace

std::optional<OptionProblem> find_problem(const HybridLoopOptions& options, const Device& device) {
  if (auto problem = find_problem(options.controller, device.loop().sampling_period)) {
    problem->member.insert(0, "controller.");
    return problem;
  }
  if (internal::damper_runs_apart(device, options.controller) && !options.controller.filters.empty()) {
    return option_problem("controller.filters", {.code = ProblemCode::filters_beside_damper_loop});
  }
  const double period = internal::shortest_period(device, options.controller);
  if (auto problem = faults_problem(options.faults, period)) return problem;
  if (!device.has_bodies() && options.user_force.kind != UserForce::Kind::none) {
    return option_problem("user_force", {.code = ProblemCode::user_force_without_body});
  }
  if (auto problem = user_force_problem(options.user_force)) return problem;
  if (auto problem = motion_problem("initial_position", options.initial_position, device)) return problem;
  return motion_problem("initial_velocity", options.initial_velocity, device);
}

}  // namespace zwidth
