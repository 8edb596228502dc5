// What the numbers of a device do behind a drive that tracks the position.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/batch/batch_stiffness.hpp"
#include "zwidth/design/sensitivity.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

constexpr const char* bandwidth_key = "sensor.tracking_bandwidth";

DeviceParameters lhifam_behind_drive(double bandwidth) {
  DeviceParameters parameters = test::with_delay(test::lhifam_parameters(), 0.25e-3);
  parameters.sensor.tracking_bandwidth = bandwidth;
  return parameters;
}

template <typename Limit>
double difference(const DeviceParameters& parameters, const std::string& key, double step, const Limit& limit) {
  const double value = *parameter(parameters, key);
  const auto at = [&](double moved) {
    DeviceParameters changed = parameters;
    set_parameter(changed, key, moved);
    return limit(Device(std::move(changed)));
  };
  const double h = step * value;
  return (8.0 * (at(value + h) - at(value - h)) - (at(value + 2.0 * h) - at(value - 2.0 * h))) / (12.0 * h);
}

TEST(TrackingDesign, SensitivitiesAreThoseOfDifferences) {
  test::RandomDevices random(511);
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    DeviceParameters parameters = random.device(test::device_kinds[random.index(18)]);
    parameters.sensor.tracking_bandwidth = random.log_uniform(300.0, 1e4);
    const CriticalStiffness critical = critical_stiffness(Device(parameters));
    if (critical.status != StiffnessStatus::finite) continue;
    for (const Sensitivity& each : stiffness_sensitivities(Device(parameters))) {
      const bool is_asked = each.key == bandwidth_key || each.key == "body.handle.mass";
      if (!is_asked || !(each.value > 0.0)) continue;
      const double by_difference =
          difference(parameters, each.key, 1e-4, [](const Device& d) { return critical_stiffness(d).stiffness; });
      EXPECT_NEAR(each.slope, by_difference, 1e-6 * critical.stiffness / each.value + 1e-6 * std::abs(by_difference))
          << parameters.name << " " << i << " " << each.key;
      ++compared;
    }
  }
  EXPECT_GT(compared, 60);
}

TEST(TrackingDesign, SensitivitiesOfTheLimitOfAnyUser) {
  for (const double bandwidth : {500.0, 1000.0, 5000.0}) {
    const DeviceParameters parameters = lhifam_behind_drive(bandwidth);
    const auto limit = [](const Device& d) { return absolute_stability_limit(d, virtual_damper(d)).stiffness; };
    int found = 0;
    for (const Sensitivity& each : absolute_stability_sensitivities(Device(parameters))) {
      if (!(each.value > 0.0)) continue;
      const double by_difference = difference(parameters, each.key, 1e-3, limit);
      EXPECT_NEAR(each.slope, by_difference, 1e-4 * limit(Device(parameters)) / each.value) << each.key;
      found += each.key == bandwidth_key ? 1 : 0;
    }
    EXPECT_EQ(found, 1);
  }
}

TEST(TrackingDesign, ManyDevicesByTheScalarWay) {
  const Device device(lhifam_behind_drive(1000.0));
  const BatchStiffness of_links =
      batch_stiffness(device, std::vector<ParameterValues>{{"link.0.stiffness", {5e4, 8e4, 2e5}}}, {}, {});
  EXPECT_EQ(of_links.scalar_count, 3U);
  DeviceParameters ideal = lhifam_behind_drive(0.0);
  const std::vector<double> bandwidths{0.0, 300.0, 1000.0, 1e5};
  const BatchStiffness of_drives =
      batch_stiffness(Device(ideal), std::vector<ParameterValues>{{bandwidth_key, bandwidths}}, {}, {});
  for (std::size_t i = 0; i < bandwidths.size(); ++i) {
    EXPECT_NEAR(of_drives.stiffness[i], critical_stiffness(Device(lhifam_behind_drive(bandwidths[i]))).stiffness,
                1e-9 * of_drives.stiffness[i]);
  }
}

}  // namespace
}  // namespace zwidth
