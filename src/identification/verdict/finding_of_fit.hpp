#pragma once

#include <optional>
#include <vector>

#include "identification/verdict/verdict.hpp"
#include "zwidth/finding.hpp"

namespace zwidth::internal {

// What is found of a fit by likelihood, a function a finding.

[[nodiscard]] Finding undetermined(const VerdictInput& fit);

/// With the rival that leaves most of the interval open, and the limit within what the records allow of it.
[[nodiscard]] Finding open_interval(const VerdictInput& fit);

/// A last step of the search, or of an end of the interval, that moved the limit by a notable share of the interval.
[[nodiscard]] bool was_stopped(const VerdictInput& fit);
[[nodiscard]] Finding stopped_search(const VerdictInput& fit);

/// The test fails.
[[nodiscard]] bool stands_out(const Omnibus& omnibus);
/// What that is, and where. The limit with it is not known: no effect.
[[nodiscard]] Finding outstanding(const Omnibus& omnibus, const std::vector<NamedRecord>& records);

/// By more than 4 deviations and a twentieth of a sampling period.
[[nodiscard]] bool contradicts(const GivenDelay& delay);
[[nodiscard]] Finding contradicted(const GivenDelay& delay);

/// Dry friction or a constant force of more than 3 deviations.
[[nodiscard]] std::optional<Finding> shown_rival(const RivalEstimate& rival, const VerdictInput& fit);

[[nodiscard]] Finding outside_band(const LimitPlace& place);

}  // namespace zwidth::internal
