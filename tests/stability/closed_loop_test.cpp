#include "zwidth/stability/closed_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "lhifam.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {
namespace {

using Complex = std::complex<double>;

DiscreteStateSpace sampled(const DeviceParameters& parameters) {
  const Device device(parameters);
  return sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
}

// m = 2 kg, T = 0.1 s: P = (T²/2m)(z + 1)/(z - 1)².
DeviceParameters mass(double delay = 0.0) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies[0] = {"mass", 2.0, 0.0, 0.0, 0.0};
  device.loop.sampling_period = 0.1;
  device.loop.delay = delay;
  return device;
}

constexpr double gain = 0.01 / 4.0;  // T²/2m

std::vector<Complex> sorted(std::vector<Complex> poles) {
  std::sort(poles.begin(), poles.end(), [](const Complex& a, const Complex& b) {
    return std::abs(a.real() - b.real()) > 1e-9 ? a.real() < b.real() : a.imag() < b.imag();
  });
  return poles;
}

// prod (z - z_i) at z = w.
Complex product(const std::vector<Complex>& poles_minus_one, Complex z) {
  Complex p = 1.0;
  for (const Complex& pole : poles_minus_one) p *= z - 1.0 - pole;
  return p;
}

const Complex points[] = {{0.3, 0.9}, {-1.1, 0.2}, {2.0, 0.0}, {0.0, -0.7}};

TEST(ClosedLoop, SpringAtAMass) {
  const double k = 8.0;  // delta² + k g delta + 2 k g = 0
  const auto poles = sorted(closed_loop_poles_minus_one(sampled(mass()), {.stiffness = k}));
  ASSERT_EQ(poles.size(), 2U);
  const double half = k * gain / 2.0;
  const double imaginary = std::sqrt(2.0 * k * gain - half * half);
  EXPECT_LE(std::abs(poles[0] - Complex(-half, -imaginary)), 1e-15);
  EXPECT_LE(std::abs(poles[1] - Complex(-half, imaginary)), 1e-15);
  // |z|² = 1 + k g: unstable for every k
  EXPECT_NEAR(stability_excess(sampled(mass()), {.stiffness = k}), std::sqrt(1.0 + k * gain) - 1.0, 1e-15);
}

TEST(ClosedLoop, SpringAtAMassOneSampleLate) {
  const double k = 8.0;
  const auto poles = closed_loop_poles_minus_one(sampled(mass(0.1)), {.stiffness = k});
  ASSERT_EQ(poles.size(), 3U);
  for (const Complex& z : points) {
    const Complex by_hand = z * (z - 1.0) * (z - 1.0) + k * gain * (z + 1.0);
    EXPECT_LE(std::abs(product(poles, z) / by_hand - 1.0), 1e-13);
  }
}

TEST(ClosedLoop, DamperAtAMass) {
  const double b = 3.0;
  const double k = 8.0;
  const auto poles = closed_loop_poles_minus_one(sampled(mass()), {.stiffness = k, .damping = b});
  ASSERT_EQ(poles.size(), 3U);
  for (const Complex& z : points) {  // v = (z - 1)/(T z)
    const Complex by_hand = z * (z - 1.0) * (z - 1.0) + gain * (z + 1.0) * (k * z + b / 0.1 * (z - 1.0));
    EXPECT_LE(std::abs(product(poles, z) / by_hand - 1.0), 1e-13);
  }
}

TEST(ClosedLoop, FilteredDamperAtAMass) {
  const double b = 3.0;
  const double k = 8.0;
  const double filter = 2.5;  // Hz
  const double a = std::exp(-2.0 * 3.14159265358979323846 * filter * 0.1);
  const auto poles = closed_loop_poles_minus_one(sampled(mass()), {k, b, filter});
  ASSERT_EQ(poles.size(), 4U);
  for (const Complex& z : points) {  // v = (z - 1)/(T z) (1 - a) z/(z - a), whose z cancels: one pole at 0 is left
    const Complex by_hand =
        z * ((z - a) * (z - 1.0) * (z - 1.0) + gain * (z + 1.0) * (k * (z - a) + b / 0.1 * (1.0 - a) * (z - 1.0)));
    EXPECT_LE(std::abs(product(poles, z) / by_hand - 1.0), 1e-13);
  }
}

// The absent wall leaves the device to itself: for a mass, poles at 1.
TEST(ClosedLoop, NoWall) {
  const auto poles = closed_loop_poles_minus_one(sampled(mass()), {});
  ASSERT_EQ(poles.size(), 2U);
  for (const Complex& pole : poles) EXPECT_LE(std::abs(pole), 1e-14);
  EXPECT_NEAR(stability_excess(sampled(mass()), {}), 0.0, 1e-14);
}

// Every pole solves 1 + C(z) P(z) = 0 with the modal route's P, on either side of the unit circle.
TEST(ClosedLoop, PolesOnTheCircleAreWhereTheResponseSaysSo) {
  const DeviceParameters device = test::with_delay(test::lhifam_parameters(), 0.25e-3);
  const SampledPlant plant = sampled_plant(Device(device));
  const double frequency = 30.5463970177;
  const double k = -1.0 / response(plant, frequency).real();
  double nearest = 1.0;
  for (const Complex& pole : closed_loop_poles_minus_one(sampled(device), {.stiffness = k})) {
    nearest = std::min(nearest, std::abs(1.0 + pole - std::polar(1.0, frequency * 1e-3)));
  }
  EXPECT_LE(nearest, 1e-11);
}

}  // namespace
}  // namespace zwidth
