#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "identification/model/rivals/rival.hpp"

namespace zwidth::internal {

// A rival a file, named for it: what it is, its numbers, what is believed of them and why.
[[nodiscard]] Rival constant_force();
[[nodiscard]] Rival coulomb_friction();
[[nodiscard]] Rival drag();
[[nodiscard]] Rival asymmetric_damping();
[[nodiscard]] Rival damping_drift();
[[nodiscard]] Rival actuator_lag();
[[nodiscard]] Rival ground_spring();
[[nodiscard]] Rival further_body();
[[nodiscard]] Rival drive_saturation();
[[nodiscard]] Rival drive_dead_band();
[[nodiscard]] Rival cogging();

/// All that a fit has, in the order in which they are added. further_body() is not among them: the search does not settle with it.
[[nodiscard]] std::span<const Rival> rivals();

/// A rival that is part of a fit.
struct AddedRival {
  std::string_view code;
  std::vector<std::string> keys;               ///< of its numbers
  RivalMeasure measure = RivalMeasure::force;  ///< of theirs
};

/// Adds every rival to the parts that have the device's numbers, and puts those of the device first, as DeviceFamily takes them.
std::vector<AddedRival> add_rivals(const RivalSetting& setting, ModelParts& parts);

/// The device as it is at the end of its records, whose damping has drifted by half of damping_drift()'s since their middle: the
/// one that is on the bench now. The fitted numbers are those of the middle.
[[nodiscard]] DeviceParameters at_record_end(DeviceParameters device, const std::vector<Number>& numbers,
                                             const Eigen::VectorXd& x);

/// A factor of 28 either way at one sigma: what is believed of a mass or a link's stiffness before its record, as the deviation of
/// its logarithm. An assumption, weak on purpose.
inline constexpr double deviation_of_logarithm = 3.3;

}  // namespace zwidth::internal
