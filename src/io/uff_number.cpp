#include "io/uff_number.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

#include "io/number_cell.hpp"

namespace zwidth::internal {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_sign(char c) { return c == '+' || c == '-'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Where a number's parts end.
struct Extent {
  std::size_t mantissa = 0;
  std::size_t exponent = 0;  ///< where its sign or digits begin; the mantissa's end where there is none
  std::size_t end = 0;
};

Extent extent_of(std::string_view text) {
  const auto at = [&](std::size_t i) { return i < text.size() ? text[i] : '\0'; };
  const auto past_digits = [&](std::size_t i) {
    while (is_digit(at(i))) ++i;
    return i;
  };
  const std::size_t begin = is_sign(at(0)) ? 1 : 0;
  std::size_t end = past_digits(begin);
  std::size_t digits = end - begin;
  const bool has_point = at(end) == '.';
  if (has_point) {
    const std::size_t fraction = end + 1;
    end = past_digits(fraction);
    digits += end - fraction;
  }
  if (digits == 0) return {};
  Extent extent{end, end, end};
  const bool has_letter = at(end) != '\0' && std::string_view("eEdD").find(at(end)) != std::string_view::npos;
  const std::size_t exponent = has_letter ? end + 1 : end;
  const std::size_t exponent_digits = is_sign(at(exponent)) ? exponent + 1 : exponent;
  const std::size_t exponent_end = past_digits(exponent_digits);
  const std::size_t length = exponent_end - exponent_digits;
  const bool without_letter = has_point && is_sign(at(exponent)) && length == 3 && at(exponent_end) != '.';
  if (has_letter ? length > 0 : without_letter) extent = {end, exponent, exponent_end};
  return extent;
}

}  // namespace

std::optional<double> take_fortran_number(std::string_view& rest) {
  rest.remove_prefix(static_cast<std::size_t>(std::find_if_not(rest.begin(), rest.end(), is_blank) - rest.begin()));
  const Extent extent = extent_of(rest);
  if (extent.end == 0) {  // perhaps a word that stands for a missing number
    const auto end = static_cast<std::size_t>(std::find_if(rest.begin(), rest.end(), is_blank) - rest.begin());
    const std::string_view word = rest.substr(0, end);
    const bool stars = !word.empty() && word.find_first_not_of('*') == word.npos;
    if (word.empty() || (!stars && read_number(word, '.').kind != NumberCell::Kind::missing)) return std::nullopt;
    rest.remove_prefix(end);
    return std::numeric_limits<double>::quiet_NaN();
  }
  const std::string_view text = rest.substr(0, extent.end);
  const bool plain = text.find_first_of("dD") == text.npos &&
                     (extent.exponent == extent.mantissa ? extent.end == extent.mantissa : true);
  NumberCell number;
  if (plain) {
    number = read_number(text, '.');
  } else {
    std::string with_letter(text.substr(0, extent.mantissa));
    with_letter += 'e';
    with_letter += text.substr(extent.exponent);
    number = read_number(with_letter, '.');
  }
  if (number.kind != NumberCell::Kind::number) return std::nullopt;
  rest.remove_prefix(extent.end);
  return number.value;
}

}  // namespace zwidth::internal
