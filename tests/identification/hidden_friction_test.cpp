// Dry friction of a thousandth of the force, on devices that are hardly damped: it passes for damping, and no deviation of a fit
// tells which is which. Records of a simulator that shares nothing with the library were sound and 10 to 190 % too high at their
// lower ends.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

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
  for (const Rubbing& each : rubbing()) {
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

// A device that does not settle while it is recorded (m/b is 21 s): from the states of the record, all free at once, a search
// did not come to what the record leaves open. Was sound, its lower end 21 % above the truth.
TEST(HiddenFriction, OfADeviceThatNeverSettlesIsNeverSound) {
  constexpr double step = 9.02275050922809e-05;
  constexpr std::size_t period = 2000;
  std::mt19937_64 random(12033);
  std::vector<double> phases(456);
  for (double& each : phases) each = std::uniform_real_distribution(0.0, 2.0 * std::numbers::pi)(random);
  std::vector<double> force(15 * period, 0.0);
  for (std::size_t k = 0; k < force.size(); ++k) {
    for (std::size_t line = 1; line < phases.size(); ++line) {
      const double turns = static_cast<double>((k * line) % period) / static_cast<double>(period);
      force[k] += 0.07 * std::cos(2.0 * std::numbers::pi * turns + phases[line]);
    }
  }
  const DeviceParameters device = chain({"motor", 0.2765151300412433, 0.0787298123606785, 0.0, 0.0015028},
                                        {"handle", 1.505547330192414, 0.0066528136075986516, 0.0, 0.0},
                                        {0, 1, 282635.8284996154, 1.4970721079840146});
  constexpr double truth = 170.781;
  std::vector<double> position = test::FrictionChain(device).positions(force);
  for (double& each : position) {
    each = step * std::round(each / step + std::normal_distribution(0.0, 0.45)(random));
  }
  const Recording record{"run", 1e-3, {{"force", std::move(force)}, {"position", std::move(position)}}, {}};
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  const Device structure(named_structure("two-body", {.record_period = 1e-3}).value().parameters);
  const Identification found = identify(record, structure, options);
  ASSERT_TRUE(found.analysis.interval);
  ASSERT_GT(found.analysis.interval->lower, 1.1 * truth) << "what is doubted";
  ASSERT_FALSE(found.trust.sound());
  EXPECT_NE(found.trust.reasons.front().find("dry friction"), std::string::npos) << found.trust.reasons.front();
}

}  // namespace
}  // namespace zwidth
