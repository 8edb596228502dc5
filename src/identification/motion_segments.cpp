#include "identification/motion_segments.hpp"

#include <algorithm>

namespace zwidth::internal {

std::vector<Segment> segments_of(const std::vector<ForceMotionRecord>& records, double length) {
  constexpr std::size_t least = 256;
  constexpr std::size_t left_out = 20;
  std::vector<Segment> segments;
  for (std::size_t record = 0; record < records.size(); ++record) {
    const std::size_t samples = records[record].position.size() - left_out;
    const auto wanted = std::max(least, static_cast<std::size_t>(length / records[record].sampling_period));
    const std::size_t count = std::max<std::size_t>(1, (samples + wanted / 2) / wanted);
    for (std::size_t i = 0; i < count; ++i)
      segments.push_back({record, left_out + i * (samples / count), samples / count});
  }
  return segments;
}

std::vector<Segment> thinned(const std::vector<Segment>& all, std::size_t most_samples,
                             const std::vector<Segment>& others) {
  std::size_t samples = 0;
  for (const Segment& each : all) samples += each.count;
  const std::size_t every = (samples + most_samples - 1) / most_samples;
  std::vector<Segment> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool begins = std::ranges::any_of(
        others, [&](const Segment& other) { return other.record == all[i].record && other.first == all[i].first; });
    if (begins || i % every == 0) kept.push_back(all[i]);
  }
  return kept;
}

}  // namespace zwidth::internal
