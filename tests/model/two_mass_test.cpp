#include "zwidth/model/two_mass.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "lhifam.hpp"
#include "log_spaced.hpp"
#include "two_mass_response.hpp"

namespace zwidth {
namespace {

using Complex = std::complex<double>;

constexpr TwoMass table_one{0.3, 5.1, 0.1, 3.4, 79.5e3, 15.0};

double difference(const Complex& a, const Complex& b) { return std::abs(a / b - 1.0); }

// Expanded: G_m = p_d / (m_m m_d s⁴ + ...), multiplied out by hand from the equations of motion.
TEST(TwoMass, ResponseSolvesTheEquationsOfMotion) {
  const auto& [mm, md, bm, bd, kc, bc] = table_one;
  for (const double w : test::log_spaced(1e-2, 1e5, 30)) {
    for (const Complex s : {Complex(0.0, w), Complex(0.3 * w, w), Complex(-0.2 * w, 0.5 * w)}) {
      const test::TwoMassResponse g = test::two_mass_response(table_one, s);
      const Complex cable = kc + bc * s;
      const Complex motor = mm * s * s + bm * s + cable;
      const Complex body = md * s * s + bd * s + cable;
      // Force on the motor: x_m = G_m, x_d = G_c; on the body: x_m = G_c, x_d = G_d. Residuals relative to their terms.
      EXPECT_LE(std::abs(motor * g.G_m - cable * g.G_c - 1.0), 1e-13 * (1.0 + std::abs(cable * g.G_c)));
      EXPECT_LE(std::abs(body * g.G_c - cable * g.G_m), 1e-13 * std::abs(cable * g.G_m));
      EXPECT_LE(std::abs(body * g.G_d - cable * g.G_c - 1.0), 1e-13 * (1.0 + std::abs(cable * g.G_c)));
      EXPECT_LE(std::abs(motor * g.G_c - cable * g.G_d), 1e-13 * std::abs(cable * g.G_d));
    }
  }
}

TEST(TwoMass, FactorisedFormIsExactForProportionalDamping) {
  const TwoMass proportional{0.3, 5.1, 0.2, 3.4, 79.5e3, 15.0};  // b_m/m_m = b_d/m_d = 2/3
  EXPECT_LE(two_mass_factors(proportional).relative_error, 1e-30);
  for (const double w : test::log_spaced(1e-2, 1e4, 60)) {
    const Complex s(0.0, w);
    const test::TwoMassResponse exact = test::two_mass_response(proportional, s);
    const test::TwoMassResponse factorised = test::two_mass_factorised_response(proportional, s);
    // Near the resonance (damping ratio 0.05) rounding grows by about 1 / (2 zeta).
    EXPECT_LE(difference(factorised.G_m, exact.G_m), 1e-12);
    EXPECT_LE(difference(factorised.G_c, exact.G_c), 1e-12);
    EXPECT_LE(difference(factorised.G_d, exact.G_d), 1e-12);
  }
}

// Its denominator lacks [(b_m m_d - b_d m_m)/m]² s², and nothing else differs.
TEST(TwoMass, FactorisedFormLacksJustOneTerm) {
  const TwoMass uneven{0.3, 5.1, 9.0, 3.4, 79.5e3, 15.0};
  const auto& [mm, md, bm, bd, kc, bc] = uneven;
  const double mismatch = (bm * md - bd * mm) / (mm + md);
  const TwoMassFactors factors = two_mass_factors(uneven);
  EXPECT_GT(factors.relative_error, 1e-6);
  for (const double w : test::log_spaced(1e-1, 1e4, 60)) {
    const Complex s(0.0, w);
    const Complex exact = (kc + bc * s) / test::two_mass_response(uneven, s).G_c;
    const Complex factorised = (kc + bc * s) / test::two_mass_factorised_response(uneven, s).G_c;
    EXPECT_LE(std::abs(factorised - exact - mismatch * mismatch * s * s), 1e-12 * std::abs(exact)) << w;
  }
  // relative to the coefficient k_c m + b_m b_d + b_c b
  EXPECT_NEAR(factors.relative_error, mismatch * mismatch / (kc * (mm + md) + bm * bd + bc * (bm + bd)),
              1e-14 * factors.relative_error);
}

TEST(TwoMass, FactorsOfTableOne) {
  const TwoMassFactors f = two_mass_factors(table_one);
  EXPECT_NEAR(f.omega_1, std::sqrt(79.5e3 / 0.3), 1e-10);
  EXPECT_NEAR(f.omega_2, std::sqrt(79.5e3 / 5.1), 1e-10);
  EXPECT_NEAR(f.omega_n, std::sqrt(79.5e3 / 0.3 + 79.5e3 / 5.1), 1e-10);
  EXPECT_NEAR(f.z_1, 15.1 / 0.3, 1e-12);
  EXPECT_NEAR(f.z_2, 18.4 / 5.1, 1e-12);
  EXPECT_NEAR(f.z_n, 15.1 / 0.3 + 18.4 / 5.1 - 3.5 / 5.4, 1e-12);
}

TEST(AsTwoMass, TakesTheActuatedBodyAsMotor) {
  DeviceParameters device = test::lhifam_parameters();
  const auto two = as_two_mass(Device(device));
  ASSERT_TRUE(two.has_value());
  EXPECT_EQ(two->motor_mass, 0.3);
  EXPECT_EQ(two->body_mass, 5.1);
  EXPECT_EQ(two->motor_damping, 0.1);
  EXPECT_EQ(two->body_damping, 3.4);
  EXPECT_EQ(two->cable_stiffness, 79.5e3);
  EXPECT_EQ(two->cable_damping, 15.0);
  device.loop.actuated = 1;
  const auto turned = as_two_mass(Device(device));
  ASSERT_TRUE(turned.has_value());
  EXPECT_EQ(turned->motor_mass, 5.1);
  EXPECT_EQ(turned->body_damping, 0.1);
}

TEST(AsTwoMass, AddsTheOperatorToTheHeldBody) {
  DeviceParameters device = test::lhifam_parameters();
  device.user = {0.5, 6.0, 0.0};
  const auto held_body = as_two_mass(Device(device));
  ASSERT_TRUE(held_body.has_value());
  EXPECT_EQ(held_body->body_mass, 5.6);
  EXPECT_EQ(held_body->body_damping, 9.4);
  EXPECT_EQ(held_body->motor_mass, 0.3);
  device.loop.held = 0;
  const auto held_motor = as_two_mass(Device(device));
  ASSERT_TRUE(held_motor.has_value());
  EXPECT_EQ(held_motor->motor_mass, 0.8);
  EXPECT_EQ(held_motor->motor_damping, 6.1);
  EXPECT_EQ(held_motor->body_mass, 5.1);
}

TEST(AsTwoMass, NothingForOtherShapes) {
  const auto none = [](DeviceParameters device) { return !as_two_mass(Device(std::move(device))).has_value(); };
  EXPECT_TRUE(none(test::rigid_parameters()));
  EXPECT_TRUE(none(test::transfer_function_parameters({1.0}, {1.0, 2.0, 0.0}, 1e-3)));
  DeviceParameters device = test::lhifam_parameters();
  device.bodies[0].stiffness = 1.0;
  EXPECT_TRUE(none(device));
  device = test::lhifam_parameters();
  device.user.stiffness = 1.0;
  EXPECT_TRUE(none(device));
  device = test::lhifam_parameters();
  device.links.push_back(device.links[0]);
  EXPECT_TRUE(none(device));
  device = test::lhifam_parameters();
  device.links[0].stiffness = 0.0;
  EXPECT_TRUE(none(device));
  device = test::lhifam_parameters();
  device.bodies.push_back({"third", 1.0, 0.0, 0.0, 0.0});
  device.links.push_back({1, 2, 1e4, 1.0});
  EXPECT_TRUE(none(device));
}

}  // namespace
}  // namespace zwidth
