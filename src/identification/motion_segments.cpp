#include "identification/motion_segments.hpp"

#include <algorithm>

namespace zwidth::internal {

std::vector<Segment> segments_of(const std::vector<ForceMotionRecord>& records, double length, std::size_t fewest) {
  constexpr std::size_t least = 256;
  constexpr std::size_t left_out = 20;
  std::vector<Segment> segments;
  for (std::size_t record = 0; record < records.size(); ++record) {
    const std::size_t samples = records[record].position.size() - left_out;
    const auto wanted = std::max(least, static_cast<std::size_t>(length / records[record].sampling_period));
    const std::size_t most = std::max<std::size_t>(1, samples / least);
    const std::size_t count = std::min(most, std::max(fewest, (samples + wanted / 2) / wanted));
    for (std::size_t i = 0; i < count; ++i)
      segments.push_back({record, left_out + i * (samples / count), samples / count});
  }
  return segments;
}

std::size_t thinning(const std::vector<ForceMotionRecord>& records, std::size_t most_samples) {
  std::size_t samples = 0;
  for (const ForceMotionRecord& each : records) samples += each.position.size();
  return (samples + most_samples - 1) / most_samples;
}

std::vector<Segment> thinned(const std::vector<Segment>& all, std::size_t every, const std::vector<Segment>& others) {
  std::vector<Segment> kept;
  std::size_t in_record = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    in_record = i > 0 && all[i].record == all[i - 1].record ? in_record + 1 : 0;
    const bool begins = std::ranges::any_of(
        others, [&](const Segment& other) { return other.record == all[i].record && other.first == all[i].first; });
    if (begins || in_record % every == 0) kept.push_back(all[i]);
  }
  return kept;
}

double fitted_share(const std::vector<Segment>& segments, const std::vector<ForceMotionRecord>& records) {
  double fitted = 0.0;
  double rows = 0.0;
  for (const Segment& each : segments) fitted += static_cast<double>(each.count);
  for (const ForceMotionRecord& each : records) rows += static_cast<double>(each.position.size());
  return fitted / rows;
}

}  // namespace zwidth::internal
