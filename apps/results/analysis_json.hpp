#pragma once

#include <optional>
#include <string>

#include "results/csv.hpp"
#include "results/json.hpp"
#include "zwidth/design/wall_summary.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::results {

/// The document of `analyze --json`, schema zwidth.analysis/1, keys in their documented order.
///
/// "walls" is null where they were not asked for. Lengths in m or rad by the device's motion ("units"). What does not exist is null; NaN and infinities never appear.
[[nodiscard]] Json analysis_json(const Device& device, const Analysis& analysis,
                                 const std::optional<WallSummary>& walls = {});

/// What `analyze --csv` writes: a row a device, the limits with each holder. A limit that is infinite or not known is an empty
/// cell; `status` tells these apart of `critical_stiffness` alone.
class LimitTable {
 public:
  void add(const Device& device, const Analysis& analysis);
  [[nodiscard]] std::string text() const { return csv_.text(); }

 private:
  Csv csv_{"device",   "critical_stiffness", "status",         "nobody", "user",
           "any_user", "frequency_hz",       "stiffness_unit", "trust"};
};

}  // namespace zwidth::results
