#include "io/response_columns.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <numbers>
#include <string_view>
#include <utility>

#include "io/column_names.hpp"
#include "io/prose.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

using Refusal = tl::unexpected<InputError>;
using Words = std::span<const std::string_view>;

constexpr double rad_s_per_hertz = 2.0 * std::numbers::pi;  // rad/s

// The first word is what the column is called in messages.
constexpr std::array<std::string_view, 8> frequency_words{"frequency", "frequencies", "freq", "freqs",
                                                          "f",         "hz",          "w",    "omega"};
constexpr std::array<std::string_view, 7> magnitude_words{"magnitude", "mag", "amplitude", "amp",
                                                          "gain",      "abs", "modulus"};
constexpr std::array<std::string_view, 4> phase_words{"phase", "arg", "angle", "argument"};
constexpr std::array<std::string_view, 2> real_words{"real", "re"};
constexpr std::array<std::string_view, 3> imaginary_words{"imaginary", "imag", "im"};

bool is_one_of(std::string_view word, Words words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return is_one_of(word, Words(words.begin(), words.size()));
}

/// What a column's name says, in lower case: "Phase [deg]" and "phase_deg" are phase in deg.
struct Meaning {
  std::string word;
  std::string unit;
};

Meaning meaning_of(const std::string& column) {
  std::string lower(column);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto [name, unit] = name_and_unit(lower);
  if (!unit.empty()) return {std::string(name), std::string(unit)};
  for (const std::string_view ending : {"_rad_s", "_khz", "_hz", "_db", "_degrees", "_deg", "_rad"}) {
    if (name.size() > ending.size() && name.ends_with(ending)) {
      return {std::string(name.substr(0, name.size() - ending.size())), std::string(ending.substr(1))};
    }
  }
  const bool is_angular = name == "w" || name == "omega";
  return {std::string(name), is_angular ? "rad/s" : ""};
}

/// rad/s per unit of frequency; nothing where the word is none.
std::optional<double> rad_s_per(std::string_view unit) {
  if (is_one_of(unit, {"hz", "1/s"})) return rad_s_per_hertz;
  if (unit == "khz") return 1e3 * rad_s_per_hertz;
  if (is_one_of(unit, {"rad/s", "rad_s", "rad/sec"})) return 1.0;
  return std::nullopt;
}

class Search {
 public:
  Search(std::span<const std::string> names, const ResponseTableOptions& options, const std::string& source)
      : names_(names), options_(options), source_(source) {}

  tl::expected<ResponseColumns, InputError> columns();

 private:
  using Found = tl::expected<std::optional<std::size_t>, InputError>;
  [[nodiscard]] Found named(const std::string& asked) const;
  /// The column asked for, or else the one whose name says so; nothing where there is none.
  [[nodiscard]] Found find(const std::string& asked, Words words) const;
  [[nodiscard]] std::optional<std::size_t> frequency_by_name() const;
  tl::expected<void, InputError> find_frequency();
  tl::expected<void, InputError> find_values();
  tl::expected<void, InputError> find_pair(ResponseColumns::Form form, const std::string& first, Words first_words,
                                           const std::string& second, Words second_words);
  void use_units_of_names();
  [[nodiscard]] Refusal refused(Problem problem, std::string key = {}) const {
    return Refusal(InputError{{.file = source_, .key = std::move(key)}, std::move(problem)});
  }
  /// No column is this part of the response; empty: which columns are any is not known.
  [[nodiscard]] Refusal no_column(std::string_view quantity) const {
    Problem problem{.code = ProblemCode::no_response_column, .subjects = {{"names", listed(names_)}}};
    if (!quantity.empty()) problem.subjects.push_back({"quantity", std::string(quantity)});
    return refused(std::move(problem));
  }

  std::span<const std::string> names_;
  const ResponseTableOptions& options_;
  const std::string& source_;
  ResponseColumns found_;
};

Search::Found Search::named(const std::string& asked) const {
  const auto column = find_column(names_, asked, source_);
  if (!column) return Refusal(column.error());
  return *column;
}

Search::Found Search::find(const std::string& asked, Words words) const {
  if (!asked.empty()) return named(asked);
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!is_one_of(meaning_of(names_[i]).word, words)) continue;
    if (found) {
      return refused({.code = ProblemCode::response_column_ambiguous,
                      .subjects = {{"first", in_quotes(names_[*found])},
                                   {"second", in_quotes(names_[i])},
                                   {"quantity", std::string(words.front())}}});
    }
    found = i;
  }
  return found;
}

/// Among several (frequency_hz beside frequency_rad_s), the one in the unit of the options.
std::optional<std::size_t> Search::frequency_by_name() const {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const Meaning meaning = meaning_of(names_[i]);
    if (!is_one_of(meaning.word, frequency_words)) continue;
    if (!found || rad_s_per(meaning.unit) == options_.frequency_scale.value_or(rad_s_per_hertz)) found = i;
  }
  return found;
}

tl::expected<void, InputError> Search::find_frequency() {
  if (options_.frequency_step > 0.0) {
    if (options_.frequency.empty()) return {};
    return refused({.code = ProblemCode::asked_for_beside, .subjects = {{"of", "frequencies"}}},
                   shortened(options_.frequency));
  }
  if (!options_.frequency.empty()) {
    const auto column = named(options_.frequency);
    if (!column) return Refusal(column.error());
    found_.frequency = *column;
    return {};
  }
  if (names_.size() == 1) return no_column(frequency_words.front());
  found_.frequency = frequency_by_name().value_or(0);
  return {};
}

tl::expected<void, InputError> Search::find_pair(ResponseColumns::Form form, const std::string& first,
                                                 Words first_words, const std::string& second, Words second_words) {
  const auto a = find(first, first_words);
  if (!a) return Refusal(a.error());
  const auto b = find(second, second_words);
  if (!b) return Refusal(b.error());
  if (!*a || !*b) return no_column(*a ? second_words.front() : first_words.front());
  found_.form = form;
  found_.first = **a;
  found_.second = **b;
  return {};
}

tl::expected<void, InputError> Search::find_values() {
  using Form = ResponseColumns::Form;
  const auto& o = options_;
  const auto has = [&](Words words) {
    return std::any_of(names_.begin(), names_.end(),
                       [&](const std::string& name) { return is_one_of(meaning_of(name).word, words); });
  };
  if (!o.magnitude.empty() || !o.phase.empty()) {
    return find_pair(Form::magnitude_and_phase, o.magnitude, magnitude_words, o.phase, phase_words);
  }
  if (!o.imaginary.empty()) {
    return find_pair(Form::real_and_imaginary, o.real, real_words, o.imaginary, imaginary_words);
  }
  if (!o.real.empty()) {
    const auto column = named(o.real);
    if (!column) return Refusal(column.error());
    found_.first = **column;
    return {};
  }
  if (has(magnitude_words) && has(phase_words)) {
    return find_pair(Form::magnitude_and_phase, o.magnitude, magnitude_words, o.phase, phase_words);
  }
  if (has(real_words) && has(imaginary_words)) {
    return find_pair(Form::real_and_imaginary, o.real, real_words, o.imaginary, imaginary_words);
  }
  const std::size_t taken = found_.frequency ? 1 : 0;
  if (names_.size() == taken + 1) {
    found_.first = found_.frequency == std::size_t{0} ? 1 : 0;
    return {};
  }
  return no_column({});
}

void Search::use_units_of_names() {
  const auto remark = [&](std::size_t column, std::string unit) {
    found_.remarks.push_back(note({.code = FindingCode::column_read_in_unit,
                                   .subjects = {{"column", in_quotes(names_[column])}, {"unit", std::move(unit)}}}));
  };
  found_.frequency_scale = options_.frequency_scale.value_or(rad_s_per_hertz);
  if (found_.frequency && !options_.frequency_scale) {
    const std::string unit = meaning_of(names_[*found_.frequency]).unit;
    const double scale = rad_s_per(unit).value_or(rad_s_per_hertz);
    if (scale != rad_s_per_hertz) remark(*found_.frequency, unit);
    found_.frequency_scale = scale;
  }
  found_.magnitude_in_db = options_.magnitude_in_db;
  found_.phase_in_degrees = options_.phase_in_degrees.value_or(true);
  if (found_.form != ResponseColumns::Form::magnitude_and_phase) return;
  if (!found_.magnitude_in_db && meaning_of(names_[found_.first]).unit == "db") {
    found_.magnitude_in_db = true;
    remark(found_.first, "dB");
  }
  if (options_.phase_in_degrees) return;
  const std::string phase_unit = meaning_of(names_[found_.second]).unit;
  const bool says_radians = is_one_of(phase_unit, {"rad", "radians"});
  if (says_radians) {
    found_.phase_in_degrees = false;
    remark(found_.second, "radians");
  }
}

tl::expected<ResponseColumns, InputError> Search::columns() {
  if (auto found = find_frequency(); !found) return Refusal(std::move(found.error()));
  if (auto found = find_values(); !found) return Refusal(std::move(found.error()));
  if (options_.coherence) {
    const auto column = named(*options_.coherence);
    if (!column) return Refusal(column.error());
    found_.coherence = *column;
  }
  use_units_of_names();
  return std::move(found_);
}

}  // namespace

tl::expected<ResponseColumns, InputError> find_response_columns(std::span<const std::string> names,
                                                                const ResponseTableOptions& options,
                                                                const std::string& source) {
  return Search(names, options, source).columns();
}

}  // namespace zwidth::internal
