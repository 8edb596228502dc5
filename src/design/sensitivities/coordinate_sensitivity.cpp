#include "design/sensitivities/coordinate_sensitivity.hpp"

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>

#include "design/sensitivities/agreeing_difference.hpp"
#include "design/sensitivities/design_parameter.hpp"
#include "stability/loop/damper_response.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth::internal {
namespace {

constexpr double same_limit_of_coordinates = 1e-6;  // relative, of a crossover handed in and the loop's own K there

// L = -1/(F P) - B v, of which K is the value where it is real.
std::complex<double> stiffness_at_angle(const Device& device, double angle) {
  const double period = device.loop().sampling_period;
  return -1.0 / response(filtered_plant(device), angle / period) -
         damper_response(virtual_damper(device), period, angle / period);
}

Device with_number(const DeviceParameters& parameters, const DesignParameter& number, double step) {
  DeviceParameters moved = parameters;
  set_parameter(moved, number.key, number.value + step);
  return Device(std::move(moved));
}

// A share of an angle says nothing.
std::optional<double> relative_slope(const DesignParameter& number, double slope, double limit) {
  if (number.value == 0.0 || number.kind == DesignParameter::Kind::joint_position) return std::nullopt;
  return number.value / limit * slope;
}

// What a step leads to that is no device, as a pose that a loop does not reach, leaves the number out.
template <typename Function>
std::optional<std::complex<double>> derivative_where_possible(const Function& value, DifferenceStep step) {
  try {
    return agreeing_derivative(value, step);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::invalid_argument) throw;
    return std::nullopt;
  }
}

DeviceParameters certain_parameters(const Device& device) {
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty.reset();
  return parameters;
}

}  // namespace

std::vector<Sensitivity> coordinate_sensitivities(const Device& device, const Crossover& limit) {
  const DeviceParameters parameters = certain_parameters(device);
  const double nyquist = std::numbers::pi / parameters.loop.sampling_period;
  const bool is_real = limit.frequency == 0.0 || limit.frequency >= nyquist;  // z = 1 or -1: the angle stays
  const double angle =
      limit.frequency >= nyquist ? std::numbers::pi : limit.frequency * parameters.loop.sampling_period;
  const std::complex<double> here = stiffness_at_angle(device, angle);
  if (!(std::abs(here.real() - limit.stiffness) <= same_limit_of_coordinates * (limit.stiffness + std::abs(here)))) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::other_devices_limit});
  }
  double along = 0.0;
  if (!is_real) {
    const auto by_angle = agreeing_derivative([&](double step) { return stiffness_at_angle(device, angle + step); },
                                              {std::min(angle, std::numbers::pi - angle)});
    if (!by_angle) return {};
    along = by_angle->real() / by_angle->imag();
  }
  std::vector<Sensitivity> result;
  for (const DesignParameter& number : design_parameters(device)) {
    const auto by_number = derivative_where_possible(
        [&](double step) { return stiffness_at_angle(with_number(parameters, number, step), angle); },
        difference_step(number, parameters, limit.stiffness, limit.frequency));
    if (!by_number) continue;
    const double slope = by_number->real() - along * by_number->imag();
    if (!std::isfinite(slope)) continue;
    result.push_back({number.key, number.value, slope, relative_slope(number, slope, limit.stiffness)});
  }
  return result;
}

std::vector<Sensitivity> any_grasp_sensitivities(const Device& device, const AbsoluteStabilityLimit& limit) {
  if (!(limit.stiffness > 0.0) || !std::isfinite(limit.stiffness)) return {};
  const Device free = device_without_user(device);
  if (limit.needs_no_user) {
    std::vector<Sensitivity> slopes = stiffness_sensitivities(free);
    std::erase_if(slopes, [](const Sensitivity& each) { return each.key.starts_with("operator."); });
    return slopes;
  }
  const DeviceParameters parameters = certain_parameters(free);
  const auto limit_of = [&](const Device& moved) {
    return std::complex<double>(absolute_stability_limit(moved, virtual_damper(moved)).stiffness);
  };
  std::vector<Sensitivity> result;
  for (const DesignParameter& number : design_parameters(free)) {
    if (number.key.starts_with("operator.")) continue;
    const auto slope =
        derivative_where_possible([&](double step) { return limit_of(with_number(parameters, number, step)); },
                                  difference_step(number, parameters, limit.stiffness, limit.frequency));
    if (!slope || !std::isfinite(slope->real())) continue;
    result.push_back({number.key, number.value, slope->real(), relative_slope(number, slope->real(), limit.stiffness)});
  }
  return result;
}

}  // namespace zwidth::internal
