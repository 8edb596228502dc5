// A device of bodies in other coordinates, x = S q with any invertible S, is the same device.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "zwidth/model/modal_form.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

std::vector<double> row(const Eigen::RowVectorXd& weights) { return {weights.begin(), weights.end()}; }

/// The same in q, its mass matrix full.
DeviceParameters in_coordinates(const DeviceParameters& bodies, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto n = static_cast<Eigen::Index>(bodies.bodies.size());
  Eigen::MatrixXd s = 2.0 * Eigen::MatrixXd::Identity(n, n);
  for (double& each : s.reshaped()) each += 0.5 * uniform(random);
  DeviceParameters result = bodies;
  result.bodies.clear();
  result.links.clear();
  Coordinates coordinates;
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Body& body = bodies.bodies[static_cast<std::size_t>(i)];
    mass += body.mass * s.row(i).transpose() * s.row(i);
    coordinates.points.push_back({body.name, row(s.row(i))});
    if (body.stiffness > 0.0 || body.damping > 0.0) {
      coordinates.elements.push_back({row(s.row(i)), body.stiffness, body.damping});
    }
  }
  for (const Link& link : bodies.links) {
    const Eigen::RowVectorXd along =
        s.row(static_cast<Eigen::Index>(link.first)) - s.row(static_cast<Eigen::Index>(link.second));
    coordinates.elements.push_back({row(along), link.stiffness, link.damping});
  }
  mass = 0.5 * (mass + mass.transpose().eval());
  coordinates.mass.assign(mass.data(), mass.data() + mass.size());
  result.coordinates = std::move(coordinates);
  return result;
}

/// Two or three bodies in a chain, the motor first and the handle last.
DeviceParameters chain(unsigned seed) {
  std::mt19937 random(seed);
  const auto spread = [&](double least, double most) {
    return least * std::pow(most / least, std::uniform_real_distribution<double>(0.0, 1.0)(random));
  };
  DeviceParameters parameters;
  const std::size_t bodies = 2 + seed % 2;
  for (std::size_t i = 0; i < bodies; ++i) {
    parameters.bodies.push_back({"body " + std::to_string(i), spread(0.05, 5.0), spread(0.05, 3.0), 0.0, 0.0});
    if (i > 0) parameters.links.push_back({i - 1, i, spread(1e3, 2e5), spread(0.5, 20.0)});
  }
  if (seed % 4 == 3) parameters.bodies[0].stiffness = spread(1.0, 100.0);
  parameters.loop = {.actuated = 0, .sensed = seed % 3 == 2 ? 1U : 0U, .held = bodies - 1, .sampling_period = 1e-3};
  parameters.loop.delay = seed % 5 == 0 ? 0.4e-3 : 0.0;
  parameters.actuator.time_constant = seed % 7 == 0 ? 1e-3 : 0.0;
  return parameters;
}

/// With that of a suspended rigid body, which coordinates do not tell from the others.
std::vector<Mode> all_modes(const Device& device) {
  ModalForm form = modal_form(device);
  if (form.suspended_rigid_body) form.modes.insert(form.modes.begin(), *form.suspended_rigid_body);
  return form.modes;
}

constexpr unsigned devices = 24;
// S loses a few digits, and the rigid motion of stiff links as many as their stiffness is above the limit.
constexpr double relative_tolerance = 1e-9;

TEST(Coordinates, have_the_modes_and_limits_of_the_bodies_that_they_describe) {
  for (unsigned seed = 0; seed < devices; ++seed) {
    SCOPED_TRACE(seed);
    const Device bodies(chain(seed));
    const Device same(in_coordinates(bodies.parameters(), seed));
    const std::vector<Mode> expected = all_modes(bodies);
    const std::vector<Mode> modes = all_modes(same);
    ASSERT_EQ(modes.size(), expected.size());
    for (std::size_t i = 0; i < modes.size(); ++i) {
      EXPECT_NEAR(modes[i].frequency / expected[i].frequency, 1.0, relative_tolerance);
      EXPECT_NEAR(modes[i].damping_ratio / expected[i].damping_ratio, 1.0, relative_tolerance);
    }
    const CriticalStiffness of_bodies = critical_stiffness(bodies);
    const CriticalStiffness found = critical_stiffness(same);
    ASSERT_EQ(found.crossovers.size(), of_bodies.crossovers.size());
    EXPECT_EQ(found.trust.verdict, of_bodies.trust.verdict);
    EXPECT_NEAR(found.stiffness / of_bodies.stiffness, 1.0, relative_tolerance);
    for (std::size_t i = 0; i < found.crossovers.size(); ++i) {
      EXPECT_NEAR(found.crossovers[i].stiffness / of_bodies.crossovers[i].stiffness, 1.0, 1e3 * relative_tolerance);
    }
  }
}

TEST(Coordinates, have_the_limit_for_any_user_of_the_bodies_that_they_describe) {
  for (unsigned seed = 0; seed < devices; seed += 3) {
    SCOPED_TRACE(seed);
    const Device bodies(chain(seed));
    const Device same(in_coordinates(bodies.parameters(), seed));
    const AbsoluteStabilityLimit expected = absolute_stability_limit(bodies);
    const AbsoluteStabilityLimit found = absolute_stability_limit(same);
    EXPECT_EQ(found.trust.verdict, expected.trust.verdict);
    EXPECT_NEAR(found.stiffness / expected.stiffness, 1.0, relative_tolerance);
  }
}

}  // namespace
}  // namespace zwidth
