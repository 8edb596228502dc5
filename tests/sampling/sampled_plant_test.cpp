#include "zwidth/sampling/sampled_plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "fifty_digits.hpp"
#include "lhifam.hpp"
#include "log_spaced.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

struct Case {
  std::string name;
  DeviceParameters device;
  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
};

DeviceParameters with(DeviceParameters device, void (*change)(DeviceParameters&)) {
  change(device);
  return device;
}

const Case cases[] = {
    {"rigid", test::rigid_parameters()},
    {"free_mass", with(test::rigid_parameters(), [](auto& d) { d.bodies[0].damping = 0.0; })},
    {"motor_sensed", test::lhifam_parameters()},
    {"reduced_pretension", test::reduced_pretension_parameters()},
    {"light_damping", with(test::lhifam_parameters(),
                           [](auto& d) {
                             d.links[0].damping = 1e-3;
                             d.bodies[0].damping = d.bodies[1].damping = 1e-3;
                           })},
    {"mode_far_above_nyquist", with(test::lhifam_parameters(), [](auto& d) { d.links[0].stiffness = 1e11; })},
    {"overdamped", with(test::lhifam_parameters(), [](auto& d) { d.links[0].damping = 2000.0; })},
    {"grounded", with(test::lhifam_parameters(), [](auto& d) { d.bodies[1].stiffness = 500.0; })},
    {"operator", with(test::lhifam_parameters(),
                      [](auto& d) {
                        d.user = {0.5, 6.0, 300.0};
                      })},
    {"actuator_lag", with(test::lhifam_parameters(), [](auto& d) { d.actuator.time_constant = 1e-3; })},
    {"three_bodies", with(test::lhifam_parameters(),
                          [](auto& d) {
                            d.bodies.push_back({"carriage", 0.8, 0.4, 0.0, 0.0});
                            d.links.push_back({0, 2, 4e4, 2.0});
                          })},
};

class SampledPlantAccuracy : public testing::TestWithParam<Case> {};

// Against the matrix exponential in 50 digits. Tolerance: a stiffness is wanted to 1e-9; the magnitude has to be ten
// times better. The frequency of a crossover is where the distance of the phase from -180 degrees changes its sign, so
// that distance is compared, relative to itself: at low frequencies it is of order 1e-4 and less. Up to 0.999 of
// Nyquist: there the distance goes to zero, and the rounding of w T is all of it.
TEST_P(SampledPlantAccuracy, AgreesWithFiftyDigits) {
  constexpr double tolerance = 1e-10;
  for (const double period : {1e-5, 1e-4, 1e-3, 1e-2}) {
    for (const double delay_samples : {0.0, 0.25, 0.999, 1.0, 2.6}) {
      DeviceParameters parameters = GetParam().device;
      parameters.loop.sampling_period = period;
      parameters.loop.delay = delay_samples * period;
      SCOPED_TRACE(testing::Message() << "T " << period << " s, delay " << delay_samples << " T");
      const Device device(parameters);
      const Sampling sampling{period, parameters.loop.delay};
      const test::ExactSampledDevice exact(test::exact_state_space(device), sampling);
      const SampledPlant plant = sampled_plant(device);
      double worst = 0.0;
      double worst_phase = 0.0;
      for (const double frequency : test::log_spaced(1e-3, 0.999 * std::numbers::pi / period, 16)) {
        const std::complex<double> ours = response(plant, frequency);
        const test::Complex50 reference = exact.response(frequency);
        worst = std::max(worst, test::relative_error(ours, reference));
        worst_phase = std::max(worst_phase, test::phase_distance_error(ours, reference));
      }
      EXPECT_LE(worst, tolerance);
      EXPECT_LE(worst_phase, tolerance);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, SampledPlantAccuracy, testing::ValuesIn(cases),
                         [](const auto& test) { return test.param.name; });

// Sensed beyond the link and far above its mode the terms cancel; the sum is formed in double-double then.
TEST(SampledPlant, HandleSensedFarAboveTheMode) {
  for (const double period : {1e-5, 1e-4, 1e-3}) {
    for (const double delay_samples : {0.0, 0.4}) {
      const Device device([&] {
        DeviceParameters d = test::handle_sensed(test::lhifam_parameters());
        d.loop.sampling_period = period;
        d.loop.delay = delay_samples * period;
        return d;
      }());
      const test::ExactSampledDevice exact(test::exact_state_space(device), {period, device.loop().delay});
      const SampledPlant plant = sampled_plant(device);
      for (const double frequency : test::log_spaced(1.0, 0.999 * std::numbers::pi / period, 25)) {
        EXPECT_LE(test::relative_error(response(plant, frequency), exact.response(frequency)), 1e-9)
            << "T " << period << " s, " << frequency << " rad/s";
      }
    }
  }
}

TEST(SampledPlant, NyquistIsReal) {
  for (const double delay : {0.0, 0.3e-3, 1e-3}) {
    const SampledPlant plant = sampled_plant(Device(test::with_delay(test::lhifam_parameters(), delay)));
    const std::complex<double> at_nyquist = response(plant, std::numbers::pi / 1e-3);
    EXPECT_LE(std::abs(at_nyquist.imag()), 1e-12 * std::abs(at_nyquist.real()));
  }
}

// 0.003 / 0.001 = 3.0000000000000004 in doubles, and is three samples.
TEST(SampledPlant, DelayWithinRoundingOfWholeSamplesIsWhole) {
  const ModalForm form = modal_form(Device(test::lhifam_parameters()));
  for (const double samples : {1.0, 3.0, 7.0, 10.0, 299.0}) {
    for (const double period : {1e-3, 0.7e-3, 1e-5}) {
      const double exact = samples * period;
      for (const double delay : {exact, std::nextafter(exact, 0.0), std::nextafter(exact, 1.0)}) {
        EXPECT_EQ(sample(form, {period, delay}).delay_samples, static_cast<std::size_t>(samples));
      }
    }
  }
  EXPECT_EQ(sample(form, {0.001, 0.003}).delay_samples, 3U);
  // A thousandth of a sample is a fraction: one sample more outside the sum, which carries z.
  EXPECT_EQ(sample(form, {0.001, 0.003001}).delay_samples, 4U);
  EXPECT_EQ(sample(form, {0.001, 0.0}).delay_samples, 0U);
}

// Continuous in the delay: just below and just above a whole sample.
TEST(SampledPlant, NearlyWholeDelaysAgreeWithWholeOnes) {
  const ModalForm form = modal_form(Device(test::lhifam_parameters()));
  const std::complex<double> whole = response(sample(form, {1e-3, 1e-3}), 500.0);
  for (const double offset : {1e-12, 1e-9}) {
    for (const double sign : {-1.0, 1.0}) {
      const double delay = 1e-3 * (1.0 + sign * offset);
      const std::complex<double> near = response(sample(form, {1e-3, delay}), 500.0);
      EXPECT_LE(std::abs(near / whole - 1.0), 2.0 * offset);  // e^{-jw dt}: w T = 0.5
    }
  }
}

TEST(SampledPlant, BadSamplingThrows) {
  const ModalForm form = modal_form(Device(test::rigid_parameters()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Sampling sampling : {Sampling{0.0, 0.0}, Sampling{-1e-3, 0.0}, Sampling{nan, 0.0}, Sampling{infinity, 0.0},
                                  Sampling{1e-3, -1e-9}, Sampling{1e-3, nan}, Sampling{1e-3, infinity}}) {
    try {
      (void)sample(form, sampling);
      FAIL() << "no error for T " << sampling.period << ", delay " << sampling.delay;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
    }
  }
}

}  // namespace
}  // namespace zwidth
