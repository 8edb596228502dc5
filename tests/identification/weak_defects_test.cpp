// What a fit in time takes for damping or mass while it is small: found by a tester's own simulator. And what it took for
// feedback where there is none.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/time_domain.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double period = 1e-3;

// A body of 0.4 kg and 1 N s/m with dry friction, or the same in two parts on a link: the first is moved, the other sensed.
struct Bench {
  double drag = 0.0;         // N s^2/m^2
  double link = 0.0;         // N/m; 0: one body
  double resolution = 1e-5;  // m
  double amplitude = 4.0;    // N
  double highest_hz = 60.0;
  ExcitationKind kind = ExcitationKind::logarithmic_chirp;
  double friction = 0.4;  // N
  double noise = 0.0;     // m, of each position
  double bend = 0.0;      // m, over which friction builds up after a turn (Dahl 1968); 0: at once
};

// Leapfrog, 50 steps a sample; the friction of a step takes no more than the motion there is.
Recording record_of(const Bench& bench, std::uint64_t seed) {
  ExcitationOptions excitation;
  excitation.kind = bench.kind;
  excitation.amplitude = bench.amplitude;
  excitation.lowest_hz = 0.5;
  excitation.highest_hz = bench.highest_hz;
  excitation.duration = 10.0;
  const std::vector<double> force = excite(excitation).samples;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 0.01);
  const std::size_t bodies = bench.link > 0.0 ? 2 : 1;
  const std::vector<double> masses = bodies == 2 ? std::vector{0.25, 0.15} : std::vector{0.4};
  const double damping = 1.0 / static_cast<double>(bodies);
  const double friction = bench.friction / static_cast<double>(bodies);
  constexpr int steps = 50;
  constexpr double step = period / steps;
  std::vector<double> x(bodies, 0.0);
  std::vector<double> v(bodies, 0.0);
  std::vector<double> bent(bodies, 0.0);
  std::vector<double> position;
  for (const double command : force) {
    const double seen = x.back() + (bench.noise > 0.0 ? bench.noise / 0.01 * normal(random) : 0.0);
    position.push_back(bench.resolution * std::floor(seen / bench.resolution));
    const double acting = command + normal(random);
    for (int i = 0; i < steps; ++i) {
      for (std::size_t b = 0; b < bodies; ++b) x[b] += 0.5 * step * v[b];
      const double stretch = bodies == 2 ? x[1] - x[0] : 0.0;
      const double rate = bodies == 2 ? v[1] - v[0] : 0.0;
      const double pull = bench.link * stretch + 0.02 * rate;
      for (std::size_t b = 0; b < bodies; ++b) {
        const double driven = (b == 0 ? acting + pull : -pull) - damping * v[b] - bench.drag * v[b] * std::abs(v[b]);
        v[b] += step / masses[b] * driven;
        if (bench.bend > 0.0) {
          bent[b] += step * (v[b] - std::abs(v[b]) * bent[b] / bench.bend);
          v[b] -= step / masses[b] * friction * bent[b] / bench.bend;
        }
        const double slid = bench.bend > 0.0 ? 0.0 : step / masses[b] * friction;
        v[b] = v[b] > slid ? v[b] - slid : v[b] < -slid ? v[b] + slid : 0.0;
        x[b] += 0.5 * step * v[b];
      }
    }
  }
  return {"seed " + std::to_string(seed), period, {{"force", force}, {"position", position}}, {}};
}

Device rigid() {
  DeviceParameters device;
  device.name = "rigid";
  device.bodies = {{"body", 0.4, 1.0}};
  device.loop = {0, 0, 0, period, 0.0};
  return Device(device);
}

TimeDomainIdentification fitted(const Bench& bench, std::uint64_t seed) {
  TimeDomainOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  const Recording recording = record_of(bench, seed);
  return identify_in_time(std::span(&recording, 1), rigid(), options);
}

std::string reasons_of(const TimeDomainIdentification& found) {
  std::string all;
  for (const std::string& each : found.trust.reasons) all += each + "\n";
  return all;
}

// Sound, and 3 and 8 % too high with intervals of 0.5 and 1 %: a fiftieth of what is left is drag, and all of it damping.
TEST(WeakDefects, DragThatMovesTheAnswerIsDoubtful) {
  for (const double drag : {0.03, 0.08}) {
    const std::string reasons = reasons_of(fitted({.drag = drag}, 7));
    EXPECT_NE(reasons.find("not in proportion to the speed"), std::string::npos) << "drag " << drag << ": " << reasons;
  }
}

// With a finer encoder: sound, the interval 8 and 29 % above the truth. What drag changes was played without the friction,
// which holds the body at every turn.
TEST(WeakDefects, DragBesideFrictionIsFoundWithTheFrictionPlayed) {
  for (const double drag : {0.08, 0.3}) {
    Bench bench{.drag = drag};
    bench.resolution = 1e-6;
    const TimeDomainIdentification found = fitted(bench, 7);
    EXPECT_NE(reasons_of(found).find("not in proportion to the speed"), std::string::npos)
        << "drag " << drag << ": " << found.analysis.critical.stiffness << " N/m; " << reasons_of(found);
  }
}

// Nothing was looked for in devices with more bodies than friction is played on.
TEST(WeakDefects, DragOfOneOfManyBodiesIsFound) {
  DeviceParameters device = rigid().parameters();
  for (int i = 1; i <= 6; ++i) {
    device.bodies.push_back({"part " + std::to_string(i), 1e-4, 0.0});
    device.links.push_back({0, static_cast<std::size_t>(i), 20.0 * i * i, 0.01});
  }
  Bench bench{.drag = 0.3, .friction = 0.0};
  bench.resolution = 1e-6;
  const Recording recording = record_of(bench, 7);
  TimeDomainOptions options;
  options.free = {"body.body.mass", "body.body.damping"};
  const auto found = identify_in_time(std::span(&recording, 1), Device(device), options);
  EXPECT_NE(reasons_of(found).find("not in proportion to the speed"), std::string::npos)
      << found.analysis.critical.stiffness << " N/m; " << reasons_of(found);
}

// Friction that bends before it slips was taken for damping: of 14 sound answers on such records seven were 23 to 580 % too
// high. Sound here before.
TEST(WeakDefects, FrictionThatBendsBeforeItSlipsIsDoubtful) {
  const TimeDomainIdentification found = fitted({.bend = 1e-3}, 7);
  EXPECT_NE(reasons_of(found).find("not Coulomb's as the motion turns"), std::string::npos)
      << found.analysis.critical.stiffness << " N/m; " << reasons_of(found);
}

// In lines: sound, its interval 88 % above the truth. What predicts the residuals from their past took up the drag, strong as
// it is. The same device without drag stays sound.
TEST(WeakDefects, DragUnderNoiseIsFoundBesideTheNumbersOfTheFit) {
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  Bench bench{.drag = 8.0, .amplitude = 8.0, .highest_hz = 100.0, .kind = ExcitationKind::noise, .friction = 0.0};
  bench.noise = 1e-4;
  const Identification found = identify(record_of(bench, 7), rigid(), options);
  std::string reasons;
  for (const std::string& each : found.trust.reasons) reasons += each + "\n";
  EXPECT_NE(reasons.find("not in proportion to the speed"), std::string::npos) << reasons;
  bench.drag = 0.0;
  const Identification linear = identify(record_of(bench, 7), rigid(), options);
  EXPECT_TRUE(linear.trust.sound());
  ASSERT_TRUE(linear.analysis.interval);
  EXPECT_LE(linear.analysis.interval->lower, critical_stiffness(rigid()).stiffness);
}

// Sound, and 2 to 4 % too high with intervals of 0.5 %: a resonance three and more times above the band leaves 1 to 2 % of
// the response. Which doubt names it hangs on how much of it a lag takes up.
TEST(WeakDefects, AResonanceAboveTheBandIsDoubtful) {
  for (const double link : {30000.0, 60000.0}) {
    const TimeDomainIdentification found = fitted({.link = link, .highest_hz = 30.0}, 7);
    EXPECT_FALSE(found.trust.sound()) << "link " << link << ": " << found.analysis.critical.stiffness << " N/m";
    ASSERT_TRUE(found.analysis.interval);
    EXPECT_LE(found.analysis.interval->lower, 0.95 * critical_stiffness(rigid()).stiffness) << "link " << link;
  }
  EXPECT_NE(reasons_of(fitted({.link = 30000.0, .highest_hz = 30.0}, 7)).find("that the structure lacks"),
            std::string::npos);
}

TEST(WeakDefects, WithoutThemTheAnswerIsSoundAndHolds) {
  const double truth = critical_stiffness(rigid()).stiffness;
  for (const std::uint64_t seed : {7U, 8U, 9U}) {
    const TimeDomainIdentification found = fitted({}, seed);
    EXPECT_TRUE(found.trust.sound()) << "seed " << seed << ": " << reasons_of(found);
    ASSERT_TRUE(found.analysis.interval);
    EXPECT_LE(found.analysis.interval->lower, truth) << "seed " << seed;
    EXPECT_GE(found.analysis.interval->upper, truth) << "seed " << seed;
  }
}

// The rounding of steps of 0.2 mm hangs on the force, before and after alike: it was taken for feedback.
TEST(WeakDefects, ACoarseEncoderIsNoFeedback) {
  for (const double resolution : {1e-4, 2e-4}) {
    const TimeDomainIdentification found = fitted({.resolution = resolution, .amplitude = 2.0, .highest_hz = 40.0}, 7);
    EXPECT_EQ(reasons_of(found).find("recorded in feedback"), std::string::npos) << reasons_of(found);
  }
}

}  // namespace
}  // namespace zwidth
