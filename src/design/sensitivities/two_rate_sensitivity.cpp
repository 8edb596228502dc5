#include "design/sensitivities/two_rate_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "design/region/two_rate_curve.hpp"
#include "design/sensitivities/agreeing_difference.hpp"
#include "design/sensitivities/design_parameter.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/two_rate_users.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

constexpr double same_crossover_stiffness = 1e-6;  // relative
constexpr double near_unit_circle_ends = 1e-7;     // rad: a real pole, whose angle stays

class LimitOfTwoRates {
 public:
  LimitOfTwoRates(const Device& device, TwoRateCurve::Node limit) : parameters_(device.parameters()), limit_(limit) {
    parameters_.uncertainty.reset();
  }

  // g + 1/(C_out P) of the device with that number.
  [[nodiscard]] std::complex<double> with(const DesignParameter& number, double step) const {
    DeviceParameters moved = parameters_;
    set_with_ratio(moved, number.key, number.value + step);
    const double damping = moved.wall.damping;
    const TwoRateCurve curve{Device(std::move(moved))};
    return at(curve, limit_.angle, {limit_.wall.stiffness, damping});
  }

  [[nodiscard]] static std::complex<double> at(const TwoRateCurve& curve, double angle, const WallPoint& wall) {
    return curve.outside(wall) +
           std::complex<double>(-curve.gain(angle, curve.inside(wall)), curve.phase(angle, curve.inside(wall)));
  }

  [[nodiscard]] DifferenceStep step_of(const DesignParameter& number) const {
    const double frequency = limit_.angle / parameters_.loop.sampling_period;
    return difference_step(number, parameters_, limit_.wall.stiffness, frequency);
  }

 private:
  DeviceParameters parameters_;
  TwoRateCurve::Node limit_;
};

}  // namespace

std::vector<DesignParameter> numbers_of_two_rates(const Device& device) {
  std::vector<DesignParameter> numbers = design_parameters(device);
  const auto delay =
      std::ranges::find(numbers, DesignParameter::Kind::delay, [](const DesignParameter& each) { return each.kind; });
  const std::optional<LoopDamper>& damper = device.loop().damper;
  if (damper && damper->delay) {
    numbers.insert(delay + 1, {DesignParameter::Kind::delay, 0, "loop.damper.delay", *damper->delay});
  }
  return numbers;
}

void set_with_ratio(DeviceParameters& parameters, std::string_view key, double value) {
  std::optional<LoopDamper>& damper = parameters.loop.damper;
  if (without_alias(key) == "loop.sampling_period" && damper && damper->sampling_period) {
    *damper->sampling_period *= value / parameters.loop.sampling_period;
  }
  set_parameter(parameters, key, value);
}

std::vector<Sensitivity> two_rate_sensitivities(const Device& device, const Crossover& limit) {
  TwoRateCurve curve(device);
  const double damping = device.parameters().wall.damping;
  const double angle = std::abs(std::remainder(limit.frequency * curve.period(), 2.0 * std::numbers::pi));
  const double fast_nyquist = curve.unreached_angle() / curve.period();
  // The slower part does not move that pole: the limit of the spring alone.
  if (!curve.is_damper_inside() && curve.unreached_gain() && limit.frequency > fast_nyquist * (1.0 - 1e-9)) {
    DeviceParameters alone = with_one_rate(device).parameters();
    alone.wall.damping = 0.0;
    std::vector<Sensitivity> result = stiffness_sensitivities(Device(std::move(alone)));
    std::erase_if(result, [](const Sensitivity& each) { return each.key == "wall.damping"; });
    return result;
  }
  const bool is_real = angle < near_unit_circle_ends || angle > std::numbers::pi - near_unit_circle_ends;
  TwoRateCurve::Node node{is_real && angle > 1.0 ? std::numbers::pi : angle, {limit.stiffness, damping}};
  curve.scales = {1.0, limit.stiffness, damping};
  if (!is_real) {
    const auto polished = curve.solve(node, Eigen::Vector3d::UnitZ());
    if (!polished) return {};
    if (std::abs(polished->wall.stiffness - limit.stiffness) > same_crossover_stiffness * limit.stiffness) {
      throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::other_devices_limit});
    }
    node = *polished;
  }
  const LimitOfTwoRates loop(device, node);
  const auto by_stiffness = agreeing_derivative(
      [&](double step) {
        return LimitOfTwoRates::at(curve, node.angle, {node.wall.stiffness + step, damping});
      },
      {node.wall.stiffness});
  const auto by_angle =
      is_real
          ? std::optional(std::complex<double>(0.0, 1.0))
          : agreeing_derivative([&](double step) { return LimitOfTwoRates::at(curve, node.angle + step, node.wall); },
                                {std::min(node.angle, std::numbers::pi - node.angle)});
  if (!by_stiffness || !by_angle) return {};
  std::vector<Sensitivity> result;
  for (const DesignParameter& number : numbers_of_two_rates(device)) {
    const auto slope = agreeing_derivative([&](double step) { return loop.with(number, step); }, loop.step_of(number));
    if (!slope) continue;
    // Cramer's rule.
    const double determinant = by_stiffness->real() * by_angle->imag() - by_stiffness->imag() * by_angle->real();
    const double by_number = (slope->imag() * by_angle->real() - slope->real() * by_angle->imag()) / determinant;
    if (!std::isfinite(by_number)) continue;
    const double value = number.value;
    result.push_back({number.key, value, by_number,
                      value != 0.0 ? std::optional(value / limit.stiffness * by_number) : std::nullopt});
  }
  return result;
}

std::vector<Sensitivity> two_rate_users_sensitivities(const Device& device, const AbsoluteStabilityLimit& limit) {
  const Device free = device_without_user(device);
  const DeviceParameters& parameters = free.parameters();
  const double angle = std::min(limit.frequency * parameters.loop.sampling_period, std::numbers::pi);
  if (angle == 0.0) return {};
  const LimitOfTwoRates loop(free, {angle, {limit.stiffness, parameters.wall.damping}});
  std::vector<Sensitivity> result;
  for (const DesignParameter& number : numbers_of_two_rates(free)) {
    if (number.key.starts_with("operator.")) continue;
    const auto moved_by = [&](double step) {
      DeviceParameters moved = parameters;
      moved.uncertainty.reset();
      set_with_ratio(moved, number.key, number.value + step);
      return moved;
    };
    const DifferenceStep size = loop.step_of(number);
    if (!knows_all_users(moved_by(widest_difference * size.unit).loop)) continue;
    const auto slope = agreeing_derivative(
        [&](double step) { return std::complex<double>(two_rate_limit_at(Device(moved_by(step)), angle)); }, size);
    if (!slope || !std::isfinite(slope->real())) continue;
    const double value = number.value;
    result.push_back({number.key, value, slope->real(),
                      value != 0.0 ? std::optional(value / limit.stiffness * slope->real()) : std::nullopt});
  }
  return result;
}

}  // namespace zwidth::internal
