#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "campaign.hpp"
#include "property/random_devices.hpp"
#include "zwidth/design/diagnosis.hpp"
#include "zwidth/simulation/simulate.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::test {
namespace {

constexpr std::uint64_t seed = 20261123;
constexpr std::size_t most_attempts = 100;  // at a device that oscillates by this cause

/// What runs, and what is known of it.
struct Case {
  DeviceParameters known;  // with the wall
  DeviceParameters runs;   // with a user who is not in the file
  SimulationOptions simulation;
};

double limit_of(const DeviceParameters& parameters) {
  const CriticalStiffness critical = critical_stiffness(Device(parameters));
  return critical.status == StiffnessStatus::finite ? critical.stiffness : 0.0;
}

bool is_possible(const Case& each) { return !find_problem(each.known) && !find_problem(each.runs); }

DeviceParameters random_device(RandomDevices& random) {
  static constexpr std::array kinds{"rigid", "two_mass", "user_side", "fractional_delay", "virtual_damper", "rotary"};
  DeviceParameters device = random.device(kinds[random.index(kinds.size())]);
  device.wall.filters.clear();
  return device;
}

/// Friction, too little to matter, on half of them.
void rub(DeviceParameters& device, RandomDevices& random) {
  if (random.chance(0.5)) device.bodies.back().coulomb = *device.wall.stiffness * random.log_uniform(1e-6, 2e-5);
}

std::optional<Case> of_device(RandomDevices& random) {
  DeviceParameters device = random_device(random);
  const double limit = limit_of(device);
  if (!(limit > 0.0)) return std::nullopt;
  device.wall.stiffness = limit * random.uniform(1.03, 1.6);
  if (random.chance(0.5)) device.sensor.resolution = 1e-6;
  rub(device, random);
  return Case{device, device, {}};
}

std::optional<Case> of_operator(RandomDevices& random) {
  DeviceParameters device = random.device("operator");
  const double held = limit_of(device);
  DeviceParameters nobody = device;
  nobody.user = {};
  const double free = limit_of(nobody);
  if (!(held > 0.0 && free > 1.2 * held)) return std::nullopt;
  device.wall.stiffness = held * random.uniform(1.05, std::min(1.6, 0.95 * free / held));
  return Case{device, device, {}};
}

std::optional<Case> of_user(RandomDevices& random) {
  DeviceParameters device = random_device(random);
  const double free = limit_of(device);
  DeviceParameters held = device;
  held.user = {random.chance(0.8) ? random.log_uniform(0.01, 10.0) : 0.0, random.log_uniform(1e-3, 1.0),
               random.log_uniform(10.0, 1e6)};
  if (device.motion == Motion::rotary) {
    held.user.mass *= 1e-4, held.user.damping *= 1e-4, held.user.stiffness *= 1e-4;
  }
  const double limit = limit_of(held);
  if (!(limit > 0.0 && free > 1.2 * limit)) return std::nullopt;
  device.wall.stiffness = limit * random.uniform(1.05, std::min(1.6, 0.95 * free / limit));
  if (random.chance(0.5)) device.sensor.resolution = 1e-6;
  rub(device, random);
  for (std::size_t i = 0; i < device.bodies.size(); ++i) held.bodies[i].coulomb = device.bodies[i].coulomb;
  held.wall = device.wall;
  held.sensor = device.sensor;
  return Case{device, held, {}};
}

/// Pushed to between two steps of the encoder.
std::optional<Case> of_quantisation(RandomDevices& random) {
  DeviceParameters device = random_device(random);
  const double limit = limit_of(device);
  if (!(limit > 0.0)) return std::nullopt;
  device.wall.stiffness = limit * random.uniform(0.3, 0.7);
  device.sensor.resolution = random.log_uniform(1e-6, 1e-4);
  Case result{device, device, {}};
  result.simulation.user_force.kind = UserForce::Kind::step;
  result.simulation.user_force.amplitude =
      (std::floor(random.uniform(3.0, 30.0)) + 0.5) * device.sensor.resolution * *device.wall.stiffness;
  result.simulation.initial_position.assign(device.bodies.size(),
                                            result.simulation.user_force.amplitude / *device.wall.stiffness);
  return result;
}

/// Stiffer than the motor alone on its cable bears, with a handle that rubs.
std::optional<Case> of_friction(RandomDevices& random) {
  DeviceParameters device = random.device("two_mass");
  const double free = limit_of(device);
  DeviceParameters stuck = device;
  stuck.bodies[1].damping = 1e5;
  const double limit = limit_of(stuck);
  if (!(limit > 0.0 && free > 1.2 * limit)) return std::nullopt;
  device.wall.stiffness = limit * random.uniform(1.05, 0.95 * free / limit);
  device.bodies[1].coulomb = *device.wall.stiffness * random.log_uniform(1e-5, 3e-4);
  return Case{device, device, {}};
}

struct Campaign {
  OscillationCause cause;
  const char* name;
  std::optional<Case> (*make)(RandomDevices&);
};

std::size_t cases() {
  const std::size_t most = by_tier<std::size_t>(12, 40);
  const char* asked = std::getenv("ZWIDTH_PROPERTY_CASES");
  return asked ? std::clamp<std::size_t>(std::strtoul(asked, nullptr, 10) / 5, 1, most) : most;
}

// Simulated loops whose mechanism is known by how they were made; what a user sees of them is the frequency and the
// amplitude.
TEST(DiagnosisProperty, NamesTheMechanismOfSimulatedOscillations) {
  const std::array campaigns{Campaign{OscillationCause::device, "device", of_device},
                             Campaign{OscillationCause::with_user, "operator", of_operator},
                             Campaign{OscillationCause::passive_user, "user", of_user},
                             Campaign{OscillationCause::quantisation, "quantisation", of_quantisation},
                             Campaign{OscillationCause::friction, "friction", of_friction}};
  std::size_t all = 0;
  std::size_t named = 0;
  for (const Campaign& campaign : campaigns) {
    std::size_t right = 0;
    std::size_t oscillating = 0;
    for (std::size_t attempt = 0; oscillating < cases() && attempt < most_attempts * cases(); ++attempt) {
      RandomDevices random(seed + attempt);
      const std::optional<Case> each = campaign.make(random);
      if (!each || !is_possible(*each)) continue;
      const Simulation run = simulate(Device(each->runs), each->simulation);
      // Friction may hold an unstable loop on a cycle: that one is friction's.
      const bool linear =
          campaign.cause != OscillationCause::quantisation && campaign.cause != OscillationCause::friction;
      const bool swings = run.verdict == LoopVerdict::unstable || (!linear && run.verdict == LoopVerdict::limit_cycle);
      if (!swings || !run.oscillation) continue;
      ++oscillating;
      const Diagnosis diagnosis = diagnose(
          Device(each->known), {.frequency = run.oscillation->frequency, .amplitude = run.oscillation->amplitude});
      if (diagnosis.cause == campaign.cause) {
        ++right;
        EXPECT_FALSE(diagnosis.changes.empty()) << campaign.name << ", seed " << seed + attempt;
      } else {
        std::string text;
        for (const OscillationCandidate& candidate : diagnosis.candidates) {
          text += std::to_string(static_cast<int>(candidate.cause)) + (candidate.fits ? " fits " : " no ") +
                  std::to_string(candidate.frequency) + " " + zwidth::text(candidate.why) + "; ";
        }
        std::printf("%s, seed %zu (%s): w %.5g amplitude %.3g K %.4g q %.2g: %s\n", campaign.name,
                    static_cast<std::size_t>(seed + attempt), each->known.name.c_str(), run.oscillation->frequency,
                    run.oscillation->amplitude, *each->known.wall.stiffness, each->known.sensor.resolution,
                    text.c_str());
      }
    }
    std::printf("%s: %zu of %zu\n", campaign.name, right, oscillating);
    EXPECT_GE(oscillating, cases() / 2) << campaign.name;
    all += oscillating;
    named += right;
  }
  EXPECT_GE(static_cast<double>(named), 0.95 * static_cast<double>(all)) << named << " of " << all;
}

// A resonance makes many steps of the encoder's error; where the force chatters besides, the swing's own frequency is
// the one that is seen.
TEST(DiagnosisProperty, ManyStepsOfAResonantLoopAreTheEncoders) {
  for (const std::uint64_t each_seed : {20261583U, 20262317U, 20262531U}) {
    SCOPED_TRACE("seed " + std::to_string(each_seed));
    RandomDevices random(each_seed);
    const std::optional<Case> each = of_quantisation(random);
    ASSERT_TRUE(each && is_possible(*each));
    const Simulation run = simulate(Device(each->runs), each->simulation);
    ASSERT_TRUE(run.oscillation);
    EXPECT_GT(run.oscillation->amplitude, 3.0 * each->known.sensor.resolution);
    const DiagnosisOptions seen{.frequency = run.oscillation->frequency, .amplitude = run.oscillation->amplitude};
    EXPECT_EQ(diagnose(Device(each->known), seen).cause, OscillationCause::quantisation);
    DiagnosisOptions larger = seen;
    *larger.amplitude *= 100.0;
    EXPECT_NE(diagnose(Device(each->known), larger).cause, OscillationCause::quantisation);
  }
}

// A change that is said to end it does so in the simulation.
TEST(DiagnosisProperty, AChangeThatEndsItDoesSoInSimulation) {
  std::size_t tried = 0;
  for (std::size_t attempt = 0; tried < cases() / 4 && attempt < 1000; ++attempt) {
    SCOPED_TRACE("seed " + std::to_string(seed + attempt));
    RandomDevices random(seed + attempt);
    const std::optional<Case> each = of_device(random);
    if (!each) continue;
    const Simulation run = simulate(Device(each->runs), each->simulation);
    if (run.verdict != LoopVerdict::unstable || !run.oscillation) continue;
    const Diagnosis diagnosis = diagnose(Device(each->known), {.frequency = run.oscillation->frequency});
    for (const DiagnosisChange& change : diagnosis.changes) {
      if (change.key != "wall.stiffness" || !change.ends_it.value_or(false)) continue;
      DeviceParameters softer = each->runs;
      softer.wall.stiffness = change.value_then;
      softer.sensor.resolution = 0.0;
      EXPECT_NE(simulate(Device(softer)).verdict, LoopVerdict::unstable);
      ++tried;
    }
  }
  EXPECT_GT(tried, 0U);
}

}  // namespace
}  // namespace zwidth::test
