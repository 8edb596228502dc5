// Regions of random devices against closed-loop eigenvalues, which know nothing of curves, branches or slabs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "property/random_devices.hpp"
#include "zwidth/design/stable_region.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

// Regions per kind; 21 kinds. ZWIDTH_REGION_CASES overrides.
std::size_t cases_per_kind() {
  const char* wish = std::getenv("ZWIDTH_REGION_CASES");
  const std::size_t all = wish != nullptr ? std::strtoul(wish, nullptr, 10) : 200;
  return std::max<std::size_t>(1, all / test::device_kinds.size());
}

// A pole that the wall neither sees nor moves (a factor s of both polynomials) stays on the circle to rounding.
constexpr double on_circle = 1e-12;

class Eigenvalues {
 public:
  Eigenvalues(const Device& device, double velocity_filter_hz)
      : plant_(sample(state_space(device), {device.loop().sampling_period, device.loop().delay})),
        velocity_filter_hz_(velocity_filter_hz),
        filters_(device.parameters().wall.filters) {}

  [[nodiscard]] double excess(double stiffness, double damping) const {
    return stability_excess(plant_, {stiffness, damping, velocity_filter_hz_, filters_});
  }
  [[nodiscard]] bool is_stable(double stiffness, double damping) const {
    return excess(stiffness, damping) < on_circle;
  }
  // Whether the verdict is the same a step of 0.1 % away in every direction.
  [[nodiscard]] bool is_clear(double stiffness, double damping) const {
    constexpr double step = 1e-3;
    const bool here = is_stable(stiffness, damping);
    return std::abs(excess(stiffness, damping)) > on_circle && is_stable(stiffness * (1.0 + step), damping) == here &&
           is_stable(stiffness * (1.0 - step), damping) == here &&
           is_stable(stiffness, damping * (1.0 + step)) == here && is_stable(stiffness, damping * (1.0 - step)) == here;
  }

 private:
  DiscreteStateSpace plant_;
  double velocity_filter_hz_;
  std::vector<WallFilter> filters_;
};

struct RandomCase {
  Device device;
  double velocity_filter_hz;
  StableWalls walls;
  StableRegion region;
  Eigenvalues eigenvalues;
};

RandomCase random_case(std::string_view kind, std::size_t seed) {
  test::RandomDevices random(seed * 1000003 + std::hash<std::string_view>{}(kind) % 1000);
  Device device(random.device(kind));
  double filter = device.parameters().wall.velocity_filter_hz;
  if (filter == 0.0 && random.chance(0.3)) filter = random.log_uniform(20.0, 400.0);
  StableWalls walls(filtered_plant(device), filter);
  StableRegion region = stable_region(walls);
  Eigenvalues eigenvalues(device, filter);
  return {std::move(device), filter, std::move(walls), std::move(region), std::move(eigenvalues)};
}

class StableRegionProperty : public testing::TestWithParam<std::string_view> {};

// To the left of the outline, 1e-6 of K and B away, walls are stable, to the right they are not.
TEST_P(StableRegionProperty, EigenvaluesChangeSidesAcrossTheBoundary) {
  constexpr double step = 1e-6;
  constexpr std::size_t asked_per_arc = 8;
  std::size_t asked = 0;
  std::size_t untold = 0;
  for (std::size_t seed = 0; seed < cases_per_kind(); ++seed) {
    const RandomCase random = random_case(GetParam(), seed);
    for (const StableComponent& component : random.region.components) {
      for (const BoundaryArc& arc : component.outline.arcs) {
        if (arc.kind != BoundaryKind::oscillation) continue;
        const std::size_t inner = arc.points.size() - 2;
        for (std::size_t k = 0; k < std::min(inner, asked_per_arc); ++k) {
          const std::size_t i = 1 + k * inner / asked_per_arc;
          const BoundaryPoint& before = arc.points[i - 1];
          const BoundaryPoint& at = arc.points[i];
          const BoundaryPoint& after = arc.points[i + 1];
          // The left normal, K and B measured by themselves.
          const double along = (after.stiffness - before.stiffness) / at.stiffness;
          const double up = (after.damping - before.damping) / at.damping;
          const double length = std::hypot(along, up);
          if (!(length > 0.0) || !std::isfinite(length)) continue;
          const auto excess = [&](double distance) {
            return random.eigenvalues.excess(at.stiffness * (1.0 - distance * up / length),
                                             at.damping * (1.0 + distance * along / length));
          };
          ++asked;
          const double inside = excess(step);
          const double outside = excess(-step);
          if (inside < on_circle && outside > std::max(inside, 0.0)) continue;
          // Eigenvalues of long chains do not resolve 1e-6: there they must tell 1e-3.
          ++untold;
          EXPECT_LT(excess(1e-3), on_circle)
              << GetParam() << " seed " << seed << " K " << at.stiffness << " B " << at.damping;
          EXPECT_GT(excess(-1e-3), 0.0) << GetParam() << " seed " << seed << " K " << at.stiffness << " B "
                                        << at.damping;
        }
      }
    }
  }
  EXPECT_LE(untold, asked / 50) << "of " << asked;
  RecordProperty("points", static_cast<int>(asked));
  RecordProperty("untold", static_cast<int>(untold));
}

// A dense raster, even and logarithmic, some beyond the region: no component is missed and none invented.
TEST_P(StableRegionProperty, EigenvaluesOfADenseRasterAgree) {
  constexpr int even = 24;
  constexpr int logarithmic = 24;
  for (std::size_t seed = 0; seed < cases_per_kind(); ++seed) {
    const RandomCase random = random_case(GetParam(), seed);
    const double largest_stiffness = random.region.stiffest ? random.region.stiffest->stiffness : 1e3;
    const double largest_damping = random.region.most_damped ? random.region.most_damped->damping : 10.0;
    std::vector<double> stiffnesses;
    std::vector<double> dampings{0.0};
    for (int i = 1; i <= even; ++i) {
      stiffnesses.push_back(1.3 * largest_stiffness * i / even);
      dampings.push_back(1.3 * largest_damping * i / even);
    }
    for (int i = 0; i < logarithmic; ++i) {
      const double share = std::pow(10.0, -4.0 + 6.0 * i / logarithmic);
      stiffnesses.push_back(share * largest_stiffness);
      dampings.push_back(share * largest_damping);
    }
    std::sort(stiffnesses.begin(), stiffnesses.end());
    const auto grid = stable_on_grid(random.walls, stiffnesses, dampings);
    for (std::size_t i = 0; i < dampings.size(); ++i) {
      for (std::size_t j = 0; j < stiffnesses.size(); ++j) {
        const bool ours = grid[i * stiffnesses.size() + j] != 0;
        if (ours == random.eigenvalues.is_stable(stiffnesses[j], dampings[i])) continue;
        EXPECT_FALSE(random.eigenvalues.is_clear(stiffnesses[j], dampings[i]))
            << GetParam() << " seed " << seed << " filter " << random.velocity_filter_hz << " K " << stiffnesses[j]
            << " B " << dampings[i] << ": " << (ours ? "stable" : "unstable") << " against eigenvalues";
      }
    }
  }
}

// At B = 0, and at any B between, the intervals are those of critical_stiffness(). Beside a mode without damping to
// speak of, rounding of the frequency alone moves K by 1e-10 of the region's extent; at B = 0 K_CR itself is held to
// 1e-9.
TEST_P(StableRegionProperty, IntervalsAreThoseOfTheCriticalStiffness) {
  for (std::size_t seed = 0; seed < cases_per_kind(); ++seed) {
    const RandomCase random = random_case(GetParam(), seed);
    const FilteredPlant plant = filtered_plant(random.device);
    const double largest = random.region.most_damped ? random.region.most_damped->damping : 10.0;
    for (const double share : {0.0, 1e-5, 0.003, 0.03, 0.123, 0.31, 0.57, 0.83, 0.97, 1.1, 7.0}) {
      const double damping = share * largest;
      const auto ours = random.walls.stable_stiffnesses(damping);
      const auto exact = critical_stiffness(plant, {damping, random.velocity_filter_hz}).stable_intervals;
      ASSERT_EQ(ours.size(), exact.size()) << GetParam() << " seed " << seed << " B " << damping;
      const double extent = random.region.stiffest ? random.region.stiffest->stiffness : 0.0;
      for (std::size_t i = 0; i < ours.size(); ++i) {
        EXPECT_NEAR(ours[i].lower, exact[i].lower, 1e-9 * extent) << GetParam() << " seed " << seed;
        ASSERT_EQ(ours[i].upper.has_value(), exact[i].upper.has_value());
        if (exact[i].upper) {
          EXPECT_NEAR(*ours[i].upper, *exact[i].upper, 1e-9 * (damping == 0.0 ? *exact[i].upper : extent))
              << GetParam() << " seed " << seed << " B " << damping;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, StableRegionProperty, testing::ValuesIn(test::device_kinds),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace zwidth
