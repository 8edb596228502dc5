#include "zwidth/simulation/synthetic_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lhifam.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"

namespace zwidth {
namespace {

DeviceParameters encoded_lhifam() {
  DeviceParameters device = test::lhifam_parameters();
  device.sensor.resolution = 3.14e-6;
  return device;
}

std::vector<double> sine(std::size_t size) {
  std::vector<double> force(size);
  for (std::size_t k = 0; k < size; ++k) force[k] = 5.0 * std::sin(0.1 * static_cast<double>(k));
  return force;
}

std::vector<double> exact_positions(const Device& device, const std::vector<double>& force) {
  return forced_response(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), force);
}

TEST(SyntheticRecord, ReadsTheExactMotionToTheNearestEncoderStep) {
  const Device device(encoded_lhifam());
  const std::vector<double> force = sine(3000);
  const std::vector<double> exact = exact_positions(device, force);
  const SyntheticRecord record = synthetic_record(device, force, {});
  EXPECT_EQ(record.force, force);
  EXPECT_EQ(record.sampling_period, 1e-3);
  ASSERT_EQ(record.position.size(), exact.size());
  const double step = device.parameters().sensor.resolution;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    EXPECT_LE(std::abs(record.position[k] - exact[k]), 0.5 * step * (1.0 + 1e-9));
    EXPECT_NEAR(record.position[k] / step, std::round(record.position[k] / step), 1e-9);
  }
}

TEST(SyntheticRecord, NoiseMovesTheDeviceAndNotTheRecordedCommand) {
  DeviceParameters parameters = test::rigid_parameters();
  parameters.sensor.resolution = 0.0;
  const Device device(parameters);
  const std::vector<double> rest(100000, 0.0);
  const SyntheticRecord record = synthetic_record(device, rest, {0.2, 7});
  EXPECT_EQ(record.force, rest);
  // The device's difference equation undone: m/T^2 times the second difference, damping apart, is the force averaged
  // over two periods, of variance sigma^2 / 2.
  double sum = 0.0;
  for (std::size_t k = 1; k + 1 < rest.size(); ++k) {
    const double acceleration =
        (record.position[k + 1] - 2.0 * record.position[k] + record.position[k - 1]) / (1e-3 * 1e-3);
    const double velocity = (record.position[k + 1] - record.position[k - 1]) / 2e-3;
    const double force = 5.4 * acceleration + 3.5 * velocity;
    sum += force * force;
  }
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(rest.size())), 0.2 / std::numbers::sqrt2, 0.01 * 0.2);
}

TEST(SyntheticRecord, ASeedIsOneRecord) {
  const Device device(encoded_lhifam());
  const std::vector<double> force = sine(500);
  EXPECT_EQ(synthetic_record(device, force, {1.0, 3}).position, synthetic_record(device, force, {1.0, 3}).position);
  EXPECT_NE(synthetic_record(device, force, {1.0, 3}).position, synthetic_record(device, force, {1.0, 4}).position);
}

}  // namespace
}  // namespace zwidth
