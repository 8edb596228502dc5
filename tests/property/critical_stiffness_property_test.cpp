// Random devices against an independent route: matrix exponential and closed-loop eigenvalues know nothing of modal
// forms, Taylor models or crossovers.

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "property/property_cases.hpp"
#include "property/random_devices.hpp"
#include "stability/second_route/pole_count.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

std::size_t cases_per_kind() {
  return std::max<std::size_t>(1, test::property_cases(10'000) / test::device_kinds.size());
}

CriticalStiffness critical_stiffness_of(const Device& device) {
  const Wall& wall = device.parameters().wall;
  return critical_stiffness(filtered_plant(device), {wall.damping, wall.velocity_filter_hz});
}

// Poles outside the circle at stiffness K; a pole within rounding of the circle, other than by K's doing, cannot occur.
int poles_outside(const DiscreteStateSpace& plant, Wall wall, double stiffness) {
  wall.stiffness = stiffness;
  int outside = 0;
  for (const std::complex<double>& delta : closed_loop_poles_minus_one(plant, wall)) {
    if (2.0 * delta.real() + std::norm(delta) > 0.0) ++outside;
  }
  return outside;
}

class CriticalStiffnessProperty : public testing::TestWithParam<std::string_view> {};

// Just below and just above every crossover the number of poles outside changes as claimed, and between one crossover
// and the next it does not change: none is missed. Stable intervals are those with no pole outside.
TEST_P(CriticalStiffnessProperty, EigenvaluesConfirmEveryCrossoverAndNoOther) {
  // Relative distance from the crossover. Eigenvalues of long chains sensed far from the actuator are uncertain by up
  // to 1e-3 at their stiffest crossovers (they respond to the last bit of the state matrix), so those are asked further
  // off.
  const auto kind = std::find(test::device_kinds.begin(), test::device_kinds.end(), GetParam());
  const double step =
      kind - test::device_kinds.begin() < static_cast<std::ptrdiff_t>(test::reference_kinds) ? 1e-4 : 1e-2;
  for (std::size_t seed = 0; seed < cases_per_kind(); ++seed) {
    test::RandomDevices random(seed * 1000003 + std::hash<std::string_view>{}(GetParam()) % 1000);
    const Device device(random.device(GetParam()));
    const Wall& wall = device.parameters().wall;
    const CriticalStiffness result = critical_stiffness_of(device);
    const DiscreteStateSpace plant = sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
    std::vector<Crossover> by_stiffness = result.crossovers;
    std::sort(by_stiffness.begin(), by_stiffness.end(),
              [](const Crossover& a, const Crossover& b) { return a.stiffness < b.stiffness; });
    const auto claimed_stable = [&result](double stiffness) {
      return std::any_of(result.stable_intervals.begin(), result.stable_intervals.end(), [&](const StableInterval& i) {
        return i.lower < stiffness && (!i.upper || stiffness < *i.upper);
      });
    };
    // Far stiffer crossovers than the softest are beyond what eigenvalues in double precision resolve.
    const double resolved = by_stiffness.empty() ? 0.0 : std::min(1e13 * by_stiffness.front().stiffness, 1e16);
    std::erase_if(by_stiffness, [&](const Crossover& c) { return c.stiffness > resolved; });
    int before = -1;  // poles outside, seen on the upper side of the last crossover
    for (std::size_t i = 0; i < by_stiffness.size(); ++i) {
      const Crossover& crossover = by_stiffness[i];
      const bool crowded =
          (i > 0 && crossover.stiffness < by_stiffness[i - 1].stiffness * (1.0 + 3.0 * step)) ||
          (i + 1 < by_stiffness.size() && by_stiffness[i + 1].stiffness < crossover.stiffness * (1.0 + 3.0 * step));
      if (crowded) {
        before = -1;
        continue;
      }
      const double below = crossover.stiffness * (1.0 - step);
      const double above = crossover.stiffness * (1.0 + step);
      const int outside_below = poles_outside(plant, wall, below);
      const int outside_above = poles_outside(plant, wall, above);
      ASSERT_EQ(outside_above - outside_below, crossover.poles_leaving)
          << GetParam() << " seed " << seed << " K = " << crossover.stiffness << " at " << crossover.frequency
          << " rad/s";
      if (before >= 0) {
        ASSERT_EQ(outside_below, before) << GetParam() << " seed " << seed
                                         << ": missed below K = " << crossover.stiffness;
      }
      ASSERT_EQ(outside_below == 0, claimed_stable(below)) << GetParam() << " seed " << seed << " K = " << below;
      ASSERT_EQ(outside_above == 0, claimed_stable(above)) << GetParam() << " seed " << seed << " K = " << above;
      before = outside_above;
    }
    // Far below the first and far above the last crossover.
    if (!by_stiffness.empty() && before >= 0) {
      if (by_stiffness.size() == result.crossovers.size()) {
        const double far = 10.0 * by_stiffness.back().stiffness;
        const std::optional<int> outside =
            far <= resolved ? poles_outside(plant, wall, far) : internal::unstable_poles_in_digits(device, far);
        ASSERT_EQ(outside, before) << GetParam() << " seed " << seed;
      }
      ASSERT_EQ(poles_outside(plant, wall, 0.1 * by_stiffness.front().stiffness) == 0,
                claimed_stable(0.1 * by_stiffness.front().stiffness))
          << GetParam() << " seed " << seed;
    }
  }
}

TEST_P(CriticalStiffnessProperty, OrderOfBodiesDoesNotMatter) {
  for (std::size_t seed = 0; seed < cases_per_kind(); ++seed) {
    test::RandomDevices random(seed * 999983 + 7);
    const DeviceParameters parameters = random.device(GetParam());
    if (parameters.bodies.empty()) return;  // a transfer function has no order of bodies
    DeviceParameters reversed = parameters;
    const std::size_t last = parameters.bodies.size() - 1;
    std::reverse(reversed.bodies.begin(), reversed.bodies.end());
    for (Link& link : reversed.links) link.first = last - link.first, link.second = last - link.second;
    reversed.loop.actuated = last - parameters.loop.actuated;
    reversed.loop.sensed = last - parameters.loop.sensed;
    reversed.loop.held = last - parameters.loop.held;
    const CriticalStiffness a = critical_stiffness_of(Device(parameters));
    const CriticalStiffness b = critical_stiffness_of(Device(reversed));
    ASSERT_EQ(a.status, b.status) << GetParam() << " seed " << seed;
    ASSERT_EQ(a.crossovers.size(), b.crossovers.size()) << GetParam() << " seed " << seed;
    if (a.limit) {
      ASSERT_NEAR(a.stiffness / b.stiffness, 1.0, 1e-9) << GetParam() << " seed " << seed;
    }
  }
}

// Units of mass scale every force, K included; units of time t -> c t scale K by 1/c². A unit of length leaves N/m as
// it is and scales a rotary device as a unit of mass does.
TEST_P(CriticalStiffnessProperty, ScalesWithUnits) {
  for (std::size_t seed = 0; seed < cases_per_kind(); ++seed) {
    test::RandomDevices random(seed * 999979 + 11);
    const DeviceParameters parameters = random.device(GetParam());
    if (parameters.bodies.empty()) return;  // nor units of mass
    const double mass = random.log_uniform(1e-3, 1e3);
    const double time = random.log_uniform(0.1, 10.0);
    DeviceParameters scaled = parameters;
    const double damping = mass / time;
    const double stiffness = mass / (time * time);
    for (Body& b : scaled.bodies) b.mass *= mass, b.damping *= damping, b.stiffness *= stiffness;
    for (Link& link : scaled.links) link.damping *= damping, link.stiffness *= stiffness;
    scaled.user.mass *= mass;
    scaled.user.damping *= damping;
    scaled.user.stiffness *= stiffness;
    scaled.wall.damping *= damping;
    scaled.wall.velocity_filter_hz /= time;
    for (WallFilter& filter : scaled.wall.filters) filter.frequency_hz /= time;
    scaled.loop.sampling_period *= time;
    scaled.loop.delay *= time;
    scaled.actuator.time_constant *= time;
    const CriticalStiffness a = critical_stiffness_of(Device(parameters));
    const CriticalStiffness b = critical_stiffness_of(Device(scaled));
    ASSERT_EQ(a.status, b.status) << GetParam() << " seed " << seed;
    ASSERT_EQ(a.crossovers.size(), b.crossovers.size()) << GetParam() << " seed " << seed;
    if (a.limit) {
      ASSERT_NEAR(b.stiffness / (a.stiffness * stiffness), 1.0, 1e-9) << GetParam() << " seed " << seed;
    }
  }
}

// The verdict on a wall and the spectral radius come by different routes.
TEST_P(CriticalStiffnessProperty, AStableWallHasItsPolesInsideTheCircle) {
  for (std::size_t seed = 0; seed < cases_per_kind(); ++seed) {
    test::RandomDevices random(seed * 999961 + 13);
    DeviceParameters parameters = random.device(GetParam());
    const CriticalStiffness result = critical_stiffness_of(Device(parameters));
    const double typical =
        result.crossovers.empty() ? 1.0 : result.crossovers[random.index(result.crossovers.size())].stiffness;
    if (typical > 1e20) continue;
    parameters.wall.stiffness = typical * random.log_uniform(0.1, 10.0);
    const WallMargins margins = wall_margins(Device(parameters));
    if (std::abs(margins.spectral_radius - 1.0) < 1e-9) continue;  // the eigenvalues do not tell
    ASSERT_EQ(margins.stable, margins.spectral_radius < 1.0)
        << GetParam() << " seed " << seed << " K = " << *parameters.wall.stiffness << " radius "
        << margins.spectral_radius;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, CriticalStiffnessProperty, testing::ValuesIn(test::device_kinds),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace zwidth
