// identify() on simulated truth: what is called sound must hold, and what the data do not carry must be said.
#include "zwidth/identification/identification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "campaign.hpp"
#include "identification/simulated_record.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth {
namespace {

IdentifyOptions of_a_named_structure() {
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  return options;
}

Device named(const char* structure, double period) {
  return Device(named_structure(structure, {.record_period = period}).value().parameters);
}

double true_stiffness(DeviceParameters device) {
  for (Body& body : device.bodies) body.coulomb = 0.0;
  return critical_stiffness(Device(std::move(device))).stiffness;
}

void expect_holds(const Identification& found, double truth) {
  EXPECT_FALSE(found.trust.refused()) << found.trust.reasons.front();
  ASSERT_TRUE(found.analysis.interval);
  EXPECT_LE(found.analysis.interval->lower, truth);
  EXPECT_GE(found.analysis.interval->upper, truth);
}

bool has(const Identification& found, std::string_view code) {
  const auto is_it = [&](const Finding& each) { return name_of(each.code) == code; };
  return std::ranges::any_of(found.trust.findings, is_it) ||
         std::ranges::any_of(found.remarks, [&](const Remark& each) { return each.finding && is_it(*each.finding); });
}

const ParameterEstimate& estimate_of(const Identification& found, std::string_view key) {
  const auto at = std::ranges::find(found.fit.estimates, key, &ParameterEstimate::key);
  if (at == found.fit.estimates.end()) throw Error(ErrorCode::invalid_argument, std::string(key));
  return *at;
}

/// A rigid rotary device whose wall is limited by its delay, at some 13 Hz: 210.8 N m/rad.
DeviceParameters late_rotor() {
  DeviceParameters device;
  device.name = "rotor";
  device.motion = Motion::rotary;
  device.bodies = {{"rotor", 0.0168, 0.62, 0.0, 0.0}};
  device.loop = {0, 0, 0, 2e-3, 2e-3};
  return device;
}

/// 10 s of it at 500 Hz under a multisine to `highest_hz`.
Recording of_rotor(double highest_hz, std::uint64_t seed = 1) {
  ExcitationOptions options;
  options.kind = ExcitationKind::multisine;
  options.amplitude = 2.0;
  options.lowest_hz = 0.5;
  options.highest_hz = highest_hz;
  options.rate = 500.0;
  options.duration = 10.0;
  options.periods = 5;
  return test::simulated_record(late_rotor(), excite(options).samples, {.seed = seed});
}

/// A motor with dry friction of 12 % of the force.
DeviceParameters rubbing_motor() {
  DeviceParameters device;
  device.name = "rubbing";
  device.bodies = {{"motor", 0.4, 1.3, 0.0, 0.15}};
  device.loop = {0, 0, 0, 1e-3, 0.25e-3};
  return device;
}

Recording of_rubbing_motor(double peak, std::uint64_t seed) {
  ExcitationOptions options;
  options.kind = ExcitationKind::noise;
  options.amplitude = peak;
  options.lowest_hz = 0.5;
  options.highest_hz = 150.0;
  options.duration = 6.0;
  options.seed = seed;
  return test::simulated_record(rubbing_motor(), excite(options).samples,
                                {.step = 2e-7, .noise = 0.5, .force = 0.0, .seed = seed});
}

TEST(NamedStructure, IsARowOfLinkedBodiesWithPlaceholders) {
  const NamedStructureOptions options{Motion::rotary, 2e-3, 1e-3};
  EXPECT_FALSE(named_structure("four-body", options));
  EXPECT_FALSE(names_structure("four-body"));
  std::size_t bodies = 0;
  for (const char* name : {"rigid", "two-body", "three-body"}) {
    EXPECT_TRUE(names_structure(name));
    const auto structure = named_structure(name, options);
    ASSERT_TRUE(structure) << name;
    EXPECT_EQ(structure->values, IdentifyOptions::StructureValues::placeholders);
    const DeviceParameters& device = structure->parameters;
    EXPECT_EQ(device.bodies.size(), ++bodies);
    EXPECT_EQ(device.links.size(), bodies - 1);
    EXPECT_EQ(device.loop.held, bodies - 1);
    EXPECT_EQ(device.loop.sensed, 0U);
    EXPECT_EQ(device.loop.sampling_period, 2e-3);
    EXPECT_EQ(device.motion, Motion::rotary);
    EXPECT_FALSE(find_problem(device)) << name;
  }
}

TEST(NamedStructure, TakesTheLoopsPeriodElseTheRecords) {
  EXPECT_EQ(named_structure("rigid", {.record_period = 5e-4})->parameters.loop.sampling_period, 5e-4);
  EXPECT_EQ(find_problem(NamedStructureOptions{})->member, "sampling_period");
  EXPECT_THROW((void)named_structure("rigid", {}), Error);
  EXPECT_TRUE(find_problem(NamedStructureOptions{.sampling_period = -1.0, .record_period = 1e-3}));
  EXPECT_TRUE(find_problem(NamedStructureOptions{.sampling_period = std::nan(""), .record_period = 1e-3}));
}

TEST(Identification, NamesTheMemberOfAnImpossibleOption) {
  IdentifyOptions options;
  EXPECT_FALSE(find_problem(options));
  options.response.overlap = 1.0;
  ASSERT_TRUE(find_problem(options));
  EXPECT_EQ(find_problem(options)->member, "response.overlap");
  EXPECT_THROW((void)identify(of_rotor(60.0), Device(late_rotor()), options), Error);
  options = {};
  options.fit.robust_threshold = -1.0;
  EXPECT_EQ(find_problem(options)->member, "fit.robust_threshold");
  options = {};
  options.response.lowest = 10.0;
  options.response.highest = 5.0;
  EXPECT_EQ(find_problem(options)->member, "response.highest");
  options = {};
  options.segment = 0.0;
  EXPECT_EQ(find_problem(options)->member, "segment");
}

TEST(Identification, RefusesKeysThatAreNoneOrComeTwice) {
  const Recording recording = of_rotor(60.0);
  for (const std::vector<std::string>& free :
       {std::vector<std::string>{"wall.stiffness"}, {"body.rotor.mass", "body.rotor.mass"}, {"body.roter.mass"}}) {
    IdentifyOptions options;
    options.fit.free = free;
    EXPECT_THROW((void)identify(recording, Device(late_rotor()), options), Error) << free.back();
  }
  EXPECT_THROW((void)identify(std::span<const Recording>{}, Device(late_rotor())), Error);
}

TEST(Identification, ARightStructureInAWholeBandIsSound) {
  const double truth = true_stiffness(late_rotor());
  EXPECT_NEAR(truth, 210.8, 0.1);
  for (std::uint64_t seed = 1; seed <= test::by_tier(2U, 10U); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Identification found = identify(of_rotor(60.0, seed), named("rigid", 2e-3), of_a_named_structure());
    EXPECT_TRUE(found.trust.sound()) << found.trust.reasons.front();
    EXPECT_NEAR(found.analysis.critical.stiffness, truth, 0.05 * truth);
    EXPECT_NEAR(found.fit.device.loop().delay + found.fit.device.parameters().actuator.time_constant, 2e-3, 2e-4);
    expect_holds(found, truth);
  }
}

// Excited to 5 Hz and limited at 13 Hz, which hangs on the delay.
TEST(Identification, AnExtrapolatedLimitIsAsOpenAsWhatItHangsOn) {
  expect_holds(identify(of_rotor(5.0), named("rigid", 2e-3), of_a_named_structure()), true_stiffness(late_rotor()));
}

TEST(Identification, ADelayThatAFilesStructureLacksIsFitted) {
  DeviceParameters without = late_rotor();
  without.loop.delay = 0.0;
  const Identification found = identify(of_rotor(60.0), Device(without));
  EXPECT_NEAR(found.fit.device.loop().delay + found.fit.device.parameters().actuator.time_constant, 2e-3, 2e-4);
  expect_holds(found, true_stiffness(late_rotor()));
}

// Of a file that gives delay and lag, neither free: the record shows both once.
TEST(Identification, ADelayAndALagThatAreGivenCountOnce) {
  DeviceParameters device = late_rotor();
  device.loop.sampling_period = 1e-3;
  device.loop.delay = 1e-3;
  device.actuator.time_constant = 2e-3;
  IdentifyOptions options;
  options.fit.free = {"body.rotor.mass", "body.rotor.damping"};
  const Recording record =
      test::simulated_record(device, test::commanded(ExcitationKind::multisine, 1.0, 1.0, 60.0, 4.0), {});
  const Identification found = identify(record, Device(device), options);
  EXPECT_TRUE(found.trust.sound());
  EXPECT_NEAR(found.fit.device.loop().delay, 1e-3, 1e-4);
  EXPECT_EQ(found.fit.device.parameters().actuator.time_constant, 2e-3);
  expect_holds(found, true_stiffness(device));
}

TEST(Identification, SeparatesFrictionFromDamping) {
  const DeviceParameters truth = rubbing_motor();
  const Recording recording = of_rubbing_motor(5.0, 7);
  const Identification found = identify(recording, named("rigid", 1e-3), of_a_named_structure());
  EXPECT_EQ(found.method, IdentifyOptions::Method::motion);
  EXPECT_TRUE(found.trust.sound()) << found.trust.reasons.front();
  EXPECT_NEAR(estimate_of(found, "body.body.mass").value, 0.4, 2e-3);
  EXPECT_NEAR(estimate_of(found, "body.body.damping").value, 1.3, 0.1);
  const auto friction = std::ranges::find(found.rivals, "coulomb_friction", &RivalEstimate::code);
  ASSERT_NE(friction, found.rivals.end());
  EXPECT_NEAR(friction->value, 0.15, 0.01);
  EXPECT_GT(friction->log_likelihood_gain, 10.0);
  expect_holds(found, true_stiffness(truth));
  // A linear device takes it for damping.
  IdentifyOptions lines = of_a_named_structure();
  lines.method = IdentifyOptions::Method::lines;
  const Identification linear = identify(recording, named("rigid", 1e-3), lines);
  EXPECT_EQ(linear.method, IdentifyOptions::Method::lines);
  EXPECT_GT(linear.analysis.critical.stiffness, 1.1 * true_stiffness(truth));
  EXPECT_TRUE(linear.motions.empty());
}

TEST(Identification, TwoRecordingsShareTheDeviceAndEachHasItsMotion) {
  const std::vector<Recording> recordings{of_rubbing_motor(5.0, 7), of_rubbing_motor(2.5, 8)};
  const Identification found = identify(recordings, named("rigid", 1e-3), of_a_named_structure());
  expect_holds(found, true_stiffness(rubbing_motor()));
  ASSERT_EQ(found.motions.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const FittedMotion& motion = found.motions[i];
    EXPECT_EQ(motion.source, recordings[i].source);
    EXPECT_EQ(motion.residuals.size(), recordings[i].channels[0].samples.size());
    EXPECT_EQ(motion.recorded, recordings[i].channels[1].samples);
    EXPECT_LT(motion.unexplained, 0.02);
    EXPECT_LT(std::abs(motion.constant_force), 5.0 * motion.constant_force_deviation + 0.01);
  }
}

TEST(Identification, TheIntervalCoversThoseOfItsRivals) {
  const Identification found = identify(of_rubbing_motor(5.0, 9), named("rigid", 1e-3), of_a_named_structure());
  ASSERT_TRUE(found.analysis.interval);
  EXPECT_FALSE(found.rivals.empty());
  for (const RivalEstimate& rival : found.rivals) {
    EXPECT_GE(rival.log_likelihood_gain, 0.0) << rival.parameter;
    if (!rival.stiffness_interval) continue;
    EXPECT_GE(rival.stiffness_interval->lower, (1.0 - 1e-9) * found.analysis.interval->lower) << rival.parameter;
    EXPECT_LE(rival.stiffness_interval->upper, (1.0 + 1e-9) * found.analysis.interval->upper) << rival.parameter;
  }
}

TEST(Identification, TheFileKeepsUncertaintyAndVerdict) {
  const Identification found = identify(of_rubbing_motor(5.0, 7), named("rigid", 1e-3), of_a_named_structure());
  const auto read = parse_device(write_device(found.fit.device.parameters()), "fitted.toml");
  ASSERT_TRUE(read);
  ASSERT_TRUE(read->parameters().uncertainty);
  EXPECT_EQ(read->parameters().uncertainty->parameters, found.fit.device.parameters().uncertainty->parameters);
  EXPECT_EQ(trust_of(*read).verdict, found.trust.verdict);
}

TEST(Identification, OfNoiseAloneNoNumberIsGiven) {
  std::mt19937_64 random(20261126);
  std::normal_distribution<double> normal;
  for (const double drift : {0.0, 1.0}) {
    Recording recording{"noise", 1e-3, {{"force", {}}, {"position", {}}}, {}};
    double position = 0.0;
    for (int i = 0; i < 4000; ++i) {
      position = drift * position + 1e-5 * normal(random);
      recording.channels[0].samples.push_back(normal(random));
      recording.channels[1].samples.push_back(position);
    }
    try {
      const Identification found = identify(recording, named("rigid", 1e-3), of_a_named_structure());
      EXPECT_TRUE(found.trust.refused()) << drift;
      EXPECT_TRUE(found.analysis.critical.trust.refused()) << drift;
      EXPECT_TRUE(trust_of(found.fit.device).refused()) << drift;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()), "") << drift;
    }
  }
}

TEST(Identification, AReversedPositionIsRefused) {
  Recording recording = of_rotor(60.0);
  for (double& value : recording.channels[1].samples) value = -value;
  for (const auto method : {IdentifyOptions::Method::motion, IdentifyOptions::Method::lines}) {
    IdentifyOptions options = of_a_named_structure();
    options.method = method;
    const Identification found = identify(recording, named("rigid", 2e-3), options);
    EXPECT_TRUE(found.trust.refused());
    EXPECT_TRUE(trust_of(found.fit.device).refused());
  }
}

TEST(Identification, CountsInsteadOfRadiansAreSaid) {
  Recording recording = of_rotor(60.0);
  for (double& value : recording.channels[1].samples) value = std::round(value / 1e-5);
  EXPECT_TRUE(has(identify(recording, named("rigid", 2e-3), of_a_named_structure()), "channel_in_counts"));
}

TEST(Identification, TheBasisIsTheStructuresWall) {
  DeviceParameters structure = late_rotor();
  structure.wall.damping = 0.2;
  structure.wall.velocity_filter_hz = 60.0;
  IdentifyOptions lines;
  lines.method = IdentifyOptions::Method::lines;
  const Identification found = identify(of_rotor(60.0), Device(structure), lines);
  EXPECT_EQ(found.basis.virtual_damping, 0.2);
  EXPECT_EQ(found.basis.velocity_filter_hz, 60.0);
}

// The handle's own mass and damping are a part of what moves with the hand.
TEST(Identification, AnOperatorOfTheStructureIsTheHandOnTheDevice) {
  DeviceParameters device;
  device.bodies = {{"motor", 0.4, 0.5, 0.0, 0.0}, {"handle", 0.2, 0.3, 0.0, 0.0}};
  device.links = {{0, 1, 3000.0, 1.0}};
  device.loop = {0, 0, 1, 1e-3, 0.0};
  device.user = {0.3, 3.0, 0.0};
  const std::vector<double> force = test::commanded(ExcitationKind::noise, 2.0, 0.5, 80.0, 6.0);
  const Identification found = identify(test::simulated_record(device, force, {.force = 0.02}), Device(device));
  expect_holds(found, true_stiffness(device));
  EXPECT_NEAR(found.fit.device.bodies()[1].mass, 0.2, 0.02);
}

// A wall that buzzes tells the damping of a body whose mass is known.
// Every holder's limit, judged as the fit is; none of a fit that is refused, though its device has one.
TEST(Identification, ItsDeviceIsAnalysedWithEveryHolder) {
  const Device device(late_rotor());
  Identification found{.source = "", .response = {}, .fit = {.device = device, .misfit = {}}};
  const Analysis sound = analyze_fit(found);
  const Analysis alone = analyze(device);
  ASSERT_TRUE(sound.limits.any_user && alone.limits.any_user);
  EXPECT_EQ(sound.limits.nobody.critical_stiffness, alone.limits.nobody.critical_stiffness);
  EXPECT_EQ(sound.limits.any_user->critical_stiffness, alone.limits.any_user->critical_stiffness);
  EXPECT_EQ(sound.trust, alone.trust);
  found.trust.doubt({.code = FindingCode::delay_not_shown});
  const Analysis doubtful = analyze_fit(found);
  EXPECT_EQ(doubtful.trust, found.trust);
  EXPECT_EQ(doubtful.limits.nobody.critical_stiffness, alone.limits.nobody.critical_stiffness);
  EXPECT_FALSE(doubtful.interval);
  found.trust.refuse({.code = FindingCode::force_unexplained, .evidence = {{"unexplained", 0.9}, {"threshold", 0.5}}});
  const Analysis refused = analyze_fit(found);
  EXPECT_EQ(refused.trust, found.trust);
  EXPECT_TRUE(std::isnan(refused.limits.nobody.critical_stiffness));
}

TEST(Identification, AMeasuredLimitAloneDeterminesOneNumber) {
  const CriticalStiffness truth = critical_stiffness(Device(late_rotor()));
  DeviceParameters guessed = late_rotor();
  guessed.bodies[0].damping *= 1.3;
  IdentifyOptions options;
  options.fit.free = {"body.rotor.damping"};
  options.loop_delay = IdentifyOptions::LoopDelay::as_given;
  EXPECT_THROW((void)identify_from_limits(Device(guessed), options), Error);
  options.limits = {{.stiffness = truth.stiffness,
                     .frequency_hz = truth.limit->frequency / (2.0 * std::numbers::pi),
                     .stiffness_deviation = 0.02}};
  const Identification found = identify_from_limits(Device(guessed), options);
  expect_holds(found, truth.stiffness);
  EXPECT_NEAR(found.analysis.critical.stiffness, truth.stiffness, 0.05 * truth.stiffness);
  EXPECT_LT(found.analysis.interval->upper, 1.2 * found.analysis.interval->lower);
}

}  // namespace
}  // namespace zwidth
