#include "io/unit_system.hpp"

#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

// No more than a device needs, so that a slip ("1 h", "5 a") is refused instead of being an hour or an are. Built here,
// not read from udunits' database: nothing has to be found at run time.
struct NamedUnit {
  const char* name;
  const char* meaning;  // in units further up; null: a base unit
};

constexpr NamedUnit units[] = {
    {"m", nullptr},
    {"g", nullptr},
    {"s", nullptr},
    {"rad", nullptr},
    {"kg", "1000 g"},
    {"N", "kg m s^-2"},
    {"turn", "6.283185307179586476925 rad"},
    {"Hz", "turn s^-1"},
    {"meter", "m"},
    {"metre", "m"},
    {"micron", "1e-6 m"},
    {"in", "0.0254 m"},
    {"inch", "0.0254 m"},
    {"ft", "0.3048 m"},
    {"gram", "g"},
    {"kilogram", "kg"},
    {"lb", "0.45359237 kg"},
    {"oz", "0.028349523125 kg"},
    {"sec", "s"},
    {"second", "s"},
    {"min", "60 s"},
    {"minute", "60 s"},
    {"newton", "N"},
    {"Nm", "N m"},
    {"Nmm", "0.001 N m"},
    {"Nms", "N m s"},
    {"kgf", "9.80665 N"},
    {"lbf", "4.4482216152605 N"},
    {"ozf", "0.27801385095378125 N"},
    {"radian", "rad"},
    {"deg", "turn/360"},
    {"degree", "turn/360"},
    {"arcmin", "turn/21600"},
    {"arcsec", "turn/1296000"},
    {"rev", "turn"},
    {"revolution", "turn"},
    {"rpm", "turn/60 s^-1"},
    {"hertz", "Hz"},
    {"count", "1"},
    {"tick", "1"},
    {"%", "0.01"},
    // The plurals that are written.
    {"turns", "turn"},
    {"revs", "turn"},
    {"revolutions", "turn"},
    {"counts", "1"},
    {"ticks", "1"},
    {"degrees", "turn/360"},
    {"radians", "rad"},
    {"seconds", "s"},
    {"minutes", "60 s"},
    {"meters", "m"},
    {"metres", "m"},
    {"newtons", "N"},
    {"grams", "g"},
    {"kilograms", "kg"},
    {"inches", "0.0254 m"},
};

constexpr std::pair<const char*, double> prefixes[] = {
    {"p", 1e-12},    {"n", 1e-9},     {"u", 1e-6},     {"m", 1e-3},   {"c", 1e-2},
    {"d", 1e-1},     {"k", 1e3},      {"M", 1e6},      {"G", 1e9},    {"nano", 1e-9},
    {"micro", 1e-6}, {"milli", 1e-3}, {"centi", 1e-2}, {"kilo", 1e3}, {"mega", 1e6}};

struct FreeUnit {
  void operator()(ut_unit* unit) const noexcept { ut_free(unit); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;

/// udunits' state (its parser, status and handler of messages) is one for the whole process: one thread at a time, and
/// messages go nowhere meanwhile.
class Udunits {
 public:
  Udunits() : lock_(mutex()), handler_(ut_set_error_message_handler(ut_ignore)) {}
  ~Udunits() { ut_set_error_message_handler(handler_); }
  Udunits(const Udunits&) = delete;
  Udunits& operator=(const Udunits&) = delete;

  [[nodiscard]] Unit parsed(const std::string& text) const { return Unit(ut_parse(system(), text.c_str(), UT_ASCII)); }

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }

  static ut_system* system() {
    static ut_system* const one = built_system();  // lives as long as the process
    return one;
  }

  static ut_system* built_system() {
    ut_system* const system = ut_new_system();
    if (!system) throw std::bad_alloc();
    for (const auto& [prefix, factor] : prefixes) ut_add_symbol_prefix(system, prefix, factor);
    for (const NamedUnit& each : units) {
      const Unit unit(each.meaning ? ut_parse(system, each.meaning, UT_ASCII) : ut_new_base_unit(system));
      if (!unit || ut_map_symbol_to_unit(each.name, UT_ASCII, unit.get()) != UT_SUCCESS) throw std::bad_alloc();
    }
    return system;
  }

  std::lock_guard<std::mutex> lock_;
  ut_error_message_handler handler_;
};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// udunits' words for offsets, times of a calendar and logarithms: none of them is a factor.
bool has_word_of_no_factor(std::string_view text) {
  constexpr std::array words{"after", "from", "ref", "re", "since", "lg", "ln"};
  std::string word;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size() && is_letter(text[i])) {
      word += static_cast<char>(text[i] | 0x20);  // small letters: udunits takes either
    } else {
      if (std::ranges::count(words, word) > 0) return true;
      word.clear();
    }
  }
  return false;
}

/// Whether a whole number has more digits than udunits holds: it would read another exponent.
bool has_long_number(std::string_view text) {
  constexpr std::size_t most_digits = 9;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = begin;
    while (end < text.size() && is_digit(text[end])) ++end;
    const bool is_fraction = begin > 0 && text[begin - 1] == '.';
    if (end - begin > most_digits && !is_fraction) return true;
    begin = std::max(end, begin + 1);
  }
  return false;
}

/// Whether a number stands where a slip may have put it: "kg cm 2" is no "kg cm^2", "turn 4096" no "turn/4096".
bool has_stray_number(std::string_view text) {
  char before = '\0';  // the last character but spaces
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = is_digit(text[i]) && (i == 0 || text[i - 1] == ' ');
    if (begins && before != '\0' && std::string_view("/*^(").find(before) == std::string_view::npos) return true;
    if (text[i] != ' ') before = text[i];
  }
  return false;
}

}  // namespace

std::optional<std::string> ascii_unit(std::string_view text) {
  constexpr std::size_t longest = 80;
  constexpr std::pair<std::string_view, std::string_view> signs[] = {
      {"\u00b5", "u"}, {"\u03bc", "u"}, {"\u00b2", "^2"},  {"\u00b3", "^3"},        {"\u00b7", "."},
      {"\u22c5", "."}, {"\u00d7", "*"}, {"\u00b0", "deg"}, {"\u207b\u00b9", "^-1"}, {"\u207b\u00b2", "^-2"}};
  if (text.size() > longest) return std::nullopt;
  std::string ascii;
  while (!text.empty()) {
    const auto sign = std::ranges::find_if(signs, [&](const auto& each) { return text.starts_with(each.first); });
    if (sign != std::end(signs)) {
      ascii += sign->second;
      text.remove_prefix(sign->first.size());
      continue;
    }
    const char c = text.front();
    if (!is_letter(c) && !is_digit(c) && std::string_view(" .*/^()-+%").find(c) == std::string_view::npos) {
      return std::nullopt;
    }
    ascii += c;
    text.remove_prefix(1);
  }
  if (has_word_of_no_factor(ascii) || has_stray_number(ascii) || has_long_number(ascii)) return std::nullopt;
  return ascii;
}

std::optional<double> unit_factor(const std::string& unit, const std::string& wanted) {
  const Udunits udunits;
  const Unit given = udunits.parsed(unit);
  const Unit target = udunits.parsed(wanted);
  const Unit one = udunits.parsed("1");
  if (!given || !target || !one) return std::nullopt;
  const Unit ratio(ut_divide(given.get(), target.get()));
  // udunits would also take the inverse of a unit for convertible, so it is the ratio that must be a number.
  if (!ratio || !ut_is_dimensionless(ratio.get())) return std::nullopt;
  cv_converter* const converter = ut_get_converter(ratio.get(), one.get());
  if (!converter) return std::nullopt;
  const double at_zero = cv_convert_double(converter, 0.0);
  const double factor = cv_convert_double(converter, 1.0);
  const double at_two = cv_convert_double(converter, 2.0);
  cv_free(converter);
  const bool is_factor = std::isfinite(factor) && factor > 0.0 && at_zero == 0.0 && at_two == 2.0 * factor;
  return is_factor ? std::optional(factor) : std::nullopt;
}

bool is_unit(const std::string& unit) {
  const Udunits udunits;
  return udunits.parsed(unit) != nullptr;
}

}  // namespace zwidth::internal
