#pragma once

#include <cstddef>
#include <vector>

#include "identification/model/motion_model.hpp"

namespace zwidth::internal {

/// The records in segments of about so many seconds, of 256 samples at least, no fewer than `fewest` of each. The first 20 samples
/// are in none: their forces came before the record.
[[nodiscard]] std::vector<Segment> segments_of(const std::vector<ForceMotionRecord>& records, double length,
                                               std::size_t fewest = 1);

/// One in how many segments is fitted, so that these hold no more samples than `most_samples`.
[[nodiscard]] std::size_t thinning(const std::vector<ForceMotionRecord>& records, std::size_t most_samples);

/// One in `every` segments of each record, the first among them, and besides those that `others` begin with.
[[nodiscard]] std::vector<Segment> thinned(const std::vector<Segment>& all, std::size_t every,
                                           const std::vector<Segment>& others);

/// Of all rows of the records, the share that lies in these segments.
[[nodiscard]] double fitted_share(const std::vector<Segment>& segments, const std::vector<ForceMotionRecord>& records);

}  // namespace zwidth::internal
