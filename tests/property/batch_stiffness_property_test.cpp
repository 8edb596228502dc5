// The kernel in vectors against critical_stiffness(Device), one by one: random devices of every kind, each number of
// theirs a column.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "property/property_cases.hpp"
#include "property/random_devices.hpp"
#include "zwidth/batch/batch_stiffness.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

// Of rigid and two-mass devices. Two-mass devices that a spring ties to ground ("grounded", "operator") the kernel does
// not take.
constexpr std::string_view kinds[] = {"rigid",           "two_mass",         "user_side",     "light_damping",
                                      "long_delay",      "fractional_delay", "slow_sampling", "fast_sampling",
                                      "virtual_damper",  "operator",         "grounded",      "rotary",
                                      "filtered_damper", "actuator_lag",     "overdamped",    "stiff_link"};

std::size_t cases_per_kind() { return std::max<std::size_t>(1, test::property_cases(20'000) / std::size(kinds)); }

// Every number of devices of one structure.
struct Columns {
  DeviceParameters base;
  std::vector<ParameterValues> changes;

  explicit Columns(const DeviceParameters& first) : base(first) {
    base.wall.stiffness.reset();
    for (const std::string& key : parameter_keys(base)) {
      if (parameter(base, key)) changes.push_back({key, {}});
    }
  }
  void add(const DeviceParameters& device) {
    for (ParameterValues& each : changes) each.values.push_back(*parameter(device, each.key));
  }
};

Columns columns_of(std::string_view kind, std::size_t count, std::uint64_t seed) {
  test::RandomDevices random(seed);
  Columns columns(random.device(kind));
  while (columns.changes.front().values.size() < count) columns.add(random.device(kind));
  return columns;
}

bool is_same(double a, double b) {
  constexpr double tolerance = 1e-12;
  return a == b || (std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= tolerance * std::abs(b);
}

class BatchStiffnessProperty : public testing::TestWithParam<std::string_view> {};

TEST_P(BatchStiffnessProperty, IsThatOfEveryDeviceAlone) {
  const std::uint64_t seed = 20261123;
  const Columns columns = columns_of(GetParam(), cases_per_kind(), seed);
  const Device device(columns.base);
  BatchOptions alone;
  alone.vectorised = false;
  const BatchStiffness expected = batch_stiffness(device, columns.changes, alone);
  const BatchStiffness found = batch_stiffness(device, columns.changes);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (is_same(found.stiffness[i], expected.stiffness[i]) && is_same(found.frequency[i], expected.frequency[i]) &&
        found.status[i] == expected.status[i] && found.mode[i] == expected.mode[i] &&
        found.poles_leaving[i] == expected.poles_leaving[i] && found.verdict[i] == expected.verdict[i]) {
      continue;
    }
    if (++wrong > 5) continue;
    ADD_FAILURE() << "seed " << seed << ", device " << i << ": " << found.stiffness[i] << " instead of "
                  << expected.stiffness[i] << ", mode " << found.mode[i] << " instead of " << expected.mode[i];
  }
  EXPECT_EQ(wrong, 0U) << "of " << found.size();
  EXPECT_EQ(expected.scalar_count, found.size());
  RecordProperty("scalar_count", static_cast<int>(found.scalar_count));
  std::printf("%s: %zu of %zu devices one by one\n", std::string(GetParam()).c_str(), found.scalar_count, found.size());
  // What the kernel is for, it answers: else nothing is compared here.
  const std::map<std::string_view, double> most{
      {"rigid", 0.02},         {"two_mass", 0.4},        {"user_side", 0.5}, {"fractional_delay", 0.5},
      {"virtual_damper", 0.5}, {"filtered_damper", 0.5}, {"rotary", 0.4},    {"actuator_lag", 0.6}};
  if (const auto limit = most.find(GetParam()); limit != most.end() && found.size() >= 100) {
    EXPECT_LE(static_cast<double>(found.scalar_count), limit->second * static_cast<double>(found.size()));
  }
}

INSTANTIATE_TEST_SUITE_P(All, BatchStiffnessProperty, testing::ValuesIn(kinds),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace zwidth
