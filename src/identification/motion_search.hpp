#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "identification/motion_start.hpp"
#include "identification/record_search.hpp"

namespace zwidth::internal {

/// The likelihood of the records whole, and where it is largest.
struct FoundMotion {
  std::unique_ptr<MotionModel> model;
  std::shared_ptr<TimeEvidence> evidence;
  std::unique_ptr<Likelihood> likelihood;
  Minimum best;
};

struct MotionSearchOptions {
  double segment = 10.0;  ///< s
  BesideRecords beside = {};
};

/// From the linear device, from much friction and a lag, and from little where that may matter, segments of half a second with
/// states of their own find what is near, by their own noise. From the most likely of these the records whole are fitted, by the
/// noise of what is left in turn; from the others too where a body rubs beyond its noise. Terms act over whole sampling periods
/// first, then over halves, and where a body rubs over finer substeps until they move no number of the device. A link's friction
/// acts from the halves on: its damping stands for it before. Where the structure is a device's, the search begins at its own
/// values too: a link above what the force excites shows in nothing but how a body that rubs stops and starts.
///
/// Of records of more than 30 000 samples in all, evenly spread segments of each are fitted. Nothing where no start can be played.
[[nodiscard]] std::optional<FoundMotion> found_motion(const MotionStart& start, const std::vector<std::string>& locked,
                                                      const MotionSearchOptions& options);

}  // namespace zwidth::internal
