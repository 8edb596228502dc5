// The disk margin, against loops whose margin is known and against eigenvalues of the loop with a complex factor in it.
#include "zwidth/stability/disk_margin.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

Device of_transfer_function(TransferFunction function, double period, double stiffness) {
  DeviceParameters device;
  device.name = "loop";
  device.transfer_function = std::move(function);
  device.loop.sampling_period = period;
  device.wall.stiffness = stiffness;
  return Device(device);
}

// Closed-loop poles with u = -f C(z) y, a state for each delayed force and for the last position. No velocity filter.
Eigen::VectorXcd poles(const Device& device, Complex factor) {
  const DiscreteStateSpace plant =
      with_delay_states(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}));
  const Eigen::Index n = plant.Phi.rows();
  const double rate = device.parameters().wall.damping / plant.period;
  Eigen::MatrixXcd closed = Eigen::MatrixXcd::Zero(n + 1, n + 1);
  closed.topLeftCorner(n, n) = (plant.Phi + Eigen::MatrixXd::Identity(n, n)).cast<Complex>();
  closed.topLeftCorner(n, n) -= factor * (*device.parameters().wall.stiffness + rate) * plant.Gamma1 * plant.C;
  closed.topRightCorner(n, 1) = factor * rate * plant.Gamma1;
  closed.bottomLeftCorner(1, n) = plant.C.cast<Complex>();
  return Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(closed, false).eigenvalues();
}

double spectral_radius(const Device& device, Complex factor) { return poles(device, factor).cwiseAbs().maxCoeff(); }

Complex on_disk(double size, double turn) {
  const Complex d = std::polar(size, turn);
  return (1.0 + 0.5 * d) / (1.0 - 0.5 * d);
}

// L = k/(z - 1): |(z - 1 - k)/(z - 1 + k)| is greatest at z = -1, (2 + k)/(2 - k); the gain margin is then that of L.
TEST(DiskMargin, OfAnIntegratorIsItsGainMargin) {
  for (const double k : {0.1, 0.5, 1.0, 1.9}) {
    const auto margin = disk_margin(of_transfer_function({{1.0}, {1.0, 0.0}}, 0.01, k / 0.01));
    ASSERT_TRUE(margin) << k;
    EXPECT_NEAR(margin->alpha, 2.0 * (2.0 - k) / (2.0 + k), 1e-9);
    EXPECT_NEAR(margin->gain_margin.value(), 2.0 / k, 1e-8 / k);
    EXPECT_NEAR(margin->lower_gain_margin.value(), 0.5 * k, 1e-8);
    EXPECT_NEAR(margin->frequency, pi / 0.01, 1e-6);
    EXPECT_NEAR(std::abs(margin->worst_factor.value() - 2.0 / k), 0.0, 1e-8 / k);
  }
}

// The example of Seiler, Packard & Gahinet 2020, 25/(s³ + 10 s² + 10 s + 10): numbers of the continuous loop from
// 100 000 frequencies and a bounded search in SciPy, of which the paper prints 0.46, 26 degrees and 1.128 - 0.483j. Here it is
// sampled at 100 us, a lag of 1e-4 rad.
TEST(DiskMargin, OfThePapersExample) {
  const Device device = of_transfer_function({{25.0}, {1.0, 10.0, 10.0, 10.0}}, 1e-4, 1.0);
  const auto margin = disk_margin(device);
  ASSERT_TRUE(margin);
  constexpr double tolerance = 3e-4;
  EXPECT_NEAR(margin->alpha, 0.458093, tolerance);
  EXPECT_NEAR(margin->lower_gain_margin.value(), 0.627278, tolerance);
  EXPECT_NEAR(margin->gain_margin.value(), 1.594189, 2.0 * tolerance);
  EXPECT_NEAR(margin->phase_margin * 180.0 / pi, 25.801709, 0.02);
  EXPECT_NEAR(margin->frequency, 1.955027, tolerance);
  EXPECT_NEAR(margin->worst_factor->real(), 1.128852, tolerance);
  EXPECT_NEAR(margin->worst_factor->imag(), -0.483116, tolerance);
}

TEST(DiskMargin, ThereIsNoneOfAnUnstableLoop) {
  DeviceParameters device = test::lhifam_parameters();
  device.wall.stiffness = 9000.0;
  EXPECT_FALSE(disk_margin(Device(device)));
}

TEST(DiskMargin, StandsInTheAnalysisOfAWall) {
  DeviceParameters device = test::lhifam_parameters();
  device.wall = {5000.0, 5.0, 0.0};
  const Analysis analysis = analyze(Device(device), {.any_user = false, .draws = 0});
  ASSERT_TRUE(analysis.disk_margin);
  EXPECT_EQ(analysis.disk_margin->alpha, disk_margin(Device(device))->alpha);
  device.wall.stiffness = 30000.0;
  EXPECT_FALSE(analyze(Device(device)).disk_margin);
}

// Just below the critical stiffness the peak is 1e-4 of its angle wide. By the stationary points of the ratio as a
// polynomial, in 200 digits.
TEST(DiskMargin, OfANarrowPeak) {
  DeviceParameters device;
  device.name = "body";
  device.bodies = {{"body", 1.0, 0.1, 0.0, 0.0}};
  device.loop.sampling_period = 2e-3;
  device.loop.delay = 1e-4;
  const auto alpha = [&device](double stiffness) {
    device.wall.stiffness = stiffness;
    return disk_margin(Device(device))->alpha;
  };
  EXPECT_NEAR(alpha(85.0) / 7.0530345290942671e-4, 1.0, 2e-9);
  EXPECT_NEAR(alpha(90.0) / 1.0572870389030499e-4, 1.0, 2e-9);
}

// Every factor inside the disk leaves the loop stable; the worst one puts a pole at e^{jwT}; and gain and phase margins
// are no wider than those that count one at a time.
TEST(DiskMargin, OfRandomDevicesIsTheLargestStableDisk) {
  constexpr double most_samples = 20.0;  // eigenvalues cost their cube
  constexpr int turns = 12;
  int seen = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    test::RandomDevices random(seed);
    const auto kind = test::device_kinds[seed % test::device_kinds.size()];
    DeviceParameters parameters = random.device(kind);
    parameters.wall.velocity_filter_hz = 0.0;
    parameters.wall.filters.clear();
    const Device bare(parameters);
    const double limit = critical_stiffness(filtered_plant(bare), virtual_damper(bare)).stiffness;
    if (!(limit > 0.0) || !std::isfinite(limit)) continue;
    if (parameters.loop.delay > most_samples * parameters.loop.sampling_period) continue;
    parameters.wall.stiffness = limit * random.uniform(0.02, 0.95);
    const Device device(parameters);
    SCOPED_TRACE(testing::Message() << "seed " << seed << " " << kind << " K " << *parameters.wall.stiffness);
    const WallMargins margins = wall_margins(device);
    const auto disk = disk_margin(device);
    ASSERT_EQ(disk.has_value(), margins.stable);
    if (!disk) continue;
    ++seen;
    if (disk->gain_margin && margins.gain_margin) {
      EXPECT_LE(*disk->gain_margin, *margins.gain_margin * (1.0 + 1e-8));
    }
    if (disk->lower_gain_margin && margins.lower_gain_margin) {
      EXPECT_GE(*disk->lower_gain_margin, *margins.lower_gain_margin * (1.0 - 1e-8));
    }
    if (margins.phase_margin) {
      EXPECT_LE(disk->phase_margin, *margins.phase_margin * (1.0 + 1e-8));
    }
    ASSERT_TRUE(disk->worst_factor);
    // f = (1 + d/2)/(1 - d/2) with |d| = alpha
    const Complex f = *disk->worst_factor;
    EXPECT_NEAR(std::abs(2.0 * (f - 1.0) / (f + 1.0)) / disk->alpha, 1.0, 1e-6);
    const Complex pole = std::polar(1.0, disk->frequency * device.loop().sampling_period);
    // An eigenvalue of a nearly defective matrix moves by the root of its rounding.
    EXPECT_LT((poles(device, f).array() - pole).abs().minCoeff(), 1e-5);
    for (int i = 0; i < turns && disk->alpha < 2.0; ++i) {
      const double turn = 2.0 * pi * (i + random.uniform(0.0, 1.0)) / turns;
      EXPECT_LT(spectral_radius(device, on_disk(0.999 * disk->alpha, turn)), 1.0 + 1e-12) << turn;
    }
  }
  EXPECT_GT(seen, 100);
}

}  // namespace
}  // namespace zwidth
