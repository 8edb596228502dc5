#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace zwidth::internal {

/// The least number of samples after which a signal repeats itself, if it does: at least 8, and at least twice in the
/// record.
///
/// A repetition is a peak of the autocorrelation, of at least 0.98, beyond its first fall to a half; or of at least 0.5
/// that comes three times at its full height, as in white noise (then six periods at least). An excitation may
/// begin late: without one in the whole, the last 7/8, 3/4 and 1/2 are looked at. Of a long record only the middle 2^19
/// samples count, so that a longer period than half of that is not found.
[[nodiscard]] std::optional<std::size_t> detect_period(std::span<const double> signal);

}  // namespace zwidth::internal
