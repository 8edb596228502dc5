// The slopes of a response, against differences of high order of the modal form's.
#include "identification/initial_fit/response_slopes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "identification/initial_fit/fit_model.hpp"
#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {
namespace {

constexpr double period = 1e-3;

DeviceParameters chain(std::size_t bodies) {
  DeviceParameters device;
  device.name = "chain";
  for (std::size_t i = 0; i < bodies; ++i) {
    const auto at = static_cast<double>(i);
    device.bodies.push_back({"b" + std::to_string(i), 0.4 / (1.0 + at), 1.3 + at, 0.0, 0.0});
    if (i > 0) device.links.push_back({i - 1, i, 8e3 * at, 1.5});
  }
  device.loop = {0, 0, bodies - 1, period, 0.3e-3};
  return device;
}

/// Of the structure itself, at 60 frequencies from 0.5 Hz to `highest`.
FrequencyResponse response_of(double highest, std::optional<double> sampling_period) {
  FrequencyResponse response;
  response.sampling_period = sampling_period;
  for (int i = 0; i < 60; ++i) {
    response.points.push_back({3.0 * std::pow(highest / 3.0, i / 59.0), {1e-3, -1e-3}});
  }
  return response;
}

void expect_slopes(const DeviceParameters& device, const std::vector<std::string>& free,
                   const std::vector<std::string>& locked, std::optional<double> sampling_period) {
  const FrequencyResponse response = response_of(2500.0, sampling_period);
  const FitModel model(Device(device), response, free, locked);
  std::vector<double> frequencies;
  for (const ResponsePoint& point : response.points) frequencies.push_back(point.frequency);
  const Eigen::VectorXd x = model.position_of(device);
  const ResponseWithSlopes at_x = model.slopes_at(x, frequencies);
  EXPECT_EQ(at_x.values, model.response_at(x, frequencies));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    SCOPED_TRACE(free[static_cast<std::size_t>(i)]);
    const auto moved = [&](double step) {
      Eigen::VectorXd at = x;
      at(i) += step;
      return model.response_at(at, frequencies);
    };
    const bool is_logarithmic = model.coordinates()[static_cast<std::size_t>(i)].kind == Coordinate::Kind::logarithmic;
    const double h = is_logarithmic ? 1e-4 : x(i) == 0.0 ? 1e-5 : 1e-3 * x(i);
    const bool at_bound = x(i) == 0.0;
    const Eigen::VectorXcd slope =
        at_bound
            ? ((-11.0 * at_x.values + 18.0 * moved(h) - 9.0 * moved(2.0 * h) + 2.0 * moved(3.0 * h)) / (6.0 * h)).eval()
            : ((8.0 * (moved(h) - moved(-h)) - (moved(2.0 * h) - moved(-2.0 * h))) / (12.0 * h)).eval();
    EXPECT_GT(slope.norm(), 0.0);
    EXPECT_LE((at_x.slopes.col(i) - slope).norm(), 1e-6 * slope.norm());
  }
}

class ResponseSlopes : public testing::TestWithParam<std::optional<double>> {};

TEST_P(ResponseSlopes, AreThoseOfTheResponse) {
  for (std::size_t bodies = 1; bodies <= 3; ++bodies) {
    SCOPED_TRACE(std::to_string(bodies) + " bodies");
    DeviceParameters device = chain(bodies);
    device.loop.sensed = bodies - 1;
    device.actuator.time_constant = 0.7e-3;
    expect_slopes(device, fittable_parameters(Device(device), {}), {}, GetParam());
  }
}

TEST_P(ResponseSlopes, OfADelayThatIsAWholeNumberOfPeriodsAndOfNoLagAtAll) {
  DeviceParameters device = chain(2);
  device.loop.delay = 3.5 * period;  // differences of it do not cross a whole number
  expect_slopes(device, {"loop.delay", "body.b0.mass", "link.0.damping"}, {}, GetParam());
  device.loop.delay = 2.0 * period;
  expect_slopes(device, {"body.b0.mass", "link.0.damping", "link.0.stiffness"}, {}, GetParam());
}

TEST_P(ResponseSlopes, OfALockedBodyAndOfAHandAroundAnother) {
  DeviceParameters device = chain(3);
  device.loop.held = 1;
  device.user = {0.8, 3.0, 300.0};
  expect_slopes(device,
                {"link.1.stiffness", "link.1.damping", "body.b0.mass", "body.b1.mass", "operator.mass",
                 "operator.damping", "operator.stiffness"},
                {"b2"}, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Of, ResponseSlopes, testing::Values(std::optional(period), std::nullopt),
                         [](const auto& each) { return each.param ? "Samples" : "ContinuousTime"; });

TEST(ResponseSlopesGuard, SlopesOfAnotherResponseAreNotGiven) {
  const Device device(chain(2));
  const std::complex<double> value = response(sampled_plant(device), 100.0);
  const auto slopes = [&](std::complex<double> of) {
    return response_slopes(device, period, {{{}, 1.0}}, {100.0}, Eigen::VectorXcd::Constant(1, of));
  };
  EXPECT_TRUE(slopes(value));
  EXPECT_FALSE(slopes(1.00001 * value));
}

}  // namespace
}  // namespace zwidth::internal
