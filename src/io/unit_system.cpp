#include "io/unit_system.hpp"

#include <udunits2.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <mutex>
#include <new>
#include <utility>

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
    {"A", nullptr},
    {"kg", "1000*g"},
    {"N", "kg m s^-2"},
    {"turn", "6.283185307179586476925*rad"},
    {"Hz", "turn s^-1"},
    {"V", "N m s^-1 A^-1"},
    {"meter", "m"},
    {"metre", "m"},
    {"micron", "1e-6*m"},
    {"in", "0.0254*m"},
    {"inch", "0.0254*m"},
    {"ft", "0.3048*m"},
    {"gram", "g"},
    {"kilogram", "kg"},
    {"lb", "0.45359237*kg"},
    {"oz", "0.028349523125*kg"},
    {"sec", "s"},
    {"second", "s"},
    {"min", "60*s"},
    {"minute", "60*s"},
    {"newton", "N"},
    {"Nm", "N m"},
    {"Nmm", "0.001*N m"},
    {"Nms", "N m s"},
    {"kgf", "9.80665*N"},
    {"lbf", "4.4482216152605*N"},
    {"ozf", "0.27801385095378125*N"},
    {"radian", "rad"},
    {"deg", "turn/360"},
    {"degree", "turn/360"},
    {"arcmin", "turn/21600"},
    {"arcsec", "turn/1296000"},
    {"rev", "turn"},
    {"revolution", "turn"},
    {"rpm", "turn/60/s"},
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
    {"minutes", "60*s"},
    {"meters", "m"},
    {"metres", "m"},
    {"newtons", "N"},
    {"grams", "g"},
    {"kilograms", "kg"},
    {"inches", "0.0254*m"},
};

constexpr std::pair<const char*, double> prefixes[] = {
    {"p", 1e-12},    {"n", 1e-9},     {"u", 1e-6},     {"m", 1e-3},   {"c", 1e-2},
    {"d", 1e-1},     {"k", 1e3},      {"M", 1e6},      {"G", 1e9},    {"nano", 1e-9},
    {"micro", 1e-6}, {"milli", 1e-3}, {"centi", 1e-2}, {"kilo", 1e3}, {"mega", 1e6}};

struct FreeUnit {
  void operator()(ut_unit* unit) const noexcept { ut_free(unit); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%'; }
bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }

/// The unit of a name, with a prefix or without; null: there is none.
Unit named_unit(ut_system* system, const std::string& name) {
  Unit unit(ut_get_unit_by_symbol(system, name.c_str()));
  for (const auto& [prefix, factor] : prefixes) {
    if (unit || !name.starts_with(prefix)) continue;
    const Unit plain(ut_get_unit_by_symbol(system, name.c_str() + std::string_view(prefix).size()));
    if (plain) unit.reset(ut_scale(factor, plain.get()));
  }
  return unit;
}

/// Reads products of powers; null where the text is none. Not udunits' own parser, which takes dates, offsets and
/// logarithms too, reads "kg cm 2" as 2 kg cm and "m^4294967297" as m, and loses memory on some errors.
class UnitReader {
 public:
  UnitReader(ut_system* system, std::string_view text) : system_(system), rest_(text) {}

  [[nodiscard]] Unit whole() {
    Unit unit = product();
    skip_spaces();
    return rest_.empty() ? std::move(unit) : nullptr;
  }

 private:
  bool skip_spaces() {
    const std::size_t before = rest_.size();
    rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
    return rest_.size() < before;
  }

  bool take(std::string_view sign) {
    if (!rest_.starts_with(sign)) return false;
    rest_.remove_prefix(sign.size());
    return true;
  }

  /// Whether the text goes on with a word, which is taken.
  bool take_word(std::string_view word) {
    return rest_.size() > word.size() && rest_[word.size()] == ' ' && take(word);
  }

  Unit product() {
    skip_spaces();
    Unit all = power(true);
    while (all) {
      const bool has_space = skip_spaces();
      if (rest_.empty() || rest_.front() == ')') break;
      const bool divides = take("/") || take_word("per");
      const bool by_sign = divides || take("*");
      const bool multiplies = by_sign || take(".") || take("-") || has_space;
      if (!multiplies) return nullptr;
      skip_spaces();
      // A number without a sign before it is a slip: "kg cm 2".
      const Unit next = power(by_sign);
      if (!next) return nullptr;
      all.reset(divides ? ut_divide(all.get(), next.get()) : ut_multiply(all.get(), next.get()));
    }
    return all;
  }

  /// A name, a number or a product in brackets, and its power.
  Unit power(bool may_be_number) {
    if (rest_.empty()) return nullptr;
    if (is_decimal_digit(rest_.front())) return may_be_number ? number() : nullptr;
    Unit unit;
    if (take("(")) {
      unit = product();
      if (!take(")")) return nullptr;
    } else {
      const auto end = std::ranges::find_if_not(rest_, is_letter);
      const std::string name(rest_.begin(), end);
      rest_.remove_prefix(name.size());
      unit = named_unit(system_, name);
    }
    if (!unit) return nullptr;
    const bool has_sign = take("^") || take("**");
    const bool has_digit = rest_.size() > 1 && rest_.front() == '-' ? is_decimal_digit(rest_[1])
                                                                    : !rest_.empty() && is_decimal_digit(rest_.front());
    if (!has_digit) return has_sign ? nullptr : std::move(unit);
    const int sign = take("-") ? -1 : 1;
    const int exponent = sign * (rest_.front() - '0');
    rest_.remove_prefix(1);
    if (!rest_.empty() && (is_decimal_digit(rest_.front()) || is_letter(rest_.front()))) return nullptr;
    return Unit(ut_raise(unit.get(), exponent));
  }

  Unit number() {
    double value = 0.0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc{} || !(value > 0.0) || !std::isfinite(value)) return nullptr;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    const Unit one(ut_get_dimensionless_unit_one(system_));
    return Unit(ut_scale(value, one.get()));
  }

  ut_system* system_;
  std::string_view rest_;
};

/// udunits' state (status, handler of messages, what units remember) is one for the whole process: one thread at a
/// time, and messages go nowhere meanwhile.
class Udunits {
 public:
  Udunits() : lock_(mutex()), handler_(ut_set_error_message_handler(ut_ignore)) {}
  ~Udunits() { ut_set_error_message_handler(handler_); }
  Udunits(const Udunits&) = delete;
  Udunits& operator=(const Udunits&) = delete;

  [[nodiscard]] Unit parsed(std::string_view text) const { return UnitReader(system(), text).whole(); }

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
    for (const NamedUnit& each : units) {
      const Unit unit = each.meaning ? UnitReader(system, each.meaning).whole() : Unit(ut_new_base_unit(system));
      if (!unit || ut_map_symbol_to_unit(each.name, UT_ASCII, unit.get()) != UT_SUCCESS) throw std::bad_alloc();
    }
    return system;
  }

  std::lock_guard<std::mutex> lock_;
  ut_error_message_handler handler_;
};

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
    if (!is_letter(c) && !is_decimal_digit(c) && std::string_view(" .*/^()-").find(c) == std::string_view::npos) {
      return std::nullopt;
    }
    ascii += c;
    text.remove_prefix(1);
  }
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
