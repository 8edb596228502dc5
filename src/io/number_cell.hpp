#pragma once

#include <complex>
#include <optional>
#include <string>
#include <string_view>

#include "zwidth/option_problem.hpp"

namespace zwidth::internal {

/// What one cell of a text table holds.
struct NumberCell {
  enum class Kind {
    number,
    missing,  ///< empty, NaN, an infinity, NA, N/A, null
    text,     ///< anything else
  };
  Kind kind = Kind::text;
  double value = 0.0;  ///< of a number; NaN otherwise
};

/// Reads a decimal number with an optional exponent; blanks around it are allowed. `decimal_mark` is '.' or ','.
[[nodiscard]] NumberCell read_number(std::string_view cell, char decimal_mark);

/// The decimal mark that a number shows: "0,5"; none where it is whole, or no number.
[[nodiscard]] std::optional<char> decimal_mark_in(std::string_view cell);

/// Reads a complex number as Python and MATLAB write it: "(1.5+2j)", "1.5-2e-3i".
[[nodiscard]] std::optional<std::complex<double>> read_complex(std::string_view cell, char decimal_mark);

/// What is wrong with a cell of text where a number must stand: "0x1F", which is hexadecimal.
[[nodiscard]] Problem no_number_in(std::string_view cell, char decimal_mark);

/// `text` without the blanks (spaces and tabs) at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// `text` itself where it is UTF-8, else its bytes read as Latin-1 and written as UTF-8: what a message or a document may
/// hold.
[[nodiscard]] std::string as_utf8(std::string_view text);

}  // namespace zwidth::internal
