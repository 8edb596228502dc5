#pragma once

#include <optional>
#include <string>
#include <vector>

#include "identification/verdict/omnibus.hpp"
#include "zwidth/finding.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::internal {

/// A record that a residual may stand out in.
struct NamedRecord {
  std::string source;            ///< where it was read from
  double sampling_period = 0.0;  ///< s
};

/// Where the limit is, and what was recorded; Hz.
struct LimitPlace {
  double limiting = 0.0;  ///< of the crossover that limits
  double lowest = 0.0;    ///< that the records excite
  double highest = 0.0;
};

/// A delay that was given, and not free, beside the one that the records ask for.
struct GivenDelay {
  double given = 0.0;            ///< s, lag included
  double shown = 0.0;            ///< s, of a fit that has it free
  double deviation = 0.0;        ///< s, one standard deviation of `shown`
  double sampling_period = 0.0;  ///< s
  double stiffness = 0.0;        ///< K_CR with the shown one
};

/// What is known of a fit when it is judged.
struct VerdictInput {
  Motion motion = Motion::linear;
  std::optional<Interval> limit = {};        ///< all within 1.92 of the best log-likelihood; absent: none was found
  double last_change = 0.0;                  ///< FoundDevice::last_change
  std::optional<Omnibus> omnibus = {};       ///< of what it leaves in time; absent: nothing was fitted
  std::vector<NamedRecord> records = {};     ///< those that `omnibus` counts
  std::vector<RivalEstimate> rivals = {};    ///< rival_table()
  std::optional<LimitPlace> place = {};      ///< of the limit of the most likely device
  std::optional<GivenDelay> delay = {};      ///< where one was given
  std::optional<Finding> further_body = {};  ///< one that the structure lacks, and the fitted device has
  bool force_has_one_size = false;           ///< has_one_size()
  std::vector<Finding> contradictions = {};  ///< refusals: data or given numbers that contradict each other
  std::vector<Finding> doubts_of_data = {};  ///< a clipped signal
  bool motion_tells_none = false;            ///< the lines of the response answer in its place
};

/// The trust in the limit, and what is to be noted beside it.
struct Verdict {
  Trust trust;
  std::vector<Remark> remarks;
};

/// Whether the structure leaves nothing but noise of what was recorded.
[[nodiscard]] bool is_explained(const VerdictInput& fit);

/// Sound where the interval is within Calibration::widest_interval and what is left does not stand out; doubtful where it is
/// wider, or stands out, or the data are not whole, or the motion tells of no limit; refused where no limit is determined, or the data contradict themselves.
/// An interval that is too wide names the rival that leaves most of it open.
[[nodiscard]] Verdict verdict_of(const VerdictInput& fit);

}  // namespace zwidth::internal
