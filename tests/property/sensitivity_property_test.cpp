// Sensitivities against central differences of the limits themselves, and against Euler's identities for a change of
// the units of time and of force, on random devices of every kind.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "campaign.hpp"
#include "property/random_devices.hpp"
#include "zwidth/design/sensitivity.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

std::size_t device_count(std::size_t usual) {
  const char* wish = std::getenv("ZWIDTH_PROPERTY_CASES");
  return wish != nullptr ? std::min<std::size_t>(usual, std::max<std::size_t>(21, std::strtoul(wish, nullptr, 10)))
                         : usual;
}

CriticalStiffness critical_of(const DeviceParameters& parameters) {
  return critical_stiffness(filtered_plant(Device(parameters)),
                            {parameters.wall.damping, parameters.wall.velocity_filter_hz});
}

struct Difference {
  double slope = 0.0;  // p/K dK/dp
  double error = 0.0;  // estimated
};

/// Central differences of log K by log p, with Richardson's extrapolation over falling steps; the estimate that changes
/// least. Nothing where K jumps or belongs to another crossover nearby.
template <typename Limit>
std::optional<Difference> difference(const DeviceParameters& parameters, const std::string& key, const Limit& limit,
                                     double first_step) {
  const double value = *parameter(parameters, key);
  const auto at = [&](double step) -> std::optional<double> {
    DeviceParameters moved = parameters;
    set_parameter(moved, key, value * (1.0 + step));
    if (find_problem(moved)) return std::nullopt;
    return limit(moved);
  };
  const std::optional<double> middle = at(0.0);
  if (!middle) return std::nullopt;
  constexpr int steps = 5;
  double table[steps][steps];
  std::optional<Difference> best;
  double step = first_step;
  for (int i = 0; i < steps; ++i, step *= 0.25) {
    const auto up = at(step);
    const auto down = at(-step);
    if (!up || !down) return std::nullopt;
    table[i][0] = (*up - *down) / (2.0 * step) / *middle;
    for (int k = 1; k <= i; ++k) {
      const double factor = std::pow(16.0, k);
      table[i][k] = (factor * table[i][k - 1] - table[i - 1][k - 1]) / (factor - 1.0);
      const double error =
          std::max(std::abs(table[i][k] - table[i][k - 1]), std::abs(table[i][k] - table[i - 1][k - 1]));
      if (!best || error < best->error) best = Difference{table[i][k], error};
    }
  }
  return best;
}

TEST(SensitivityProperty, OfTheCriticalStiffnessEqualsCentralDifferences) {
  constexpr double tolerance = 1e-6;
  std::size_t compared = 0;
  std::size_t limited = 0;
  std::size_t unsure = 0;
  const std::size_t devices = device_count(test::by_tier<std::size_t>(210, 1000));
  for (std::size_t seed = 0; seed < devices; ++seed) {
    const auto kind = test::device_kinds[seed % test::device_kinds.size()];
    const DeviceParameters parameters = test::RandomDevices(seed + 4000).device(kind);
    const CriticalStiffness critical = critical_of(parameters);
    if (!critical.limit) continue;
    ++limited;
    const auto limit = [&](const DeviceParameters& moved) -> std::optional<double> {
      const CriticalStiffness there = critical_of(moved);
      if (!there.limit || std::abs(std::log(there.stiffness / critical.stiffness)) > 0.5) return std::nullopt;
      return there.stiffness;
    };
    for (const Sensitivity& each : stiffness_sensitivities(Device(parameters))) {
      if (!each.relative) continue;
      const auto expected = difference(parameters, each.key, limit, 3e-3);
      // A corner (another crossover takes over within the step) or rounding: too little to compare with.
      const double scale = std::max(1.0, std::abs(*each.relative));
      if (!expected || expected->error > 0.1 * tolerance * scale) {
        ++unsure;
        continue;
      }
      ++compared;
      EXPECT_NEAR(*each.relative, expected->slope, tolerance * scale)
          << kind << ", seed " << seed << ", " << each.key << ", error " << expected->error;
    }
  }
  RecordProperty("compared", std::to_string(compared));
  RecordProperty("unsure", std::to_string(unsure));
  EXPECT_GT(limited, devices / 2);
  EXPECT_GT(compared, 7 * limited);
  EXPECT_LT(unsure, compared / 10);
}

/// Exponents of the units of time and of force in a parameter.
struct Units {
  double time = 0.0;
  double force = 0.0;
};

Units units_of(const std::string& key) {
  if (key.ends_with(".mass")) return {2.0, 1.0};
  if (key.ends_with(".damping")) return {1.0, 1.0};
  if (key.ends_with(".stiffness")) return {0.0, 1.0};
  if (key.starts_with("loop.") || key.starts_with("actuator.")) return {1.0, 0.0};
  if (key.ends_with("_hz")) return {-1.0, 0.0};
  return {};
}

void expect_homogeneous(const std::vector<Sensitivity>& sensitivities, double tolerance, const std::string& what) {
  double in_time = 0.0;
  double in_force = 0.0;
  double size = 1.0;
  for (const Sensitivity& each : sensitivities) {
    const Units units = units_of(each.key);
    in_time += units.time * each.relative.value_or(0.0);
    in_force += units.force * each.relative.value_or(0.0);
    size += std::abs(each.relative.value_or(0.0));
  }
  EXPECT_NEAR(in_time, 0.0, tolerance * size) << what;
  EXPECT_NEAR(in_force, 1.0, tolerance * size) << what;
}

TEST(SensitivityProperty, FollowsAChangeOfUnits) {
  const std::size_t devices = device_count(1000);
  std::size_t limited = 0;
  for (std::size_t seed = 0; seed < devices; ++seed) {
    const auto kind = test::device_kinds[seed % test::device_kinds.size()];
    if (kind == "transfer_function") continue;  // its coefficients have units, too
    const DeviceParameters parameters = test::RandomDevices(seed + 9000).device(kind);
    const auto sensitivities = stiffness_sensitivities(Device(parameters));
    if (sensitivities.empty()) continue;
    ++limited;
    expect_homogeneous(sensitivities, 1e-8, std::string(kind) + ", seed " + std::to_string(seed));
  }
  EXPECT_GT(limited, devices / 2);
}

TEST(SensitivityProperty, OfTheAnyUserLimitEqualsCentralDifferences) {
  // A limit reached towards w = 0 is itself good to 2e-6 only (absolute_stability.hpp): its differences and its slopes to 1e-4.
  constexpr double clear_angle = 3e-3;
  constexpr double of_flat_limits = 1e-4;
  std::size_t compared = 0;
  std::size_t limited = 0;
  std::size_t clear = 0;
  std::size_t unsure = 0;
  const std::size_t devices = device_count(test::by_tier<std::size_t>(21, 105));
  for (std::size_t seed = 0; seed < devices; ++seed) {
    const auto kind = test::device_kinds[seed % test::device_kinds.size()];
    if (kind == "transfer_function") continue;
    const DeviceParameters parameters = test::RandomDevices(seed + 300).device(kind);
    const AbsoluteStabilityLimit own =
        absolute_stability_limit(Device(parameters), {parameters.wall.damping, parameters.wall.velocity_filter_hz});
    if (!(own.stiffness > 0.0) || !std::isfinite(own.stiffness)) continue;
    ++limited;
    const bool is_clear = own.frequency * parameters.loop.sampling_period > clear_angle;
    clear += is_clear ? 1 : 0;
    const double tolerance = is_clear ? 1e-5 : of_flat_limits;
    const auto limit = [&](const DeviceParameters& moved) -> std::optional<double> {
      const double there =
          absolute_stability_limit(Device(moved), {moved.wall.damping, moved.wall.velocity_filter_hz}).stiffness;
      if (!(there > 0.0) || !std::isfinite(there)) return std::nullopt;
      return there;
    };
    const auto sensitivities = absolute_stability_sensitivities(Device(parameters));
    expect_homogeneous(sensitivities, tolerance, std::string(kind) + ", seed " + std::to_string(seed));
    for (const Sensitivity& each : sensitivities) {
      if (!each.relative) continue;
      const auto expected = difference(parameters, each.key, limit, 0.02);
      const double scale = std::max(1.0, std::abs(*each.relative));
      if (!expected || expected->error > 0.1 * tolerance * scale) {
        ++unsure;
        continue;
      }
      ++compared;
      EXPECT_NEAR(*each.relative, expected->slope, tolerance * scale)
          << kind << ", seed " << seed << ", " << each.key << ", error " << expected->error
          << ", at w T = " << own.frequency * parameters.loop.sampling_period;
    }
  }
  RecordProperty("compared", std::to_string(compared));
  RecordProperty("unsure", std::to_string(unsure));
  EXPECT_GT(limited, devices / 2);
  EXPECT_GT(clear, devices / 4);
  EXPECT_GT(compared, 5 * limited);
  EXPECT_LT(unsure, compared / 4);
}

}  // namespace
}  // namespace zwidth
