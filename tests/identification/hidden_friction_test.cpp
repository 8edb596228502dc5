// Dry friction of a thousandth of the force, on devices that are hardly damped: it passes for damping, and no deviation of a fit
// tells which is which. Records of a simulator that shares nothing with the library were sound and 10 to 190 % too high at their
// lower ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "campaign.hpp"
#include "property/friction_recordings.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

struct Rubbing {
  DeviceParameters device;
  ExcitationOptions force;
  double step;            ///< of the encoder
  double too_high;        ///< the critical stiffness as fitted, by how much at least
  double lower_too_high;  ///< the interval's lower end; 0: it reaches down to the truth
};

DeviceParameters chain(Body motor, Body handle, Link link) {
  DeviceParameters device;
  device.bodies = {std::move(motor), std::move(handle)};
  device.links = {link};
  device.loop = {0, 0, 0, 1e-3, 0.0};
  return device;
}

ExcitationOptions excitation(ExcitationKind kind, double peak, double lowest_hz, double highest_hz, double duration) {
  ExcitationOptions options;
  options.kind = kind;
  options.amplitude = peak;
  options.lowest_hz = lowest_hz;
  options.highest_hz = highest_hz;
  options.duration = duration;
  return options;
}

ExcitationOptions sweep(double peak) { return excitation(ExcitationKind::logarithmic_chirp, peak, 0.565, 8.28, 30.0); }

ExcitationOptions multisine(double peak) {
  ExcitationOptions options = excitation(ExcitationKind::multisine, peak, 1.0, 250.0, 12.0);
  options.periods = 12;
  return options;
}

std::vector<Rubbing> rubbing() {
  return {{chain({"motor", 0.32411896126597667, 0.07195077787930944, 0.0, 0.001472},
                 {"handle", 3.7208879853744237, 0.028810431661753243, 0.0, 0.0},
                 {0, 1, 729578.6613690768, 10.879713314081704}),
           multisine(1.0114282432149815), 3.4553412195059206e-05, 1.5, 1.5},
          {chain({"motor", 0.07303962481229523, 0.07283808099794709, 0.0, 0.005834},
                 {"handle", 0.7311071496406494, 0.006005763121724623, 0.0, 0.0},
                 {0, 1, 28773.10887995031, 6.261506682424102}),
           multisine(4.181761420681698), 0.00045196393370117394, 1.5, 1.5},
          {chain({"motor", 0.25273898960638724, 0.09093787632168049, 0.0, 0.0014826},
                 {"handle", 0.8549590056318525, 0.0028643622883453073, 0.0, 0.0},
                 {0, 1, 381346.5578037801, 30.742982639699214}),
           sweep(0.8072979144073471), 1.9211271110408682e-05, 1.05, 0.0}};
}

Recording recorded(const Rubbing& rubbing) {
  std::vector<double> force = excite(rubbing.force).samples;
  std::vector<double> position = test::FrictionChain(rubbing.device).positions(force);
  for (double& each : position) each = rubbing.step * std::round(each / rubbing.step);
  return {"run", 1e-3, {{"force", std::move(force)}, {"position", std::move(position)}}, {}};
}

TEST(HiddenFriction, OfAThousandthOfTheForceIsNeverSound) {
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  const Device structure(named_structure("two-body", {.record_period = 1e-3}).value().parameters);
  const std::vector<Rubbing> all = rubbing();
  for (const Rubbing& each : std::span(all).first(test::by_tier(1U, 3U))) {
    DeviceParameters linear = each.device;
    for (Body& body : linear.bodies) body.coulomb = 0.0;
    const double truth = critical_stiffness(Device(std::move(linear))).stiffness;
    const Identification found = identify(recorded(each), structure, options);
    ASSERT_GT(found.analysis.critical.stiffness, each.too_high * truth) << "what is doubted";
    ASSERT_GT(found.analysis.interval->lower, each.lower_too_high * truth) << "what is doubted";
    ASSERT_FALSE(found.trust.sound()) << found.analysis.critical.stiffness << " for " << truth;
    EXPECT_NE(found.trust.reasons.front().find("dry friction"), std::string::npos) << found.trust.reasons.front();
  }
}

/// A column of a record of another simulator (Moreau's steps, 40 a sample): records.tar.xz, unpacked by tests/CMakeLists.txt.
std::vector<double> column_of(const std::string& name) {
  std::ifstream file(std::string(ZWIDTH_RECORDS_DIR "/") + name);
  std::string header;
  std::getline(file, header);
  std::vector<double> values;
  for (double value = 0.0; file >> value;) values.push_back(value);
  return values;
}

void expect_doubt_of_friction(std::vector<double> force, const std::string& counts, double step,
                              const std::string& structure, double too_high) {
  std::vector<double> position = column_of(counts);
  ASSERT_EQ(position.size(), force.size());
  for (double& each : position) each *= step;
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  const Recording record{"run", 1e-3, {{"force", std::move(force)}, {"position", std::move(position)}}, {}};
  const Identification found =
      identify(record, Device(named_structure(structure, {.record_period = 1e-3}).value().parameters), options);
  ASSERT_TRUE(found.analysis.interval);
  ASSERT_GT(found.analysis.interval->lower, too_high) << "what is doubted";
  ASSERT_EQ(found.trust.reasons.size(), 1U);
  const std::string& reason = found.trust.reasons.front();
  EXPECT_EQ(reason.find("the record does not tell damping from dry friction"), 0U) << reason;
}

// 0.27652 and 1.50555 kg, 0.07873 and 0.00665 N s/m, 282 636 N/m, 1.497 N s/m, friction of 1.5 mN on the motor under a multisine of
// 4 N: it does not settle while it is recorded, and from the states of the record, all free at once, no search came to
// what the record leaves open. Was sound, its lower end 21 % above the truth.
TEST(HiddenFrictionCampaign, OfADeviceThatNeverSettlesIsNeverSound) {
  const std::vector<double> period = column_of("slow_device_force.txt");
  ASSERT_EQ(period.size(), 2000U);
  std::vector<double> force(15 * period.size());
  for (std::size_t k = 0; k < force.size(); ++k) force[k] = period[k % period.size()];
  expect_doubt_of_friction(std::move(force), "slow_device_multisine.txt", 9.02275050922809e-05, "two-body",
                           1.2 * 170.781);
}

// 0.1292 kg, 0.00866 N s/m, friction of 0.228 mN under a chirp of 0.934 N: in time it explains the record by 43 of the log-likelihood,
// and was passed over since its deviation is as large as half of it. Was sound, its lower end 3 % above the truth.
TEST(HiddenFriction, ThatExplainsTheRecordClearlyCountsWhateverItsDeviation) {
  constexpr double duration = 16.0;
  constexpr double lowest = 0.5875032659719687;
  constexpr double highest = 7.369991720349708;
  std::vector<double> force(16000);
  for (std::size_t k = 0; k < force.size(); ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    const double turns = lowest * t + 0.5 * (highest - lowest) * t * t / duration;
    force[k] = 0.9339760071787465 * std::sin(2.0 * std::numbers::pi * turns);
  }
  expect_doubt_of_friction(std::move(force), "light_body_chirp.txt", 0.004398777809894018, "rigid", 1.02 * 17.3158);
}

// 0.23568 kg, 0.03395 N s/m, 0.25 ms late, friction of 1.57 mN under three sines: beside it the critical stiffness is 4.6 % lower than the
// linear fit's. Was sound, its lower end 7 % above the truth.
TEST(HiddenFriction, UnderThreeLinesIsNeverSound) {
  std::vector<double> force(30000);
  for (std::size_t k = 0; k < force.size(); ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    const auto line = [&](double hz, double phase) { return std::sin(2.0 * std::numbers::pi * hz * t + phase); };
    force[k] = 1.2913023796591896 *
               (line(1.5, 1.866106336939593) + line(2.0, 1.444985986191354) + line(2.5, 4.190883904463815));
  }
  expect_doubt_of_friction(std::move(force), "one_body_three_lines.txt", 0.002337020368406416, "rigid", 1.06 * 45.2678);
}

// A lag far below the sampling period was too fast to be played, and nobody asked.
TEST(HiddenFriction, BesideAShortLagIsAskedFor) {
  DeviceParameters device;
  device.bodies = {{"body", 0.5, 2.0, 0.0, 0.04}};
  device.loop = {0, 0, 0, 1e-3, 0.0};
  std::mt19937_64 random(5);
  std::vector<double> force;
  double slow = 0.0;
  for (int k = 0; k < 12000; ++k) force.push_back(slow = 0.9 * slow + std::normal_distribution()(random));
  std::vector<double> position = test::FrictionChain(device).positions(force);
  for (double& each : position) each += std::normal_distribution(0.0, 1e-3)(random);
  device.bodies.front().coulomb = 0.0;
  const double truth = critical_stiffness(Device(device)).stiffness;
  device.actuator.time_constant = 1e-5;
  IdentifyOptions options;
  options.fit.free = {"body.body.mass", "body.body.damping"};
  options.loop_delay = IdentifyOptions::LoopDelay::as_given;  // there is none
  const Identification found = identify(
      {"run", 1e-3, {{"force", std::move(force)}, {"position", std::move(position)}}, {}}, Device(device), options);
  ASSERT_TRUE(found.analysis.interval);
  ASSERT_GT(found.analysis.interval->lower, 1.03 * truth) << "what is doubted";
  ASSERT_EQ(found.trust.reasons.size(), 1U);
  const std::string& reason = found.trust.reasons.front();
  EXPECT_NE(reason.find("on body; beside it the critical stiffness"), std::string::npos) << reason;
}

TEST(HiddenFriction, OfARecordTooShortToAskItIsSaid) {
  DeviceParameters device;
  device.bodies = {{"body", 0.5, 100.0}};  // limited within the band that so short a record has
  device.loop = {0, 0, 0, 1e-3, 0.0};
  std::mt19937_64 random(1);
  std::vector<double> force;
  for (int k = 0; k < 500; ++k) force.push_back(std::normal_distribution()(random));
  std::vector<double> position = test::FrictionChain(device).positions(force);
  for (double& each : position) each += std::normal_distribution(0.0, 1e-9)(random);
  IdentifyOptions options;
  options.fit.free = {"body.body.mass", "body.body.damping"};
  options.loop_delay = IdentifyOptions::LoopDelay::as_given;  // there is none
  const Identification found = identify(
      {"run", 1e-3, {{"force", std::move(force)}, {"position", std::move(position)}}, {}}, Device(device), options);
  const auto is_said = [](const Remark& each) { return each.what.starts_with("dry friction was not looked for"); };
  EXPECT_EQ(std::ranges::any_of(found.remarks, is_said), found.trust.sound());
  EXPECT_TRUE(found.trust.sound()) << found.trust.reasons.front();
}

}  // namespace
}  // namespace zwidth
