#include "cli/users_argument.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <string_view>
#include <vector>

#include "cli/number_text.hpp"
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

ValueRange range_in(const std::string& key, const std::string& text) {
  const std::vector<std::string> ends = split(text, ':');
  const auto least = number_in(ends.front());
  const auto greatest = number_in(ends.back());
  if (ends.size() > 2 || !least || !greatest) {
    throw BadInput(fmt::format("--users: {}: '{}' must be LEAST:GREATEST or one number, at most 1e30", key, text));
  }
  if (*least < 0.0) throw BadInput(fmt::format("--users: {}: {} is negative; a passive user has none", key, *least));
  if (*greatest < *least) {
    throw BadInput(fmt::format("--users: {}: {} is reversed; did you mean {}:{}?", key, text, *greatest, *least));
  }
  return {*least, *greatest};
}

std::optional<ValueRange>* place_of(UserRanges& ranges, const std::string& key) {
  if (key == "mass" || key == "inertia") return &ranges.mass;
  if (key == "damping") return &ranges.damping;
  if (key == "stiffness") return &ranges.stiffness;
  return nullptr;
}

}  // namespace

UserRanges user_ranges(const std::string& text) {
  UserRanges ranges;
  for (const std::string& part : split(text, ',')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos) {
      throw BadInput(fmt::format("--users: '{}' must be KEY=LEAST:GREATEST; {}", part, example));
    }
    const std::string key = part.substr(0, equals);
    std::optional<ValueRange>* place = place_of(ranges, key);
    if (place == nullptr) {
      const std::string nearest =
          nearest_word(key, std::vector<std::string>{"mass", "inertia", "damping", "stiffness"});
      throw BadInput(
          fmt::format("--users: there is no key '{}'; {}", key,
                      nearest.empty() ? "one of mass, damping, stiffness" : "did you mean " + nearest + "?"));
    }
    if (*place) throw BadInput(fmt::format("--users: {} is given twice", key));
    *place = range_in(key, part.substr(equals + 1));
  }
  return ranges;
}

UserFamily user_family(const UserRanges& ranges, const Operator& own) {
  return {ranges.mass.value_or(ValueRange{own.mass, own.mass}),
          ranges.damping.value_or(ValueRange{own.damping, own.damping}),
          ranges.stiffness.value_or(ValueRange{own.stiffness, own.stiffness})};
}

}  // namespace zwidth::cli
