#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "io/uff_file.hpp"

namespace zwidth::internal {

/// The numbers of a function, in its own units. NaN where the file has no number.
struct UffValues {
  std::vector<double> abscissa;   ///< of every point, also where the file has only its first value and step
  std::vector<double> ordinate;   ///< real part of a complex function
  std::vector<double> imaginary;  ///< empty for a real function
  std::vector<Remark> remarks;    ///< fewer points than the header says
};

/// Reads the numbers of a record of this file.
/// Refused, with the line: text that is no number, no point at all, and more numbers than the points take.
[[nodiscard]] tl::expected<UffValues, InputError> read_uff_values(const UffFile& file, const UffRecord& record);

}  // namespace zwidth::internal
