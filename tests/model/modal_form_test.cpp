#include "zwidth/model/modal_form.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <random>
#include <string>
#include <vector>

#include "fifty_digits.hpp"
#include "lhifam.hpp"
#include "log_spaced.hpp"
#include "model/modal_forms.hpp"
#include "two_mass_response.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/two_mass.hpp"

namespace zwidth {
namespace {

using test::log_spaced;

// A sum of terms is accurate relative to its largest term, not to itself where the terms cancel (a transfer across
// links far above their modes): the error is taken relative to the sum of magnitudes.
double error_of(const ModalForm& form, const Device& device, double frequency) {
  const test::Complex50 exact = test::exact_response(device, frequency);
  double size = 0.0;
  for (const ModalTerm& term : form.terms) size += std::abs(response(term, frequency));
  const double magnitude = static_cast<double>(abs(exact));
  return test::relative_error(response(form, frequency), exact) * magnitude / std::max(size, magnitude);
}

// Near a resonance of damping ratio zeta the response is as sensitive to the frequency as 1/zeta.
void expect_exact(const DeviceParameters& parameters, double first, double last, double tolerance) {
  const Device device(parameters);
  const ModalForm form = modal_form(device);
  double worst = 0.0;
  double worst_at = 0.0;
  for (const double frequency : log_spaced(first, last, 41)) {
    const double error = error_of(form, device, frequency);
    if (!(error <= worst)) worst = error, worst_at = frequency;
  }
  EXPECT_LE(worst, tolerance) << "at " << worst_at << " rad/s";
}

DeviceParameters two_bodies(double m1, double b1, double m2, double b2, double k, double b) {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies = {{"motor", m1, b1, 0.0, 0.0}, {"handle", m2, b2, 0.0, 0.0}};
  device.links = {{0, 1, k, b}};
  return device;
}

DeviceParameters chain(std::size_t bodies, std::mt19937_64& random) {
  const auto log_uniform = [&random](double low, double high) {
    return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(random));
  };
  DeviceParameters device;
  device.name = "chain";
  for (std::size_t i = 0; i < bodies; ++i) {
    device.bodies.push_back({"body" + std::to_string(i), log_uniform(0.01, 10.0), log_uniform(0.01, 10.0),
                             i % 3 == 1 ? log_uniform(1.0, 1e3) : 0.0, 0.0});
    if (i > 0) device.links.push_back({i - 1, i, log_uniform(1e3, 1e6), log_uniform(0.1, 30.0)});
  }
  device.loop = {0, 0, bodies - 1, 1e-3, 0.0};
  return device;
}

TEST(ModalForm, AgreesWithTheClosedFormsOfTwoMasses) {
  const Device device(test::lhifam_parameters());
  const TwoMass two = as_two_mass(device).value();
  struct {
    Path path;
    std::complex<double> test::TwoMassResponse::*response;
  } const cases[] = {{{0, 0}, &test::TwoMassResponse::G_m},
                     {{0, 1}, &test::TwoMassResponse::G_c},
                     {{1, 0}, &test::TwoMassResponse::G_c},
                     {{1, 1}, &test::TwoMassResponse::G_d}};
  for (const auto& [path, member] : cases) {
    const ModalForm form = modal_form(device, path, ActuatorLag::included);
    // Up to a few times the mode: beyond, terms of G_c cancel and the closed form is the better one.
    for (const double frequency : log_spaced(1e-3, 2000.0, 400)) {
      const std::complex<double> closed = test::two_mass_response(two, {0.0, frequency}).*member;
      EXPECT_LE(std::abs(response(form, frequency) / closed - 1.0), 1e-12)
          << "at " << frequency << " rad/s, " << path.force_at << " -> " << path.position_of;
    }
  }
}

TEST(ModalForm, AgreesWithFiftyDigitsOnRandomChains) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937_64 random(seed);
    DeviceParameters device = chain(1 + seed % 6, random);
    device.loop.sensed = random() % device.bodies.size();
    device.loop.actuated = random() % device.bodies.size();
    if (seed % 4 == 1) device.user = {0.3, 5.0, 200.0};
    if (seed % 5 == 2) device.actuator.time_constant = 1e-3;
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    expect_exact(device, 1e-2, 1e5, 1e-13);
  }
}

TEST(ModalForm, UndampedModes) {
  const DeviceParameters device = two_bodies(1.0, 0.0, 3.0, 0.0, 1200.0, 0.0);
  const ModalForm form = modal_form(Device(device));
  ASSERT_EQ(form.modes.size(), 1U);
  EXPECT_NEAR(form.modes[0].frequency, 40.0, 1e-12);  // k (1/m1 + 1/m2) = 1600
  EXPECT_EQ(form.modes[0].damping_ratio, 0.0);
  ASSERT_EQ(form.terms.size(), 2U);
  EXPECT_EQ(form.terms[0].integrators, 2);
  EXPECT_EQ(form.terms[0].undamped_pairs, 0);
  EXPECT_EQ(form.terms[1].undamped_pairs, 1);
  expect_exact(device, 1e-2, 39.0, 1e-13);
  expect_exact(device, 41.0, 1e4, 1e-13);
}

// m1 = m2 = 1, k = b²/2: the mode is s² + 2 b s + 2 k = (s + b)² exactly.
TEST(ModalForm, CriticallyDampedMode) {
  for (const double b : {2.0, 64.0}) {
    const DeviceParameters device = two_bodies(1.0, 0.0, 1.0, 0.0, b * b / 2.0, b);
    const ModalForm form = modal_form(Device(device));
    ASSERT_EQ(form.modes.size(), 1U);
    EXPECT_NEAR(form.modes[0].frequency, b, 1e-13 * b);
    EXPECT_NEAR(form.modes[0].damping_ratio, 1.0, 1e-13);
    expect_exact(device, 1e-3, 1e5, 1e-13);
  }
}

TEST(ModalForm, NearlyCriticalDamping) {
  for (const double step : {1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6, 1e-3, -1e-3}) {
    SCOPED_TRACE(step);
    expect_exact(two_bodies(1.0, 0.3, 1.0, 0.1, 2.0 * (1.0 + step), 2.0), 1e-3, 1e5, 1e-13);
  }
}

TEST(ModalForm, OverdampedModeIsTwoRealPoles) {
  const DeviceParameters device = two_bodies(0.5, 0.0, 0.5, 0.0, 4.0, 5.0);  // s² + 20 s + 16
  const ModalForm form = modal_form(Device(device));
  ASSERT_EQ(form.modes.size(), 1U);
  EXPECT_NEAR(form.modes[0].frequency, 4.0, 1e-13);
  EXPECT_NEAR(form.modes[0].damping_ratio, 2.5, 1e-13);
  expect_exact(device, 1e-3, 1e5, 1e-13);
}

// A hub with identical branches: the branches' own mode is multiple, and unseen from the hub.
TEST(ModalForm, RepeatedModesOfAHub) {
  DeviceParameters device;
  device.name = "hub";
  device.bodies = {{"hub", 2.0, 0.1, 0.0, 0.0}};
  for (std::size_t i = 1; i <= 4; ++i) {
    device.bodies.push_back({"branch" + std::to_string(i), 0.5, 0.2, 0.0, 0.0});
    device.links.push_back({0, i, 5000.0, 1.5});
  }
  device.loop = {0, 0, 4, 1e-3, 0.0};
  for (const std::size_t sensed : {0U, 1U, 2U}) {
    for (const std::size_t actuated : {0U, 1U}) {
      device.loop.sensed = sensed;
      device.loop.actuated = actuated;
      SCOPED_TRACE(testing::Message() << actuated << " -> " << sensed);
      expect_exact(device, 1e-2, 1e5, 1e-12);
    }
  }
  EXPECT_EQ(modal_form(Device(device)).modes.size(), 4U);
}

// Two branches tuned so that two different modes nearly or exactly coincide.
TEST(ModalForm, NearlyRepeatedModes) {
  for (const double mistuning : {0.0, 1e-14, 1e-10, 1e-6, 1e-3}) {
    DeviceParameters device;
    device.bodies = {{"hub", 2.0, 0.1, 0.0, 0.0}, {"left", 0.5, 0.2, 0.0, 0.0}, {"right", 0.5, 0.2, 0.0, 0.0}};
    device.links = {{0, 1, 5000.0, 1.5}, {0, 2, 5000.0 * (1.0 + mistuning), 1.5}};
    device.loop = {0, 1, 2, 1e-3, 0.0};
    SCOPED_TRACE(mistuning);
    expect_exact(device, 1e-2, 1e5, 1e-12);
  }
}

TEST(ModalForm, StiffLinkTendsToTheRigidDevice) {
  const DeviceParameters device = two_bodies(0.3, 0.1, 5.1, 3.4, 1e12, 15.0);
  expect_exact(device, 1e-3, 1e5, 1e-13);
  const ModalForm stiff = modal_form(Device(device));
  const ModalForm rigid = modal_form(Device(test::rigid_parameters()));
  for (const double frequency : log_spaced(1e-3, 3000.0, 50)) {
    // The link gives by m w²/k: 5e-5 at 3000 rad/s.
    EXPECT_LE(std::abs(response(stiff, frequency) / response(rigid, frequency) - 1.0),
              1e-12 + frequency * frequency * 5.4 / 1e12);
  }
}

// Ten times below the accuracy promised for K_CR.
TEST(ModalForm, WidelySpreadMasses) {
  expect_exact(two_bodies(1e-6, 0.01, 1e3, 5.0, 1e4, 0.1), 1e-3, 1e6, 1e-10);
  expect_exact(two_bodies(1e3, 5.0, 1e-6, 0.01, 1e4, 0.1), 1e-3, 1e6, 1e-10);
  expect_exact(two_bodies(1e-6, 0.0, 1e3, 0.0, 1e4, 1e-4), 1e-3, 1e4, 1e-10);
}

TEST(ModalForm, ThirtyBodiesInAChain) {
  std::mt19937_64 random(7);
  DeviceParameters device = chain(30, random);
  for (Body& body : device.bodies) body.stiffness = 0.0;
  device.loop.sensed = 2;
  const ModalForm form = modal_form(Device(device));
  EXPECT_EQ(form.modes.size(), 29U);
  for (const double frequency : log_spaced(1e-1, 1e4, 21)) {
    EXPECT_LE(error_of(form, Device(device), frequency), 1e-12) << "at " << frequency << " rad/s";
  }
}

// Poles that are found once are those of every path.
TEST(ModalForms, AlongEachPathIsThatOfThePathAlone) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    std::mt19937_64 random(seed);
    DeviceParameters parameters = chain(1 + seed % 8, random);
    if (seed % 3 == 1) parameters.actuator.time_constant = 1e-3;
    if (seed % 4 == 2) {  // alike: exact arithmetic
      for (Body& body : parameters.bodies) body = parameters.bodies.front();
      for (std::size_t i = 0; i < parameters.bodies.size(); ++i) parameters.bodies[i].name = std::to_string(i);
    }
    const Device device(parameters);
    internal::ModalForms forms(device, ActuatorLag::included);
    for (std::size_t force_at = 0; force_at < device.bodies().size(); ++force_at) {
      for (std::size_t position_of = 0; position_of < device.bodies().size(); ++position_of) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ": " << force_at << " -> " << position_of);
        const Path path{force_at, position_of};
        const ModalForm shared = forms.along(path);
        const ModalForm alone = modal_form(device, path, ActuatorLag::included);
        ASSERT_EQ(shared.terms.size(), alone.terms.size());
        for (std::size_t k = 0; k < shared.terms.size(); ++k) {
          ASSERT_EQ(shared.terms[k].degree, alone.terms[k].degree);
          for (std::size_t i = 0; i < shared.terms[k].degree; ++i) {
            EXPECT_EQ(shared.terms[k].numerator[i], alone.terms[k].numerator[i]);
            EXPECT_EQ(shared.terms[k].denominator[i], alone.terms[k].denominator[i]);
          }
        }
      }
    }
  }
}

TEST(ModalForm, LinksInACircle) {
  std::mt19937_64 random(3);
  DeviceParameters device = chain(5, random);
  device.links.push_back({4, 0, 2e4, 3.0});
  device.links.push_back({1, 3, 7e4, 0.0});
  device.links.push_back({0, 1, 1e3, 0.5});  // beside the chain's own link
  device.loop.sensed = 3;
  expect_exact(device, 1e-2, 1e5, 1e-13);
}

// No spring ties the bodies: each has a pole of its own at s = 0, one of them cancelled by a zero.
TEST(ModalForm, DamperAloneAsLink) { expect_exact(two_bodies(0.3, 0.1, 5.1, 3.4, 0.0, 15.0), 1e-3, 1e5, 1e-13); }

TEST(ModalForm, DamperAloneAsLinkOfFreeBodies) {
  expect_exact(two_bodies(0.3, 0.0, 5.1, 0.0, 0.0, 15.0), 1e-3, 1e5, 1e-13);
}

TEST(ModalForm, ActuatorLagAtADevicePole) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies = {{"body", 2.0, 8.0, 0.0, 0.0}};  // s (2 s + 8): pole at -4
  for (const double constant : {0.25, 0.25 * (1.0 + 1e-15), 0.25 * (1.0 + 1e-9), 0.2501}) {
    device.actuator.time_constant = constant;
    SCOPED_TRACE(constant);
    expect_exact(device, 1e-3, 1e5, 1e-13);
  }
  DeviceParameters critical = two_bodies(1.0, 0.0, 1.0, 0.0, 2.0, 2.0);  // (s + 2)²
  critical.actuator.time_constant = 0.5;                                 // and a third pole there
  expect_exact(critical, 1e-3, 1e5, 1e-13);
  const ModalForm without = modal_form(Device(critical), {0, 0}, ActuatorLag::left_out);
  critical.actuator.time_constant = 0.0;
  const ModalForm never = modal_form(Device(critical));
  EXPECT_LE(std::abs(response(without, 3.0) / response(never, 3.0) - 1.0), 1e-14);
}

TEST(ModalForm, ModesAreNumberedByRisingFrequency) {
  for (unsigned seed = 100; seed < 130; ++seed) {
    std::mt19937_64 random(seed);
    const ModalForm form = modal_form(Device(chain(2 + seed % 5, random)));
    EXPECT_TRUE(std::is_sorted(form.modes.begin(), form.modes.end(),
                               [](const Mode& a, const Mode& b) { return a.frequency < b.frequency; }));
    int last = 0;
    for (const ModalTerm& term : form.terms) {
      if (term.mode < 0) continue;
      EXPECT_GE(term.mode, last) << "seed " << seed;
      last = term.mode;
      EXPECT_LE(static_cast<std::size_t>(term.mode), form.modes.size());
    }
  }
}

// Springs to ground turn the rigid body's motion into a mode of its own, which is no vibration mode.
TEST(ModalForm, SuspendedRigidBody) {
  DeviceParameters device = test::lhifam_parameters();
  EXPECT_FALSE(modal_form(Device(device)).suspended_rigid_body.has_value());
  device.bodies[1].stiffness = 54.0;  // w² = 54 / 5.4
  const ModalForm form = modal_form(Device(device));
  ASSERT_TRUE(form.suspended_rigid_body.has_value());
  EXPECT_NEAR(form.suspended_rigid_body->frequency, std::sqrt(10.0), 1e-3);
  EXPECT_NEAR(form.suspended_rigid_body->damping_ratio, 3.5 / (2.0 * 5.4 * std::sqrt(10.0)), 1e-3);
  ASSERT_EQ(form.modes.size(), 1U);
  EXPECT_NEAR(form.modes[0].frequency, 529.7, 0.5);
  expect_exact(device, 1e-3, 1e5, 1e-13);
}

TEST(ModalForm, WrongPathsThrow) {
  const Device device(test::lhifam_parameters());
  for (const Path path : {Path{2, 0}, Path{0, 2}}) {
    try {
      (void)modal_form(device, path, ActuatorLag::included);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::no_such_body);
    }
  }
  try {
    (void)modal_form(Device(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1e-3)), {0, 0},
                     ActuatorLag::included);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::needs_bodies);
  }
}

}  // namespace
}  // namespace zwidth
