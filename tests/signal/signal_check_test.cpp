#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "zwidth/error.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/io/recording_file.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth {
namespace {

using Samples = std::vector<double>;
constexpr double T = 1e-3;

/// The remarks as one text; empty for a clean signal.
std::string check(const Samples& samples, SignalRole role) {
  std::string text;
  for (const Remark& remark : check_signal({"x", samples}, T, role)) {
    text += remark.what + "; " + remark.consequence + "\n";
  }
  return text;
}

Samples excitation(ExcitationKind kind, double fade_in = 0.0) {
  ExcitationOptions options;
  options.kind = kind;
  options.amplitude = 2.0;
  options.lowest_hz = kind == ExcitationKind::relay ? 3.0 : 5.0;
  options.fade_in = fade_in;
  return excite(options).samples;
}

Samples noise(std::size_t size, unsigned seed = 1) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Samples samples(size);
  for (double& value : samples) value = normal(generator);
  return samples;
}

Samples sine(double hz, std::size_t size, double amplitude) {
  Samples samples(size);
  for (std::size_t i = 0; i < size; ++i) {
    samples[i] = amplitude * std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(i) * T + 0.3);
  }
  return samples;
}

Samples rounded(Samples samples, double step) {
  for (double& value : samples) value = step * std::round(value / step);
  return samples;
}

Samples limited(Samples samples, double least, double most) {
  for (double& value : samples) value = std::clamp(value, least, most);
  return samples;
}

/// A mass with friction that the force pushes.
Samples motion_under(const Samples& force) {
  Samples position{0.0};
  double velocity = 0.0;
  for (const double f : force) {
    velocity += T * (f - 5.0 * velocity - 400.0 * position.back());
    position.push_back(position.back() + T * velocity);
  }
  return position;
}

TEST(CheckSignal, RaisesNoAlarmForCommandedForces) {
  for (const ExcitationKind kind : {ExcitationKind::linear_chirp, ExcitationKind::logarithmic_chirp,
                                    ExcitationKind::multisine, ExcitationKind::noise, ExcitationKind::relay}) {
    EXPECT_EQ(check(excitation(kind), SignalRole::force), "") << static_cast<int>(kind);
    EXPECT_EQ(check(excitation(kind, 1.0), SignalRole::force), "") << static_cast<int>(kind) << " with fade-in";
    EXPECT_EQ(check(rounded(excitation(kind), 4.0 / 4096.0), SignalRole::force), "")
        << static_cast<int>(kind) << " through 12 bits";
  }
}

TEST(CheckSignal, RaisesNoAlarmForMotionOfHundredsOfEncoderSteps) {
  for (const ExcitationKind kind : {ExcitationKind::linear_chirp, ExcitationKind::logarithmic_chirp,
                                    ExcitationKind::multisine, ExcitationKind::noise, ExcitationKind::relay}) {
    const Samples position = motion_under(excitation(kind));
    const auto [least, most] = std::minmax_element(position.begin(), position.end());
    for (const double steps : {150.0, 400.0, 1000.0, 10000.0}) {
      EXPECT_EQ(check(rounded(position, (*most - *least) / steps), SignalRole::position), "")
          << static_cast<int>(kind) << ", " << steps << " steps";
    }
    EXPECT_EQ(check(position, SignalRole::position), "") << static_cast<int>(kind);
  }
}

TEST(CheckSignal, RaisesNoAlarmForStationarySinesOfAnyFrequency) {
  for (double hz = 0.3; hz < 500.0; hz *= 1.07) {
    for (const double steps : {60.0, 200.0, 901.5}) {
      EXPECT_EQ(check(rounded(sine(hz, 8000, steps), 1.0), SignalRole::position), "") << hz << " Hz, " << steps;
    }
    EXPECT_EQ(check(sine(hz, 8000, 1.0), SignalRole::position), "") << hz << " Hz";
  }
}

TEST(CheckSignal, RaisesNoAlarmForRestBeforeAndBetweenMotions) {
  Samples position(3000, 0.25);  // moves there and back smoothly, and dwells at the ends
  for (std::size_t i = 0; i < 8000; ++i) {
    const double phase = std::fmod(static_cast<double>(i) * T, 2.0);
    const double along = std::min(1.0, std::min(phase, 2.0 - phase) / 0.5);
    position.push_back(0.25 + along * along * along * (10.0 + along * (6.0 * along - 15.0)));
  }
  EXPECT_EQ(check(position, SignalRole::position), "");
  EXPECT_EQ(check(rounded(position, 1e-3), SignalRole::position), "");
}

TEST(CheckSignal, SaysWhatAConstantSignalMeans) {
  EXPECT_EQ(check(Samples(1000, 0.5), SignalRole::force),
            "x is constant at 0.5; nothing excites the device: there is no response to find\n");
  EXPECT_EQ(check(Samples(1000, 0.0), SignalRole::position),
            "x is constant at 0; the device did not move or its sensor was not read: there is no response\n");
}

TEST(CheckSignal, SaysThatARecordIsTooShort) {
  EXPECT_EQ(check(noise(100), SignalRole::force),
            "x has only 100 samples, 0.1 s; the response has few lines, 10 Hz apart or more, and little is averaged: "
            "narrow resonances are missed and intervals are wide\n");
  EXPECT_EQ(check({}, SignalRole::force), "x has only 0 samples, 0 s; there is nothing to identify\n");
}

TEST(CheckSignal, FindsClipping) {
  const std::vector<Samples> signals{limited(sine(7.0, 8000, 1.0), -1.0, 0.9),
                                     limited(rounded(sine(7.0, 8000, 300.0), 1.0), -400.0, 270.0),
                                     limited(excitation(ExcitationKind::linear_chirp), -3.0, 1.8),
                                     limited(excitation(ExcitationKind::multisine), -3.0, 1.2),
                                     limited(motion_under(excitation(ExcitationKind::noise)), -1.0, 1.2e-4)};
  for (const Samples& samples : signals) {
    for (const double sign : {1.0, -1.0}) {
      Samples signal = samples;
      for (double& value : signal) value *= sign;
      const auto remarks = check_signal({"x", signal}, T, SignalRole::position);
      ASSERT_EQ(remarks.size(), 1U) << &samples - signals.data();
      EXPECT_EQ(remarks[0].severity, Remark::Severity::warning);
      EXPECT_NE(remarks[0].what.find("is clipped at"), std::string::npos) << remarks[0].what;
      EXPECT_NE(remarks[0].consequence.find("the motion beyond is lost"), std::string::npos);
    }
  }
  const Samples both = limited(sine(7.0, 8000, 1.0), -0.8, 0.8);
  EXPECT_EQ(check_signal({"x", both}, T, SignalRole::force).size(), 2U);
}

TEST(CheckSignal, FindsAHeavilyClippedSine) {
  const auto remarks = check_signal({"x", limited(sine(3.0, 8000, 1.0), -0.1, 0.1)}, T, SignalRole::position);
  ASSERT_EQ(remarks.size(), 2U);
  EXPECT_EQ(remarks[0].what.substr(0, 20), "x is clipped at 0.1:");
  for (const std::size_t i : {0U, 1U}) {
    ASSERT_TRUE(remarks[i].finding);
    EXPECT_EQ(remarks[i].finding->code, FindingCode::signal_clipped);
    EXPECT_EQ(remarks[i].finding->evidence[0], (Evidence{"level", i == 0 ? 0.1 : -0.1}));
  }
}

TEST(CheckSignal, FindsCoarseQuantisation) {
  EXPECT_EQ(check(rounded(sine(3.0, 8000, 10.0), 1.0), SignalRole::position),
            "x is coarsely quantised: it takes 21 different values; rounding errs by up to 2.5 % of its whole range: "
            "what moves less than that, mostly at high frequency, is not seen; excite more strongly or use a finer "
            "sensor\n");
  EXPECT_NE(check(rounded(sine(3.0, 8000, 1.0), 1.0), SignalRole::position), "");
  EXPECT_NE(check(rounded(sine(3.0, 8000, 10.0), 1.0), SignalRole::force), "");
}

TEST(CheckSignal, FindsADropout) {
  for (const bool to_zero : {false, true}) {
    for (Samples samples : {noise(8000), motion_under(excitation(ExcitationKind::multisine)),
                            rounded(motion_under(excitation(ExcitationKind::linear_chirp)), 2e-6)}) {
      const double held = to_zero ? 0.0 : samples[3300];
      std::fill(samples.begin() + 3301, samples.begin() + 3401, held);
      const std::string text = check(samples, SignalRole::position);
      const std::size_t stays = text.find("x stays at ");
      ASSERT_NE(stays, std::string::npos) << text;
      EXPECT_NE(text.find(to_zero ? " from 3.301 s to 3.4 s (100 samples)" : " from 3.3 s to 3.4 s (101 samples)"),
                std::string::npos)
          << text;
      EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    }
  }
}

TEST(CheckSignal, FindsASensorThatStops) {
  Samples position = motion_under(excitation(ExcitationKind::multisine));
  std::fill(position.begin() + 15000, position.end(), 0.0);
  EXPECT_NE(check(position, SignalRole::position).find("x stays at 0 from 15 s to 20 s"), std::string::npos);
}

TEST(CheckSignal, NotesAForceThatRestsBetweenBursts) {
  Samples force(1000, 0.0);
  for (int burst = 0; burst < 3; ++burst) {
    const Samples shaken = noise(1000, static_cast<unsigned>(burst) + 1);
    force.insert(force.end(), shaken.begin(), shaken.end());
    force.insert(force.end(), 1000, 0.0);
  }
  const auto remarks = check_signal({"F", force}, T, SignalRole::force);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].severity, Remark::Severity::note);
  EXPECT_EQ(remarks[0].what, "F stays at 0 from 2 s to 2.999 s (1000 samples), the longest of 2 such stretches");
  ASSERT_TRUE(remarks[0].finding);
  EXPECT_EQ(remarks[0].finding->code, FindingCode::signal_idle);
  EXPECT_EQ(remarks[0].finding->severity, Finding::Severity::note);
}

TEST(CheckSignal, TellsScaleFromDefects) {
  for (const double scale : {1e-250, 1e-12, 1e12, 1e250}) {
    Samples samples = noise(4000);
    for (double& value : samples) value *= scale;
    EXPECT_EQ(check(samples, SignalRole::position), "") << scale;
  }
}

TEST(CheckSignal, RefusesBugsOfTheCaller) {
  EXPECT_THROW((void)check_signal({"x", {1.0, 2.0}}, 0.0, SignalRole::force), Error);
  EXPECT_THROW((void)check_signal({"x", {1.0, std::nan("")}}, T, SignalRole::force), Error);
}

// Real records, which nobody has found a defect in.
TEST(CheckSignal, RaisesNoAlarmForTheMotorBenchAndThePositioningSystem) {
  struct Record {
    const char* file;
    std::vector<std::string> forces, motions;
    double rate;
  };
  const std::vector<Record> records{
      {"two_mass_bench/MultisineTypeA.mat", {"iq_refx", "iq_adx"}, {"theta_mx", "theta_my", "omega_max"}, 2500.0},
      {"emps/DATA_EMPS.mat", {"vir"}, {"qm", "qg"}, 1000.0}};
  const std::filesystem::path folder = std::filesystem::path(ZWIDTH_SHARED_DIR) / "data";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder << ": the recordings are not here";
  for (const Record& record : records) {
    RecordingOptions options;
    options.rate = record.rate;
    for (const auto& name : record.forces) options.columns.push_back({name, 1.0});
    for (const auto& name : record.motions) options.columns.push_back({name, 1.0});
    const auto recording = read_recording((folder / record.file).string(), options);
    ASSERT_TRUE(recording.has_value()) << recording.error().str();
    for (std::size_t i = 0; i < recording->channels.size(); ++i) {
      const SignalRole role = i < record.forces.size() ? SignalRole::force : SignalRole::position;
      for (const Remark& remark : check_signal(recording->channels[i], recording->sampling_period, role)) {
        ADD_FAILURE() << record.file << ": " << remark.what;
      }
    }
  }
}

}  // namespace
}  // namespace zwidth
