#pragma once

#include <string>
#include <vector>

#include "identification/motion_search.hpp"
#include "identification/motion_start.hpp"
#include "zwidth/finding.hpp"
#include "zwidth/identification/measured_stiffness.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// Masses, dampings and stiffnesses that were given, and not free, where the records ask for others with which the limit lies
/// outside of its interval: one step of Gauss and Newton from the best fit with these numbers free too (a score test: Rao 1948).
///
/// By more than 5 deviations, so that chance says so of one record in a million.
[[nodiscard]] std::vector<Finding> contradicted_numbers(const FoundMotion& found, const MotionStart& start,
                                                        const std::vector<std::string>& locked,
                                                        const Interval& interval, const std::string& source);

}  // namespace zwidth::internal
