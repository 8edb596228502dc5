#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// Which columns of a table hold a frequency response, and their units.
struct ResponseColumns {
  enum class Form { magnitude_and_phase, real_and_imaginary, complex };
  Form form = Form::complex;
  std::optional<std::size_t> frequency;  ///< absent: a list of values at multiples of a step
  std::size_t first = 0;                 ///< magnitude, real part, or complex number
  std::size_t second = 0;                ///< phase or imaginary part
  std::optional<std::size_t> coherence;
  double frequency_scale = 1.0;  ///< rad/s per unit
  bool magnitude_in_db = false;
  bool phase_in_degrees = true;
  std::vector<Remark> remarks;  ///< units that the columns' names say
};

/// Finds the columns that `options` name, or else those whose names say what they are: "frequency_hz", "mag [dB]",
/// "phase (rad)", "re". The units that names say count before those of the options. Without any of them: complex
/// numbers in a table of one column, or of two behind the frequency.
/// Refused: columns that are not there, and a table in which it is not clear which are meant.
[[nodiscard]] tl::expected<ResponseColumns, InputError> find_response_columns(std::span<const std::string> names,
                                                                              const ResponseTableOptions& options,
                                                                              const std::string& source);

}  // namespace zwidth::internal
