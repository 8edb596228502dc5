#include "io/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "io/device_reading.hpp"
#include "io/number_cell.hpp"
#include "io/prose.hpp"
#include "zwidth/io/message_words.hpp"
#include "zwidth/io/number_with_unit.hpp"

namespace zwidth::internal {
namespace {

// Each dot of a key may open a table in a table, and their destructors recurse; a line of a device file has few.
constexpr std::ptrdiff_t most_dots_in_line = 200;

struct LineOfText {
  std::size_t number = 1;
  std::size_t column = 1;
};

/// toml++ names the macro that sets a limit, which tells the user nothing.
std::string_view without_macro(std::string_view description) {
  return description.substr(0, description.find(" (TOML_"));
}

/// toml++ has no code for it, and says of a number too large for a double only that it is no value.
bool is_number_out_of_range(std::string_view description) {
  return (description.find("floating-point") != std::string_view::npos &&
          description.ends_with("could not be interpreted as a value")) ||
         description.find("is not representable in 64 bits") != std::string_view::npos;
}

std::optional<InputError> problem_of_text(std::string_view text, std::string_view source, std::string_view of) {
  const auto refusal = [&](LineOfText line, std::string what, std::string allowed) {
    return InputError{std::string(source), line.number, line.column, "", std::move(what), std::move(allowed)};
  };
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && text[first] == '{') {
    return refusal({1, 1}, "begins with a brace, as no TOML text does", fmt::format("must be the TOML text of {}", of));
  }
  std::size_t number = 1;
  for (std::size_t begin = 0; begin <= text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    if (const auto nul = line.find('\0'); nul != std::string_view::npos) {
      return refusal({number, nul + 1}, "is not text: it has a zero byte",
                     fmt::format("must be the TOML text of {}", of));
    }
    if (std::ranges::count(line, '.') > most_dots_in_line) {
      return refusal({number, 1}, fmt::format("the line has more than {} dots", most_dots_in_line),
                     "break it into several lines");
    }
    begin = end + 1;
  }
  return std::nullopt;
}

/// "KEY = VALUE" of a line, without its comment; both empty where the line is none.
struct Assignment {
  std::string_view key;
  std::string_view value;
};

Assignment assignment_of(std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) return {};
  std::string_view value = line.substr(equals + 1);
  if (value.find_first_of("\"'") == std::string_view::npos) value = value.substr(0, value.find('#'));
  return {trimmed(line.substr(0, equals)), trimmed(value)};
}

/// The dotted key of an assignment in the line at `at`: below its header, whose table may have a name.
std::string key_in_text(std::string_view text, std::size_t at, std::string_view key) {
  std::string table;
  std::string name;
  std::map<std::string, std::size_t, std::less<>> counts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(text.substr(begin, end - begin));
    if (line.starts_with('[')) {
      if (begin > at) break;
      const bool is_of_many = line.starts_with("[[");
      const std::size_t first = is_of_many ? 2 : 1;
      table = trimmed(line.substr(first, std::max(line.find(']'), first) - first));
      if (is_of_many) table = fmt::format("{}.{}", table, counts[table]++);
      name.clear();
    } else if (const Assignment own = assignment_of(line); own.key == "name" && own.value.size() > 2) {
      name = own.value.substr(1, own.value.size() - 2);
    }
    begin = end + 1;
  }
  if (!name.empty() && table.starts_with("body.")) table = "body." + name;
  return table.empty() ? std::string(key) : fmt::format("{}.{}", table, key);
}

/// What to write for a text without quotes: with its unit the one that is measured, where that can be told.
std::string meant_by(std::string_view key, std::string_view value) {
  const std::optional<Measure> measure = measure_of(key);
  for (const Motion motion : {Motion::linear, Motion::rotary}) {
    if (!measure) break;
    const auto number = number_with_unit(value, *measure, motion);
    if (number) break;
    if (number.error().suggestion) return *number.error().suggestion;
  }
  return std::string(value);
}

/// The two slips that make a line no TOML: a text without quotes, and a comma for the decimal mark.
std::optional<InputError> problem_of_line(std::string_view text, std::string_view source, std::size_t number) {
  std::size_t begin = 0;
  for (std::size_t i = 1; i < number && begin < text.size(); ++i)
    begin = std::min(text.find('\n', begin), text.size()) + 1;
  if (begin >= text.size()) return std::nullopt;
  const std::string_view line = text.substr(begin, text.find('\n', begin) - begin);
  const auto [key, value] = assignment_of(line);
  const bool is_plain_key = !key.empty() && std::ranges::all_of(key, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  });
  const bool is_number = value.find_first_not_of("+-.,0123456789eE_") == std::string_view::npos;
  const bool has_comma = is_number && value.find(',') != std::string_view::npos;
  if (!is_plain_key || !(has_comma || (is_bare_text(value) && !is_number)) ||
      value.find_first_of("[]{}'") != std::string_view::npos ||
      toml::parse(fmt::format("value = {}", value)).succeeded()) {
    return std::nullopt;
  }
  InputError error(std::string(source), number, static_cast<std::size_t>(value.data() - line.data()) + 1,
                   key_in_text(text, begin, key), fmt::format("{} has a comma", in_quotes(value)),
                   "the decimal mark is a point, and nothing stands between thousands");
  error.suggestion = with_decimal_point(value);
  if (has_comma && error.suggestion) error.allowed = fmt::format("the decimal mark is a point: {}", *error.suggestion);
  if (!has_comma) {
    error.suggestion = meant_by(error.place.key, value);
    error.what = fmt::format("the text {} has no quotes", shortened(value));
    error.allowed = fmt::format("write {}", in_quotes(*error.suggestion));
  }
  return error;
}

}  // namespace

bool is_bare_text(std::string_view text) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '%' || (c & 0x80);
  };
  if (text.empty() || text.find_first_of("\"\\") != std::string_view::npos) return false;
  if (is_letter(text.front())) return true;
  return std::string_view(".+-0123456789").find(text.front()) != std::string_view::npos &&
         std::ranges::any_of(text, is_letter);
}

tl::expected<toml::table, InputError> parse_toml(std::string_view text, std::string_view source, std::string_view of) {
  if (auto problem = problem_of_text(text, source, of)) return tl::unexpected(std::move(*problem));
  toml::parse_result parsed = toml::parse(text, source);
  if (parsed.failed()) {
    const toml::parse_error& error = parsed.error();
    const std::size_t line = std::max<std::size_t>(1, error.source().begin.line);
    if (auto problem = problem_of_line(text, source, line)) return tl::unexpected(*std::move(problem));
    const bool is_out_of_range = is_number_out_of_range(error.description());
    return tl::unexpected(
        InputError{std::string(source), line, std::max<std::size_t>(1, error.source().begin.column), "",
                   is_out_of_range ? std::string(number_out_of_range)
                                   : fmt::format("is not TOML: {}", without_macro(error.description())),
                   is_out_of_range ? std::string(number_range) : fmt::format("must be the TOML text of {}", of)});
  }
  return std::move(parsed).table();
}

toml::source_region override_region() {
  static const auto path = std::make_shared<const std::string>(override_source);
  return {.begin = {}, .end = {}, .path = path};
}

}  // namespace zwidth::internal
