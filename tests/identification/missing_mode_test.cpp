// A mode in what a fit leaves of a record, alone and beside noise.

#include "identification/missing_mode.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"

namespace zwidth::internal {
namespace missing_mode_test {
namespace {

constexpr double period = 1e-3;
constexpr double frequency = 62.8;  // rad/s
constexpr double damping_ratio = 0.03;

/// A mass on a spring is one mode: 1 / (s^2 + 2 zeta w s + w^2), pushed by the force with a delay of 1.3 samples.
std::vector<double> motion_of_mode(std::span<const double> force) {
  DeviceParameters device;
  device.bodies = {{"body", 1.0, 2.0 * damping_ratio * frequency}};
  device.bodies[0].stiffness = frequency * frequency;
  device.loop.sampling_period = period;
  return forced_response(sample(state_space(Device(device)), {period, 1.3 * period}), force);
}

/// Parts of a record of which nothing is known, under white noise of this size.
struct Simulated {
  std::vector<double> force;
  RestLines rest;

  Simulated(std::vector<RestPart> parts, double size, double noise) {
    std::mt19937_64 random(20261126);
    std::normal_distribution<double> normal;
    force.resize(12'011);  // a prime number
    for (double& each : force) each = normal(random);
    std::vector<double> position = motion_of_mode(force);
    for (double& each : position) each = size * each + noise * normal(random);
    rest.parts = std::move(parts);
    Eigen::Index rows = 0;
    for (const RestPart& part : rest.parts) {
      rest.stretches.push_back(static_cast<Eigen::Index>(part.band.size()));
      rows += rest.stretches.back();
    }
    rest.lines = [parts = rest.parts, rows](std::span<const double> motion) {
      Eigen::VectorXcd lines(rows);
      Eigen::Index row = 0;
      for (const RestPart& part : parts) {
        const auto size_of_part = static_cast<Eigen::Index>(part.band.size());
        lines.segment(row, size_of_part) = lines_of(motion.subspan(part.first, part.count), part.band);
        row += size_of_part;
      }
      return lines;
    };
    rest.filter = Eigen::VectorXcd::Ones(rows);
    rest.known = Eigen::MatrixXcd(rows, 1);
    rest.known.col(0) = rest.lines(std::vector<double>(force.size(), 1.0));
    rest.target = rest.lines(position);
  }

  [[nodiscard]] std::optional<ModeBeside> found() const {
    return find_missing_mode(rest, {force, period, 1.3 * period, 5.0, 600.0});
  }
};

const std::vector<RestPart> whole = {{0, 12'011, {5, 2000}}};
const std::vector<RestPart> short_parts = {
    {0, 1000, {3, 180}}, {1000, 997, {3, 180}}, {5000, 1024, {3, 180}}, {11'000, 1000, {3, 180}}};

void expect_the_mode(const std::optional<ModeBeside>& found) {
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->frequency, frequency, 0.01 * frequency);
  EXPECT_NEAR(found->damping_ratio, damping_ratio, 0.3 * damping_ratio);
  EXPECT_GT(found->ratio, 30.0);
  EXPECT_NEAR(found->term.numerator[0], 1.0, 0.1);
}

TEST(MissingMode, IsFoundInAWholeRecord) { expect_the_mode(Simulated(whole, 1.0, 1e-4).found()); }

// It rings for 0.5 s, into and out of each part of 1 s.
TEST(MissingMode, IsFoundWhereItRingsOnFromPartToPart) { expect_the_mode(Simulated(short_parts, 1.0, 1e-4).found()); }

TEST(MissingMode, IsNotFoundInNoise) {
  for (const auto& parts : {whole, short_parts}) {
    const auto found = Simulated(parts, 0.0, 1e-4).found();
    EXPECT_LT(found ? found->ratio : 0.0, 6.0);
  }
}

}  // namespace
}  // namespace missing_mode_test
}  // namespace zwidth::internal
