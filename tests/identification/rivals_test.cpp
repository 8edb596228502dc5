#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "identification/model/rivals/catalogue.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

constexpr double rivals_period = 1e-3;  // s

/// A motor and a handle at 30 Hz, rotary.
DeviceParameters motor_and_handle() {
  DeviceParameters device;
  device.name = "motor and handle";
  device.motion = Motion::rotary;
  device.bodies = {{"motor", 0.2, 0.6}, {"handle", 0.1, 0.1}};
  device.links = {{0, 1, 2400.0, 0.3}};
  device.loop = {0, 0, 1, rivals_period, 0.0};
  return device;
}

/// A force of three incommensurable lines, and a position of about their motion.
struct RivalsRecord {
  std::vector<double> force;
  std::vector<double> position;

  explicit RivalsRecord(std::size_t samples) {
    for (std::size_t k = 0; k < samples; ++k) {
      const double time = rivals_period * static_cast<double>(k);
      force.push_back(2.0 * std::sin(41.0 * time) + 1.1 * std::cos(97.0 * time + 0.4) + 0.7 * std::sin(263.0 * time));
      position.push_back(0.01 * std::sin(41.0 * time) + 0.002 * std::cos(97.0 * time));
    }
  }
  [[nodiscard]] ForceMotionRecord record() const { return {force, position, rivals_period}; }
};

/// The device's numbers, with the delay or without.
ModelParts numbers_of(const DeviceParameters& device, bool with_delay) {
  ModelParts parts;
  using Scale = Number::Scale;
  for (const Body& body : device.bodies) {
    parts.add({"body." + body.name + ".mass", Scale::logarithmic, body.mass, 0.0, deviation_of_logarithm});
    parts.add({"body." + body.name + ".damping", Scale::not_negative, body.damping});
  }
  parts.add({"link.0.stiffness", Scale::logarithmic, device.links[0].stiffness, 0.0, deviation_of_logarithm});
  parts.add({"link.0.damping", Scale::not_negative, device.links[0].damping});
  if (with_delay) parts.add({"loop.delay", Scale::not_negative, rivals_period});
  return parts;
}

MotionModel model_of(const DeviceParameters& device, const ModelParts& parts, const RivalsRecord& record, int steps) {
  return {DeviceFamily(device, parts.numbers, {}), parts.terms, {record.record()}, steps};
}

RivalSetting setting_of(const DeviceParameters& device, const RivalsRecord& record) {
  const std::vector<ForceMotionRecord> records = {record.record()};
  RivalSetting setting = rival_setting(device, {}, records);
  setting.frees_lag = true;
  return setting;
}

const Segment whole{0, 0, 150};

std::vector<Eigen::VectorXd> states_of(const MotionModel& model) {
  Eigen::VectorXd state = Eigen::VectorXd::Zero(model.states());
  state(0) = 0.3;
  const Eigen::Index bodies = model.states() / 2;
  state.tail(bodies).setConstant(0.4);
  return {state};
}

TEST(Rivals, CodesAndNumbersAreDistinct) {
  const RivalsRecord record(200);
  const DeviceParameters device = motor_and_handle();
  ModelParts parts = numbers_of(device, true);
  const std::vector<AddedRival> added = add_rivals(setting_of(device, record), parts);
  std::set<std::string_view> codes;
  for (const Rival& rival : rivals()) codes.insert(rival.code);
  EXPECT_EQ(codes.size(), rivals().size());
  EXPECT_EQ(added.size(), rivals().size());  // all apply to this device
  std::set<std::string> keys;
  for (const Number& number : parts.numbers) keys.insert(number.key);
  EXPECT_EQ(keys.size(), parts.numbers.size());
  for (const AddedRival& rival : added) {
    for (const std::string& key : rival.keys) EXPECT_TRUE(parts.has(key)) << key;
  }
  // those of the device first: 6 and its delay, lag and spring; its drifts behind them
  EXPECT_EQ(DeviceFamily(device, parts.numbers, {}).of_device(), 9);
  EXPECT_EQ(DeviceFamily(device, parts.numbers, {}).of_limit(), 11);
  for (std::size_t i = 9; i < parts.numbers.size(); ++i) EXPECT_FALSE(parameter(device, parts.numbers[i].key));
}

TEST(Rivals, SettingRulesSomeOut) {
  const RivalsRecord record(200);
  DeviceParameters device = motor_and_handle();
  device.motion = Motion::linear;
  device.bodies[1].stiffness = 3.0;
  RivalSetting setting = setting_of(device, record);
  setting.locked = {"handle"};
  setting.frees_lag = false;
  ModelParts parts = numbers_of(device, false);
  std::set<std::string_view> codes;
  for (const AddedRival& rival : add_rivals(setting, parts)) codes.insert(rival.code);
  for (const char* absent : {"ground_spring", "actuator_lag"}) {
    EXPECT_FALSE(codes.contains(absent)) << absent;
  }
  EXPECT_TRUE(parts.has("friction.motor"));
  EXPECT_FALSE(parts.has("friction.handle"));
  EXPECT_FALSE(codes.contains("link_friction"));  // the handle stands still: friction of the motor
}

/// All dampings fall to 0.9 and rise to 1.1 of their mean, the force comes up to 0.4 ms later or earlier, never before its time.
TEST(Rivals, DeviceDriftsWhileItIsRecorded) {
  const RivalsRecord record(200);
  DeviceParameters device = motor_and_handle();
  device.loop.delay = 0.3e-3;
  ModelParts parts = numbers_of(device, true);
  add_rivals(setting_of(device, record), parts);
  const DeviceFamily family(device, parts.numbers, {});
  Eigen::VectorXd x = family.coordinates_of(device);
  const auto set = [&](const char* key, double value) {
    const auto number = std::ranges::find(parts.numbers, key, &Number::key);
    x(number - parts.numbers.begin()) = number->coordinate(value);
  };
  set("actuator.time_constant", 0.0);
  set("damping_drift", 0.2);
  set("delay_drift", 0.4e-3);
  constexpr double no_lag = 2.1e-5;  // s: the least that the number can be is 20 us
  EXPECT_DOUBLE_EQ(family.device_at(x).bodies[0].damping, 0.6);
  EXPECT_DOUBLE_EQ(family.device_at(x, DriftInstants{}).bodies[0].damping, 0.6);
  EXPECT_NEAR(family.device_at(x, {0.0, 0.0}).loop.delay, 0.3e-3, no_lag);
  EXPECT_NEAR(family.device_at(x, {1.0, 1.0}).loop.delay, 0.7e-3, no_lag);
  for (const std::size_t body : {0U, 1U}) {
    const double damping = device.bodies[body].damping;
    EXPECT_DOUBLE_EQ(family.device_at(x, {0.0, 0.0}).bodies[body].damping, 0.9 * damping);
    EXPECT_DOUBLE_EQ(family.device_at(x, {1.0, 1.0}).bodies[body].damping, 1.1 * damping);
  }
  set("delay_drift", -0.4e-3);
  EXPECT_DOUBLE_EQ(family.device_at(x, {1.0, 1.0}).loop.delay, 0.0);
  EXPECT_GE(family.device_at(x, {1.0, 1.0}).actuator.time_constant, 0.0);
}

TEST(Rivals, PriorsAreOfTheRecord) {
  const RivalsRecord record(1000);
  const DeviceParameters device = motor_and_handle();
  const RivalSetting setting = setting_of(device, record);
  EXPECT_NEAR(setting.rms_force, std::sqrt((2.0 * 2.0 + 1.1 * 1.1 + 0.7 * 0.7) / 2.0), 0.05);
  EXPECT_NEAR(setting.rms_position, std::sqrt((0.01 * 0.01 + 0.002 * 0.002) / 2.0), 0.0003);
  EXPECT_NEAR(setting.rms_speed, std::sqrt((0.41 * 0.41 + 0.194 * 0.194) / 2.0),
              0.02);  // 1 % less by its reach of 5 periods
  EXPECT_DOUBLE_EQ(setting.duration, 1.0);
  EXPECT_DOUBLE_EQ(typical_damping(setting), 0.7);
  ModelParts parts = numbers_of(device, true);
  add_rivals(setting, parts);
  // one sigma, in units
  const auto sigma = [&](const std::string& key) {
    const Number& number = *std::ranges::find(parts.numbers, key, &Number::key);
    return number.unit * number.prior_deviation;
  };
  EXPECT_DOUBLE_EQ(sigma("friction.motor"), 0.1 * setting.rms_force);
  EXPECT_DOUBLE_EQ(sigma("link_friction.0"), 0.05 * setting.rms_force);
  EXPECT_DOUBLE_EQ(sigma("drag.motor") * setting.largest_speed, 0.7);
  EXPECT_DOUBLE_EQ(sigma("damping_drift"), 0.2);
  EXPECT_DOUBLE_EQ(sigma("delay_drift"), 1e-4);
  EXPECT_DOUBLE_EQ(sigma("stiffening.cube") * std::pow(setting.rms_position, 3), setting.rms_force);
  EXPECT_DOUBLE_EQ(sigma("presliding_length"), 1e-2 * setting.rms_position);
  EXPECT_DOUBLE_EQ(sigma("actuator.time_constant"), 2e-3);
  EXPECT_DOUBLE_EQ(sigma("body.handle.stiffness"), setting.rms_force / setting.rms_position);
  EXPECT_DOUBLE_EQ(sigma("saturation"), 0.1 * setting.rms_force);
  EXPECT_DOUBLE_EQ(sigma("dead_band"), 0.05 * setting.rms_force);
}

/// Saturation and dead band of a drive that is given one size of force act as another gain: no number of the fit.
TEST(Rivals, AForceOfOneSizeTellsNothingOfTheDrive) {
  const DeviceParameters device = motor_and_handle();
  const RivalsRecord smooth(1000);
  RivalsRecord square = smooth;
  for (double& force : square.force) force = std::copysign(2.0, force);
  square.force.front() = 0.0;
  for (const auto& [record, is_of_one_size] : {std::pair<const RivalsRecord*, bool>{&smooth, false}, {&square, true}}) {
    const std::vector<ForceMotionRecord> records = {record->record()};
    EXPECT_EQ(has_one_size(records), is_of_one_size);
    ModelParts parts = numbers_of(device, false);
    add_rivals(rival_setting(device, {}, records), parts);
    EXPECT_EQ(parts.has("saturation"), !is_of_one_size);
    EXPECT_EQ(parts.has("dead_band"), !is_of_one_size);
  }
  // A second record of another size tells.
  RivalsRecord half = square;
  for (double& force : half.force) force *= 0.5;
  const std::vector<ForceMotionRecord> both = {square.record(), half.record()};
  EXPECT_FALSE(has_one_size(both));
}

/// Of a link that is a damper: of its static stretch it would be 2e5 m.
TEST(Rivals, PreslidingOfALinkIsOfItsStretchFromTurnToTurn) {
  constexpr double pulse = 60.0;  // rad/s
  DeviceParameters device = motor_and_handle();
  device.bodies = {{"motor", 0.2, 1e-3}, {"handle", 0.1, 1e-3}};
  device.links = {{0, 1, 1e-6, 3.0}};
  std::vector<double> force;
  for (std::size_t k = 0; k < 8000; ++k)
    force.push_back(2.0 * std::sin(pulse * rivals_period * static_cast<double>(k)));
  const std::vector<ForceMotionRecord> records = {{force, force, rivals_period}};
  const RivalSetting setting = rival_setting(device, {}, records);
  const double speed = 2.0 / 0.2 / std::hypot(pulse, 3.0 * (1.0 / 0.2 + 1.0 / 0.1));  // of the stretch, amplitude
  ASSERT_EQ(setting.link_strokes.size(), 1U);
  EXPECT_NEAR(setting.link_strokes[0], speed / pulse / std::sqrt(2.0), 0.02 * speed / pulse);
  ModelParts parts = numbers_of(device, false);
  add_rivals(setting, parts);
  const Number& length = *std::ranges::find(parts.numbers, "link_presliding.0", &Number::key);
  EXPECT_DOUBLE_EQ(length.unit, 0.1 * setting.link_strokes[0]);
}

TEST(Rivals, PartialsOfForcesAreDifferences) {
  const RivalsRecord record(200);
  const DeviceParameters device = motor_and_handle();
  ModelParts parts = numbers_of(device, true);
  add_rivals(setting_of(device, record), parts);
  constexpr double step = 1e-6;
  constexpr double close = 1e-8;  // of forces of about 1: the difference's own error is 1e-10
  for (const ForceTerm& term : parts.terms.forces) {
    for (const double velocity : {0.7, -0.4}) {
      const LawState state{0.3, velocity, 0.8};
      std::vector<double> numbers(most_numbers_of_law, 0.0);
      for (std::size_t i = 0; i < term.numbers.size(); ++i) numbers[i] = 0.5 + 0.2 * static_cast<double>(i);
      const LawForce here = term.law(state, numbers.data());
      const auto difference = [&](auto&& changed) { return (changed(step) - changed(-step)) / (2.0 * step); };
      const auto by_position = difference([&](double by) {
        return term.law({state.position + by, state.velocity, state.share}, numbers.data()).force;
      });
      const auto by_velocity = difference([&](double by) {
        return term.law({state.position, state.velocity + by, state.share}, numbers.data()).force;
      });
      EXPECT_NEAR(here.by_position, by_position, close) << term.numbers[0];
      EXPECT_NEAR(here.by_velocity, by_velocity, close) << term.numbers[0];
      for (std::size_t i = 0; i < term.numbers.size(); ++i) {
        const auto by_number = difference([&](double by) {
          std::vector<double> moved = numbers;
          moved[i] += by;
          return term.law(state, moved.data()).force;
        });
        EXPECT_NEAR(here.by_number[i], by_number, close) << term.numbers[i];
      }
    }
  }
}

TEST(Rivals, NoneAtTheirNullValue) {
  const RivalsRecord record(200);
  const DeviceParameters device = motor_and_handle();
  const ModelParts alone = numbers_of(device, false);
  ModelParts parts = alone;
  RivalSetting setting = setting_of(device, record);
  setting.frees_lag = false;  // a lag is never quite 0 (Number::least_square)
  add_rivals(setting, parts);
  const MotionModel linear = model_of(device, alone, record, 1);
  const MotionModel full = model_of(device, parts, record, 4);
  Eigen::VectorXd x = full.family().coordinates_of(device);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (!parameter(device, parts.numbers[static_cast<std::size_t>(i)].key)) x(i) = 0.0;
  }
  const auto one = linear.play(linear.family().coordinates_of(device), {whole}, states_of(linear), false);
  const auto other = full.play(x, {whole}, states_of(full), false);
  ASSERT_TRUE(one && other);
  const Eigen::VectorXd& positions = one->front().positions;
  const double largest = positions.cwiseAbs().maxCoeff();
  EXPECT_GT(largest, 1e-3);
  EXPECT_LT((positions - other->front().positions).cwiseAbs().maxCoeff(), 1e-12 * largest);
}

/// Every rival at a size that matters; each changes the motion, by its derivatives.
TEST(Rivals, SlopesOfMotionAreDifferences) {
  const RivalsRecord record(200);
  const DeviceParameters device = motor_and_handle();
  for (const Rival& rival : rivals()) {
    SCOPED_TRACE(rival.code);
    ModelParts parts = numbers_of(device, true);
    const RivalSetting setting = setting_of(device, record);
    // what they bend
    if (rival.code == "presliding") coulomb_friction().add(setting, parts);
    if (rival.code == "link_presliding") link_friction().add(setting, parts);
    const std::size_t before = parts.numbers.size();
    rival.add(setting, parts);
    ASSERT_GT(parts.numbers.size(), before);
    std::vector<std::string> keys;
    for (std::size_t i = before; i < parts.numbers.size(); ++i) keys.push_back(parts.numbers[i].key);
    // alone, the numbers of the device come first as they are added
    const MotionModel model = model_of(device, parts, record, 4);
    Eigen::VectorXd x = model.family().coordinates_of(device);
    for (std::size_t i = 0; i < parts.numbers.size(); ++i) {
      const Number& number = parts.numbers[i];
      if (i >= before) x(static_cast<Eigen::Index>(i)) = number.scale == Number::Scale::logarithmic ? 0.1 : 0.23;
      if (number.key.starts_with("friction.") || number.key.starts_with("link_friction."))
        x(static_cast<Eigen::Index>(i)) = 0.23;
      if (number.key == "loop.delay") x(static_cast<Eigen::Index>(i)) = 2.37;  // beyond the lag of 0.96 ms
    }
    const std::vector<Eigen::VectorXd> states = states_of(model);
    const auto played = model.play(x, {whole}, states, true);
    ASSERT_TRUE(played);
    for (const std::string& key : keys) {
      SCOPED_TRACE(key);
      const auto place = std::ranges::find(parts.numbers, key, &Number::key) - parts.numbers.begin();
      constexpr double step = 1e-5;
      const auto moved = [&](double by) {
        Eigen::VectorXd at = x;
        at(place) += by;
        return model.play(at, {whole}, states, false)->front().positions;
      };
      const Eigen::VectorXd difference = (moved(step) - moved(-step)) / (2.0 * step);
      const double largest = difference.cwiseAbs().maxCoeff();
      EXPECT_GT(largest, 1e-8 * played->front().positions.cwiseAbs().maxCoeff());
      EXPECT_LT((played->front().slopes.col(place) - difference).cwiseAbs().maxCoeff(), 1e-4 * largest);
    }
  }
}

}  // namespace
}  // namespace zwidth::internal
