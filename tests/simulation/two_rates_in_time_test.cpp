// A damper in a loop of its own, in time: against a computation of its own of one rigid body, event by event, and against the
// critical stiffness.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "property/random_two_rates.hpp"
#include "simulation/simulated_devices.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double spring_period = 1e-3;
constexpr int periods = 300;

struct Timing {
  double period = spring_period;
  double delay = 0.0;
};

struct TwoRateCase {
  Timing damper;
  double spring_delay = 0.0;
  double filter_hz = 0.0;
  double force_limit = never;
  double resolution = 0.0;
  bool only_pushes = false;
};

constexpr double stiffness = 3000.0;
constexpr double damping = 25.0;

/// m v' + b v = F over a time, in closed form.
struct Rigid {
  double position = 1e-3;
  double velocity = -0.02;
  void move(double force, double duration) {
    const double mass = 5.4;
    const double viscous = 3.5;
    const double rate = viscous / mass;
    const double share = -std::expm1(-rate * duration) / rate;
    position += velocity * share + force / viscous * (duration - share);
    velocity = velocity * std::exp(-rate * duration) + force / viscous * rate * share;
  }
};

/// All reads and arrivals of both paths, sorted and played: the position at every read of the spring.
std::vector<double> by_all_events(const TwoRateCase& each) {
  struct Happening {
    double time = 0.0;
    int order = 0;  // at one instant: reads before arrivals
    bool of_damper = false;
    std::size_t sample = 0;
  };
  std::vector<Happening> all;
  const double end = periods * spring_period;
  for (const bool of_damper : {false, true}) {
    const Timing timing = of_damper ? each.damper : Timing{spring_period, each.spring_delay};
    for (std::size_t k = 0; static_cast<double>(k) * timing.period < end * (1.0 - 1e-12); ++k) {
      const double time = static_cast<double>(k) * timing.period;
      all.push_back({time, 0, of_damper, k});
      all.push_back({time + timing.delay, 1, of_damper, k});
    }
  }
  std::ranges::stable_sort(all, [](const Happening& a, const Happening& b) {
    return std::abs(a.time - b.time) > 1e-12 ? a.time < b.time : a.order < b.order;
  });
  const double pole =
      each.filter_hz > 0.0 ? std::exp(-2.0 * std::numbers::pi * each.filter_hz * each.damper.period) : 0.0;
  Rigid body;
  std::vector<double> spring(1, 0.0);
  std::vector<double> damper(1, 0.0);
  std::vector<double> positions;
  double last = 0.0;
  double velocity = 0.0;
  double held_spring = 0.0;
  double held_damper = 0.0;
  double now = 0.0;
  for (const Happening& next : all) {
    if (next.time > end) break;
    double sum = held_spring + held_damper;
    if (each.only_pushes) sum = std::min(sum, 0.0);
    body.move(std::clamp(sum, -each.force_limit, each.force_limit), next.time - now);
    now = next.time;
    if (next.order == 1) {
      (next.of_damper ? held_damper : held_spring) = (next.of_damper ? damper : spring)[next.sample];
      continue;
    }
    const double seen =
        each.resolution > 0.0 ? each.resolution * std::floor(body.position / each.resolution + 0.5) : body.position;
    const bool acts = !each.only_pushes || seen > 0.0;
    if (next.of_damper) {
      if (next.sample == 0) last = seen;
      velocity = pole * velocity + (1.0 - pole) * (seen - last) / each.damper.period;
      last = seen;
      damper.resize(next.sample + 1);
      damper.back() = acts ? -damping * velocity : 0.0;
    } else {
      positions.push_back(body.position);
      spring.resize(next.sample + 1);
      spring.back() = acts ? -stiffness * seen : 0.0;
    }
  }
  return positions;
}

DeviceParameters device_of(const TwoRateCase& each) {
  DeviceParameters device = test::with_delay(test::rigid_parameters(), each.spring_delay);
  device.loop.sampling_period = spring_period;
  device.loop.damper = LoopDamper{each.damper.period, each.damper.delay};
  device.sensor.resolution = each.resolution;
  if (std::isfinite(each.force_limit)) device.actuator.force_limit = each.force_limit;
  return device;
}

HybridLoopOptions options_of(const TwoRateCase& each) {
  HybridLoopOptions options = test::starting_at(test::spring_wall(stiffness, damping, each.filter_hz), {1e-3}, {-0.02});
  if (each.only_pushes) options.controller.contact = ControllerOptions::Contact::unilateral;
  return options;
}

TEST(TwoRateLoop, MovesAsEventByEvent) {
  const TwoRateCase cases[] = {
      {.damper = {1e-4, 0.0}},
      {.damper = {1e-4, 3.7e-4}, .spring_delay = 0.25e-3},
      {.damper = {2e-4, 2e-4}, .spring_delay = 2.3e-3, .filter_hz = 150.0},
      {.damper = {spring_period / 7.0, 1.234e-4}, .spring_delay = 1e-3, .force_limit = 1.5},
      {.damper = {5e-3, 0.0}},
      {.damper = {5e-3, 7.31e-3}, .spring_delay = 1.7e-3, .filter_hz = 60.0},
      {.damper = {3e-3, 3e-3}, .spring_delay = 3e-3, .force_limit = 1.0},
      {.damper = {1e-3, 0.4e-3}, .spring_delay = 0.0},
      {.damper = {1e-3, 0.4e-3}, .spring_delay = 1.4e-3, .filter_hz = 60.0},
      {.damper = {1e-4, 1.5e-4}, .spring_delay = 0.5e-3, .resolution = 1e-5},
      {.damper = {4e-3, 1.5e-4}, .spring_delay = 0.5e-3, .only_pushes = true},
      {.damper = {2.5e-4, 1.5e-4}, .spring_delay = 0.5e-3, .force_limit = 2.0, .only_pushes = true},
  };
  for (const TwoRateCase& each : cases) {
    SCOPED_TRACE(&each - cases);
    const std::vector<double> expected = by_all_events(each);
    ASSERT_EQ(expected.size(), static_cast<std::size_t>(periods));
    const double largest = std::abs(*std::ranges::max_element(expected, {}, [](double y) { return std::abs(y); }));
    HybridLoop loop(Device(device_of(each)), options_of(each));
    for (const double position : expected) {
      ASSERT_NEAR(loop.sensed_position(), position, 1e-11 * largest) << loop.sample();
      loop.step();
    }
    EXPECT_NEAR(loop.time(), periods * spring_period, 1e-12);
    if (each.damper.delay + each.spring_delay > 0.0 && !each.only_pushes && each.resolution == 0.0) {
      EXPECT_NE(loop.command(), loop.spring_command());
    }
  }
}

TEST(TwoRateLoop, OfOneRateIsThatRateBitForBit) {
  DeviceParameters together = test::with_friction(test::lhifam_parameters(), 0.02, 0.0);
  together.loop.delay = 0.3e-3;
  DeviceParameters apart = together;
  apart.loop.damper = LoopDamper{together.loop.sampling_period, together.loop.delay};
  const HybridLoopOptions options = test::starting_at(test::spring_wall(4000.0, 20.0, 100.0), {1e-3, 1e-3});
  HybridLoop first{Device(together), options};
  HybridLoop second{Device(apart), options};
  // Nor does the loop of a damper that does nothing.
  apart.loop.damper = LoopDamper{1e-4, 0.0};
  const HybridLoopOptions undamped = test::starting_at(test::spring_wall(4000.0), {1e-3, 1e-3});
  HybridLoop third{Device(together), undamped};
  HybridLoop fourth{Device(apart), undamped};
  for (int k = 0; k < 500; ++k) {
    for (HybridLoop* loop : {&first, &second, &third, &fourth}) loop->step();
    ASSERT_EQ(first.sensed_position(), second.sensed_position());
    ASSERT_EQ(first.command(), second.command());
    ASSERT_EQ(third.sensed_position(), fourth.sensed_position());
  }
}

TEST(TwoRateLoop, ASpringThatRunsElsewhereHasTheDamperBesideIt) {
  for (const double damper_period : {1e-4, 4e-3}) {
    DeviceParameters device = test::lhifam_parameters();
    device.loop.damper = LoopDamper{damper_period, 2.3e-4};
    const HybridLoopOptions options = test::starting_at(test::spring_wall(4000.0, 20.0), {1e-3, 1e-3});
    HybridLoop whole{Device(device), options};
    HybridLoop outside{Device(device), options};
    for (int k = 0; k < 300; ++k) {
      whole.step();
      outside.move(-4000.0 * outside.measure());
      ASSERT_NEAR(outside.sensed_position(), whole.sensed_position(), 1e-15);
      ASSERT_NEAR(outside.command(), whole.command(), 1e-11);
    }
  }
}

TEST(TwoRateLoop, FaultsActOnEachPath) {
  for (const double damper_period : {2e-4, 3e-3}) {
    DeviceParameters device = test::rigid_parameters();
    device.loop.sampling_period = spring_period;
    device.loop.delay = 0.3e-3;
    device.loop.damper = LoopDamper{damper_period, 0.5e-3};
    HybridLoopOptions options = test::starting_at(test::spring_wall(stiffness, damping), {1e-3}, {0.01});
    HybridLoop undisturbed{Device(device), options};
    // Late by nothing: the events come one by one, and change nothing.
    options.faults.overrun_probability = 1.0;
    HybridLoop one_by_one{Device(device), options};
    options.faults.overrun_probability = 0.0;
    options.faults.lost_sample_probability = 1.0;
    HybridLoop lost{Device(device), options};
    Rigid free{1e-3, 0.01};
    for (int k = 0; k < 200; ++k) {
      undisturbed.step();
      one_by_one.step();
      lost.step();
      free.move(0.0, spring_period);
      ASSERT_NEAR(one_by_one.sensed_position(), undisturbed.sensed_position(), 1e-14);
      ASSERT_NEAR(lost.sensed_position(), free.position, 1e-14);
    }
    options.faults = {.sampling_jitter = 0.5e-3};
    const auto problem = find_problem(options, Device(device));
    EXPECT_EQ(problem.has_value(), damper_period < 0.5e-3);
    if (problem) {
      EXPECT_EQ(problem->member, "faults.sampling_jitter");
    }
  }
}

TEST(TwoRateLoop, FiltersAreRefusedBesideIt) {
  DeviceParameters device = test::lhifam_parameters();
  device.loop.damper = LoopDamper{1e-4, 0.0};
  HybridLoopOptions options = test::spring_wall(3000.0, 3.0);
  options.controller.filters = {{.kind = WallFilter::Kind::low_pass, .frequency_hz = 60.0}};
  const auto problem = find_problem(options, Device(device));
  ASSERT_TRUE(problem.has_value());
  EXPECT_EQ(problem->member, "controller.filters");
  options.controller.damping = 0.0;
  EXPECT_FALSE(find_problem(options, Device(device)).has_value());
}

// More of them: the property tests.
TEST(TwoRateLoop, GrowsAboveTheCriticalStiffnessAndDecaysBelow) {
  test::RandomTwoRates devices(45);
  int compared = 0;
  while (compared < 12) {
    const Device device = devices.next();
    SCOPED_TRACE(device.name());
    compared += test::compare_in_time(device) ? 1 : 0;
  }
}

TEST(TwoRateLoop, SimulateAgreesWithLinearAnalysis) {
  for (const double damper_period : {1e-4, 2e-3}) {
    DeviceParameters device = test::lhifam_parameters();
    device.loop.damper = LoopDamper{damper_period, 0.0};
    device.wall.damping = 30.0;
    const double critical = critical_stiffness(Device(device)).stiffness;
    for (const double share : {0.7, 1.3}) {
      device.wall.stiffness = share * critical;
      const Simulation run = simulate(Device(device), {});
      EXPECT_EQ(run.verdict, share < 1.0 ? LoopVerdict::settles : LoopVerdict::unstable);
      EXPECT_EQ(run.linear.critical.stiffness, critical);
      ASSERT_TRUE(run.linear.agrees.has_value());
      EXPECT_TRUE(*run.linear.agrees);
      EXPECT_GT(run.peak_penetration, 0.0);
    }
  }
}

}  // namespace
}  // namespace zwidth
