#include "cli/sweep_argument.hpp"

#include <fmt/format.h>

#include <charconv>
#include <vector>

#include "cli/option_units.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/io/message_words.hpp"

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

double end_of(const std::string& argument, const std::string& text, std::string_view which, Measure measure,
              Motion motion) {
  const auto number = measured_number(text, measure, motion);
  if (!number) refuse(argument, fmt::format("{}: {}; {}", which, number.error().what, number.error().allowed));
  return *number;
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
  const Measure measure = measure_of(axis.key).value_or(Measure::ratio);
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
