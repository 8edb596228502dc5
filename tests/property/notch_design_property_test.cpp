// design --notch on random devices: what it proposes is stable with the margins asked at every modal shift, by eigenvalues of
// closed loops that are put together here, and lowers no user's limit.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>
#include <string>

#include "property/random_devices.hpp"
#include "property/random_notch_options.hpp"
#include "zwidth/design/notch_design.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/filter_section.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth::test {
namespace {

constexpr std::uint64_t seed = 20261124;
constexpr std::size_t usual_cases = 12;
constexpr int modal_shifts = 41;
constexpr double rounding = 1e-11;  // of |z| - 1: a heavy user's own pole is as near the circle
constexpr std::array kinds = {"two_mass",   "three_mass",   "light_damping",    "virtual_damper", "slow_sampling",
                              "grounded",   "user_side",    "fractional_delay", "operator",       "rotary",
                              "chain",      "actuator_lag", "filtered_damper",  "long_delay",     "wall_filter",
                              "everything", "fast_sampling"};

// ZWIDTH_CAMPAIGN_DEVICES=300 is the campaign: some minutes.
std::size_t cases() {
  if (const char* campaign = std::getenv("ZWIDTH_CAMPAIGN_DEVICES")) return std::strtoul(campaign, nullptr, 10);
  const char* asked = std::getenv("ZWIDTH_PROPERTY_CASES");
  return asked ? std::clamp<std::size_t>(std::strtoul(asked, nullptr, 10), 1, usual_cases) : usual_cases;
}

// x+ = A x + B u, y = C x + D u
struct Discrete {
  Eigen::MatrixXd A;
  Eigen::VectorXd B;
  Eigen::RowVectorXd C;
  double D = 0.0;
};

Discrete in_series(const Discrete& first, const Discrete& second) {
  const Eigen::Index n = first.A.rows();
  const Eigen::Index m = second.A.rows();
  Discrete both{Eigen::MatrixXd::Zero(n + m, n + m), Eigen::VectorXd(n + m), Eigen::RowVectorXd(n + m),
                first.D * second.D};
  both.A.topLeftCorner(n, n) = first.A;
  both.A.bottomRightCorner(m, m) = second.A;
  both.A.bottomLeftCorner(m, n) = second.B * first.C;
  both.B << first.B, second.B * first.D;
  both.C << second.D * first.C, second.C;
  return both;
}

// K + B (1 - a)(1 - z^-1)/(T (1 - a z^-1)) and the filters behind it.
Discrete controller(const Wall& wall, double stiffness, double damping, double period) {
  const double a =
      wall.velocity_filter_hz > 0.0 ? std::exp(-2.0 * std::numbers::pi * wall.velocity_filter_hz * period) : 0.0;
  const double rate = damping * (1.0 - a) / period;
  // rate (z - 1)/(z - a) = rate + rate (a - 1)/(z - a)
  Discrete loop{Eigen::MatrixXd::Constant(1, 1, a), Eigen::VectorXd::Ones(1),
                Eigen::RowVectorXd::Constant(1, rate * (a - 1.0)), stiffness + rate};
  for (const WallFilter& filter : wall.filters) {
    const FilterSection section = filter_section(filter, period);
    const std::array<double, 3> n = whole_numerator(section);
    const auto degree = static_cast<Eigen::Index>(section.degree);
    Discrete each{Eigen::MatrixXd::Identity(degree, degree), Eigen::VectorXd::Zero(degree),
                  Eigen::RowVectorXd::Zero(degree), n[section.degree]};
    for (Eigen::Index i = 0; i + 1 < degree; ++i) each.A(i, i + 1) += 1.0;
    for (Eigen::Index i = 0; i < degree; ++i) {
      const double d = section.denominator[static_cast<std::size_t>(i)];
      each.A(degree - 1, i) -= d;
      each.C(i) = n[static_cast<std::size_t>(i)] - n[section.degree] * d;
    }
    each.B(degree - 1) = 1.0;
    loop = in_series(loop, each);
  }
  return loop;
}

// Rows and columns alike in size, by powers of two.
void balance(Eigen::MatrixXcd& matrix) {
  for (int sweep = 0; sweep < 20; ++sweep) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      const double column = matrix.col(i).cwiseAbs().sum() - std::abs(matrix(i, i));
      const double row = matrix.row(i).cwiseAbs().sum() - std::abs(matrix(i, i));
      if (!(column > 0.0 && row > 0.0)) continue;
      const double factor = std::exp2(std::round(0.5 * std::log2(row / column)));
      matrix.col(i) *= factor;
      matrix.row(i) /= factor;
    }
  }
}

// Largest |z| - 1 of the device with springs and dampers of the wall grown by these factors, and its force turned by
// this angle.
double excess(const Device& device, double stiffness, double spring = 1.0, double damper = 1.0, double angle = 0.0) {
  const double period = device.loop().sampling_period;
  const DiscreteStateSpace sampled = with_delay_states(sample(state_space(device), {period, device.loop().delay}));
  const Wall& wall = device.parameters().wall;
  const Discrete loop = in_series({sampled.Phi, sampled.Gamma1, sampled.C},
                                  controller(wall, spring * stiffness, damper * wall.damping, period));
  // The plant's Phi is e^{AT} - I, and so is all of this, to keep the digits of slow poles.
  Eigen::MatrixXd states = loop.A;
  const Eigen::Index n = sampled.Phi.rows();
  states.bottomRightCorner(states.rows() - n, states.cols() - n).diagonal().array() -= 1.0;
  Eigen::MatrixXcd closed =
      states.cast<std::complex<double>>() - std::polar(1.0, angle) * (loop.B * loop.C).cast<std::complex<double>>();
  balance(closed);
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(closed, false);
  double largest = -1.0;
  for (const std::complex<double>& delta : solver.eigenvalues()) {
    largest = std::max(largest, (2.0 * delta.real() + std::norm(delta)) / (std::abs(1.0 + delta) + 1.0));
  }
  return largest;
}

// Links as the modal shift moves them.
Device moved(const Device& device, double modal_shift) {
  DeviceParameters parameters = device.parameters();
  for (Link& link : parameters.links) {
    link.stiffness *= (1.0 + modal_shift) * (1.0 + modal_shift);
    link.damping *= 1.0 + modal_shift;
  }
  return Device(std::move(parameters));
}

Device notched(const Device& device, const NotchDesign& design) {
  DeviceParameters parameters = device.parameters();
  if (design.notch) parameters.wall.filters.push_back(*design.notch);
  return Device(std::move(parameters));
}

void expect_margins(const Device& device, double stiffness, const NotchOptions& options) {
  const double gain = options.gain_margin * (1.0 - 1e-5);
  EXPECT_LT(excess(device, stiffness), 0.0);
  EXPECT_LT(excess(device, stiffness, gain, 1.0), 0.0) << "the stiffness alone grown";
  EXPECT_LT(excess(device, stiffness, gain, gain), 0.0) << "the whole force grown";
  EXPECT_LT(excess(device, stiffness, std::sqrt(gain), std::sqrt(gain)), 0.0);
  for (const double share : {0.5, 0.9, 1.0 - 1e-4}) {
    if (options.phase_margin == 0.0) break;
    EXPECT_LT(excess(device, stiffness, 1.0, 1.0, -share * options.phase_margin), 0.0)
        << "turned by " << share << " of the phase margin";
  }
}

// Just below the limit that any user leaves without the notch, nobody destabilises the wall behind it.
void expect_no_user_worse_off(const Device& plain, const Device& with_notch, RandomDevices& random) {
  const VirtualDamper damper = virtual_damper(plain);
  const double limit = absolute_stability_limit(plain, damper).stiffness;
  EXPECT_GE(absolute_stability_limit(with_notch, damper).stiffness, limit * (1.0 - 1e-8));
  if (!(limit > 0.0) || !std::isfinite(limit)) return;
  for (int k = 0; k < 5; ++k) {
    DeviceParameters held = with_notch.parameters();
    held.user = {random.chance(0.7) ? random.log_uniform(1e-3, 1e3) : 0.0,
                 random.chance(0.3) ? random.log_uniform(1e-3, 1e3) : 0.0,
                 random.chance(0.7) ? limit * random.log_uniform(1e-3, 1e4) : 0.0};
    EXPECT_LT(excess(Device(held), limit * (1.0 - 1e-6)), rounding)
        << held.user.mass << " " << held.user.damping << " " << held.user.stiffness;
  }
}

TEST(NotchDesignProperty, RandomDevicesKeepTheMarginsAtEveryDrift) {
  std::size_t designed = 0;
  std::size_t found = 0;
  std::size_t refused = 0;
  for (std::size_t i = 0; i < cases(); ++i) {
    RandomDevices random(seed + i);
    const char* kind = kinds[i % kinds.size()];
    const Device device(random.device(kind));
    const NotchOptions options = random_notch_options(random);
    SCOPED_TRACE(testing::Message() << kind << ", seed " << seed + i << ", drift "
                                    << options.modal_frequency_uncertainty << ", gain margin " << options.gain_margin
                                    << ", phase margin " << options.phase_margin);
    if (find_problem(options, device)) continue;
    const NotchDesign design = design_notch(device, options);
    ++designed;
    found += design.notch.has_value();
    if (design.trust.refused()) {
      ++refused;
      continue;
    }
    EXPECT_GE(design.with, design.without);
    if (design.state_with) {
      EXPECT_EQ(design.state_with->device.parameters().wall.stiffness, design.with);
    }
    for (int k = 0; k < (options.modal_frequency_uncertainty > 0.0 ? modal_shifts : 1); ++k) {
      const double modal_shift = options.modal_frequency_uncertainty * (2.0 * k / (modal_shifts - 1) - 1.0);
      const Device plain = options.modal_frequency_uncertainty > 0.0 ? moved(device, modal_shift) : device;
      SCOPED_TRACE(testing::Message() << "drift " << (options.modal_frequency_uncertainty > 0.0 ? modal_shift : 0.0));
      const Device with_notch = notched(plain, design);
      if (design.with > 0.0 && std::isfinite(design.with)) expect_margins(with_notch, design.with, options);
      if (design.without > 0.0 && std::isfinite(design.without)) expect_margins(plain, design.without, options);
      if (design.notch && !options.lower_absolute_stability_limit) expect_no_user_worse_off(plain, with_notch, random);
      if (testing::Test::HasFailure()) break;
    }
  }
  EXPECT_GE(found, cases() / 10);
  EXPECT_LE(refused, cases() / 20);
  std::printf("%zu devices, %zu notches, %zu refused\n", designed, found, refused);
}

// The grid promises a wall where none keeps the margins.
TEST(NotchDesignProperty, FourBodiesMayHaveNoWall) {
  RandomDevices random(seed + 967);
  const Device device(random.device("everything"));
  ASSERT_EQ(device.bodies().size(), 4U);
  const NotchDesign design = design_notch(device, random_notch_options(random));
  EXPECT_EQ(design.with, 0.0);
}

}  // namespace
}  // namespace zwidth::test
