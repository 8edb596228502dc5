#pragma once

#include <optional>
#include <string>

#include "zwidth/stability/user_family.hpp"

namespace zwidth::cli {

/// What --users says: the ranges that it names.
struct UserRanges {
  std::optional<ValueRange> mass;
  std::optional<ValueRange> damping;
  std::optional<ValueRange> stiffness;
};

/// Reads "mass=0:2,damping=0:30,stiffness=1000": some of the three keys (inertia is the mass of a rotary axis), each
/// with a range LEAST:GREATEST or one value, plain or with units ("mass=0:500 g"). Throws BadInput that names the key.
[[nodiscard]] UserRanges user_ranges(const std::string& text, Motion motion);

/// The family for a device: what is not named has the value of the device's own [operator].
[[nodiscard]] UserFamily user_family(const UserRanges& ranges, const Operator& own);

}  // namespace zwidth::cli
