// The critical stiffness in time: just below it every loop decays, just above it grows, at the rate and frequency of
// the dominant closed-loop eigenvalue.

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "device_from_json.hpp"
#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t most_samples = 400'000;
constexpr double dominance = 1e-12;  // of the next pole's share at the tail
constexpr double smallest = 1e-250;  // of the motion at the tail: above the denormals

/// The pole of largest |z|, and how long a motion must last until it is all that is left.
struct Dominant {
  Complex pole;
  double samples = 0.0;
};

Dominant dominant_pole(const Device& device, double stiffness) {
  Wall wall = device.parameters().wall;
  wall.stiffness = stiffness;
  std::vector<Complex> poles;
  for (const Complex& each : closed_loop_poles_minus_one(
           sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), wall)) {
    if (each.imag() >= 0.0) poles.push_back(1.0 + each);
  }
  std::sort(poles.begin(), poles.end(), [](const Complex& a, const Complex& b) { return std::abs(a) > std::abs(b); });
  const double ratio = poles.size() > 1 ? std::abs(poles[1]) / std::abs(poles[0]) : 0.0;
  return {poles[0], std::log(dominance) / std::log(ratio)};
}

/// The pole that the end of a motion shows: with z^d = p, y[k+d] = 2 Re(p) y[k] - |p|² y[k-d] by least squares on its
/// differences, which know no resting place. The stride d makes the angle of p about 1 rad. A real pole: y[k+1] = z
/// y[k]. Returned as log z.
Complex logarithm_of_pole(const std::vector<double>& motion, std::size_t stride, bool is_real) {
  const auto d = static_cast<Eigen::Index>(stride);
  const auto rows = static_cast<Eigen::Index>(motion.size()) - 2 * d - 1;
  Eigen::VectorXd next(rows);
  Eigen::MatrixXd past(rows, is_real ? 1 : 2);
  const auto difference = [&](Eigen::Index k) {
    const auto at = static_cast<std::size_t>(k);
    return (motion[at + 1] - motion[at]) / std::abs(motion[1]);
  };
  for (Eigen::Index k = 0; k < rows; ++k) {
    next[k] = difference(k + 2 * d);
    past(k, 0) = difference(k + d);
    if (!is_real) past(k, 1) = difference(k);
  }
  const Eigen::VectorXd weights = past.colPivHouseholderQr().solve(next);
  const double half = 0.5 * weights[0];
  const Complex power = is_real ? Complex(weights[0]) : half + std::sqrt(Complex(half * half + weights[1]));
  return std::log(power) / static_cast<double>(stride);
}

/// The end of the loop's motion after so many samples: enough of it to see its frequency.
std::vector<double> tail_of_motion(const Device& device, double stiffness, std::size_t samples, std::size_t length) {
  HybridLoopOptions options;
  options.controller = wall_controller(device.parameters().wall);
  options.controller.stiffness = stiffness;
  for (std::size_t i = 0; i < device.bodies().size(); ++i) {
    options.initial_position.push_back(1e-3 * (1.0 + 0.3 * static_cast<double>(i)));
  }
  HybridLoop loop(device, options);
  std::vector<double> tail;
  for (std::size_t k = 0; k < samples + length; ++k) {
    loop.step();
    if (k >= samples) tail.push_back(loop.sensed_position());
  }
  return tail;
}

/// Whether the loop could be compared: its dominant pole shows in time within the samples and before overflow.
bool compare(const Device& device, double stiffness) {
  const Dominant dominant = dominant_pole(device, stiffness);
  if (!(dominant.samples < static_cast<double>(most_samples))) return false;
  const auto samples =
      static_cast<std::size_t>(std::max(dominant.samples, 10.0 * device.loop().delay / device.loop().sampling_period));
  if (std::abs(std::log(std::abs(dominant.pole))) * static_cast<double>(samples) > -std::log(smallest)) return false;
  const double angle = std::abs(std::arg(dominant.pole));
  const bool is_real = std::abs(dominant.pole.imag()) < 1e-9;
  const std::size_t stride = is_real ? 1 : std::max<std::size_t>(1, static_cast<std::size_t>(1.0 / angle));
  const Complex shown =
      logarithm_of_pole(tail_of_motion(device, stiffness, samples, 30 * stride + 50), stride, is_real);
  const Complex expected = std::log(dominant.pole);
  EXPECT_EQ(shown.real() > 0.0, expected.real() > 0.0);
  EXPECT_NEAR(shown.real(), expected.real(), 1e-6 * std::abs(expected.real()) + 1e-10 * std::abs(expected));
  EXPECT_NEAR(std::abs(shown.imag()), angle, 1e-9 * angle);
  return true;
}

struct Count {
  int compared = 0;
  int in_all = 0;
};

void compare_on_both_sides(const Device& device, Count& count) {
  const Wall& wall = device.parameters().wall;
  const CriticalStiffness critical =
      critical_stiffness(filtered_plant(device), {wall.damping, wall.velocity_filter_hz});
  if (critical.status != StiffnessStatus::finite) return;
  for (const double share : {0.98, 1.02}) {
    SCOPED_TRACE(share);
    ++count.in_all;
    const double excess = std::abs(dominant_pole(device, share * critical.stiffness).pole) - 1.0;
    EXPECT_EQ(excess > 0.0, share > 1.0);
    if (compare(device, share * critical.stiffness)) ++count.compared;
  }
}

TEST(CriticalStiffnessInTime, ReferenceDevices) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/critical_stiffness.json");
  Count count;
  for (const auto& each : nlohmann::json::parse(file)) {
    const Device device = test::device_from_json(each.at("device"));
    SCOPED_TRACE(device.name() + " " + std::to_string(count.in_all));
    compare_on_both_sides(device, count);
  }
  EXPECT_GE(count.in_all, 280);
  EXPECT_GE(count.compared, count.in_all * 9 / 10) << count.compared << " of " << count.in_all;
  RecordProperty("compared", count.compared);
  RecordProperty("of", count.in_all);
}

TEST(CriticalStiffnessInTime, RandomDevices) {
  test::RandomDevices devices(20240611);
  Count count;
  for (const std::string_view kind : test::device_kinds) {
    if (kind == "transfer_function") continue;  // has no place to start from
    for (int i = 0; i < 6; ++i) {
      const Device device(devices.device(kind));
      SCOPED_TRACE(std::string(kind) + " " + std::to_string(i));
      compare_on_both_sides(device, count);
    }
  }
  EXPECT_GE(count.compared, count.in_all * 8 / 10) << count.compared << " of " << count.in_all;
  RecordProperty("compared", count.compared);
  RecordProperty("of", count.in_all);
}

// Each type of filter, and all in series, on the flexible device with a damper and a delay.
TEST(CriticalStiffnessInTime, EveryWallFilter) {
  using enum WallFilter::Kind;
  const std::vector<WallFilter> each{
      {.kind = low_pass, .frequency_hz = 60.0},
      {.kind = low_pass, .frequency_hz = 90.0, .order = 2, .damping_ratio = 0.4},
      {.kind = notch, .frequency_hz = 80.0, .damping_ratio = 0.3, .depth = 0.05},
      {.kind = lead_lag, .frequency_hz = 30.0, .ratio = 3.0},
      {.kind = biquad, .numerator = {1e-6, 1e-3, 1.0}, .denominator = {4e-6, 2e-3, 1.0}},
      {.kind = digital, .numerator = {0.5, 0.5}, .denominator = {1.0, -0.2}},
  };
  std::vector<std::vector<WallFilter>> walls{{}, each};
  for (const WallFilter& filter : each) walls.push_back({filter});
  Count count;
  for (const std::vector<WallFilter>& filters : walls) {
    DeviceParameters device = test::lhifam_parameters();
    device.loop.delay = 0.25e-3;
    device.wall.damping = 3.0;
    device.wall.velocity_filter_hz = 100.0;
    device.wall.filters = filters;
    SCOPED_TRACE(filters.size() == 1 ? static_cast<int>(filters[0].kind) : -1);
    compare_on_both_sides(Device(device), count);
  }
  EXPECT_EQ(count.in_all, 16);
  EXPECT_EQ(count.compared, count.in_all);
}

}  // namespace
}  // namespace zwidth
