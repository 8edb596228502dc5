#pragma once

#include <string>
#include <vector>

#include "report/analysed_device.hpp"

namespace zwidth::report {

/// One limit, and who holds the device at it.
struct LimitRow {
  std::string what;    ///< "spring alone"; empty where the row above says it
  std::string holder;  ///< words_of(Holder)
  std::string answer;  ///< "8.849 kN/m, then shakes at 6.143 Hz: the rigid body and ..."
  std::string hint;    ///< the command that tells more; mostly empty
};

/// The first lines of an answer: spring alone, damper alone (where the axis turns, the wall has no spring or no spring is
/// stable), and where they were asked for the stiffest wall with a damper and the one to run. Empty where refused.
[[nodiscard]] std::vector<LimitRow> limit_rows(const AnalysedDevice& analysed);

/// The rows under a line with the device's name and whether the answer is sound.
[[nodiscard]] std::string limit_lines(const AnalysedDevice& analysed);

}  // namespace zwidth::report
