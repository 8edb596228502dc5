#include "identification/search_starts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/model/number_keys.hpp"
#include "model/loop_keys.hpp"

namespace zwidth::internal {

Eigen::VectorXd with_friction_and_lag(Eigen::VectorXd x, const MotionModel& model, const std::string& body,
                                      double share) {
  constexpr double damping_beside = 0.3;  // of the linear fit's, which has the friction in it
  constexpr double of_lateness = 0.5;
  double lateness = 0.0;
  for (std::size_t i = 0; i < model.numbers().size(); ++i) {
    const Number& number = model.numbers()[i];
    const auto at = static_cast<Eigen::Index>(i);
    if (number.key == friction_key(body)) x(at) = share;
    if (number.key.starts_with("body.") && number.key.ends_with(".damping")) x(at) *= damping_beside;
    if (number.key == key_of_delay) lateness = number.value(x(at));  // lag and all
  }
  for (std::size_t i = 0; i < model.numbers().size(); ++i) {
    const Number& number = model.numbers()[i];
    if (number.key == key_of_lag) x(static_cast<Eigen::Index>(i)) = number.coordinate(of_lateness * lateness);
  }
  return x;
}

std::optional<Eigen::VectorXd> with_link_frictions(Eigen::VectorXd x, const MotionModel& model) {
  constexpr double share = 0.2;  // of the force
  constexpr double damping_beside = 0.5;
  const DeviceParameters device = model.family().device_at(x);
  const auto rings = [&](const Link& link) {
    const double first = device.bodies[link.first].mass;
    const double second = device.bodies[link.second].mass;
    constexpr double least_quality = 2.0;
    return link.stiffness * first * second / (first + second) > std::pow(least_quality * link.damping, 2);
  };
  const auto element = [&](const std::string& key) {
    const auto number = std::ranges::find(model.numbers(), key, &Number::key);
    return number == model.numbers().end() ? nullptr : &x(number - model.numbers().begin());
  };
  bool has_any = false;
  for (std::size_t i = 0; i < device.links.size(); ++i) {
    double* const friction = element(link_friction_key(i));
    double* const damping = element("link." + std::to_string(i) + ".damping");
    if (friction == nullptr || damping == nullptr || rings(device.links[i])) continue;
    *friction = share;
    *damping *= damping_beside;
    has_any = true;
  }
  return has_any ? std::optional(std::move(x)) : std::nullopt;
}

Eigen::VectorXd without_forces(Eigen::VectorXd z, const MotionModel& model, const Eigen::VectorXd& linear) {
  for (Eigen::Index i = model.family().of_device(); i < linear.size(); ++i) {
    if (model.numbers()[static_cast<std::size_t>(i)].scale == Number::Scale::any) z(i) = linear(i);
  }
  return z;
}

Eigen::VectorXd of_known(const DeviceParameters& device, const DeviceFamily& family) {
  Eigen::VectorXd x = family.coordinates_of(device);
  x.tail(x.size() - family.of_device()).setZero();
  for (const Body& body : device.bodies) {
    const auto place = std::ranges::find(family.numbers(), friction_key(body.name), &Number::key);
    if (place != family.numbers().end()) x(place - family.numbers().begin()) = place->coordinate(body.coulomb);
  }
  return x;
}

}  // namespace zwidth::internal
