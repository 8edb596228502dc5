// Lost samples, jitter and late forces against an event-by-event computation of one rigid body in closed form.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "simulation/simulated_devices.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using test::spring_wall;
using test::starting_at;

constexpr double period = 1e-3;
constexpr double stiffness = 2000.0;
constexpr int steps = 2000;

DeviceParameters rigid(double delay) { return test::with_delay(test::rigid_parameters(), delay); }

/// m v' + b v = F over a time.
struct RigidBody {
  double position = 1e-3;
  double velocity = 0.0;
  void move(double force, double duration) {
    const double mass = 5.4;
    const double damping = 3.5;
    const double rate = damping / mass;
    const double share = -std::expm1(-rate * duration) / rate;  // of v(0) in the travel
    position += velocity * share + force / damping * (duration - share);
    velocity = velocity * std::exp(-rate * duration) + force / damping * rate * share;
  }
};

/// All samples and arrivals of the run first, then sorted, then played.
std::vector<double> by_events(double delay, const Faults& faults) {
  std::mt19937_64 random(faults.seed);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  struct Sample {
    double time = 0.0;
    double arrival = 0.0;
    bool is_lost = false;
    double force = 0.0;
  };
  std::vector<Sample> samples;
  for (int k = 0; k < steps; ++k) {
    Sample sample;
    sample.time = k * period + (faults.sampling_jitter > 0.0 ? faults.sampling_jitter * uniform() : 0.0);
    sample.is_lost = uniform() < faults.lost_sample_probability;
    sample.arrival = sample.time + delay + (uniform() < faults.overrun_probability ? faults.overrun_delay : 0.0);
    samples.push_back(sample);
  }
  // A force that a newer one reaches the device before, or with, never acts.
  double newest = std::numeric_limits<double>::infinity();
  for (auto sample = samples.rbegin(); sample != samples.rend(); ++sample) {
    if (sample->is_lost) continue;
    if (sample->arrival >= newest) sample->arrival = std::numeric_limits<double>::infinity();
    newest = std::min(newest, sample->arrival);
  }
  struct Event {
    double time = 0.0;
    int order = 0;  // at one time: arrivals first
    std::size_t sample = 0;
  };
  std::vector<Event> events;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!samples[k].is_lost) {
      events.push_back({samples[k].time, 0, k});
      if (std::isfinite(samples[k].arrival)) events.push_back({samples[k].arrival, 1, k});
    }
    events.push_back({static_cast<double>(k + 1) * period, 2, k});
  }
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.time < b.time; });
  RigidBody body;
  std::vector<double> positions;
  double now = 0.0;
  double force = 0.0;
  for (const Event& event : events) {
    body.move(force, event.time - now);
    now = event.time;
    if (event.order == 0) samples[event.sample].force = -stiffness * body.position;
    if (event.order == 1) force = samples[event.sample].force;
    if (event.order == 2) positions.push_back(body.position);
  }
  return positions;
}

void expect_as_by_events(double delay, const Faults& faults) {
  HybridLoopOptions options = starting_at(spring_wall(stiffness), {1e-3});
  options.faults = faults;
  HybridLoop loop(Device(rigid(delay)), options);
  const std::vector<double> expected = by_events(delay, faults);
  ASSERT_EQ(expected.size(), static_cast<std::size_t>(steps));
  for (const double position : expected) {
    loop.step();
    ASSERT_NEAR(loop.position(0), position, 1e-12 + 1e-9 * std::abs(position)) << loop.sample();
  }
}

TEST(Faults, LostSamplesKeepTheLastForce) { expect_as_by_events(0.0, {0.3, 0.0, 0.0, 0.0, 1}); }
TEST(Faults, LostSamplesWithADelay) { expect_as_by_events(1.3e-3, {0.3, 0.0, 0.0, 0.0, 2}); }
TEST(Faults, Jitter) { expect_as_by_events(0.0, {0.0, 0.8e-3, 0.0, 0.0, 3}); }
TEST(Faults, JitterWithADelay) { expect_as_by_events(2.7e-3, {0.0, 0.8e-3, 0.0, 0.0, 4}); }
TEST(Faults, LateForcesWithinThePeriod) { expect_as_by_events(0.0, {0.0, 0.0, 0.25, 0.4e-3, 5}); }
TEST(Faults, LateForcesThatNewerOnesOvertake) { expect_as_by_events(0.2e-3, {0.0, 0.0, 0.25, 1.7e-3, 6}); }
TEST(Faults, Everything) { expect_as_by_events(3.1e-3, {0.1, 0.5e-3, 0.2, 2.3e-3, 7}); }

TEST(Faults, AllSamplesLostIsAFreeDevice) {
  HybridLoopOptions lost = starting_at(spring_wall(stiffness), {1e-3}, {0.1});
  lost.faults.lost_sample_probability = 1.0;
  HybridLoop loop(Device(rigid(0.0)), lost);
  HybridLoop free(Device(rigid(0.0)), starting_at({}, {1e-3}, {0.1}));
  for (int k = 0; k < 100; ++k) {
    loop.step();
    free.step();
    EXPECT_NEAR(loop.position(0), free.position(0), 1e-15);
  }
}

// Faults that never happen, and yet take the path that could have them.
TEST(Faults, FaultsWithoutEffectAreNoFaults) {
  for (const double delay : {0.0, 0.25e-3, 1e-3, 2.25e-3, 7e-3}) {
    SCOPED_TRACE(delay);
    DeviceParameters device = test::with_friction(test::with_delay(test::lhifam_parameters(), delay), 0.05, 0.1);
    HybridLoopOptions options = starting_at(spring_wall(400.0, 2.0), {1e-3, 1e-3}, {0.02, 0.02});
    HybridLoop plain(Device(device), options);
    options.faults.overrun_probability = 1.0;  // late by nothing
    HybridLoop faulty(Device(device), options);
    for (int k = 0; k < 1000; ++k) {
      plain.step();
      faulty.step();
      for (std::size_t i = 0; i < 2; ++i) ASSERT_NEAR(plain.position(i), faulty.position(i), 1e-13) << k;
      ASSERT_NEAR(plain.work(), faulty.work(), 1e-13) << k;
    }
  }
}

TEST(Faults, TheSeedDecidesEverything) {
  HybridLoopOptions options = starting_at(spring_wall(stiffness), {1e-3});
  options.faults = {0.2, 0.5e-3, 0.2, 0.7e-3, 42};
  HybridLoop one(Device(rigid(0.0)), options);
  HybridLoop same(Device(rigid(0.0)), options);
  options.faults.seed = 43;
  HybridLoop other(Device(rigid(0.0)), options);
  bool differs = false;
  std::vector<double> first;
  for (int k = 0; k < 500; ++k) {
    one.step();
    same.step();
    other.step();
    first.push_back(one.position(0));
    ASSERT_EQ(one.position(0), same.position(0));
    differs = differs || one.position(0) != other.position(0);
  }
  EXPECT_TRUE(differs);
  one.reset();
  for (const double position : first) {
    one.step();
    ASSERT_EQ(one.position(0), position);
  }
}

TEST(Faults, RefusedOutsideTheirDomain) {
  const Device device(rigid(0.0));
  const auto refused = [&device](Faults faults) {
    HybridLoopOptions options;
    options.faults = faults;
    EXPECT_THROW(HybridLoop(device, options), Error);
  };
  refused({1.5, 0.0, 0.0, 0.0, 1});
  refused({-0.1, 0.0, 0.0, 0.0, 1});
  refused({std::nan(""), 0.0, 0.0, 0.0, 1});
  refused({0.0, 1e-3, 0.0, 0.0, 1});
  refused({0.0, -1e-5, 0.0, 0.0, 1});
  refused({0.0, 0.0, 2.0, 0.0, 1});
  refused({0.0, 0.0, 0.5, -1.0, 1});
  refused({0.0, 0.0, 0.5, 1e9, 1});
}

}  // namespace
}  // namespace zwidth
