#include "zwidth/stability/wall_margins.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "stability/margins/unit_gain.hpp"
#include "stability/second_route/spectral_radius.hpp"
#include "zwidth/error.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;

DeviceParameters with_wall(DeviceParameters device, Wall wall) {
  device.wall = wall;
  return device;
}

// The product of many terms is nothing but rounding where their sum is not: three of six crossovers were made up by that,
// and a delay margin of 3.6 ms where 102 ms are true.
TEST(WallMargins, GainCrossoversOfManyBodiesAreAllTrueAndAllThere) {
  for (const std::uint64_t seed : {1U, 2U}) {
    test::RandomDevices random(seed);
    DeviceParameters parameters;
    constexpr std::size_t bodies = 60;
    for (std::size_t i = 0; i < bodies; ++i) {
      parameters.bodies.push_back(
          {"b" + std::to_string(i), random.log_uniform(0.1, 3.0), random.log_uniform(0.01, 5.0), 0.0, 0.0});
      if (i > 0) parameters.links.push_back({i - 1, i, random.log_uniform(3e3, 1e6), random.log_uniform(0.1, 20.0)});
    }
    parameters.loop.sampling_period = 1e-3;
    parameters.loop.delay = 0.3e-3;
    parameters.loop.held = bodies - 1;
    parameters.wall.stiffness = 300.0;
    parameters.wall.damping = 5.0;
    const FilteredPlant plant = filtered_plant(Device(parameters));
    const auto gain = [&](double angle) { return std::abs(loop_gain(plant, parameters.wall, angle)); };
    std::size_t passes = 0;
    constexpr double step = 2e-4;  // relative
    for (double angle = 1e-6; angle * (1.0 + step) < pi; angle *= 1.0 + step) {
      if ((gain(angle) > 1.0) != (gain(angle * (1.0 + step)) > 1.0)) ++passes;
    }
    const std::vector<UnitGainPoint> points = unit_gain_points(plant, parameters.wall);
    EXPECT_EQ(points.size(), passes) << "seed " << seed;
    for (const UnitGainPoint& point : points) EXPECT_NEAR(gain(point.angle), 1.0, 1e-6) << "seed " << seed;
  }
}

double excess(const DeviceParameters& parameters, const Wall& wall) {
  const Device device(parameters);
  const auto is_tied = [](const Body& body) { return body.stiffness > 0.0; };
  const bool is_free = *wall.stiffness == 0.0 && std::ranges::none_of(parameters.bodies, is_tied);
  return stability_excess(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), wall,
                          is_free ? CountedPoles::but_free_position : CountedPoles::all);
}

std::vector<DeviceParameters> devices() {
  std::vector<DeviceParameters> all{test::rigid_parameters(), test::lhifam_parameters(),
                                    test::handle_sensed(test::lhifam_parameters()),
                                    test::reduced_pretension_parameters()};
  for (const double delay : {0.25e-3, 2e-3, 5.7e-3}) {
    all.push_back(test::with_delay(test::lhifam_parameters(), delay));
    all.push_back(test::with_delay(test::reduced_pretension_parameters(), delay));
  }
  DeviceParameters grounded = test::lhifam_parameters();
  grounded.bodies[1].stiffness = 500.0;
  all.push_back(grounded);
  return all;
}

const Wall walls[] = {{100.0, 0.0, 0.0},  {100.0, 5.0, 0.0},    {100.0, 5.0, 30.0}, {3000.0, 0.0, 0.0},
                      {3000.0, 5.0, 0.0}, {6000.0, 40.0, 20.0}, {0.0, 5.0, 0.0},    {20000.0, 10.0, 0.0}};

template <typename Check>
void for_every_wall(Check check) {
  for (const DeviceParameters& device : devices()) {
    for (const Wall& wall : walls) {
      SCOPED_TRACE(testing::Message() << device.name << ", sensed " << device.loop.sensed << ", t_d "
                                      << device.loop.delay << ", K " << *wall.stiffness << ", B " << wall.damping
                                      << ", f " << wall.velocity_filter_hz);
      check(device, wall);
    }
  }
}

TEST(WallMargins, StableIffEigenvaluesAreInside) {
  int stable = 0;
  int unstable = 0;
  for_every_wall([&](const DeviceParameters& device, const Wall& wall) {
    const WallMargins margins = wall_margins(Device(with_wall(device, wall)));
    EXPECT_EQ(margins.stiffness, *wall.stiffness);
    EXPECT_EQ(margins.damping, wall.damping);
    EXPECT_NEAR(margins.spectral_radius - 1.0, excess(device, wall), 1e-12);
    EXPECT_EQ(margins.stable, excess(device, wall) < 0.0);
    ++(margins.stable ? stable : unstable);
    if (!margins.stable) {
      EXPECT_FALSE(margins.gain_margin.has_value());
      EXPECT_FALSE(margins.lower_gain_margin.has_value());
      EXPECT_FALSE(margins.phase_margin.has_value());
      EXPECT_FALSE(margins.delay_margin.has_value());
    }
  });
  EXPECT_GT(stable, 20);
  EXPECT_GT(unstable, 10);
}

// The whole wall, K and B, times the gain margin is at the edge: stable below, unstable above.
TEST(WallMargins, GainMarginsAreEdges) {
  int seen = 0;
  for_every_wall([&](const DeviceParameters& device, const Wall& wall) {
    const WallMargins margins = wall_margins(Device(with_wall(device, wall)));
    const auto times = [&](double factor) {
      return excess(device, {*wall.stiffness * factor, wall.damping * factor, wall.velocity_filter_hz});
    };
    if (margins.gain_margin) {
      ++seen;
      EXPECT_GT(*margins.gain_margin, 1.0);
      EXPECT_GT(times(*margins.gain_margin * (1.0 + 1e-5)), 0.0);
      if (*wall.stiffness > 0.0) {
        EXPECT_LT(times(*margins.gain_margin * (1.0 - 1e-5)), 0.0);
        EXPECT_LT(times(0.5 * (1.0 + *margins.gain_margin)), 0.0);
      }
    }
    if (margins.lower_gain_margin) {
      EXPECT_LT(*margins.lower_gain_margin, 1.0);
      EXPECT_GT(times(*margins.lower_gain_margin * (1.0 - 1e-5)), 0.0);
      EXPECT_LT(times(*margins.lower_gain_margin * (1.0 + 1e-5)), 0.0);
    }
  });
  EXPECT_GT(seen, 20);
}

TEST(WallMargins, WithoutDamperGainMarginLandsOnACrossover) {
  const Device device(with_wall(test::lhifam_parameters(), {2500.0, 0.0, 0.0}));
  const CriticalStiffness critical = critical_stiffness(filtered_plant(device));
  const WallMargins margins = wall_margins(device);
  ASSERT_TRUE(margins.stable);
  EXPECT_NEAR(*margins.gain_margin * 2500.0 / critical.stiffness, 1.0, 1e-13);
  EXPECT_FALSE(margins.lower_gain_margin.has_value());
}

std::complex<double> loop_of(const SampledPlant& plant, const Wall& wall, double frequency) {
  const std::complex<double> z = std::polar(1.0, frequency * plant.period);
  std::complex<double> v = (1.0 - 1.0 / z) / plant.period;
  if (wall.velocity_filter_hz > 0.0) {
    const double a = std::exp(-2.0 * pi * wall.velocity_filter_hz * plant.period);
    v *= (1.0 - a) / (1.0 - a / z);
  }
  return (*wall.stiffness + wall.damping * v) * response(plant, frequency);
}

// At every gain crossover |L| = 1; between them, and on a fine grid, |L| - 1 keeps its sign: none is missed.
TEST(WallMargins, GainCrossoversAreComplete) {
  for_every_wall([&](const DeviceParameters& device, const Wall& wall) {
    const FilteredPlant plant = filtered_plant(Device(device));
    const LoopMargins margins = loop_margins(plant, wall);
    std::vector<double> edges{0.0};
    for (const GainCrossover& crossover : margins.gain_crossovers) {
      EXPECT_NEAR(std::abs(loop_of(plant, wall, crossover.frequency)), 1.0, 1e-9);
      EXPECT_NEAR(
          std::remainder(std::arg(-loop_of(plant, wall, crossover.frequency)) - crossover.phase_margin, 2.0 * pi), 0.0,
          1e-9);
      EXPECT_GT(crossover.frequency, edges.back());
      edges.push_back(crossover.frequency);
    }
    edges.push_back(pi / plant.period);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      const double width = edges[i + 1] - edges[i];
      const bool above = std::abs(loop_of(plant, wall, edges[i] + 0.5 * width)) > 1.0;
      for (int k = 1; k < 400; ++k) {
        const double magnitude = std::abs(loop_of(plant, wall, edges[i] + width * (k / 400.0)));
        ASSERT_EQ(magnitude > 1.0, above) << edges[i] + width * (k / 400.0);
      }
    }
  });
}

// Least over all gain crossovers: phase either way, delay by phase lag over frequency.
TEST(WallMargins, PhaseAndDelayMarginsAreTheLeast) {
  int seen = 0;
  for_every_wall([&](const DeviceParameters& device, const Wall& wall) {
    const LoopMargins margins = loop_margins(filtered_plant(Device(device)), wall);
    if (!margins.stable || margins.gain_crossovers.empty()) return;
    ++seen;
    double phase = 10.0;
    double delay = 1e9;
    for (const GainCrossover& crossover : margins.gain_crossovers) {
      phase = std::min(phase, std::abs(crossover.phase_margin));
      const double lag = crossover.phase_margin < 0.0 ? crossover.phase_margin + 2.0 * pi : crossover.phase_margin;
      delay = std::min(delay, lag / crossover.frequency);
    }
    EXPECT_EQ(margins.phase_margin.value(), phase);
    EXPECT_EQ(margins.delay_margin.value(), delay);
  });
  EXPECT_GT(seen, 10);
}

// Added delay of whole samples is exact: stable just below the margin, unstable just above it.
TEST(WallMargins, DelayMarginIsTheEdge) {
  for (const DeviceParameters& base : {test::rigid_parameters(), test::lhifam_parameters()}) {
    for (const double stiffness : {100.0, 300.0, 1000.0}) {
      const Wall wall{stiffness, 1.0, 0.0};
      const LoopMargins margins = loop_margins(filtered_plant(Device(base)), wall);
      ASSERT_TRUE(margins.stable);
      ASSERT_TRUE(margins.delay_margin.has_value());
      const double samples = *margins.delay_margin / 1e-3;
      EXPECT_GT(samples, 1.0);
      EXPECT_LT(excess(test::with_delay(base, std::floor(samples) * 1e-3), wall), 0.0);
      EXPECT_GT(excess(test::with_delay(base, std::ceil(samples) * 1e-3), wall), 0.0);
    }
  }
  // A stiffness whose margin is exactly two samples: the critical stiffness at a delay of 2 T.
  const double k =
      critical_stiffness(filtered_plant(Device(test::with_delay(test::lhifam_parameters(), 2e-3)))).stiffness;
  const LoopMargins margins = loop_margins(filtered_plant(Device(test::lhifam_parameters())), {k, 0.0, 0.0});
  EXPECT_NEAR(margins.delay_margin.value(), 2e-3, 2e-12);
}

TEST(WallMargins, NoWallStiffnessAndNoDamping) {
  const LoopMargins free = loop_margins(filtered_plant(Device(test::lhifam_parameters())), {0.0, 0.0, 0.0});
  EXPECT_TRUE(free.stable);  // it stays where it is: a position that nothing holds is no instability
  EXPECT_TRUE(free.gain_crossovers.empty());
  DeviceParameters grounded = test::lhifam_parameters();
  grounded.bodies[1].stiffness = 500.0;
  const LoopMargins held = loop_margins(filtered_plant(Device(grounded)), {0.0, 0.0, 0.0});
  EXPECT_TRUE(held.stable);
  EXPECT_TRUE(held.gain_crossovers.empty());
  EXPECT_FALSE(held.gain_margin.has_value());
  EXPECT_FALSE(held.delay_margin.has_value());
}

TEST(WallMargins, BadWallsThrow) {
  const FilteredPlant plant = filtered_plant(Device(test::rigid_parameters()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Wall& wall : {Wall{}, Wall{-1.0, 0.0, 0.0}, Wall{nan, 0.0, 0.0}, Wall{1.0, -1.0, 0.0}, Wall{1.0, nan, 0.0},
                           Wall{1.0, 1.0, -1.0}, Wall{std::numeric_limits<double>::infinity(), 0.0, 0.0}}) {
    try {
      (void)loop_margins(plant, wall);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
    }
  }
  EXPECT_THROW((void)wall_margins(Device(test::lhifam_parameters())), Error);
}

// The winding number's route, used beyond 100 samples of delay, against eigenvalues where both can.
TEST(SpectralRadius, ByWindingAgreesWithEigenvalues) {
  for_every_wall([&](const DeviceParameters& device, const Wall& wall) {
    EXPECT_NEAR(spectral_radius_by_winding(filtered_plant(Device(device)), wall) - 1.0, excess(device, wall), 1e-9);
  });
  for (const double samples : {20.0, 60.5, 100.0}) {
    const DeviceParameters device = test::with_delay(test::lhifam_parameters(), samples * 1e-3);
    for (const Wall& wall : {Wall{20.0, 0.0, 0.0}, Wall{300.0, 2.0, 0.0}, Wall{300.0, 2.0, 30.0}}) {
      EXPECT_NEAR(spectral_radius_by_winding(filtered_plant(Device(device)), wall) - 1.0, excess(device, wall), 1e-9)
          << samples << " samples, K " << *wall.stiffness;
    }
  }
}

TEST(SpectralRadius, OfLongDelays) {
  for (const double samples : {101.0, 150.5}) {
    for (const double stiffness : {2.0, 200.0}) {
      const Wall wall{stiffness, 0.5, 0.0};
      const DeviceParameters device = test::with_delay(test::lhifam_parameters(), samples * 1e-3);
      const WallMargins margins = wall_margins(Device(with_wall(device, wall)));
      EXPECT_NEAR(margins.spectral_radius - 1.0, excess(device, wall), 1e-9);
      EXPECT_EQ(margins.stable, margins.spectral_radius < 1.0);
    }
  }
}

}  // namespace
}  // namespace zwidth
