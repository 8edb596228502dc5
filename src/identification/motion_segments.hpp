#pragma once

#include <cstddef>
#include <vector>

#include "identification/model/motion_model.hpp"

namespace zwidth::internal {

/// The records in segments of about so many seconds, of 256 samples at least. The first 20 samples are in none: their forces came
/// before the record.
[[nodiscard]] std::vector<Segment> segments_of(const std::vector<ForceMotionRecord>& records, double length);

/// Segments at even distances that hold no more samples than `most_samples`, and besides those that `others` begin with.
[[nodiscard]] std::vector<Segment> thinned(const std::vector<Segment>& all, std::size_t most_samples,
                                           const std::vector<Segment>& others);

}  // namespace zwidth::internal
