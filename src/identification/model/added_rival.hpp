#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// What a rival's numbers measure.
enum class RivalMeasure : std::uint8_t { force, damping, quadratic_damping, stiffness, length, time, ratio, mixed };

/// "N s2/m2", "N m s2/rad2", ...; empty for a ratio, and where a rival has numbers of several units.
[[nodiscard]] std::string_view unit_of(RivalMeasure measure, Motion motion);

/// A rival that is part of a fit.
struct AddedRival {
  std::string_view code;
  std::vector<std::string> keys;               ///< of its numbers
  RivalMeasure measure = RivalMeasure::force;  ///< of theirs
};

}  // namespace zwidth::internal
