#include "zwidth/control/sampled_controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

void require(bool holds, const char* what, double value) {
  if (!holds) throw Error(ErrorCode::invalid_argument, std::string(what) + " is " + fmt::format("{}", value));
}

void require_at_least_zero(const char* what, double value) {
  require(std::isfinite(value) && value >= 0.0, what, value);
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

SampledController::SampledController(const ControllerOptions& options, double sampling_period)
    : options_(options), rate_(1.0 / sampling_period) {
  require(std::isfinite(sampling_period) && sampling_period > 0.0, "sampling period", sampling_period);
  require(std::isfinite(options.position), "controller position", options.position);
  require_at_least_zero("wall stiffness", options.stiffness);
  require_at_least_zero("wall damping", options.damping);
  require_at_least_zero("velocity filter", options.velocity_filter_hz);
  require_at_least_zero("relay hysteresis", options.hysteresis);
  require_at_least_zero("relay amplitude", options.amplitude);
  require(options.kind != ControllerOptions::Kind::relay || options.amplitude > 0.0, "relay amplitude",
          options.amplitude);
  if (options.velocity_filter_hz > 0.0) {
    filter_ = std::exp(-2.0 * std::numbers::pi * options.velocity_filter_hz * sampling_period);
  }
  require(options.filters.size() <= max_wall_filters, "number of wall filters",
          static_cast<double>(options.filters.size()));
  for (const WallFilter& filter : options.filters) {
    filters_[filter_count_++] = RunningFilter(filter_section(filter, sampling_period));
  }
}

void SampledController::reset() noexcept {
  started_ = false;
  velocity_ = 0.0;
  relay_force_ = 0.0;
  for (std::size_t i = 0; i < filter_count_; ++i) filters_[i].reset();
}

double SampledController::wall_force(double measured) noexcept {
  const double beyond = measured - options_.position;
  if (!started_) previous_ = measured;
  started_ = true;
  velocity_ = filter_ * velocity_ + (1.0 - filter_) * rate_ * (measured - previous_);
  previous_ = measured;
  const bool one_sided = options_.contact == ControllerOptions::Contact::unilateral;
  double force = -(options_.stiffness * beyond + options_.damping * velocity_);
  if (one_sided && !(beyond > 0.0 && force < 0.0)) force = 0.0;
  for (std::size_t i = 0; i < filter_count_; ++i) force = filters_[i].update(force);
  return one_sided ? std::min(force, 0.0) : force;
}

double SampledController::update(double measured) noexcept {
  const double beyond = measured - options_.position;
  switch (options_.kind) {
    case ControllerOptions::Kind::none:
      return 0.0;
    case ControllerOptions::Kind::wall:
      return wall_force(measured);
    case ControllerOptions::Kind::relay:
      if (beyond > options_.hysteresis) {
        relay_force_ = -options_.amplitude;
      } else if (beyond < -options_.hysteresis || relay_force_ == 0.0) {
        relay_force_ = options_.amplitude;
      }
      return relay_force_;
  }
  return 0.0;
}

}  // namespace zwidth
