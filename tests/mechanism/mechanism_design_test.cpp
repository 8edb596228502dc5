// What the numbers of a mechanism do to its limits, beside limits of changed mechanisms and beside the same device of bodies.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "zwidth/batch/batch_stiffness.hpp"
#include "zwidth/design/design.hpp"
#include "zwidth/design/design_target.hpp"
#include "zwidth/design/diagnosis.hpp"
#include "zwidth/design/parameter_sweep.hpp"
#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/study_file.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/model/mechanism_key.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/simulation/relay_prediction.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/grasp_limit.hpp"
#include "zwidth/study/study_run.hpp"

namespace zwidth {
namespace {

// tests/reference/planar_arm.xml with its motors behind transmissions.
constexpr const char* arm_without_motors = R"(<mujoco>
  <compiler angle="radian"/>
  <worldbody>
    <body name="upper">
      <joint name="shoulder" axis="0 0 1" damping="2e-3"/>
      <inertial pos="0.1 0 0" mass="0.15" diaginertia="1e-6 6e-4 6e-4"/>
      <body name="fore" pos="0.2 0 0">
        <joint name="elbow" axis="0 0 1" damping="2e-3"/>
        <inertial pos="0.12 0 0" mass="0.10" diaginertia="1e-6 6e-4 6e-4"/>
        <site name="tip" pos="0.25 0 0"/>
      </body>
    </body>
  </worldbody>
</mujoco>)";

DeviceParameters posed_arm(double shoulder, double elbow) {
  DeviceParameters parameters;
  parameters.loop.sampling_period = 1e-3;
  MechanismFile& mechanism = parameters.mechanism.emplace().mechanism;
  mechanism.text = arm_without_motors;
  mechanism.tip = "tip";
  mechanism.pose = {{"shoulder", shoulder}, {"elbow", elbow}};
  for (const auto& [joint, stiffness] : {std::pair{"shoulder", 400.0}, std::pair{"elbow", 300.0}}) {
    mechanism.transmissions.push_back({.joint = joint,
                                       .ratio = 10.0,
                                       .inertia = 8e-5,
                                       .motor_damping = 2e-4,
                                       .stiffness = stiffness,
                                       .damping = 0.05});
  }
  parameters.mechanism->normal = {1.0, 0.0, 0.0};
  return parameters;
}

TEST(MechanismDesign, a_device_whose_numbers_change_is_put_to_its_pose_again) {
  const Device device = device_of_mechanism(posed_arm(0.3, 1.2));
  DeviceParameters moved = posed_arm(0.3, 0.4);
  moved.mechanism->mechanism.transmissions[1].stiffness = 250.0;
  const Device expected = device_of_mechanism(std::move(moved));
  const Device found = device.with("mechanism.pose.elbow", 0.4).with("transmission.1.stiffness", 250.0);
  EXPECT_EQ(found.parameters().coordinates->mass, expected.parameters().coordinates->mass);
  EXPECT_EQ(critical_stiffness(found).stiffness, critical_stiffness(expected).stiffness);
  EXPECT_EQ(parameter(found.parameters(), "mechanism.pose.elbow"), 0.4);
  EXPECT_EQ(parameter(found.parameters(), "transmission.1.inertia"), 8e-5);
}

TEST(MechanismDesign, a_number_that_makes_no_mechanism_is_refused_with_its_key) {
  const Device device = device_of_mechanism(posed_arm(0.3, 1.2));
  for (const auto& [key, value, at] : {std::tuple{"transmission.0.ratio", -1.0, "transmission.0.ratio"},
                                       std::tuple{"mechanism.pose.elbow", std::nan(""), "mechanism.pose.elbow"},
                                       // stretched out, its tip does not move along x
                                       std::tuple{"mechanism.pose.elbow", 0.0, "mechanism.normal"}}) {
    SCOPED_TRACE(key);
    DeviceParameters parameters = device.parameters();
    set_parameter(parameters, "mechanism.pose.shoulder", 0.0);
    set_parameter(parameters, key, value);
    const auto problem = find_problem(parameters);
    ASSERT_TRUE(problem.has_value());
    EXPECT_EQ(problem->key, at);
    EXPECT_TRUE(problem->problem.has_value());
    EXPECT_THROW(Device{parameters}, Error);
  }
}

TEST(MechanismDesign, numbers_of_motors_and_hinges_are_of_rotary_motion) {
  const DeviceParameters parameters = posed_arm(0.3, 1.2);
  EXPECT_EQ(motion_of_key(parameters, "transmission.0.stiffness"), Motion::rotary);
  EXPECT_EQ(motion_of_key(parameters, "mechanism.pose.elbow"), Motion::rotary);
  EXPECT_EQ(motion_of_key(parameters, "wall.stiffness"), Motion::linear);
  EXPECT_TRUE(is_key_of_pose("mechanism.pose.elbow"));
  EXPECT_FALSE(is_key_of_pose("transmission.0.ratio"));
}

TEST(MechanismDesign, slopes_are_those_of_the_limits_of_changed_mechanisms) {
  std::mt19937 random(46);
  std::uniform_real_distribution<double> angle(0.2, 1.4);
  for (int i = 0; i < 3; ++i) {
    DeviceParameters parameters = posed_arm(angle(random), angle(random));
    parameters.loop.delay = 1e-4;
    parameters.actuator.time_constant = 2e-4;
    const Device device = device_of_mechanism(std::move(parameters));
    const std::vector<Sensitivity> slopes = stiffness_sensitivities(device);
    EXPECT_EQ(slopes.size(), 23U);  // 2 joints, 10 of motors, 4 of the file, period, delay, lag, damper, user
    for (const Sensitivity& each : slopes) {
      if (each.value == 0.0) continue;
      SCOPED_TRACE(each.key);
      const double step = 1e-4 * each.value;
      const auto limit_at = [&](double value) { return critical_stiffness(device.with(each.key, value)).stiffness; };
      const double expected = (limit_at(each.value + step) - limit_at(each.value - step)) / (2.0 * step);
      EXPECT_NEAR(each.slope / expected, 1.0, 1e-5);
      EXPECT_EQ(each.relative.has_value(), !is_key_of_pose(each.key));
    }
  }
}

TEST(MechanismDesign, slopes_of_any_grasp_are_those_of_its_limits) {
  const Device device = device_of_mechanism(posed_arm(0.3, 1.2));
  const std::vector<Sensitivity> slopes = absolute_stability_sensitivities(device);
  EXPECT_EQ(slopes.size(), 20U);  // without the user's
  for (const char* key : {"mechanism.pose.elbow", "transmission.0.ratio", "transmission.1.damping"}) {
    SCOPED_TRACE(key);
    const Sensitivity* const found = find_sensitivity(slopes, key);
    ASSERT_NE(found, nullptr);
    const double step = 1e-3 * found->value;
    const auto limit_at = [&](double value) { return absolute_stability_limit(device.with(key, value), {}).stiffness; };
    const double expected = (limit_at(found->value + step) - limit_at(found->value - step)) / (2.0 * step);
    EXPECT_NEAR(found->slope / expected, 1.0, 1e-4);
  }
}

// A slide behind a cable: of bodies the slopes are exact.
TEST(MechanismDesign, slopes_are_those_of_the_same_device_of_bodies) {
  constexpr double ratio = 3.0;
  DeviceParameters slide;
  slide.loop.sampling_period = 1e-3;
  slide.loop.delay = 2.5e-4;
  MechanismFile& mechanism = slide.mechanism.emplace().mechanism;
  mechanism.text = R"(<mujoco><worldbody><body><joint name="slide" type="slide" axis="1 0 0" damping="3.4"/>
    <inertial pos="0 0 0" mass="5.1" diaginertia="1 1 1"/><site name="tip"/></body></worldbody></mujoco>)";
  mechanism.tip = "tip";
  mechanism.transmissions.push_back({.joint = "slide",
                                     .ratio = ratio,
                                     .inertia = 0.3 / (ratio * ratio),
                                     .motor_damping = 0.1 / (ratio * ratio),
                                     .stiffness = 79.5e3,
                                     .damping = 15.0});
  slide.mechanism->normal = {1.0, 0.0, 0.0};
  DeviceParameters bodies;
  bodies.bodies = {{"motor", 0.3, 0.1}, {"handle", 5.1, 3.4}};
  bodies.links = {{0, 1, 79.5e3, 15.0}};
  bodies.loop = slide.loop;
  bodies.loop.held = 1;
  const std::vector<Sensitivity> found = stiffness_sensitivities(device_of_mechanism(std::move(slide)));
  const std::vector<Sensitivity> expected = stiffness_sensitivities(Device(bodies));
  for (const auto& [key, of_bodies, factor] :
       {std::tuple{"transmission.0.inertia", "body.motor.mass", ratio * ratio},
        std::tuple{"transmission.0.motor_damping", "body.motor.damping", ratio * ratio},
        std::tuple{"transmission.0.stiffness", "link.0.stiffness", 1.0},
        std::tuple{"transmission.0.damping", "link.0.damping", 1.0},
        std::tuple{"loop.sampling_period", "loop.sampling_period", 1.0}, std::tuple{"loop.delay", "loop.delay", 1.0},
        std::tuple{"operator.mass", "operator.mass", 1.0}, std::tuple{"wall.damping", "wall.damping", 1.0}}) {
    SCOPED_TRACE(key);
    const Sensitivity* const one = find_sensitivity(found, key);
    const Sensitivity* const other = find_sensitivity(expected, of_bodies);
    ASSERT_NE(one, nullptr);
    ASSERT_NE(other, nullptr);
    EXPECT_NEAR(one->slope / (factor * other->slope), 1.0, 1e-6);
  }
}

TEST(MechanismDesign, a_design_finds_where_another_crossover_takes_over_but_not_along_a_joint) {
  const Design found = design(device_of_mechanism(posed_arm(0.3, 1.2)));
  EXPECT_TRUE(found.trust.sound());
  EXPECT_EQ(found.sensitivities.size(), 23U);
  EXPECT_EQ(found.absolute_stability_sensitivities.size(), 20U);
  ASSERT_TRUE(found.branch_switches.has_value());
  for (const BranchSwitch& each : *found.branch_switches) {
    SCOPED_TRACE(each.key);
    EXPECT_FALSE(is_key_of_pose(each.key));
    const double below =
        critical_stiffness(device_of_mechanism(posed_arm(0.3, 1.2)).with(each.key, each.value)).stiffness;
    EXPECT_NEAR(below / each.stiffness_beyond, 1.0, 0.05);
  }
}

// The disc of every frequency, by the limit that it leaves, and behind a filter.
TEST(MechanismDesign, the_grasped_plant_leaves_the_limit_of_any_grasp) {
  const Device device = device_of_mechanism(posed_arm(0.3, 1.2));
  const TipMotion motion = tip_motion_of(device).value();
  const Eigen::Vector3d normal(1.0, 0.0, 0.0);
  const GraspLimit limit = any_grasp_limit(motion, device.parameters(), normal);
  const GraspedPlant plant(motion, device.parameters(), normal);
  EXPECT_FALSE(plant.is_undamped());
  const auto least_at = [&](double frequency) {
    // |1 + K c| = K r for the least K > 0: (|c|^2 - r^2) K^2 + 2 Re c K + 1 = 0
    const auto [c, r] = plant.at(frequency);
    const double power = std::norm(c) - r * r;
    const double root = c.real() * c.real() - power;
    const double least = (-c.real() - std::sqrt(std::max(root, 0.0))) / power;
    const double most = (-c.real() + std::sqrt(std::max(root, 0.0))) / power;
    if (root < 0.0) return 1e300;
    return least > 0.0 && most > 0.0               ? std::min(least, most)
           : std::max({least, most, -1e300}) > 0.0 ? std::max(least, most)
                                                   : 1e300;
  };
  EXPECT_NEAR(least_at(limit.frequency) / limit.stiffness, 1.0, 1e-9);
  const double nyquist = std::numbers::pi / device.loop().sampling_period;
  for (int i = 0; i <= 500; ++i) {
    EXPECT_GE(least_at(nyquist * std::pow(10.0, -3.4 * i / 500.0)), limit.stiffness * (1.0 - 1e-9));
  }
  const auto wall = [](double) { return GraspedPlant::Wall{1.0, 0.0}; };
  EXPECT_NEAR(plant.least_gain(wall).stiffness / limit.stiffness, 1.0, 1e-9);
}

TEST(MechanismDesign, targets_are_reached_and_judged_by_any_grasp) {
  const Device device = device_of_mechanism(posed_arm(0.3, 1.2));
  const DesignTargets found = design_targets(device, {.factor = 3.0, .times_now = 1.2});
  EXPECT_TRUE(found.trust.sound());
  EXPECT_NEAR(*found.absolute_stability_limit_now / 278.845911, 1.0, 1e-5);
  std::size_t reached = 0;
  for (const DesignTarget& each : found.targets) {
    SCOPED_TRACE(each.key);
    EXPECT_FALSE(is_key_of_pose(each.key));
    if (!each.value_needed) continue;
    ++reached;
    const Device there = device.with(each.key, *each.value_needed);
    EXPECT_NEAR(critical_stiffness(there).stiffness / *found.target, 1.0, 1e-8);
    const double any_user = absolute_stability_limit(there, virtual_damper(there)).stiffness;
    ASSERT_TRUE(each.absolute_stability_limit_then.has_value());
    EXPECT_NEAR(*each.absolute_stability_limit_then / any_user, 1.0, 1e-6);
    EXPECT_EQ(each.safe, any_user >= *found.absolute_stability_limit_now * (1.0 - 1e-9));
  }
  EXPECT_GE(reached, 5U);
  EXPECT_FALSE(found.drive_damper.has_value());
}

TEST(MechanismDesign, an_oscillation_is_told_and_what_moves_it_is_judged_by_any_grasp) {
  const Device device = device_of_mechanism(posed_arm(0.3, 1.2));
  const CriticalStiffness critical = critical_stiffness(device);
  const Diagnosis found =
      diagnose(device, {.frequency = critical.limit->frequency, .stiffness = 1.1 * critical.stiffness});
  EXPECT_EQ(found.cause, OscillationCause::device);
  EXPECT_NEAR(*found.absolute_stability_limit_now / 278.845911, 1.0, 1e-5);
  EXPECT_FALSE(found.changes.empty());
  for (const DiagnosisChange& each : found.changes) {
    SCOPED_TRACE(each.key);
    EXPECT_NE(each.kind, DiagnosisChange::Kind::damper_on_drive);
    EXPECT_TRUE(each.safe.has_value());
    if (each.key != "transmission.0.stiffness") continue;
    const Device there = device.with(each.key, each.value_then);
    EXPECT_NEAR(*each.limit_then / critical_stiffness(there).stiffness, 1.0, 1e-8);
  }
  // Between the two limits it is a user.
  const AbsoluteStabilityLimit users = absolute_stability_limit(device, {});
  const Diagnosis held = diagnose(device, {.frequency = users.frequency, .stiffness = 290.0});
  EXPECT_EQ(held.cause, OscillationCause::passive_user);
}

// Whoever grasps the tip, as far as 100 springs, dampers and masses in all directions of the plane tell.
TEST(MechanismDesign, no_grasp_destabilises_the_wall_that_is_recommended) {
  const Device device = device_of_mechanism(posed_arm(0.3, 1.2));
  const WallRecommendation found = recommend_wall(device, {.alternatives = false});
  ASSERT_EQ(found.status, WallRecommendation::Status::found);
  EXPECT_TRUE(found.trust.sound());
  const double stiffness = *found.wall->wall.stiffness;
  EXPECT_GE(*found.wall->absolute_stability_limit, 2.0 * stiffness * (1.0 - 1e-6));
  const MechanismAtPose arm_at_pose = at_pose(device.parameters().mechanism->mechanism);
  std::mt19937 random(4611);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    MechanismAtPose held = arm_at_pose;
    for (int element = 0; element < 2; ++element) {
      const double angle = 6.283185307179586 * uniform(random);
      const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
      const Eigen::VectorXd along = held.tip.transpose() * direction;
      const double spring = std::pow(10.0, 1.0 + 5.0 * uniform(random));
      held.elements.push_back({{along.begin(), along.end()}, spring, uniform(random) < 0.5 ? 0.0 : 1e-3 * spring});
      if (uniform(random) < 0.5) held.mass += std::pow(10.0, -2.0 + 3.0 * uniform(random)) * along * along.transpose();
    }
    DeviceParameters walled;
    walled.loop = device.loop();
    walled.wall = found.wall->wall;
    const CriticalStiffness critical =
        critical_stiffness(device_along(held, Eigen::Vector3d(1.0, 0.0, 0.0), std::move(walled)));
    EXPECT_GT(critical.stiffness, stiffness);
  }
}

TEST(MechanismDesign, a_sweep_of_a_joint_has_the_limits_of_its_poses) {
  const Device device = device_of_mechanism(posed_arm(0.3, 1.2));
  const ParameterSweep found = parameter_sweep(
      device, {{.key = "mechanism.pose.elbow", .first = 0.4, .last = 1.2, .count = 3}}, {.any_user = true});
  ASSERT_EQ(found.points.size(), 3U);
  EXPECT_NEAR(found.points[2].stiffness / 318.881897, 1.0, 1e-8);
  EXPECT_NEAR(found.points[0].stiffness / 716.245862, 1.0, 1e-8);
  EXPECT_NEAR(found.points[0].any_user->stiffness / 589.6555, 1.0, 1e-6);
}

TEST(MechanismDesign, a_study_draws_poses_and_cables) {
  const Device device = device_of_mechanism(posed_arm(0.3, 1.2));
  StudyDistributions distributions;
  distributions.parameters = {
      {"mechanism.pose.elbow", {.kind = Distribution::Kind::uniform, .lower = 0.4, .upper = 1.2}},
      {"transmission.0.stiffness", {.kind = Distribution::Kind::normal, .centre = 400.0, .deviation = 40.0}}};
  const StudyOptions options{
      .samples = 20, .any_user = true, .index_samples = 0, .tightening_samples = 0, .worst = false};
  const StudyRun run(device, distributions, options);
  const BatchStiffness answers = run.answers(0);
  const std::vector<ParameterValues> columns = run.columns(0);
  for (const std::size_t i : {0U, 7U, 19U}) {
    const double elbow = columns[0].values[i];
    const double stiffness = columns[1].values[i];
    SCOPED_TRACE(elbow);
    DeviceParameters unit = posed_arm(0.3, elbow);
    unit.mechanism->mechanism.transmissions[0].stiffness = stiffness;
    const Device expected = device_of_mechanism(std::move(unit));
    EXPECT_EQ(answers.stiffness[i], critical_stiffness(expected).stiffness);
    EXPECT_EQ(answers.any_user[i], absolute_stability_limit(expected, {}).stiffness);
    EXPECT_EQ(answers.failure_of(i), "");
  }
  const Study found = study(device, distributions, options);
  EXPECT_EQ(found.failed_count, 0U);
  EXPECT_FALSE(found.trust.refused());
}

TEST(MechanismDesign, a_unit_that_is_no_mechanism_fails_alone) {
  const Device device = device_of_mechanism(posed_arm(0.0, 1.2));
  // stretched out along x, no wall of that normal is felt
  const std::vector<ParameterValues> changes = {{"mechanism.pose.elbow", {1.2, 0.0}}};
  const BatchStiffness answers = batch_stiffness(device, changes, {});
  EXPECT_EQ(answers.failure_of(0), "");
  EXPECT_NE(answers.failure_of(1), "");
  EXPECT_EQ(answers.status[1], StiffnessStatus::refused);
}

TEST(MechanismDesign, a_relay_finds_the_crossover_of_an_arm_in_which_nothing_rubs) {
  const Device device = device_of_mechanism(posed_arm(0.3, 1.2));
  const RelayPrediction found = relay_prediction(device, {.amplitude = 1.0});
  EXPECT_NEAR(found.linear.stiffness / 318.881897, 1.0, 1e-8);
  ASSERT_FALSE(found.describing_function.empty());
  EXPECT_NEAR(found.describing_function.front().stiffness / 318.881897, 1.0, 1e-3);
  DeviceParameters rubbing = posed_arm(0.3, 1.2);
  std::string& text = rubbing.mechanism->mechanism.text;
  text.replace(text.find("damping=\"2e-3\""), 14, "damping=\"2e-3\" frictionloss=\"0.01\"");
  EXPECT_THROW(static_cast<void>(relay_prediction(device_of_mechanism(std::move(rubbing)), {.amplitude = 1.0})), Error);
}

// Friction of joints is told from what it is not.
TEST(MechanismDesign, friction_of_joints_is_a_cause) {
  DeviceParameters rubbing = posed_arm(0.3, 1.2);
  std::string& text = rubbing.mechanism->mechanism.text;
  text.replace(text.find("damping=\"2e-3\""), 14, "damping=\"2e-3\" frictionloss=\"0.01\"");
  const Device device = device_of_mechanism(std::move(rubbing));
  const CriticalStiffness critical = critical_stiffness(device);
  const Diagnosis found =
      diagnose(device, {.frequency = critical.limit->frequency, .stiffness = 1.1 * critical.stiffness});
  EXPECT_EQ(found.cause, OscillationCause::device);
  EXPECT_TRUE(std::ranges::any_of(
      found.candidates, [](const OscillationCandidate& each) { return each.cause == OscillationCause::friction; }));
}

TEST(MechanismDesign, a_study_file_takes_the_units_of_joints_and_motors) {
  const Device device = device_of_mechanism(posed_arm(0.3, 1.2));
  const auto found = parse_study(
      "[[parameter]]\nkey = \"mechanism.pose.elbow\"\ndistribution = \"uniform\"\nlower = \"20 deg\"\nupper = \"1.2 "
      "rad\"\n"
      "[[parameter]]\nkey = \"transmission.0.stiffness\"\ndistribution = \"normal\"\n"
      "standard_deviation = \"0.02 kN m/rad\"\n",
      "study.toml", device, std::nullopt);
  ASSERT_TRUE(found) << found.error().str();
  const std::vector<StudyParameter>& parameters = found->distributions.parameters;
  EXPECT_NEAR(parameters[0].distribution.lower, 0.3490658503988659, 1e-12);
  EXPECT_EQ(parameters[0].distribution.upper, 1.2);
  EXPECT_EQ(parameters[1].distribution.centre, 400.0);
  EXPECT_NEAR(parameters[1].distribution.deviation, 20.0, 1e-12);
}

}  // namespace
}  // namespace zwidth
