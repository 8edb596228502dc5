#include "io/unit_system.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <numbers>
#include <utility>

namespace zwidth::internal {
namespace {

/// factor m^a kg^b s^c rad^d A^e
struct Unit {
  long double factor = 1.0L;  // so that 60 Hz in Hz are 60
  std::array<int, 5> powers = {};
};

constexpr Unit scaled(long double factor, Unit unit) {
  unit.factor *= factor;
  return unit;
}

constexpr Unit one;
constexpr Unit metre{1.0L, {1, 0, 0, 0, 0}};
constexpr Unit kilogram{1.0L, {0, 1, 0, 0, 0}};
constexpr Unit second{1.0L, {0, 0, 1, 0, 0}};
constexpr Unit radian{1.0L, {0, 0, 0, 1, 0}};
constexpr Unit ampere{1.0L, {0, 0, 0, 0, 1}};
constexpr Unit newton{1.0L, {1, 1, -2, 0, 0}};
constexpr Unit newton_metre{1.0L, {2, 1, -2, 0, 0}};
constexpr Unit turn = scaled(2.0L * std::numbers::pi_v<long double>, radian);
constexpr Unit hertz{turn.factor, {0, 0, -1, 1, 0}};

struct NamedUnit {
  std::string_view name;
  Unit unit;
};

// No more than a device needs, so that a slip ("1 h", "5 a") is refused instead of being an hour or an are.
constexpr NamedUnit units[] = {
    {"m", metre},
    {"g", scaled(1e-3L, kilogram)},
    {"s", second},
    {"rad", radian},
    {"A", ampere},
    {"kg", kilogram},
    {"N", newton},
    {"turn", turn},
    {"Hz", hertz},
    {"V", {1.0L, {2, 1, -3, 0, -1}}},
    {"meter", metre},
    {"metre", metre},
    {"micron", scaled(1e-6L, metre)},
    {"in", scaled(0.0254L, metre)},
    {"inch", scaled(0.0254L, metre)},
    {"ft", scaled(0.3048L, metre)},
    {"gram", scaled(1e-3L, kilogram)},
    {"kilogram", kilogram},
    {"lb", scaled(0.45359237L, kilogram)},
    {"oz", scaled(0.028349523125L, kilogram)},
    {"sec", second},
    {"second", second},
    {"min", scaled(60.0L, second)},
    {"minute", scaled(60.0L, second)},
    {"newton", newton},
    {"Nm", newton_metre},
    {"Nmm", scaled(1e-3L, newton_metre)},
    {"Nms", {1.0L, {2, 1, -1, 0, 0}}},
    {"kgf", scaled(9.80665L, newton)},
    {"lbf", scaled(4.4482216152605L, newton)},
    {"ozf", scaled(0.27801385095378125L, newton)},
    {"radian", radian},
    {"deg", scaled(1.0L / 360.0L, turn)},
    {"degree", scaled(1.0L / 360.0L, turn)},
    {"arcmin", scaled(1.0L / 21600.0L, turn)},
    {"arcsec", scaled(1.0L / 1296000.0L, turn)},
    {"rev", turn},
    {"revolution", turn},
    {"rpm", scaled(1.0L / 60.0L, hertz)},
    {"hertz", hertz},
    {"count", one},
    {"tick", one},
    {"%", scaled(0.01L, one)},
    // The plurals that are written.
    {"turns", turn},
    {"revs", turn},
    {"revolutions", turn},
    {"counts", one},
    {"ticks", one},
    {"degrees", scaled(1.0L / 360.0L, turn)},
    {"radians", radian},
    {"seconds", second},
    {"minutes", scaled(60.0L, second)},
    {"meters", metre},
    {"metres", metre},
    {"newtons", newton},
    {"grams", scaled(1e-3L, kilogram)},
    {"kilograms", kilogram},
    {"inches", scaled(0.0254L, metre)},
};

constexpr std::pair<std::string_view, long double> prefixes[] = {
    {"p", 1e-12L},    {"n", 1e-9L},     {"u", 1e-6L},     {"m", 1e-3L},   {"c", 1e-2L},
    {"d", 1e-1L},     {"k", 1e3L},      {"M", 1e6L},      {"G", 1e9L},    {"nano", 1e-9L},
    {"micro", 1e-6L}, {"milli", 1e-3L}, {"centi", 1e-2L}, {"kilo", 1e3L}, {"mega", 1e6L}};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%'; }
bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }

std::optional<Unit> plain_unit(std::string_view name) {
  const auto found = std::ranges::find(units, name, &NamedUnit::name);
  return found == std::end(units) ? std::nullopt : std::optional(found->unit);
}

/// The unit of a name, with a prefix or without.
std::optional<Unit> named_unit(std::string_view name) {
  if (const auto unit = plain_unit(name)) return unit;
  for (const auto& [prefix, factor] : prefixes) {
    if (!name.starts_with(prefix)) continue;
    if (const auto unit = plain_unit(name.substr(prefix.size()))) return scaled(factor, *unit);
  }
  return std::nullopt;
}

/// a b^exponent; none beyond the powers that a unit has.
std::optional<Unit> product_of(const Unit& a, const Unit& b, int exponent) {
  constexpr int largest_power = 99;
  Unit all = scaled(std::pow(b.factor, exponent), a);
  for (std::size_t i = 0; i < all.powers.size(); ++i) {
    all.powers[i] += exponent * b.powers[i];
    if (std::abs(all.powers[i]) > largest_power) return std::nullopt;
  }
  return all;
}

/// Reads products of powers; none where the text is none.
class UnitReader {
 public:
  explicit UnitReader(std::string_view text) : rest_(text) {}

  [[nodiscard]] std::optional<Unit> whole() {
    const std::optional<Unit> unit = product();
    skip_spaces();
    return rest_.empty() ? unit : std::nullopt;
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

  std::optional<Unit> product() {
    skip_spaces();
    std::optional<Unit> all = power(true);
    while (all) {
      const bool has_space = skip_spaces();
      if (rest_.empty() || rest_.front() == ')') break;
      const bool divides = take("/") || take_word("per");
      const bool by_sign = divides || take("*");
      const bool multiplies = by_sign || take(".") || take("-") || has_space;
      if (!multiplies) return std::nullopt;
      skip_spaces();
      // A number without a sign before it is a slip: "kg cm 2".
      const std::optional<Unit> next = power(by_sign);
      if (!next) return std::nullopt;
      all = product_of(*all, *next, divides ? -1 : 1);
    }
    return all;
  }

  /// A name, a number or a product in brackets, and its power.
  std::optional<Unit> power(bool may_be_number) {
    if (rest_.empty()) return std::nullopt;
    if (is_decimal_digit(rest_.front())) return may_be_number ? number() : std::nullopt;
    std::optional<Unit> unit;
    if (take("(")) {
      unit = product();
      if (!take(")")) return std::nullopt;
    } else {
      const auto end = std::ranges::find_if_not(rest_, is_letter);
      const std::string_view name(rest_.begin(), end);
      rest_.remove_prefix(name.size());
      unit = named_unit(name);
    }
    if (!unit) return std::nullopt;
    const bool has_sign = take("^") || take("**");
    const bool has_digit = rest_.size() > 1 && rest_.front() == '-' ? is_decimal_digit(rest_[1])
                                                                    : !rest_.empty() && is_decimal_digit(rest_.front());
    if (!has_digit) return has_sign ? std::nullopt : unit;
    const int sign = take("-") ? -1 : 1;
    const int exponent = sign * (rest_.front() - '0');
    rest_.remove_prefix(1);
    if (!rest_.empty() && (is_decimal_digit(rest_.front()) || is_letter(rest_.front()))) return std::nullopt;
    return product_of(one, *unit, exponent);
  }

  std::optional<Unit> number() {
    double value = 0.0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc{} || !(value > 0.0) || !std::isfinite(value)) return std::nullopt;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return scaled(value, one);
  }

  std::string_view rest_;
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

std::optional<long double> unit_factor(const std::string& unit, const std::string& wanted) {
  const std::optional<Unit> given = UnitReader(unit).whole();
  const std::optional<Unit> target = UnitReader(wanted).whole();
  if (!given || !target || given->powers != target->powers) return std::nullopt;
  const long double factor = given->factor / target->factor;
  const auto rounded = static_cast<double>(factor);
  return std::isfinite(rounded) && rounded > 0.0 ? std::optional(factor) : std::nullopt;
}

bool is_unit(const std::string& unit) { return UnitReader(unit).whole().has_value(); }

}  // namespace zwidth::internal
