#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/found_device.hpp"
#include "identification/motion_start.hpp"
#include "identification/verdict/omnibus.hpp"
#include "identification/verdict/verdict.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/measured_limit.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/signal/frequency_response.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

struct MotionFitOptions {
  FreeNumbers free;
  double segment = 10.0;                   ///< s
  std::vector<MeasuredLimit> limits = {};  ///< observed beside the records
  std::function<void()> tell = {};         ///< at each step; what it throws ends the work
};

/// A device found by likelihood from its motion, and the range of its limit.
struct MotionFit {
  FoundDevice found;
  Omnibus omnibus;                           ///< of what it leaves
  std::vector<FittedMotion> motions;         ///< by recording
  std::optional<GivenDelay> delay;           ///< where the structure's was taken
  std::vector<Finding> contradicted;         ///< contradicted_numbers()
  double fitted_share = 1.0;                 ///< of all rows
  bool force_has_one_size = false;           ///< has_one_size()
  std::optional<Finding> further_body = {};  ///< fitted because the structure leaves motion that follows the force
};

/// The most likely device of a structure, with all that may explain its records beside it (add_rivals()), and the least and
/// the largest critical stiffness that the records allow, nobody holding, no damper.
///
/// Where what is left follows the force most clearly, no given number being why, a device with a further body is fitted too
/// (with_further_body()): it is the answer where that body swings, nothing stands out, and no number is one that nobody believes.
///
/// Nothing where no start can be played or the found device has no limit. Throws Error as fit_parameters() does.
/// Source: docs/identification_method.md; Venzon & Moolgavkar 1988.
[[nodiscard]] std::optional<MotionFit> fit_motion(std::span<const Recording> recordings,
                                                  const FrequencyResponse& response, const Device& structure,
                                                  const MotionFitOptions& options);

}  // namespace zwidth::internal
