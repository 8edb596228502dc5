// 150 devices of 15 kinds, every crossover computed elsewhere with 110 digits and confirmed by closed-loop eigenvalues.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "device_from_json.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double relative_tolerance = 1e-9;

void expect_close(double ours, double reference, const std::string& what) {
  EXPECT_NEAR(ours / reference, 1.0, relative_tolerance) << what << ": " << ours << " for " << reference;
}

TEST(CriticalStiffnessReference, EveryCrossoverOfEveryDevice) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/critical_stiffness.json");
  const nlohmann::json cases = nlohmann::json::parse(file);
  ASSERT_EQ(cases.size(), 150U);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto& expected = cases[i];
    const Device device = test::device_from_json(expected.at("device"));
    SCOPED_TRACE("case " + std::to_string(i) + ", " + device.name());
    const Wall& wall = device.parameters().wall;
    const CriticalStiffness result =
        critical_stiffness(filtered_plant(device), {wall.damping, wall.velocity_filter_hz});

    const auto& crossovers = expected.at("crossovers");
    ASSERT_EQ(result.crossovers.size(), crossovers.size());
    for (std::size_t k = 0; k < crossovers.size(); ++k) {
      expect_close(result.crossovers[k].frequency, crossovers[k][0], "frequency " + std::to_string(k));
      expect_close(result.crossovers[k].stiffness, crossovers[k][1], "stiffness " + std::to_string(k));
    }
    const double critical = expected.at("critical_stiffness");
    if (critical == 0.0) {
      EXPECT_EQ(result.status, StiffnessStatus::none_stable);
      EXPECT_EQ(result.stiffness, 0.0);
      EXPECT_FALSE(result.limit.has_value());
      continue;
    }
    ASSERT_EQ(result.status, StiffnessStatus::finite);
    ASSERT_TRUE(result.limit.has_value());
    expect_close(result.stiffness, critical, "critical stiffness");
    EXPECT_EQ(result.limit->stiffness, result.stiffness);
    expect_close(result.limit->frequency, expected.at("critical_frequency_rad_s"), "critical frequency");
    ASSERT_FALSE(result.stable_intervals.empty());
    EXPECT_EQ(result.stable_intervals[0].lower, 0.0);
    EXPECT_EQ(result.stable_intervals[0].upper, result.stiffness);
  }
}

// The second computation contradicts none of them, and is in doubt of none.
TEST(CriticalStiffnessReference, EveryDeviceIsConfirmed) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/critical_stiffness.json");
  const nlohmann::json cases = nlohmann::json::parse(file);
  ASSERT_EQ(cases.size(), 150U);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Device device = test::device_from_json(cases[i].at("device"));
    SCOPED_TRACE("case " + std::to_string(i) + ", " + device.name());
    const CriticalStiffness result = critical_stiffness(device);
    EXPECT_TRUE(result.trust.sound()) << (result.trust.reasons.empty() ? "" : result.trust.reasons.front());
    const double critical = cases[i].at("critical_stiffness");
    if (critical == 0.0) {
      EXPECT_EQ(result.status, StiffnessStatus::none_stable);
      EXPECT_EQ(result.stiffness, 0.0);
    } else {
      expect_close(result.stiffness, critical, "critical stiffness");
    }
  }
}

}  // namespace
}  // namespace zwidth
