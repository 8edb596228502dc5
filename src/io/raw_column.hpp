#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/io/input_error.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::internal {

/// A column of a recording as its file holds it, before anything is checked.
struct RawColumn {
  std::string source;                                   ///< the file's name, for errors
  std::string name;                                     ///< as the file names it
  std::vector<double> values;                           ///< NaN or infinite where the file has no number
  std::function<std::size_t(std::size_t sample)> line;  ///< where a sample (from 0) stands; empty: no lines (MAT, UFF)
};

/// The refusal of a column at a sample (from 0): with the sample's line where the file has lines, else with the number of
/// the `sample` (from 1).
[[nodiscard]] InputError refused_sample(const RawColumn& column, std::size_t sample, Problem problem);

/// "line 57", or "sample 56" (from 1) where the file has no lines.
[[nodiscard]] std::string place_of(const RawColumn& column, std::size_t sample);

/// Replaces what is not finite by the straight line between the neighbours (at the ends: by the nearest sample).
/// Adds a remark where there was something to fill. Refused, with the first place: more than 1 % of the column, and a
/// column without a number.
[[nodiscard]] tl::expected<void, InputError> fill_missing(RawColumn& column, std::vector<Remark>& remarks);

}  // namespace zwidth::internal
