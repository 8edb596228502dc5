#include "cli/users_argument.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <string_view>
#include <vector>

#include "cli/option_units.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::cli {
namespace {

constexpr std::string_view example = "for instance mass=0:2,damping=0:30,stiffness=0:1000";

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = text.find(separator); end != std::string::npos; end = text.find(separator, begin)) {
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

/// One of the three ranges that --users may name.
struct Named {
  std::optional<ValueRange>* range = nullptr;
  Measure measure = Measure::mass;
};

ValueRange range_in(const std::string& key, const std::string& text, Measure measure, Motion motion) {
  const std::vector<std::string> ends = split(text, ':');
  const std::string option = "--users: " + key;
  const auto least_given = measured_number(ends.front(), measure, motion);
  const auto greatest_given = measured_number(ends.back(), measure, motion);
  if (ends.size() > 2 || !least_given || !greatest_given) {
    const UnitProblem* problem = !least_given      ? &least_given.error()
                                 : !greatest_given ? &greatest_given.error()
                                                   : nullptr;
    throw BadInput(fmt::format("{}: '{}' must be LEAST:GREATEST or one number{}", option, text,
                               problem ? ": " + problem->what + "; " + problem->allowed : ""));
  }
  return {*least_given, *greatest_given};
}

Named place_of(UserRanges& ranges, const std::string& key) {
  if (key == "mass" || key == "inertia") return {&ranges.mass, Measure::mass};
  if (key == "damping") return {&ranges.damping, Measure::damping};
  if (key == "stiffness") return {&ranges.stiffness, Measure::stiffness};
  return {};
}

}  // namespace

UserRanges user_ranges(const std::string& text, Motion motion) {
  UserRanges ranges;
  for (const std::string& part : split(text, ',')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos) {
      throw BadInput(fmt::format("--users: '{}' must be KEY=LEAST:GREATEST; {}", part, example));
    }
    const std::string key = part.substr(0, equals);
    const Named named = place_of(ranges, key);
    if (named.range == nullptr) {
      const std::string nearest =
          nearest_word(key, std::vector<std::string>{"mass", "inertia", "damping", "stiffness"});
      throw BadInput(
          fmt::format("--users: there is no key '{}'; {}", key,
                      nearest.empty() ? "one of mass, damping, stiffness" : "did you mean " + nearest + "?"));
    }
    if (*named.range) throw BadInput(fmt::format("--users: {} is given twice", key));
    *named.range = range_in(key, part.substr(equals + 1), named.measure, motion);
  }
  return ranges;
}

}  // namespace zwidth::cli
