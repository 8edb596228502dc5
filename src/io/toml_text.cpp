#include "io/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "io/device_reading.hpp"

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

}  // namespace

tl::expected<toml::table, InputError> parse_toml(std::string_view text, std::string_view source, std::string_view of) {
  if (auto problem = problem_of_text(text, source, of)) return tl::unexpected(std::move(*problem));
  toml::parse_result parsed = toml::parse(text, source);
  if (parsed.failed()) {
    const toml::parse_error& error = parsed.error();
    const bool is_out_of_range = is_number_out_of_range(error.description());
    return tl::unexpected(InputError{
        .source = std::string(source),
        .line = std::max<std::size_t>(1, error.source().begin.line),
        .column = std::max<std::size_t>(1, error.source().begin.column),
        .key = "",
        .what = is_out_of_range ? std::string(number_out_of_range)
                                : fmt::format("is not TOML: {}", without_macro(error.description())),
        .allowed = is_out_of_range ? std::string(number_range) : fmt::format("must be the TOML text of {}", of)});
  }
  return std::move(parsed).table();
}

toml::source_region override_region() {
  static const auto path = std::make_shared<const std::string>(override_source);
  return {.begin = {}, .end = {}, .path = path};
}

}  // namespace zwidth::internal
