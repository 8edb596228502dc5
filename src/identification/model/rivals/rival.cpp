#include "identification/model/rivals/rival.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "zwidth/identification/parameter_fit.hpp"

namespace zwidth::internal {

RivalSetting rival_setting(const DeviceParameters& device, const std::vector<std::string>& locked,
                           std::span<const ForceMotionRecord> records) {
  constexpr std::size_t reach = 5;
  RivalSetting setting{.device = device, .locked = locked, .records = records.size()};
  const auto rms = [](double squares, std::size_t count) { return std::sqrt(squares / static_cast<double>(count)); };
  for (const ForceMotionRecord& record : records) {
    double force_squares = 0.0;
    for (const double force : record.force) force_squares += force * force;
    const std::size_t count = record.position.size();
    double mean = 0.0;
    for (const double position : record.position) mean += position / static_cast<double>(count);
    double position_squares = 0.0;
    double speed_squares = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      position_squares += std::pow(record.position[k] - mean, 2);
      if (k < reach) continue;
      const double speed = (record.position[k] - record.position[k - reach]) / (reach * record.sampling_period);
      speed_squares += speed * speed;
      setting.largest_speed = std::max(setting.largest_speed, std::abs(speed));
    }
    setting.rms_force = std::max(setting.rms_force, rms(force_squares, record.force.size()));
    setting.rms_position = std::max(setting.rms_position, rms(position_squares, count));
    setting.rms_speed = std::max(setting.rms_speed, rms(speed_squares, count - reach));
    setting.duration = std::max(setting.duration, static_cast<double>(count) * record.sampling_period);
    setting.sampling_period = record.sampling_period;
  }
  return setting;
}

double typical_damping(const RivalSetting& setting) {
  constexpr double least = 0.02;
  double damping = 0.0;
  for (const Body& body : setting.device.bodies) damping += body.damping;
  return std::max(damping, least * setting.rms_force / setting.rms_speed);
}

std::vector<std::string> moving_bodies_of(const RivalSetting& setting) {
  DeviceParameters parameters = setting.device;
  parameters.uncertainty.reset();
  const Device device(std::move(parameters));
  std::vector<std::size_t> still;
  for (const std::string& name : setting.locked) still.push_back(device.body_index(name));
  std::vector<std::string> names;
  const Device recorded = locked_device(device, still);
  for (const Body& body : recorded.bodies()) names.push_back(body.name);
  return names;
}

std::optional<std::string> moving_held_body(const RivalSetting& setting) {
  const std::string& held = setting.device.bodies[setting.device.loop.held].name;
  const std::vector<std::string> moving = moving_bodies_of(setting);
  return std::ranges::find(moving, held) == moving.end() ? std::nullopt : std::optional(held);
}

double typical_stiffness(const RivalSetting& setting) { return setting.rms_force / setting.rms_position; }

const std::string& actuated_body(const RivalSetting& setting) {
  return setting.device.bodies[setting.device.loop.actuated].name;
}

bool ModelParts::has(std::string_view key) const {
  return std::ranges::find(numbers, key, &Number::key) != numbers.end();
}

std::string ModelParts::add(Number number) {
  numbers.push_back(std::move(number));
  return numbers.back().key;
}

}  // namespace zwidth::internal
