#include "zwidth/control/sampled_controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "counted.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

bool is_at_least_zero(double value) { return std::isfinite(value) && value >= 0.0; }

const ControllerOptions& checked(const ControllerOptions& options, double sampling_period) {
  if (const auto problem = find_problem(options, sampling_period)) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("controller {} {}; {}", problem->member, problem->what, problem->allowed));
  }
  return options;
}

}  // namespace

ControllerOptions wall_controller(const Wall& wall) {
  ControllerOptions options;
  options.kind = ControllerOptions::Kind::wall;
  options.stiffness = wall.stiffness.value_or(0.0);
  options.damping = wall.damping;
  options.velocity_filter_hz = wall.velocity_filter_hz;
  options.filters = wall.filters;
  return options;
}

std::optional<OptionProblem> find_problem(const ControllerOptions& options, double sampling_period) {
  using enum ProblemCode;
  const auto problem = [](const char* member, ProblemCode code, double value, std::vector<Subject> subjects = {}) {
    return option_problem(
        member, {.code = code, .evidence = {{"value", value}, {"bound", 0.0}}, .subjects = std::move(subjects)});
  };
  if (!std::isfinite(options.position)) {
    return problem("position", not_finite, options.position, {{"in", "m or rad"}});
  }
  if (!is_at_least_zero(options.stiffness)) return problem("stiffness", negative, options.stiffness);
  if (!is_at_least_zero(options.damping)) return problem("damping", negative, options.damping);
  if (!is_at_least_zero(options.velocity_filter_hz)) {
    return problem("velocity_filter_hz", negative, options.velocity_filter_hz, {{"in", "Hz"}});
  }
  if (!is_at_least_zero(options.hysteresis)) {
    return problem("hysteresis", below_bound, options.hysteresis, {{"measure", "position"}});
  }
  const bool is_relay = options.kind == ControllerOptions::Kind::relay;
  if (!is_at_least_zero(options.amplitude) || (is_relay && options.amplitude == 0.0)) {
    return problem("amplitude", not_above, options.amplitude, {{"measure", "force"}});
  }
  if (options.filters.size() > max_wall_filters) {
    return option_problem("filters", {.code = too_many,
                                      .evidence = {internal::counted("value", options.filters.size()),
                                                   internal::counted("most", max_wall_filters)}});
  }
  for (const WallFilter& filter : options.filters) {
    if (const auto wrong = find_problem(filter, sampling_period)) {
      return option_problem("filters",
                            {.code = of_the_device, .subjects = {{"what", wrong->what}, {"allowed", wrong->allowed}}});
    }
  }
  return std::nullopt;
}

SampledController::SampledController(const ControllerOptions& options, double sampling_period)
    : options_(checked(options, sampling_period)), velocity_(options.velocity_filter_hz, sampling_period) {
  for (const WallFilter& filter : options.filters) {
    filters_[filter_count_++] = RunningFilter(filter_section(filter, sampling_period));
  }
}

void SampledController::reset() noexcept {
  velocity_.reset();
  relay_force_ = 0.0;
  for (std::size_t i = 0; i < filter_count_; ++i) filters_[i].reset();
}

double SampledController::wall_force(double measured) noexcept {
  const double beyond = measured - options_.position;
  const bool one_sided = options_.contact == ControllerOptions::Contact::unilateral;
  double force = -(options_.stiffness * beyond + options_.damping * velocity_.update(measured));
  if (one_sided && !(beyond > 0.0 && force < 0.0)) force = 0.0;
  for (std::size_t i = 0; i < filter_count_; ++i) force = filters_[i].update(force);
  return one_sided ? std::min(force, 0.0) : force;
}

double SampledController::relay_force(double measured) noexcept {
  const double beyond = measured - options_.position;
  if (beyond > options_.hysteresis) {
    relay_force_ = -options_.amplitude;
  } else if (beyond < -options_.hysteresis || relay_force_ == 0.0) {
    relay_force_ = options_.amplitude;
  }
  return relay_force_;
}

double SampledController::update(double measured) noexcept {
  switch (options_.kind) {
    case ControllerOptions::Kind::none:
      return 0.0;
    case ControllerOptions::Kind::wall:
      return wall_force(measured);
    case ControllerOptions::Kind::relay:
      return relay_force(measured);
  }
  return 0.0;
}

}  // namespace zwidth
