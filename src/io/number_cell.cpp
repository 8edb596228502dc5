#include "io/number_cell.hpp"

#include <algorithm>
#include <array>
#include <boost/locale/utf.hpp>
#include <charconv>
#include <cmath>
#include <limits>

#include "io/prose.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr NumberCell missing_cell{NumberCell::Kind::missing, nan_value};
constexpr NumberCell text_cell{NumberCell::Kind::text, nan_value};

/// No number of a measurement is longer; a longer one is no number.
constexpr std::size_t longest_number = 400;

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool stands_for_missing(std::string_view cell) {
  constexpr std::array<std::string_view, 6> words{"nan", "na", "n/a", "null", "inf", "infinity"};
  if (cell.empty()) return true;
  if (cell.front() == '+' || cell.front() == '-') cell.remove_prefix(1);
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
    return std::equal(cell.begin(), cell.end(), word.begin(), word.end(), [](char a, char b) { return lower(a) == b; });
  });
}

/// Too small a number is 0; too large a one is none.
NumberCell out_of_range(std::string_view cell) {
  const std::size_t exponent = cell.find_first_of("eE");
  const bool small = exponent != std::string_view::npos
                         ? cell[exponent + 1] == '-'
                         : cell.find_first_of("123456789") > std::min(cell.find('.'), cell.size());
  return small ? NumberCell{NumberCell::Kind::number, 0.0} : text_cell;
}

/// The number at the start of `text` and how much of it was read (0: none).
struct LeadingNumber {
  NumberCell cell;
  std::size_t length = 0;
};

LeadingNumber leading_number(std::string_view text) {
  const std::size_t sign = !text.empty() && text.front() == '+' ? 1 : 0;  // from_chars takes no '+'
  const std::string_view number = text.substr(sign);
  if (number.empty() || !(is_digit(number.front()) || number.front() == '.' || (sign == 0 && number.front() == '-'))) {
    return {text_cell, 0};
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  const auto length = static_cast<std::size_t>(end - number.data());
  if (error == std::errc::invalid_argument) return {text_cell, 0};
  if (error == std::errc::result_out_of_range) return {out_of_range(number.substr(0, length)), sign + length};
  return {std::isfinite(value) ? NumberCell{NumberCell::Kind::number, value} : missing_cell, sign + length};
}

/// The cell with a decimal point in place of its mark; nothing where it cannot be a number.
struct WithPoint {
  std::array<char, longest_number> characters{};
  std::size_t size = 0;
  [[nodiscard]] std::string_view view() const { return {characters.data(), size}; }
};

std::optional<WithPoint> with_point(std::string_view cell, char decimal_mark) {
  if (cell.size() > longest_number || cell.back() == decimal_mark || cell.find('.') != std::string_view::npos) {
    return std::nullopt;  // "1," is a number and a separator; "1.234,5" groups thousands
  }
  WithPoint number;
  number.size = cell.size();
  std::replace_copy(cell.begin(), cell.end(), number.characters.begin(), decimal_mark, '.');
  return number;
}

NumberCell number_with_point(std::string_view cell) {
  const auto [number, length] = leading_number(cell);
  if (length == cell.size()) return number;
  return length == 0 && stands_for_missing(cell) ? missing_cell : text_cell;
}

bool is_utf8(std::string_view text) {
  namespace utf = boost::locale::utf;
  for (auto p = text.begin(); p != text.end();) {
    const utf::code_point point = utf::utf_traits<char>::decode(p, text.end());
    if (point == utf::illegal || point == utf::incomplete) return false;
  }
  return true;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

NumberCell read_number(std::string_view cell, char decimal_mark) {
  cell = trimmed(cell);
  if (cell.empty()) return missing_cell;
  if (decimal_mark == '.') return number_with_point(cell);
  const auto number = with_point(cell, decimal_mark);
  return number ? number_with_point(number->view()) : text_cell;
}

std::optional<char> decimal_mark_in(std::string_view cell) {
  const std::size_t mark = cell.find_first_of(".,");
  if (mark == std::string_view::npos || read_number(cell, cell[mark]).kind != NumberCell::Kind::number) {
    return std::nullopt;
  }
  return cell[mark];
}

std::optional<std::complex<double>> read_complex(std::string_view cell, char decimal_mark) {
  cell = trimmed(cell);
  if (cell.size() > 2 && cell.front() == '(' && cell.back() == ')') cell = trimmed(cell.substr(1, cell.size() - 2));
  if (cell.empty() || (cell.back() != 'j' && cell.back() != 'i')) return std::nullopt;
  cell.remove_suffix(1);
  if (cell.empty()) return std::nullopt;
  std::optional<WithPoint> pointed;
  if (decimal_mark != '.') {
    pointed = with_point(cell, decimal_mark);
    if (!pointed) return std::nullopt;
    cell = pointed->view();
  }
  const auto [real, length] = leading_number(cell);
  if (length == 0 || real.kind != NumberCell::Kind::number) return std::nullopt;
  if (length == cell.size()) return std::complex<double>(0.0, real.value);
  std::string_view rest = trimmed(cell.substr(length));
  if (rest.empty() || (rest.front() != '+' && rest.front() != '-')) return std::nullopt;
  const double sign = rest.front() == '-' ? -1.0 : 1.0;
  rest = trimmed(rest.substr(1));
  const auto [imaginary, rest_length] = leading_number(rest);
  const bool signed_twice = rest.empty() || rest.front() == '-' || rest.front() == '+';
  if (signed_twice || rest_length != rest.size() || imaginary.kind != NumberCell::Kind::number) return std::nullopt;
  return std::complex<double>(real.value, sign * imaginary.value);
}

Problem no_number_in(std::string_view cell, char decimal_mark) {
  cell = trimmed(cell);
  Problem problem{.code = ProblemCode::no_number_in_cell,
                  .subjects = {{"cell", in_quotes(as_utf8(cell))}, {"decimal_mark", std::string(1, decimal_mark)}}};
  const auto because = [&](const char* why) {
    problem.subjects.push_back({"why", why});
    return problem;
  };
  const auto count = [&](char c) { return std::count(cell.begin(), cell.end(), c); };
  const bool digits_first = !cell.empty() && is_digit(cell.front());
  if (cell.size() > 2 && cell.front() == '0' && lower(cell[1]) == 'x') return because("hexadecimal");
  if (digits_first && count(':') > 0) return because("time_of_day");
  const auto unread = [&](char mark) { return read_number(cell, mark).kind != NumberCell::Kind::number; };
  const char other_mark = decimal_mark == '.' ? ',' : '.';
  if (digits_first && count('.') + count(',') > 1 &&
      cell.find_first_not_of("0123456789.,+-eE") == std::string_view::npos) {
    return because("thousands");
  }
  if (unread(decimal_mark) && !unread(other_mark)) return because("decimal_mark");
  std::string with_e(cell);
  std::replace_if(
      with_e.begin(), with_e.end(), [](char c) { return lower(c) == 'd'; }, 'e');
  if (with_e != cell && read_number(with_e, decimal_mark).kind == NumberCell::Kind::number) return because("fortran");
  if (digits_first || (!cell.empty() && (cell.front() == '-' || cell.front() == '+'))) {
    const auto [number, length] = leading_number(cell);
    if (length > 0 && length == cell.size() && number.kind == NumberCell::Kind::text) return because("range");
  }
  return problem;
}

std::string as_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string converted;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    boost::locale::utf::utf_traits<char>::encode(byte, std::back_inserter(converted));
  }
  return converted;
}

}  // namespace zwidth::internal
