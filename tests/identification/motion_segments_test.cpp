// Which rows of long records a motion is fitted to.
#include "identification/motion_segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace zwidth::internal {
namespace {

/// Records of so many samples at 2 kHz.
class MotionSegments : public ::testing::Test {
 protected:
  std::vector<ForceMotionRecord> records_of(const std::vector<std::size_t>& samples) {
    rows_.assign(std::ranges::max(samples), 0.0);
    std::vector<ForceMotionRecord> records;
    for (const std::size_t each : samples) {
      const std::span<const double> rows = std::span<const double>(rows_).first(each);
      records.push_back({rows, rows, 5e-4});
    }
    return records;
  }
  static std::size_t count_of(const std::vector<Segment>& segments, std::size_t record) {
    std::size_t samples = 0;
    for (const Segment& each : segments) samples += each.record == record ? each.count : 0;
    return samples;
  }

 private:
  std::vector<double> rows_;
};

// 12 s each, in segments of 10 s: of the second record nothing was fitted.
TEST_F(MotionSegments, OfEveryRecordSomeAreFitted) {
  const std::vector<ForceMotionRecord> records = records_of({24000, 24000, 24000});
  const std::size_t every = thinning(records, 30000);
  EXPECT_EQ(every, 3U);
  const std::vector<Segment> some = thinned(segments_of(records, 10.0, every), every, {});
  for (std::size_t record = 0; record < records.size(); ++record)
    EXPECT_NEAR(static_cast<double>(count_of(some, record)), 8000.0, 20.0) << record;
  EXPECT_NEAR(fitted_share(some, records), 1.0 / 3.0, 1e-3);
}

TEST_F(MotionSegments, ShortRecordsAreFittedWhole) {
  const std::vector<ForceMotionRecord> records = records_of({24000, 300});
  const std::size_t every = thinning(records, 30000);
  EXPECT_EQ(every, 1U);
  const std::vector<Segment> all = thinned(segments_of(records, 10.0, every), every, {});
  EXPECT_EQ(count_of(all, 0), 23980U);
  EXPECT_EQ(count_of(all, 1), 280U);
  EXPECT_GT(fitted_share(all, records), 0.99);
}

TEST_F(MotionSegments, NoneIsShorterThanItsLeast) {
  const std::vector<ForceMotionRecord> records = records_of({600, 90000});
  for (const Segment& each : segments_of(records, 10.0, 4)) EXPECT_GE(each.count, 256U);
}

// Those that another choice begins with stay, so that its states can be carried over.
TEST_F(MotionSegments, WhereOthersBeginAreKept) {
  const std::vector<ForceMotionRecord> records = records_of({24000});
  const std::vector<Segment> all = segments_of(records, 0.5);
  const std::vector<Segment> kept = thinned(all, 6, {all[5]});
  EXPECT_TRUE(std::ranges::any_of(kept, [&](const Segment& each) { return each.first == all[5].first; }));
}

}  // namespace
}  // namespace zwidth::internal
