// What a recorder did to the rows: lost, repeated, sampled or stamped off their time, at another rate than stated.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "io/recording_folder.hpp"
#include "signal/restored_rows.hpp"
#include "zwidth/io/recorded_columns.hpp"

namespace zwidth {
namespace {

using internal::averaged_hold;
using internal::restored_rows;
using internal::RestoredRows;
using internal::row_grid;

constexpr double period = 1e-3;
constexpr std::size_t rows = 10000;

/// 1 to 100 Hz in 10 s.
double chirp(double time) { return 5.0 * std::sin(2.0 * std::numbers::pi * (time + 4.95 * time * time)); }

struct Rows {
  std::vector<double> times;
  std::vector<double> force;
  std::vector<double> position;

  /// Of a mass that moves under the force, nearly so: a chirp of falling size, by an encoder of 1 um.
  void add(double stamp, double sampled, double acting) {
    times.push_back(stamp);
    force.push_back(acting);
    const double size = 2e-3 / (1.0 + sampled * sampled);
    position.push_back(1e-6 * std::round(size * chirp(sampled) / 1e-6));
  }
  [[nodiscard]] RecordedColumns columns() const {
    return {"bench", {{"t", times}, {"force", force}, {"position", position}}, {}};
  }
  [[nodiscard]] std::vector<std::span<const double>> signals() const { return {force, position}; }
};

Rows whole() {
  Rows made;
  for (std::size_t k = 0; k < rows; ++k)
    made.add(period * static_cast<double>(k), period * static_cast<double>(k), chirp(period * static_cast<double>(k)));
  return made;
}

template <typename Lost>
Rows without(const Rows& all, const Lost& is_lost) {
  Rows kept;
  for (std::size_t k = 0; k < all.times.size(); ++k) {
    if (is_lost(k)) continue;
    kept.times.push_back(all.times[k]);
    kept.force.push_back(all.force[k]);
    kept.position.push_back(all.position[k]);
  }
  return kept;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

Recording read(const Rows& made, std::optional<double> rate = {}) {
  RecordingOptions options = columns_named({"force", "position"});
  options.rate = rate;
  const auto recording = read_recording(made.columns(), options);
  EXPECT_TRUE(recording) << recording.error().str();
  return recording.value_or(Recording{});
}

void expect_like(const Recording& recording, const Rows& all) {
  EXPECT_NEAR(recording.sampling_period, period, 1e-12);
  ASSERT_EQ(recording.channels[0].samples.size(), all.force.size());
  EXPECT_LT(largest_difference(recording.channels[0].samples, all.force), 1e-3 * 5.0);
  EXPECT_LT(largest_difference(recording.channels[1].samples, all.position), 5e-6);
  EXPECT_TRUE(recording.doubts.empty());
}

// Were joined: the link came out 9 times too stiff, sound.
TEST(LostRows, EveryTenthIsFilledIn) {
  const Rows all = whole();
  const Recording recording = read(without(all, [](std::size_t k) { return k % 10 == 5; }));
  expect_like(recording, all);
  EXPECT_TRUE(
      mentions(recording.remarks, "1000 of 10000 rows are lost (10 %) in 1000 gaps, the first before sample 6"));
  EXPECT_EQ(warnings_in(recording.remarks), 1U);
  const auto lost = std::ranges::find_if(recording.remarks, [](const Remark& each) {
    return each.finding && each.finding->code == FindingCode::rows_lost;
  });
  ASSERT_NE(lost, recording.remarks.end());
  const std::vector<Evidence>& evidence = lost->finding->evidence;
  EXPECT_THAT(evidence,
              testing::IsSupersetOf({Evidence{"lost", 1000.0}, Evidence{"rows", 10000.0}, Evidence{"gaps", 1000.0},
                                     Evidence{"longest", 1.0}, Evidence{"filled", 1000.0}}));
}

TEST(LostRows, TwoInAHundredAtRandomAreFilledIn) {
  const Rows all = whole();
  std::mt19937_64 random(7);
  std::vector<bool> lost(rows);
  for (std::size_t k = 1; k + 1 < rows; ++k) lost[k] = random() % 50 == 0;
  const Recording recording = read(without(all, [&](std::size_t k) { return lost[k]; }));
  expect_like(recording, all);
  EXPECT_TRUE(mentions(recording.remarks, "rows are lost (2"));
}

TEST(LostRows, ARateThatIsStatedDoesNotJoinThem) {
  const Rows all = whole();
  const Recording recording = read(without(all, [](std::size_t k) { return k % 10 == 5; }), 1000.0);
  expect_like(recording, all);
  EXPECT_TRUE(mentions(recording.remarks, "1000 of 10000 rows are lost"));
}

// Steps of noise: nothing tells what a row that was lost held.
TEST(LostRows, OfARoughForceTheLongestWholeStretchIsUsed) {
  Rows all = whole();
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (double& each : all.force) each = normal(random);
  const Recording recording =
      read(without(all, [](std::size_t k) { return k % 4000 == 2999 || (k % 100 == 99 && k < 2000); }));
  ASSERT_EQ(recording.channels[0].samples.size(), 3999U);
  EXPECT_EQ(largest_difference(recording.channels[0].samples, {all.force.begin() + 3000, all.force.begin() + 6999}),
            0.0);
  EXPECT_TRUE(mentions(recording.remarks, "used is the longest stretch without such a gap alone, 3.998 s from sample"));
  RecordingOptions options = columns_named({"force", "position"});
  const auto refused = read_recording(without(all, [](std::size_t k) { return k % 10 == 9; }).columns(), options);
  ASSERT_FALSE(refused);
  ASSERT_EQ(refused.error().problem->code, ProblemCode::too_many_rows_lost);
  EXPECT_EQ(refused.error().problem->evidence.at(0).value, 999.0);   // lost
  EXPECT_EQ(refused.error().problem->evidence.at(1).value, 9999.0);  // rows
}

TEST(LostRows, ALongPauseIsNotBridged) {
  const Rows all = whole();
  const Recording recording = read(without(all, [](std::size_t k) { return k >= 3000 && k < 3100; }));
  ASSERT_EQ(recording.channels[0].samples.size(), 6900U);
  EXPECT_EQ(recording.channels[0].samples.front(), all.force[3100]);
}

TEST(RepeatedRows, AreLeftOutAndCounted) {
  const Rows all = whole();
  Rows twice;
  for (std::size_t k = 0; k < rows; ++k) {
    for (int i = 0; i < (k % 100 == 50 ? 2 : 1); ++i) {
      twice.times.push_back(all.times[k]);
      twice.force.push_back(all.force[k]);
      twice.position.push_back(all.position[k]);
    }
  }
  const Recording recording = read(twice);
  EXPECT_EQ(recording.channels[0].samples, all.force);
  EXPECT_EQ(recording.channels[1].samples, all.position);
  EXPECT_TRUE(mentions(recording.remarks, "100 of 10100 rows are repeated (0.99 %), the first at sample 52"));
  Rows other = twice;
  other.force[51] += 1.0;  // the same time, another force: times of too few digits
  EXPECT_FALSE(read_recording(other.columns(), columns_named({"force", "position"})));
}

/// Stamps or rows up to 30 % of a period off.
std::vector<double> off_their_time(unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> off(-0.3 * period, 0.3 * period);
  std::vector<double> times;
  for (std::size_t k = 0; k < rows; ++k) times.push_back(period * static_cast<double>(k) + off(random));
  return times;
}

TEST(Jitter, OfStampsAloneChangesNothing) {
  Rows made = whole();
  made.times = off_their_time(5);
  const Recording recording = read(made);
  EXPECT_EQ(recording.channels[1].samples, made.position);
  EXPECT_TRUE(mentions(recording.remarks, "the stamps alone are off"));
  EXPECT_TRUE(mentions(recording.remarks, "the times are up to 30 % of a period off equal steps (rms 17 %)"));
  EXPECT_EQ(warnings_in(recording.remarks), 0U);
  EXPECT_TRUE(recording.doubts.empty());
}

TEST(Jitter, OfRowsIsTakenOutOfTheMotion) {
  const Rows all = whole();
  const std::vector<double> times = off_their_time(6);
  Rows made;
  for (std::size_t k = 0; k < rows; ++k) made.add(times[k], times[k], all.force[k]);
  EXPECT_GT(largest_difference(made.position, all.position), 4e-5);
  const Recording recording = read(made);
  EXPECT_NEAR(recording.sampling_period, period, 1e-9);
  ASSERT_EQ(recording.channels[1].samples.size(), rows);
  EXPECT_LT(largest_difference(recording.channels[1].samples, all.position), 5e-6);
  EXPECT_TRUE(mentions(recording.remarks, "the rows were sampled so"));
  EXPECT_TRUE(recording.doubts.empty());
}

TEST(Jitter, BesideLostRowsLeavesTheGridKnown) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const std::vector<double> times = off_their_time(seed);
    std::mt19937_64 random(seed);
    std::vector<double> kept;
    std::vector<std::size_t> slots;
    for (std::size_t k = 0; k < rows; ++k) {
      if (k > 0 && random() % 5 == 0) continue;
      kept.push_back(times[k]);
      slots.push_back(k);
    }
    const auto grid = row_grid(kept);
    EXPECT_EQ(grid.slots, slots) << "seed " << seed;
    EXPECT_NEAR(grid.period, period, 1e-8) << "seed " << seed;
  }
}

TEST(Jitter, OfAHundredthIsNone) {
  Rows made = whole();
  for (std::size_t k = 0; k < rows; k += 2) made.times[k] += 1e-5;
  EXPECT_EQ(restored_rows(made.times, row_grid(made.times), made.signals()).jitter, RestoredRows::Jitter::none);
  for (std::size_t k = 0; k < rows; k += 2) made.times[k] += 2e-5;
  EXPECT_EQ(restored_rows(made.times, row_grid(made.times), made.signals()).jitter, RestoredRows::Jitter::of_stamps);
}

// A motion as coarse as the encoder does not tell which it was.
TEST(Jitter, ThatDoesNotShowInTheMotionIsADoubtWhereItMatters) {
  Rows made = whole();
  for (double& each : made.position) each = std::round(200.0 * each);
  made.times = off_their_time(8);
  const Recording recording = read(made);
  EXPECT_TRUE(mentions(recording.remarks, "does not show in the motion"));
  ASSERT_EQ(recording.doubts.size(), 1U);
  EXPECT_EQ(recording.doubts[0].code, FindingCode::jitter_undecided);
}

TEST(StatedRate, ThatTheTimesContradictIsADoubt) {
  const Rows all = whole();
  EXPECT_TRUE(read(all, 1000.0).doubts.empty());
  EXPECT_TRUE(read(all, 1000.5).doubts.empty());
  const Recording recording = read(all, 1005.0);  // half a percent was let pass
  ASSERT_EQ(recording.doubts.size(), 1U);
  EXPECT_EQ(recording.doubts[0].code, FindingCode::rate_contradicts_times);
  EXPECT_EQ(recording.doubts[0].evidence[0], (Evidence{"given", 1005.0}));
  EXPECT_EQ(recording.sampling_period, 1.0 / 1005.0);
  EXPECT_EQ(read(without(all, [](std::size_t k) { return k % 10 == 5; }), 900.0).doubts.size(), 1U);
}

TEST(OwnTimes, ThatAreTheSameAreThoseOfTheRecording) {
  const Rows all = whole();
  const Rows kept = without(all, [](std::size_t k) { return k % 10 == 5; });
  RecordedColumns columns{
      "scope", {{"a", kept.times}, {"force", kept.force, 0}, {"b", kept.times}, {"position", kept.position, 2}}, {}};
  const auto recording = read_recording(columns, columns_named({"force", "position"}));
  ASSERT_TRUE(recording) << recording.error().str();
  expect_like(*recording, all);
}

TEST(AveragedHold, KeepsTheIntegralAndItsMoment) {
  const std::vector<double> times{0.0, 0.7, 2.2, 3.0};
  const std::vector<double> held{1.0, 2.0, 3.0, 4.0};
  const std::vector<double> found = averaged_hold(times, held, 0.0, 1.0, 4);
  double integral = 0.0;
  double moment = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    integral += found[k];
    moment += found[k] * (static_cast<double>(k) + 0.5);
  }
  EXPECT_NEAR(integral, 0.7 * 1.0 + 1.5 * 2.0 + 0.8 * 3.0 + 4.0, 1e-14);
  // All but what the first step, which has no neighbour before it, has of its own.
  const double first = 0.7 * 1.0 * -0.15 + 0.3 * 2.0 * 0.35;
  EXPECT_NEAR(moment, 0.7 * 1.0 * 0.35 + 1.5 * 2.0 * 1.45 + 0.8 * 3.0 * 2.6 + 4.0 * 3.5 - first, 1e-14);
  const std::vector<double> even{0.0, 1.0, 2.0, 3.0};
  EXPECT_EQ(averaged_hold(even, held, 0.0, 1.0, 4), held);
}

}  // namespace
}  // namespace zwidth
