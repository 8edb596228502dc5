#include "identification/model/rivals/rival.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/model/linear_step.hpp"
#include "zwidth/identification/parameter_fit.hpp"

namespace zwidth::internal {
namespace {

/// The device whose bodies move.
Device recorded_device(const DeviceParameters& device, const std::vector<std::string>& locked) {
  DeviceParameters parameters = device;
  parameters.uncertainty.reset();
  const Device all(std::move(parameters));
  std::vector<std::size_t> still;
  still.reserve(locked.size());
  for (const std::string& name : locked) still.push_back(all.body_index(name));
  return locked_device(all, still);
}

/// A row per link: its speed by the motion's state; zeros where one of its bodies stands still.
Eigen::MatrixXd speeds_of_links(const DeviceParameters& device, const Device& moving, Eigen::Index states) {
  const auto links = static_cast<Eigen::Index>(device.links.size());
  const auto bodies = static_cast<Eigen::Index>(moving.bodies().size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(links, states);
  for (Eigen::Index i = 0; i < links; ++i) {
    const Link& link = device.links[static_cast<std::size_t>(i)];
    for (const auto& [body, sign] : {std::pair(link.second, 1.0), std::pair(link.first, -1.0)}) {
      const auto at = std::ranges::find(moving.bodies(), device.bodies[body].name, &Body::name);
      if (at != moving.bodies().end()) rows(i, bodies + (at - moving.bodies().begin())) = sign;
    }
    if (rows.row(i).sum() != 0.0) rows.row(i).setZero();
  }
  return rows;
}

std::vector<double> link_strokes(const DeviceParameters& device, const Device& moving,
                                 std::span<const ForceMotionRecord> records) {
  const Eigen::MatrixXd columns = motion_columns(moving);
  const Eigen::Index states = columns.rows();
  const Eigen::MatrixXd of_state = speeds_of_links(device, moving, states);
  Eigen::ArrayXd speeds = Eigen::ArrayXd::Zero(of_state.rows());
  Eigen::ArrayXd accelerations = speeds;
  double samples = 0.0;
  for (const ForceMotionRecord& record : records) {
    const LinearStep step = linear_step(columns, {}, record.sampling_period);
    Eigen::VectorXd state = Eigen::VectorXd::Zero(states);
    Eigen::ArrayXd before = Eigen::ArrayXd::Zero(of_state.rows());
    for (const double force : record.force) {
      state = (step.columns.leftCols(states) * state + step.columns.col(states) * force).eval();
      const Eigen::ArrayXd now = of_state * state;
      speeds += now.square();
      accelerations += ((now - before) / step.length).square();
      before = now;
    }
    samples += static_cast<double>(record.force.size());
  }
  std::vector<double> strokes;
  for (Eigen::Index i = 0; i < of_state.rows(); ++i)
    strokes.push_back(accelerations(i) > 0.0 ? speeds(i) / std::sqrt(accelerations(i) * samples) : 0.0);
  return strokes;
}

}  // namespace

RivalSetting rival_setting(const DeviceParameters& device, const std::vector<std::string>& locked,
                           std::span<const ForceMotionRecord> records) {
  constexpr std::size_t reach = 5;
  RivalSetting setting{
      .device = device, .locked = locked, .records = records.size(), .has_one_size = has_one_size(records)};
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
  if (!device.links.empty()) setting.link_strokes = link_strokes(device, recorded_device(device, locked), records);
  return setting;
}

bool has_one_size(std::span<const ForceMotionRecord> records) {
  constexpr double near = 0.05;  // of the largest
  constexpr double few = 0.01;   // of all samples
  double largest = 0.0;
  for (const ForceMotionRecord& record : records) {
    for (const double force : record.force) largest = std::max(largest, std::abs(force));
  }
  double others = 0.0;
  double samples = 0.0;
  for (const ForceMotionRecord& record : records) {
    for (const double force : record.force) {
      const double size = std::abs(force) / largest;
      if (size > near && size < 1.0 - near) others += 1.0;
    }
    samples += static_cast<double>(record.force.size());
  }
  return others <= few * samples;
}

double typical_damping(const RivalSetting& setting) {
  constexpr double least = 0.02;
  double damping = 0.0;
  for (const Body& body : setting.device.bodies) damping += body.damping;
  return std::max(damping, least * setting.rms_force / setting.rms_speed);
}

std::vector<std::string> moving_bodies_of(const RivalSetting& setting) {
  std::vector<std::string> names;
  const Device recorded = recorded_device(setting.device, setting.locked);
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
