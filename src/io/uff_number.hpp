#pragma once

#include <optional>
#include <string_view>

namespace zwidth::internal {

/// Takes a number off the front of `rest`, as Fortran writes it: blanks before it are passed over, the next number may
/// follow without a blank ("1.5E+00-2.5E+00"), D stands for E, and an exponent of three digits may lack its letter
/// ("1.5-100"). NaN for "NaN", an infinity, and the stars of a number too wide for its field.
/// Nothing where no number begins; `rest` then begins with what is none.
[[nodiscard]] std::optional<double> take_fortran_number(std::string_view& rest);

}  // namespace zwidth::internal
