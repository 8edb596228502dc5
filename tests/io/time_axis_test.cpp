#include "io/time_axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "io/recording_folder.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

RawColumn times_of(std::vector<double> values) { return {"a.mat", "t", std::move(values), {}}; }

std::vector<double> uniform(std::size_t size, double period, double start = 0.0) {
  std::vector<double> times(size);
  for (std::size_t i = 0; i < size; ++i) times[i] = start + period * static_cast<double>(i);
  return times;
}

std::string refusal(std::vector<double> values, const RecordingOptions& options = {}) {
  const auto axis = time_axis(times_of(std::move(values)), options);
  return axis ? "taken" : axis.error().str();
}

TEST(TimeAxis, FindsThePeriodOfUniformTimes) {
  for (const double period : {1e-5, 1e-3, 1.0 / 2048.0, 0.05}) {
    for (const double start : {0.0, -3.0, 12345.678}) {
      const auto axis = time_axis(times_of(uniform(5000, period, start)), {});
      ASSERT_TRUE(axis.has_value()) << axis.error().str();
      EXPECT_NEAR(axis->sampling_period, period, 1e-12 * (period + std::abs(start) / 5000.0));
      EXPECT_EQ(warnings_in(axis->remarks), 0U);
      EXPECT_TRUE(mentions(axis->remarks, "the mean of the times in column \"t\""));
    }
  }
}

TEST(TimeAxis, NeedsTwoTimes) {
  EXPECT_EQ(refusal({}), "a.mat: t: has 0 samples; a time axis needs two at least");
  EXPECT_EQ(refusal({1.0}), "a.mat: t: has 1 sample; a time axis needs two at least");
  EXPECT_EQ(refusal({1.0, 1.5}), "taken");
}

TEST(TimeAxis, RefusesTimesThatFallBack) {
  auto times = uniform(100, 1e-3);
  times[40] = 0.005;
  EXPECT_EQ(refusal(times),
            "a.mat: t: sample 41: the time falls from 0.039 to 0.005; times must rise, or state the "
            "rate instead (`rate`)");
}

TEST(TimeAxis, RefusesTimesThatStandStill) {
  EXPECT_EQ(refusal({0.0, 0.001, 0.001, 0.001, 0.002}),
            "a.mat: t: sample 3: the time stands still at 0.001, 2 times in the record; times must rise: where they "
            "have too few digits or are repeated, state the rate instead (`rate`)");
}

TEST(TimeAxis, RecognisesATimerThatWraps) {
  for (const unsigned bits : {8U, 16U, 32U}) {
    std::vector<double> counts;
    const double turn = std::ldexp(1.0, static_cast<int>(bits));
    const double step = bits == 8 ? 10.0 : 1012.0;
    for (int i = 0; i < 300; ++i) counts.push_back(std::fmod(turn - 100.0 + step * i, turn));
    EXPECT_NE(refusal(counts).find("`timer_bits` " + std::to_string(bits)), std::string::npos) << refusal(counts);
    RecordingOptions options;
    options.time_scale = 1e-6;
    options.timer_bits = bits;
    const auto axis = time_axis(times_of(counts), options);
    ASSERT_TRUE(axis.has_value()) << axis.error().str();
    EXPECT_NEAR(axis->sampling_period, step * 1e-6, 1e-12 * turn * 1e-6);
    EXPECT_EQ(warnings_in(axis->remarks), 0U);
  }
}

TEST(TimeAxis, RefusesWhatATimerCannotShow) {
  RecordingOptions options;
  options.timer_bits = 16;
  const std::string allowed = "; a timer of 16 bits shows whole numbers from 0 to 65535";
  EXPECT_EQ(refusal({0.0, 65536.0}, options), "a.mat: t: sample 2: is 65536" + allowed);
  EXPECT_EQ(refusal({-1.0, 0.0}, options), "a.mat: t: sample 1: is -1" + allowed);
  EXPECT_EQ(refusal({0.0, 1.5}, options), "a.mat: t: sample 2: is 1.5" + allowed);
  EXPECT_EQ(refusal({7.0, 7.0}, options).substr(0, 43), "a.mat: t: sample 2: the time stands still a");
  options.timer_bits = 60;
  EXPECT_EQ(refusal({0.0, 1.0}, options), "a.mat: timer bits: are 60; must be 1 to 52");
}

TEST(TimeAxis, TakesThePeriodBetweenGaps) {
  auto times = uniform(1000, 1e-3);
  for (std::size_t i = 600; i < times.size(); ++i) times[i] += 0.25;
  for (std::size_t i = 800; i < times.size(); ++i) times[i] += 0.001;
  const auto axis = time_axis(times_of(times), {});
  ASSERT_TRUE(axis.has_value());
  EXPECT_NEAR(axis->sampling_period, 1e-3, 1e-12);
  EXPECT_EQ(axis->grid.lost(), 251U);
  EXPECT_EQ(axis->grid.slots[600], 850U);
  EXPECT_EQ(axis->grid.slots[800], 1051U);
}

TEST(TimeAxis, CallsALateSampleJitterAndNoGap) {
  auto times = uniform(1000, 1e-3);
  times[500] += 0.7e-3;
  const auto axis = time_axis(times_of(times), {});
  ASSERT_TRUE(axis.has_value());
  EXPECT_NEAR(axis->sampling_period, 1e-3, 1e-12);
  EXPECT_EQ(axis->grid.lost(), 0U);
}

TEST(TimeAxis, FindsTheMeanOfJitteringTimes) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> jitter(-0.2e-3, 0.2e-3);
    auto times = uniform(20000, 1e-3);
    for (double& time : times) time += jitter(generator);
    const auto axis = time_axis(times_of(times), {});
    ASSERT_TRUE(axis.has_value());
    EXPECT_NEAR(axis->sampling_period, 1e-3, 1e-9) << "seed " << seed;  // 5 deviations of a straight line's slope
    EXPECT_EQ(axis->grid.lost(), 0U) << "seed " << seed;
  }
}

TEST(TimeAxis, FillsAFewMissingTimesAndRefusesMany) {
  auto times = uniform(1000, 1e-3);
  times[0] = times[500] = times[501] = nan_value;
  EXPECT_EQ(refusal(times).substr(0, 44),
            "a.mat: t: sample 2: the time stands still at");  // nothing precedes the first
  times[0] = 0.0;
  const auto axis = time_axis(times_of(times), {});
  ASSERT_TRUE(axis.has_value());
  EXPECT_NEAR(axis->sampling_period, 1e-3, 1e-12);
  EXPECT_TRUE(mentions(axis->remarks, "t: 2 of 1000 samples are missing"));
  EXPECT_EQ(refusal({0.0, nan_value, 2.0}),
            "a.mat: t: sample 2: is NaN, infinite or empty, the first of 1 such samples among 3; at most 1 % may be "
            "missing");
}

TEST(TimeAxis, WarnsOfAnUnlikelyUnit) {
  EXPECT_TRUE(mentions(time_axis(times_of(uniform(100, 1.0)), {})->remarks, "a sampling period of 1 s is unusual"));
  EXPECT_FALSE(mentions(time_axis(times_of(uniform(100, 0.01)), {})->remarks, "unusual"));
}

TEST(TimeAxis, RefusesTimesOutsideAllReason) {
  EXPECT_EQ(refusal({-1.7e308, 1.7e308}),
            "a.mat: t: the times are too large or too small for a sampling period; must be times in s");
  EXPECT_EQ(refusal({0.0, 5e-324, 1e-323}),
            "a.mat: t: the times are too large or too small for a sampling period; must be times in s");
}

TEST(TimeAxis, KnowsNamesOfTimesAndTheirUnits) {
  struct Name {
    const char* name;
    bool is_time;
    double scale;
  };
  for (const auto& [name, is_time, scale] :
       {Name{"t", true, 1.0}, Name{"Time", true, 1.0}, Name{"time [s]", true, 1.0}, Name{"TIME (ms)", true, 1e-3},
        Name{"t_us", true, 1e-6}, Name{"time_ms", true, 1e-3}, Name{"Zeit [\u00b5s]", true, 1e-6},
        Name{"timestamp", true, 1.0}, Name{"seconds", true, 1.0}, Name{"millis", true, 1e-3}, Name{"s", false, 1.0},
        Name{"min", false, 60.0}, Name{"torque", false, 1.0}, Name{"theta [rad]", false, 1.0}, Name{"", false, 1.0},
        Name{"time of flight", false, 1.0}}) {
    EXPECT_EQ(names_a_time(name), is_time) << name;
    EXPECT_EQ(time_scale_of(name, {}), scale) << name;
  }
  RecordingOptions options;
  options.time_scale = 0.5;
  EXPECT_EQ(time_scale_of("t [ms]", options), 0.5);
}

TEST(TimeAxis, RefusesBugsOfTheCaller) {
  RecordingOptions options;
  options.time_scale = 0.0;
  EXPECT_THROW((void)time_axis(times_of({0.0, 1.0}), options), Error);
  EXPECT_THROW((void)period_of_rate(0.0), Error);
  EXPECT_THROW((void)period_of_rate(nan_value), Error);
  EXPECT_EQ(period_of_rate(2500.0), 1.0 / 2500.0);
}

}  // namespace
}  // namespace zwidth
