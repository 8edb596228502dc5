#include "zwidth/identification/excitation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <span>

#include "lhifam.hpp"
#include "signal/fourier.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::array all_kinds{ExcitationKind::linear_chirp, ExcitationKind::logarithmic_chirp,
                               ExcitationKind::multisine, ExcitationKind::noise, ExcitationKind::relay};

/// Power of the signal's lines below, in and above [lowest, highest] Hz, as parts of all of it.
struct PowerSplit {
  double below = 0.0;
  double inside = 0.0;
  double above = 0.0;
};

PowerSplit split_power(const std::vector<double>& signal, double rate, double lowest, double highest) {
  const auto lines = spectrum(signal);
  PowerSplit split;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const double frequency = static_cast<double>(k) * rate / static_cast<double>(signal.size());
    (frequency < lowest ? split.below : frequency > highest ? split.above : split.inside) += std::norm(lines[k]);
  }
  const double all = split.below + split.inside + split.above;
  return {split.below / all, split.inside / all, split.above / all};
}

void expect_rounded(const Remark& remark, const char* what, double actual, double wanted) {
  const Finding found = remark.finding.value();
  EXPECT_EQ(found.code, FindingCode::excitation_rounded);
  EXPECT_EQ(found.subjects.at(0), (Subject{"what", what}));
  EXPECT_NEAR(found.evidence.at(0).value, actual, 1e-9);
  EXPECT_EQ(found.evidence.at(1).value, wanted);
}

/// Times at which a sampled signal rises through zero, by the line between its neighbours.
std::vector<double> rising_zeros(const std::vector<double>& samples, double rate) {
  std::vector<double> times;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    if (samples[k - 1] < 0.0 && samples[k] >= 0.0) {
      times.push_back((static_cast<double>(k) - samples[k] / (samples[k] - samples[k - 1])) / rate);
    }
  }
  return times;
}

TEST(Excitation, LinearChirpPassesEveryFrequencyAtItsTime) {
  ExcitationOptions options;
  options.lowest_hz = 5.0;
  options.highest_hz = 50.0;
  options.rate = 1e5;
  options.duration = 4.0;
  const std::vector<double> zeros = rising_zeros(excite(options).samples, 1e5);
  // Cycle n begins where f1 t + (f2 - f1) t^2 / (2 D) = n.
  ASSERT_EQ(zeros.size(), 109U);  // 110 cycles in all, the first from t = 0, the last complete at the end
  const double slope = 45.0 / 4.0;
  for (std::size_t i = 0; i < zeros.size(); ++i) {
    const auto n = static_cast<double>(i + 1);
    EXPECT_NEAR(zeros[i], (-5.0 + std::sqrt(25.0 + 2.0 * slope * n)) / slope, 1e-8) << n;
  }
}

TEST(Excitation, LogarithmicChirpSpendsEqualTimeInEachOctave) {
  ExcitationOptions options;
  options.kind = ExcitationKind::logarithmic_chirp;
  options.lowest_hz = 2.0;
  options.highest_hz = 64.0;
  options.rate = 1e5;
  options.duration = 5.0;  // five octaves: one each second
  const std::vector<double> zeros = rising_zeros(excite(options).samples, 1e5);
  for (std::size_t i = 1; i < zeros.size(); ++i) {
    // The mean frequency of a cycle is that of a logarithmic chirp at some time within it.
    const double octaves = std::log2(1.0 / (zeros[i] - zeros[i - 1]) / 2.0);
    EXPECT_GT(octaves, zeros[i - 1]);
    EXPECT_LT(octaves, zeros[i]);
  }
  options.highest_hz = options.lowest_hz;  // a plain sine
  const std::vector<double> sine = excite(options).samples;
  EXPECT_NEAR(sine[12500], 1.0, 1e-9);
}

TEST(Excitation, PowerStaysInTheBand) {
  for (const ExcitationKind kind : {ExcitationKind::linear_chirp, ExcitationKind::logarithmic_chirp}) {
    ExcitationOptions options;
    options.kind = kind;
    options.fade_in = 0.5;
    const PowerSplit split = split_power(excite(options).samples, 1000.0, 9.0, 202.0);
    EXPECT_LT(split.below + split.above, 1e-3);
  }
  for (const ExcitationKind kind : {ExcitationKind::multisine, ExcitationKind::noise}) {
    ExcitationOptions options;
    options.kind = kind;
    const PowerSplit split = split_power(excite(options).samples, 1000.0, 9.999, 200.001);
    EXPECT_LT(split.below + split.above, 1e-25);
  }
}

TEST(Excitation, MultisineRepeatsAndItsLinesAreEqual) {
  ExcitationOptions options;
  options.kind = ExcitationKind::multisine;
  options.amplitude = 3.0;
  options.lowest_hz = 10.0;
  options.highest_hz = 200.0;
  options.duration = 7.0;
  options.periods = 7;
  const Excitation excitation = excite(options);
  ASSERT_EQ(excitation.period, 1000U);
  ASSERT_EQ(excitation.samples.size(), 7000U);
  for (std::size_t k = 1000; k < 7000; ++k) ASSERT_EQ(excitation.samples[k], excitation.samples[k - 1000]);
  const auto lines = spectrum(std::span(excitation.samples).first(1000));
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const double expected = k >= 10 && k <= 200 ? std::abs(lines[10]) : 0.0;
    EXPECT_NEAR(std::abs(lines[k]), expected, 1e-12 * std::abs(lines[10])) << k;
  }
  const CrestFactor crest = crest_factor(excitation.samples);
  EXPECT_NEAR(crest.peak, 3.0, 1e-12);
  // Schroeder's phases give about 1.7 for a flat band; random phases about 3.3, equal phases sqrt(2 * 191) = 19.5.
  EXPECT_LT(crest.factor, 1.9);
}

TEST(Excitation, AnAwkwardPeriodIsRoundedAndSaidSo) {
  ExcitationOptions options;
  options.kind = ExcitationKind::multisine;
  options.duration = 10.0;
  options.periods = 3;
  const Excitation excitation = excite(options);
  EXPECT_EQ(excitation.period, 3333U);
  EXPECT_EQ(excitation.samples.size(), 9999U);
  ASSERT_EQ(excitation.remarks.size(), 1U);
  expect_rounded(excitation.remarks[0], "duration", 9.999, 10.0);
}

TEST(Excitation, NoiseIsGaussianAndFlatAndTheSameForASeed) {
  ExcitationOptions options;
  options.kind = ExcitationKind::noise;
  options.duration = 100.0;
  const std::vector<double> noise = excite(options).samples;
  EXPECT_EQ(noise, excite(options).samples);
  const CrestFactor crest = crest_factor(noise);
  EXPECT_DOUBLE_EQ(crest.peak, options.amplitude);
  double fourth = 0.0;
  for (const double each : noise) fourth += std::pow(each / crest.rms, 4.0) / static_cast<double>(noise.size());
  // 38 000 independent values: the kurtosis of 3 is met to sqrt(24 / 38000) = 0.025.
  EXPECT_NEAR(fourth, 3.0, 0.1);
  const PowerSplit halves = split_power(noise, 1000.0, 10.0, 105.0);
  EXPECT_NEAR(halves.inside, 0.5, 0.02);  // 9500 lines in each half: 1 %
  options.seed = 2;
  EXPECT_NE(noise, excite(options).samples);
}

TEST(Excitation, NoiseOfOneLineIsTheSineThatItsSeedSays) {
  ExcitationOptions options;
  options.kind = ExcitationKind::noise;
  options.duration = 0.016;
  options.lowest_hz = 100.0;
  options.highest_hz = 150.0;  // one line of 16 samples: k = 2
  options.seed = 5;
  const std::vector<double> noise = excite(options).samples;
  std::mt19937_64 generator(5);
  (void)generator();  // the line's magnitude, gone with the scaling
  const double phase = 2.0 * std::numbers::pi * static_cast<double>((generator() >> 11) + 1) / 9007199254740992.0;
  std::vector<double> sine(16);
  for (std::size_t k = 0; k < 16; ++k) sine[k] = std::cos(std::numbers::pi / 4.0 * static_cast<double>(k) + phase);
  const double peak = crest_factor(sine).peak;
  for (std::size_t k = 0; k < 16; ++k) EXPECT_NEAR(noise[k], sine[k] / peak, 1e-14);
}

TEST(Excitation, RelaySwitchesEveryHalfPeriodOfWholeSamples) {
  ExcitationOptions options;
  options.kind = ExcitationKind::relay;
  options.amplitude = 2.0;
  options.lowest_hz = 30.0;
  options.duration = 1.0;
  const Excitation excitation = excite(options);
  EXPECT_EQ(excitation.period, 34U);  // 1000 / 60 = 16.7 rounded to 17
  ASSERT_EQ(excitation.remarks.size(), 1U);
  expect_rounded(excitation.remarks[0], "frequency", 1000.0 / 34.0, 30.0);
  for (std::size_t k = 0; k < excitation.samples.size(); ++k) {
    EXPECT_EQ(excitation.samples[k], k / 17 % 2 == 0 ? 2.0 : -2.0);
  }
}

TEST(Excitation, NeverExceedsTheAmplitudeAndFadesAtTheEnds) {
  for (const ExcitationKind kind : all_kinds) {
    ExcitationOptions options;
    options.kind = kind;
    options.amplitude = 4.0;
    options.fade_in = 0.25;
    const std::vector<double> plain = [&] {
      ExcitationOptions unfaded = options;
      unfaded.fade_in = 0.0;
      return excite(unfaded).samples;
    }();
    const std::vector<double> faded = excite(options).samples;
    ASSERT_EQ(faded.size(), 20000U);
    EXPECT_LE(crest_factor(plain).peak, 4.0 * (1.0 + 1e-12));
    EXPECT_EQ(faded[0], 0.0);
    EXPECT_NEAR(faded[125], 0.5 * plain[125], 1e-12);
    const bool periodic = kind == ExcitationKind::multisine;
    for (std::size_t k = 250; k < 19750; ++k) ASSERT_EQ(faded[k], plain[k]);
    EXPECT_NEAR(faded[19999 - 125], (periodic ? 1.0 : 0.5) * plain[19999 - 125], 1e-12);
  }
}

TEST(Excitation, RefusesWhatMakesNoSignal) {
  const auto refused = [](auto change) {
    ExcitationOptions options;
    change(options);
    EXPECT_THROW((void)excite(options), Error);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    refused([&](auto& options) { options.amplitude = bad; });
    refused([&](auto& options) { options.duration = bad; });
    refused([&](auto& options) { options.rate = bad; });
    refused([&](auto& options) { options.lowest_hz = bad; });
    refused([&](auto& options) { options.highest_hz = bad; });
  }
  refused([](auto& options) { options.highest_hz = 500.1; });
  refused([](auto& options) { options.lowest_hz = 201.0; });
  refused([](auto& options) { options.duration = 1.1e5; });
  refused([](auto& options) { options.duration = 1e-3; });
  refused([](auto& options) { options.fade_in = 10.1; });
  refused([&](auto& options) { options.fade_in = nan; });
  refused([](auto& options) {
    options.kind = ExcitationKind::multisine;
    options.periods = 0;
  });
  refused([](auto& options) {
    options.kind = ExcitationKind::multisine;
    options.periods = 10001;
  });
  refused([](auto& options) {  // lines 0.5 Hz apart, none in the band
    options.kind = ExcitationKind::multisine;
    options.lowest_hz = 10.1;
    options.highest_hz = 10.4;
  });
  refused([](auto& options) {
    options.kind = ExcitationKind::noise;
    options.duration = 1.1e4;
  });
}

TEST(Excitation, ProblemsNameTheMember) {
  const auto member = [](auto change) {
    ExcitationOptions options;
    change(options);
    const auto problem = find_problem(options);
    return problem ? problem->member : "none";
  };
  EXPECT_EQ(member([](auto&) {}), "none");
  EXPECT_EQ(member([](auto& options) { options.amplitude = 0.0; }), "amplitude");
  EXPECT_EQ(member([](auto& options) { options.rate = -1.0; }), "rate");
  EXPECT_EQ(member([](auto& options) { options.duration = 1e9; }), "duration");
  EXPECT_EQ(member([](auto& options) { options.lowest_hz = 501.0; }), "lowest_hz");
  EXPECT_EQ(member([](auto& options) { options.highest_hz = 501.0; }), "highest_hz");
  EXPECT_EQ(member([](auto& options) { options.fade_in = 10.1; }), "fade_in");
  EXPECT_EQ(member([](auto& options) { options.stroke_limit = 0.0; }), "stroke_limit");
  for (const ExcitationKind kind : {ExcitationKind::multisine, ExcitationKind::noise}) {
    EXPECT_EQ(member([&](auto& options) {
                options.kind = kind;
                options.lowest_hz = 10.01;
                options.highest_hz = 10.04;
              }),
              "highest_hz");
  }
  EXPECT_EQ(member([](auto& options) {
              options.kind = ExcitationKind::multisine;
              options.periods = 0;
            }),
            "periods");
}

// A band beyond half of 1000 Hz is one of a device that samples faster.
TEST(Excitation, TakesTheDevicesRateWhereItHasNone) {
  DeviceParameters parameters = test::rigid_parameters();
  parameters.loop.sampling_period = 1e-4;
  ExcitationOptions options;
  options.highest_hz = 2000.0;
  EXPECT_EQ(find_problem(options)->member, "highest_hz");
  EXPECT_FALSE(find_problem(options, Device(parameters)));
  EXPECT_EQ(excite(options, Device(parameters)).rate, 1e4);
  options.rate = 5000.0;
  EXPECT_EQ(excite(options, Device(parameters)).rate, 5000.0);
  EXPECT_EQ(excite({}).rate, 1000.0);
}

TEST(Excitation, LessThanACycleIsWarnedOf) {
  ExcitationOptions options;
  options.lowest_hz = 0.04;
  ASSERT_EQ(excite(options).remarks.size(), 1U);
  EXPECT_EQ(excite(options).remarks[0].severity, Remark::Severity::warning);
  EXPECT_EQ(excite(options).remarks[0].finding.value().code, FindingCode::excitation_shorter_than_cycle);
}

TEST(ExcitationCheck, StrokeOfARigidBodyIsTheClosedForm) {
  // A force F in turns of +, - for h on a mass m alone: it first goes F h^2 / m from standstill to standstill, and so
  // on, always the same way.
  DeviceParameters parameters = test::rigid_parameters();
  parameters.bodies[0] = {"body", 2.0, 0.0, 0.0, 0.0};
  parameters.actuator.force_limit = 3.0;
  ExcitationOptions options;
  options.kind = ExcitationKind::relay;
  options.amplitude = 4.0;
  options.lowest_hz = 5.0;
  options.rate = 2000.0;  // not the device's own
  options.duration = 1.0;
  options.stroke_limit = 0.05;
  const double period_travel = 4.0 * 0.1 * 0.1 / 2.0;
  const ExcitationCheck check = *excite(options, Device(parameters)).check;
  EXPECT_EQ(check.peak_force, 4.0);
  EXPECT_NEAR(check.peak_stroke, 5.0 * period_travel, 1e-6);
  ASSERT_EQ(check.exceeded.size(), 2U);
  EXPECT_EQ(check.exceeded[0].what, "the peak force, 4 N, is beyond the actuator's limit, 3 N");
  EXPECT_EQ(check.exceeded[1].what, "the device moves 0.1 m from its start, beyond the stroke of 0.05 m");
  parameters.actuator.force_limit = 4.0;
  options.stroke_limit = 0.2;
  EXPECT_TRUE(excite(options, Device(parameters)).check->exceeded.empty());
}

TEST(ExcitationCheck, AnUnstableDeviceLeavesEveryStroke) {
  const Device device(test::transfer_function_parameters({1.0}, {1.0, 0.0, -1e6}, 1e-3));
  ExcitationOptions options;
  options.duration = 2.0;
  options.stroke_limit = 1.0;
  const ExcitationCheck check = *excite(options, device).check;
  EXPECT_EQ(check.peak_stroke, std::numeric_limits<double>::infinity());
  EXPECT_EQ(check.exceeded.size(), 1U);
}

TEST(ExcitationCheck, DoubtsOfTheDeviceAreRepeated) {
  DeviceParameters parameters = test::lhifam_parameters();
  EXPECT_TRUE(excite({}, Device(parameters)).check->remarks.empty());
  parameters.uncertainty.emplace().warning = "guessed";
  const Excitation excitation = excite({}, Device(parameters));
  ASSERT_EQ(excitation.check->remarks.size(), 1U);
  const Finding doubt = excitation.check->remarks[0].finding.value();
  EXPECT_EQ(doubt.code, FindingCode::excitation_of_doubtful_device);
  EXPECT_NE(doubt.subjects.at(0).text.find("guessed"), std::string::npos);  // the file's own words
}

TEST(ExcitationCheck, DoubtsAboutEncoderAndFrictionAreSaid) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.sensor.resolution = 1e-3;
  parameters.bodies[0].coulomb = 0.5;
  const ExcitationCheck check = *excite({}, Device(parameters)).check;
  EXPECT_TRUE(check.exceeded.empty());
  ASSERT_EQ(check.remarks.size(), 2U);
  EXPECT_EQ(check.remarks[0].finding.value().code, FindingCode::excitation_moves_few_steps);
  EXPECT_EQ(check.remarks[1].finding.value().code, FindingCode::stroke_without_friction);
}

}  // namespace
}  // namespace zwidth
