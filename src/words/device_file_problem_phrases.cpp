#include <array>

#include "words/problem_phrase.hpp"

namespace zwidth::internal {
namespace {

// What must stand in a place, by the name of NeededValue.
constexpr const char* needed =
    "{?element|every element }{?row|every row }must be {?missing|given{!needed=gain| as }}"
    "{?needed=gain|, or damping, or both}"
    "{?needed=number|a number}"
    "{?needed=positive|a number > 0}"
    "{?needed=measured|a number{?in| of {in}}, or a text with its unit such as \"{example}\"}"
    "{?needed=text|text in quotes}"
    "{?needed=choice|one of {example}}"
    "{?needed=numbers|an array of numbers}"
    "{?needed=rows|an array of rows, each an array of numbers}"
    "{?needed=texts|an array of texts}"
    "{?needed=keys|an array of keys such as \"{example}\"}"
    "{?needed=key|a key such as \"{example}\"}"
    "{?needed=file|the name of a file of numbers, one per line, a weight beside it}"
    "{?needed=bodies|an array of two body names}"
    "{?needed=loop|[loop] with sampling_period in seconds}"
    "{?needed=table|a table, {example}}"
    "{?needed=tables|tables, {example}}";

constexpr const char* key_remedy =
    "{?meant|did you mean \"{meant}\"?}"
    "{?homes|it belongs in {homes}}"
    "{?keys|the keys{?table| of {table}} are {keys}}"
    "{?same|did you mean \"{same}\"{?of| of {of}}{?rotary|, or of rotary motion \"{rotary}\"}"
    "{?in|, in {in}{?in_rotary| or of rotary motion {in_rotary}}}?}"
    "{?result|write {result}{?of| of {of}}{?in| in {in}}, which is {formula}{?example|: {example}}"
    "{?per_line| (of N lines with quadrature: {per_line} N counts)}}"
    "{?kinds=friction|write damping for viscous friction (N s/m), coulomb for dry friction (N)}"
    "{?kinds=velocity_filter|write velocity_filter_hz, or velocity_filter_tau for backward Euler's time constant in s}"
    "{?kinds=ends|write between = [\"BODY\", \"BODY\"]}";

}  // namespace

std::span<const ProblemPhrase> device_file_problem_phrases() {
  using enum ProblemCode;
  static constexpr std::array phrases{
      ProblemPhrase{of_other_type, "of_other_type",
                    "is {?text|the text \"{text}\"}{?number|the number {number:exact}}{?kind=true|true}"
                    "{?kind=false|false}{?kind=array|an array}{?kind=table|a table}{?kind=time|a date or time}",
                    needed},
      ProblemPhrase{is_missing, "is_missing", "is missing", needed},
      ProblemPhrase{unknown_key, "unknown_key", "unknown key \"{name}\"", key_remedy},
      ProblemPhrase{key_of_other_filters, "key_of_other_filters", "is no key of a filter of type \"{type}\"",
                    "its keys are {keys}"},
      ProblemPhrase{no_such_name, "no_such_name", "there is no {what} \"{name}\"",
                    "{?meant|did you mean \"{meant}\"?}{?bodies|the bodies are {bodies}}"
                    "{?last|must be {what}.0 to {what}.{last:n}}"},
      ProblemPhrase{given_beside, "given_beside", "is given beside {other}",
                    "must be {?both|either it, or lower and upper}{!both|one of the two}"},
      ProblemPhrase{damping_of_first_order, "damping_of_first_order", "stands beside order 1, which has none",
                    "must be left out, or set order = 2"},
      ProblemPhrase{inertia_of_linear_motion, "inertia_of_linear_motion", "is for rotary motion",
                    "must be \"mass\", or set motion = \"rotary\""},
      ProblemPhrase{not_two_bodies, "not_two_bodies", "has length {length:n}", "must name two bodies"},
      ProblemPhrase{number_beyond_range, "number_beyond_range",
                    "{?value|is {value:exact}}{!value|the number is out of range}",
                    "must be 0 or from 1e-30 to 1e30 {?in|(in {in})}"
                    "{!in|in magnitude (coefficients: 1e-100 to 1e100)}"},
      ProblemPhrase{number_without_unit, "number_without_unit", "\"{text}\" has no unit", needed},
      ProblemPhrase{decimal_comma, "decimal_comma", "\"{text}\" has a comma",
                    "the decimal mark is a point{?meant|: {meant}}{!meant|, and nothing stands between thousands}"},
      ProblemPhrase{unknown_unit, "unknown_unit", "cannot read the unit \"{unit}\"",
                    "{?meant|did you mean \"{meant}\"?}{!meant|must be a number{?in| of {in}}, or a text with its unit "
                    "such as \"{example}\"}"},
      ProblemPhrase{unit_of_other_measure, "unit_of_other_measure",
                    "\"{unit}\" is no unit of {?vowel|an}{!vowel|a} {measure}",
                    "{?period|a period is 1/frequency: \"{period}\"}{?step|a step is its inverse: \"{step}\"}"
                    "{?example|must be a number{?in| of {in}}, or a text with its unit such as \"{example}\"}"},
      ProblemPhrase{not_toml, "not_toml",
                    "{?reason|is not TOML: {reason}}{?kind=brace|begins with a brace, as no TOML text does}"
                    "{?kind=zero_byte|is not text: it has a zero byte}",
                    "must be the TOML text of {of}"},
      ProblemPhrase{too_many_dots, "too_many_dots", "the line has more than {most:n} dots",
                    "break it into several lines"},
      ProblemPhrase{text_without_quotes, "text_without_quotes", "the text {text} has no quotes", "write \"{meant}\""},
      ProblemPhrase{not_an_assignment, "not_an_assignment", "{?text|\"{text}\" }is not {form}",
                    "write for instance {example}"},
      ProblemPhrase{not_a_toml_value, "not_a_toml_value", "cannot read the value \"{text}\"",
                    "must be a TOML value such as 0.25e-3, \"handle\" or [1, 2], or a number with its unit"},
      ProblemPhrase{in_several_tables, "in_several_tables", "could be in any of {count:n} {header}",
                    "write for instance {example}"},
      ProblemPhrase{no_table_to_override, "no_table_to_override", "the device has no {header}",
                    "{?example|to add one write {example}}"
                    "{!example|an override changes what the file has; it adds no body or link}"},
      ProblemPhrase{value_and_no_table, "value_and_no_table", "\"{name}\" is one value, not a table",
                    "write {name}=VALUE"},
      ProblemPhrase{one_variant, "one_variant", "has one value", "give two or more"},
      ProblemPhrase{cannot_be_read, "cannot_be_read", "cannot be read: {reason}",
                    "must be a readable {kind}, or \"-\" for standard input"},
      ProblemPhrase{not_a_file, "not_a_file",
                    "is {?found=nothing|no file name}{?found=directory|a directory}"
                    "{?found=device|neither a file nor a pipe}",
                    "must be a {kind}{!found=directory|, or \"-\" for standard input}"},
      ProblemPhrase{too_many_bytes_read, "too_many_bytes_read",
                    "{?line|the line is longer}{!line|is larger} than {most:n} MiB",
                    "must be a {?line|table of numbers with a line for each sample}"
                    "{!line|{kind}, which takes a few hundred bytes}"}};
  return phrases;
}

}  // namespace zwidth::internal
