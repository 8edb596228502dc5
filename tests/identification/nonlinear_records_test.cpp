#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "identification/plausibility.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"
#include "zwidth/identification/time_domain.hpp"

namespace zwidth {
namespace {

constexpr double period = 1e-3;

Device body() {
  DeviceParameters device;
  device.name = "body";
  device.bodies = {{"motor", 5.4, 3.5}};
  device.loop = {0, 0, 0, period, 0.0};
  return Device(device);
}

struct Defects {
  double cogging = 0.0;     ///< N, every 3.14 mm
  double cubic = 0.0;       ///< N/m^3
  double saturation = 1e9;  ///< N
};

/// A body of 5.4 kg under noise to 30 Hz, 3 N at most, with 20 mN of force noise; by the leapfrog rule, 20 steps a sample.
Recording record_of(const Defects& defects, std::uint64_t seed) {
  ExcitationOptions excitation;
  excitation.kind = ExcitationKind::noise;
  excitation.amplitude = 3.0;
  excitation.lowest_hz = 0.2;
  excitation.highest_hz = 30.0;
  excitation.duration = 20.0;
  excitation.seed = seed;
  const std::vector<double> force = excite(excitation).samples;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> position;
  double x = 0.0;
  double v = 0.0;
  constexpr int steps = 20;
  constexpr double step = period / steps;
  for (const double command : force) {
    position.push_back(x + 6e-8 * normal(random));
    const double acting = std::clamp(command, -defects.saturation, defects.saturation) + 0.02 * normal(random);
    for (int i = 0; i < steps; ++i) {
      x += 0.5 * step * v;
      v += step / 5.4 * (acting - 3.5 * v - defects.cogging * std::sin(2000.0 * x) - defects.cubic * x * x * x);
      x += 0.5 * step * v;
    }
  }
  return {"seed " + std::to_string(seed), period, {{"force", force}, {"position", position}}, {}};
}

std::string reasons_in_time(const Defects& defects, std::uint64_t seed) {
  TimeDomainOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  const Recording recording = record_of(defects, seed);
  std::string all;
  for (const std::string& each : identify_in_time(std::span(&recording, 1), body(), options).trust.reasons) all += each;
  return all;
}

TEST(Nonlinearity, CoggingIsDoubtful) {
  EXPECT_NE(reasons_in_time({.cogging = 0.15}, 7).find("comes and goes with the position"), std::string::npos)
      << "seed 7";
}

TEST(Nonlinearity, AStiffeningSpringIsDoubtful) {
  EXPECT_NE(reasons_in_time({.cubic = 1e7}, 7).find("with the position"), std::string::npos) << "seed 7";
}

TEST(Nonlinearity, ASaturatedAmplifierIsDoubtful) {
  EXPECT_NE(reasons_in_time({.saturation = 1.0}, 7).find("saturates"), std::string::npos) << "seed 7";
}

TEST(Nonlinearity, ALinearBodyIsNot) {
  for (const std::uint64_t seed : {7U, 8U}) {
    EXPECT_EQ(reasons_in_time({}, seed).find("shows a force"), std::string::npos) << "seed " << seed;
  }
}

std::string reasons_of_inverse_dynamics(const Defects& defects, std::uint64_t seed) {
  std::string all;
  for (const std::string& each : identify_rigid_body(record_of(defects, seed)).trust.reasons) all += each;
  return all;
}

// Inverse dynamics asks the same of its equations, but for the amplifier, which only leaves more unexplained.
TEST(Nonlinearity, InverseDynamicsAsksToo) {
  EXPECT_NE(reasons_of_inverse_dynamics({.cogging = 0.03}, 7).find("comes and goes with the position"),
            std::string::npos);
  EXPECT_NE(reasons_of_inverse_dynamics({.cubic = 1e7}, 7).find("with the position"), std::string::npos);
  EXPECT_NE(reasons_of_inverse_dynamics({.saturation = 1.0}, 7).find("stays unexplained"), std::string::npos);
  for (const std::uint64_t seed : {7U, 8U, 9U}) {
    EXPECT_EQ(reasons_of_inverse_dynamics({}, seed).find("shows a force"), std::string::npos) << "seed " << seed;
  }
}

TEST(Nonlinearity, PositionsInCountsAreDoubtful) {
  Recording recording = record_of({}, 7);
  for (double& x : recording.channels[1].samples) x = std::round(x / 1e-6);
  const Identification found = identify(recording, body(), {});
  EXPECT_FALSE(found.trust.sound());
  std::string all;
  for (const std::string& each : found.trust.reasons) all += each;
  EXPECT_NE(all.find("metres or radians per count"), std::string::npos) << all;
}

TEST(Nonlinearity, CountsInTheMiddleOfTheirStepsAreCounts) {
  Recording recording = record_of({}, 7);
  for (double& x : recording.channels[1].samples) x = std::floor(x / 1e-6) + 0.5;
  const Identification found = identify(recording, body(), {});
  EXPECT_FALSE(found.trust.sound());
  EXPECT_NE(found.trust.reasons.back().find("whole ones apart only, as an encoder counts"), std::string::npos)
      << found.trust.reasons.back();
}

// A fit in time of a body on a cubic spring took the body's inertia for a lag of 0.48 s, and called 20 kN/m sound where 7
// is true.
TEST(Plausibility, ALagOfManySamplesIsDoubtful) {
  const auto doubt_of = [](double lag) {
    std::vector<ParameterEstimate> estimates(2);
    estimates[0].key = "body.motor.mass";
    estimates[1].key = "actuator.time_constant";
    estimates[1].value = lag;
    return internal::doubt_of_lag(estimates, period);
  };
  EXPECT_TRUE(doubt_of(0.48));
  EXPECT_FALSE(doubt_of(0.005));
  EXPECT_FALSE(internal::doubt_of_lag({}, period));
}

}  // namespace
}  // namespace zwidth
