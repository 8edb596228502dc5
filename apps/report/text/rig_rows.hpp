#pragma once

#include <string>
#include <vector>

#include "report/text/text_table.hpp"
#include "zwidth/rig/results.hpp"

namespace zwidth::report {

// What an action on a rig found, without what is found against it.
[[nodiscard]] std::vector<LabelledText> rig_rows(const Device& device, const RigCheck& check);
[[nodiscard]] std::vector<LabelledText> rig_rows(const Device& device, const RigWall& wall);
[[nodiscard]] std::vector<LabelledText> rig_rows(const Device& device, const RigLimit& limit);

/// Why and when the session stopped; none where it came to its end.
[[nodiscard]] std::vector<LabelledText> stopped_rows(const RigSession& session);
/// On what it ran, and how many cycles.
[[nodiscard]] std::vector<LabelledText> session_rows(const RigSession& session);
/// Beyond what the force went to zero.
[[nodiscard]] std::vector<LabelledText> safety_rows(const RigSession& session);
/// Percentiles of latency, period and cycle; headings alone in lock step.
[[nodiscard]] TextTable latency_table(const LoopTiming& timing);
/// The stiffnesses that were tried, and what their oscillation did.
[[nodiscard]] TextTable trial_table(const LimitMeasurement& measured, const Units& units);

}  // namespace zwidth::report
