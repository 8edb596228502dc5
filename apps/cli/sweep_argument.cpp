#include "cli/sweep_argument.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "cli/subcommand.hpp"
#include "zwidth/io/message_words.hpp"
#include "zwidth/io/number_with_unit.hpp"

namespace zwidth::cli {
namespace {

[[noreturn]] void refuse(const std::string& argument, const std::string& why) {
  throw BadInput(
      fmt::format("--sweep: {}: {}; write KEY=FIRST:LAST:COUNT or KEY=FIRST:LAST:COUNT:log, for instance "
                  "loop.delay=0:8e-3:81",
                  in_quotes(argument), why));
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char letter : text) {
    if (letter == ':') {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

double end_of(const std::string& argument, const std::string& text, std::string_view which,
              std::optional<Measure> measure, Motion motion) {
  double value = 0.0;
  const bool has_unit = text.find_first_of("0123456789") != std::string::npos &&
                        text.find_first_not_of("0123456789.+-eE") != std::string::npos;
  if (measure && has_unit) {
    const auto number = number_with_unit(text, *measure, motion);
    if (!number) refuse(argument, fmt::format("{}: {}; {}", which, number.error().what, number.error().allowed));
    return *number;
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    refuse(argument, fmt::format("{} {} is no finite number", which, in_quotes(text)));
  }
  return value;
}

}  // namespace

SweepAxis sweep_axis(const std::string& argument, Motion motion) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos || equals == 0) refuse(argument, "has no KEY=");
  const std::vector<std::string> parts = split(argument.substr(equals + 1));
  if (parts.size() != 3 && parts.size() != 4) {
    refuse(argument, fmt::format("has {} parts after KEY=", parts.size()));
  }
  SweepAxis axis;
  axis.key = argument.substr(0, equals);
  // A body's inertia is its mass to the library.
  constexpr std::string_view inertia = ".inertia";
  if (axis.key.ends_with(inertia)) axis.key.replace(axis.key.size() - inertia.size(), inertia.size(), ".mass");
  const std::optional<Measure> measure = measure_of(axis.key);
  axis.first = end_of(argument, parts[0], "FIRST", measure, motion);
  axis.last = end_of(argument, parts[1], "LAST", measure, motion);
  const std::string& count = parts[2];
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), axis.count);
  if (error != std::errc{} || end != count.data() + count.size()) {
    refuse(argument, fmt::format("COUNT {} is no whole number", in_quotes(count)));
  }
  if (parts.size() == 4) {
    if (parts[3] != "log") refuse(argument, fmt::format("{} is not log", in_quotes(parts[3])));
    axis.spacing = SweepAxis::Spacing::logarithmic;
  }
  return axis;
}

}  // namespace zwidth::cli
