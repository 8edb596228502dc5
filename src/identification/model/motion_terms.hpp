#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "identification/model/force_law.hpp"

namespace zwidth::internal {

/// A smooth force beside the linear device.
struct ForceTerm {
  ForceLaw law = nullptr;
  std::string body;
  std::vector<std::string> numbers = {};   ///< of the law, by their keys, in its order
  std::optional<std::size_t> record = {};  ///< it acts in; absent: all
};

/// Dry friction of a body, on its guide or on another body, which sticks, or bends before it slides.
struct FrictionTerm {
  std::string body;
  std::string number;                              ///< N or N m, by its key
  std::optional<std::string> against{};            ///< the other body; absent: the ground
  std::optional<std::string> presliding_length{};  ///< key of a number, m or rad; absent: it sticks
};

/// A drive that gives less than it is told: none within the dead band, no more than its limit; and later and later.
struct DriveTerm {
  std::optional<std::string> delay_drift =
      {};  ///< key of a number, s: how much later at a record's end than at its beginning
  std::optional<std::string> dead_band = {};  ///< key of a number, N or N m
  std::optional<std::string> saturation =
      {};  ///< key of a number, N or N m: how far the limit is below the largest command
};

/// What moves the device beside its linear equations.
struct MotionTerms {
  std::vector<ForceTerm> forces = {};
  std::vector<FrictionTerm> frictions = {};
  DriveTerm drive = {};
};

}  // namespace zwidth::internal
