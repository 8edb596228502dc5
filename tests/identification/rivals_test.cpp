#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "identification/model/friction_step.hpp"
#include "identification/model/presliding_step.hpp"
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
  return {DeviceFamily(device, parts.numbers, {}, parts.further_body), parts.terms, {record.record()}, steps};
}

RivalSetting setting_of(const DeviceParameters& device, const RivalsRecord& record) {
  const std::vector<ForceMotionRecord> records = {record.record()};
  constexpr double highest = 60.0;
  RivalSetting setting = rival_setting(device, {}, records, highest);
  setting.frees_lag = true;
  setting.cogging_per_turn = 14.0;
  return setting;
}

/// The catalogue, and what is written but not yet in it.
std::vector<Rival> all_rivals() {
  std::vector<Rival> all(rivals().begin(), rivals().end());
  all.push_back(further_body());
  return all;
}

void add_all(const RivalSetting& setting, ModelParts& parts) {
  further_body().add(setting, parts);  // its numbers belong among the device's, which add_rivals() puts first
  add_rivals(setting, parts);
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
  for (const Rival& rival : all_rivals()) codes.insert(rival.code);
  EXPECT_EQ(codes.size(), all_rivals().size());
  EXPECT_EQ(added.size(), rivals().size());  // all apply to this device
  std::set<std::string> keys;
  for (const Number& number : parts.numbers) keys.insert(number.key);
  EXPECT_EQ(keys.size(), parts.numbers.size());
  for (const AddedRival& rival : added) {
    for (const std::string& key : rival.keys) EXPECT_TRUE(parts.has(key)) << key;
  }
  // those of the device first: 6 and its delay, lag and spring; three of a further body; its drifts behind them
  EXPECT_EQ(DeviceFamily(device, parts.numbers, {}).of_device(), 9);
  EXPECT_EQ(DeviceFamily(device, parts.numbers, {}).of_limit(), 11);
  ModelParts more = numbers_of(device, true);
  add_all(setting_of(device, record), more);
  const DeviceFamily family(device, more.numbers, {}, more.further_body);
  EXPECT_EQ(family.of_device(), 12);
  for (std::size_t i = 12; i < more.numbers.size(); ++i) EXPECT_FALSE(parameter(device, more.numbers[i].key));
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
  further_body().add(setting, parts);
  EXPECT_FALSE(parts.further_body);
  for (const char* absent : {"cogging", "ground_spring", "actuator_lag"}) {
    EXPECT_FALSE(codes.contains(absent)) << absent;
  }
  EXPECT_TRUE(parts.has("friction.motor"));
  EXPECT_FALSE(parts.has("friction.handle"));
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
  EXPECT_DOUBLE_EQ(family.device_at(x, 0.5).bodies[0].damping, 0.6);
  EXPECT_NEAR(family.device_at(x, 0.0).loop.delay, 0.3e-3, no_lag);
  EXPECT_NEAR(family.device_at(x, 1.0).loop.delay, 0.7e-3, no_lag);
  for (const std::size_t body : {0U, 1U}) {
    const double damping = device.bodies[body].damping;
    EXPECT_DOUBLE_EQ(family.device_at(x, 0.0).bodies[body].damping, 0.9 * damping);
    EXPECT_DOUBLE_EQ(family.device_at(x, 1.0).bodies[body].damping, 1.1 * damping);
  }
  set("delay_drift", -0.4e-3);
  EXPECT_DOUBLE_EQ(family.device_at(x, 1.0).loop.delay, 0.0);
  EXPECT_GE(family.device_at(x, 1.0).actuator.time_constant, 0.0);
}

/// A body of 0.2 on friction of 0.05 and a spring of 0.05 / 2e-3 until it slides, pushed with 0.03: it swings about 1.2e-3 and
/// loses what Dahl's law says. A Runge-Kutta integration with steps of 1 us is the judge.
TEST(Rivals, FrictionBendsBeforeItSlides) {
  constexpr double limit = 0.05;
  constexpr double length = 2e-3;
  constexpr double mass = 0.2;
  constexpr double duration = 2.5e-4;
  constexpr double push = 0.045;
  double velocity = 0.0;
  double bend = 0.0;
  double exact_velocity = 0.0;
  double exact_bend = 0.0;
  double largest = 0.0;
  double furthest = 0.0;
  for (int step = 0; step < 4000; ++step) {
    const double force = step < 2000 ? push : -push;
    const PreslidingStep next =
        presliding_step(velocity, velocity + force * duration / mass, limit, duration / mass, bend, length, duration);
    velocity = next.velocity.value;
    bend = next.bend.value;
    constexpr int fine = 250;
    constexpr double h = duration / fine;
    for (int i = 0; i < fine; ++i) {
      const auto change = [&](double v, double z) {
        return std::pair((force - limit * z) / mass, (v - std::abs(v) * z) / length);
      };
      const auto [a1, b1] = change(exact_velocity, exact_bend);
      const auto [a2, b2] = change(exact_velocity + 0.5 * h * a1, exact_bend + 0.5 * h * b1);
      exact_velocity += h * a2;
      exact_bend += h * b2;
    }
    largest = std::max(largest, std::abs(exact_velocity));
    furthest = std::max(furthest, std::abs(velocity - exact_velocity));
  }
  EXPECT_GT(largest, 1e-3);
  EXPECT_LT(furthest, 1e-3 * largest);
}

/// With a presliding length far below all motion it is Coulomb's friction, and slides for ever.
TEST(Rivals, ShortPreslidingIsCoulombs) {
  constexpr double limit = 0.3;
  constexpr double compliance = 1e-3;
  constexpr double duration = 1e-3;
  constexpr double length = 1e-12;
  const auto last = [&](double before, double free, double bend) {
    return presliding_step(before, free, limit, compliance, bend, length, duration).velocity.value;
  };
  EXPECT_NEAR(last(0.01, 0.012, 1.0), friction_step(0.01, 0.012, limit, compliance).velocity, 1e-9);
  EXPECT_NEAR(last(-0.01, -0.012, -1.0), friction_step(-0.01, -0.012, limit, compliance).velocity, 1e-9);
  EXPECT_NEAR(last(0.0, 0.0002, 0.5), 0.0, 1e-8);
  EXPECT_NEAR(last(0.0001, 0.0002, 1.0), 0.0, 1e-8);
  // it turns round within the step: a part of eight is the error
  EXPECT_NEAR(last(0.0001, -0.0009, 1.0), friction_step(0.0001, -0.0009, limit, compliance).velocity,
              2.0 * limit * compliance / 8.0);
}

TEST(Rivals, SlopesOfPreslidingAreDifferences) {
  struct Case {
    double before, free, bend;
  };
  for (const Case& each : {Case{0.02, 0.025, 0.3}, Case{0.02, 0.025, -0.9}, Case{-0.01, 0.012, -0.7},
                           Case{0.0004, -0.0007, 0.98}, Case{-0.02, -0.021, -1.0}}) {
    std::array<double, 6> at = {each.before, each.free, 0.3, 1e-3, each.bend, 2e-5};
    const auto step = [](const std::array<double, 6>& p) {
      return presliding_step(p[0], p[1], p[2], p[3], p[4], p[5], 1e-3);
    };
    const PreslidingStep here = step(at);
    const auto slopes = [](const PreslidingStep::End& end) {
      return std::array{end.by_before, end.by_free, end.by_limit, end.by_compliance, end.by_bend, end.by_length};
    };
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (std::abs(each.bend) == 1.0 && i == 4) continue;  // the bound
      const double by = 1e-6 * std::abs(at[i]);
      std::array<double, 6> above = at;
      std::array<double, 6> below = at;
      above[i] += by;
      below[i] -= by;
      const PreslidingStep high = step(above);
      const PreslidingStep low = step(below);
      const double velocity = (high.velocity.value - low.velocity.value) / (2.0 * by);
      const double bend = (high.bend.value - low.bend.value) / (2.0 * by);
      EXPECT_NEAR(slopes(here.velocity)[i], velocity, 1e-5 * (std::abs(velocity) + 1e-5 / std::abs(at[i]))) << i;
      EXPECT_NEAR(slopes(here.bend)[i], bend, 1e-5 * (std::abs(bend) + 1e-2 / std::abs(at[i]))) << i;
    }
  }
}

/// A further body takes its mass from the one it hangs on, and is none for a limit where it is next to none.
TEST(Rivals, FurtherBodyKeepsTheMass) {
  const RivalsRecord record(200);
  const DeviceParameters device = motor_and_handle();
  ModelParts parts = numbers_of(device, false);
  further_body().add(setting_of(device, record), parts);
  const DeviceFamily family(device, parts.numbers, {}, parts.further_body);
  Eigen::VectorXd x = family.coordinates_of(device);
  const Eigen::Index ratio =
      std::ranges::find(parts.numbers, parts.further_body->mass_ratio, &Number::key) - parts.numbers.begin();
  x(ratio) = 0.25;
  const DeviceParameters with = family.device_at(x);
  ASSERT_EQ(with.bodies.size(), 3U);
  EXPECT_DOUBLE_EQ(with.bodies[1].mass, 0.08);
  EXPECT_DOUBLE_EQ(with.bodies[2].mass, 0.02);
  constexpr double frequency = 180.0;  // Hz: three times the highest
  EXPECT_DOUBLE_EQ(std::sqrt(with.links[1].stiffness / 0.02), 2.0 * std::numbers::pi * frequency);
  EXPECT_DOUBLE_EQ(with.links[1].damping / (2.0 * std::sqrt(with.links[1].stiffness * 0.02)), 0.01);
  EXPECT_EQ(with.links[1].first, 1U);
  x(ratio) = 0.0;
  EXPECT_EQ(family.device_at(x).bodies.size(), 2U);
  EXPECT_TRUE(family.has_device_at(x));
  x(ratio + 2) = -80.0;  // a damping below all bounds: no device, and nothing throws
  EXPECT_FALSE(family.has_device_at(x));
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
      const LawForce here = term.law->at(state, numbers.data());
      const auto difference = [&](auto&& changed) { return (changed(step) - changed(-step)) / (2.0 * step); };
      const auto by_position = difference([&](double by) {
        return term.law->at({state.position + by, state.velocity, state.share}, numbers.data()).force;
      });
      const auto by_velocity = difference([&](double by) {
        return term.law->at({state.position, state.velocity + by, state.share}, numbers.data()).force;
      });
      EXPECT_NEAR(here.by_position, by_position, close) << term.numbers[0];
      EXPECT_NEAR(here.by_velocity, by_velocity, close) << term.numbers[0];
      for (std::size_t i = 0; i < term.numbers.size(); ++i) {
        const auto by_number = difference([&](double by) {
          std::vector<double> moved = numbers;
          moved[i] += by;
          return term.law->at(state, moved.data()).force;
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
  add_all(setting, parts);
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
  for (const Rival& rival : all_rivals()) {
    SCOPED_TRACE(rival.code);
    ModelParts parts = numbers_of(device, true);
    RivalSetting setting = setting_of(device, record);
    setting.highest_frequency = 15.0;  // a further body near the lines of the force, which move it
    if (rival.code == "presliding") coulomb_friction().add(setting, parts);  // which it bends
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
      if (number.key.starts_with("friction.")) x(static_cast<Eigen::Index>(i)) = 0.23;
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
