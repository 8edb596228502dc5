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
  return axis ? "taken" : data_of(axis.error());
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
  EXPECT_EQ(refusal({}), "t: too_few_samples samples=0");
  EXPECT_EQ(refusal({1.0}), "t: too_few_samples samples=1");
  EXPECT_EQ(refusal({1.0, 1.5}), "taken");
}

TEST(TimeAxis, RefusesTimesThatFallBack) {
  auto times = uniform(100, 1e-3);
  times[40] = 0.005;
  EXPECT_EQ(refusal(times), "t: times_not_rising time=0.039 after=0.005 sample=41");
}

TEST(TimeAxis, RefusesTimesThatStandStill) {
  EXPECT_EQ(refusal({0.0, 0.001, 0.001, 0.001, 0.002}), "t: times_not_rising time=0.001 times=2 sample=3");
}

TEST(TimeAxis, RecognisesATimerThatWraps) {
  for (const unsigned bits : {8U, 16U, 32U}) {
    std::vector<double> counts;
    const double turn = std::ldexp(1.0, static_cast<int>(bits));
    const double step = bits == 8 ? 10.0 : 1012.0;
    for (int i = 0; i < 300; ++i) counts.push_back(std::fmod(turn - 100.0 + step * i, turn));
    EXPECT_NE(refusal(counts).find(" bits=" + std::to_string(bits)), std::string::npos) << refusal(counts);
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
  EXPECT_EQ(refusal({0.0, 65536.0}, options), "t: no_timer_count value=65536 bits=16 most=65535 sample=2");
  EXPECT_EQ(refusal({-1.0, 0.0}, options), "t: no_timer_count value=-1 bits=16 most=65535 sample=1");
  EXPECT_EQ(refusal({0.0, 1.5}, options), "t: no_timer_count value=1.5 bits=16 most=65535 sample=2");
  EXPECT_EQ(refusal({7.0, 7.0}, options), "t: times_not_rising time=7 times=1 sample=2");
  options.timer_bits = 60;
  EXPECT_EQ(refusal({0.0, 1.0}, options), "timer bits: count_out_of_range value=60 least=1 most=52 several=60");
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
  EXPECT_EQ(refusal(times), "t: times_not_rising time=0.001 times=1 sample=2");  // nothing precedes the first
  times[0] = 0.0;
  const auto axis = time_axis(times_of(times), {});
  ASSERT_TRUE(axis.has_value());
  EXPECT_NEAR(axis->sampling_period, 1e-3, 1e-12);
  EXPECT_TRUE(mentions(axis->remarks, "t: 2 of 1000 samples are missing"));
  EXPECT_EQ(refusal({0.0, nan_value, 2.0}), "t: too_many_samples_missing missing=1 samples=3 sample=2");
}

TEST(TimeAxis, WarnsOfAnUnlikelyUnit) {
  EXPECT_TRUE(mentions(time_axis(times_of(uniform(100, 1.0)), {})->remarks, "a sampling period of 1 s is unusual"));
  EXPECT_FALSE(mentions(time_axis(times_of(uniform(100, 0.01)), {})->remarks, "unusual"));
}

TEST(TimeAxis, RefusesTimesOutsideAllReason) {
  EXPECT_EQ(refusal({-1.7e308, 1.7e308}), "t: no_period_in_times");
  EXPECT_EQ(refusal({0.0, 5e-324, 1e-323}), "t: no_period_in_times");
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
