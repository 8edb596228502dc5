#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "io/prose.hpp"
#include "zwidth/io/number_with_unit.hpp"
#include "zwidth/model/device_key.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth::internal {

/// What must stand in a place, by the name that the phrases of `of_other_type` and `is_missing` have for it.
struct NeededValue {
  std::string_view what;     ///< "number", "positive", "measured", "text", "choice", "keys", "tables"
  std::string example = {};  ///< of what is measured, of keys; the choices; how a table's header is written
  std::string unit = {};     ///< of a plain number of what is measured; empty: a ratio
};

/// A number of what is measured.
[[nodiscard]] NeededValue needed_number(Measure measure, Motion motion);

/// Why a number with a comma for its decimal mark is none.
[[nodiscard]] UnitProblem comma_problem(std::string_view text);

/// A problem whose sentence says what is needed.
[[nodiscard]] inline Problem needs(ProblemCode code, NeededValue needed) {
  Problem problem{.code = code, .subjects = {{"needed", std::string(needed.what)}}};
  if (!needed.example.empty()) problem.subjects.push_back({"example", std::move(needed.example)});
  if (!needed.unit.empty()) problem.subjects.push_back({"in", std::move(needed.unit)});
  return problem;
}

/// A text that is none of the choices: `meant` is the one that it was probably to be, empty where there is none.
[[nodiscard]] inline Problem not_one_of(std::string_view given, std::string choices, std::string meant = {}) {
  Problem problem{.code = ProblemCode::not_one_of, .subjects = {{"given", shortened(given)}}};
  problem.subjects.push_back(meant.empty() ? Subject{"choices", std::move(choices)}
                                           : Subject{"meant", std::move(meant)});
  return problem;
}

/// No body is called that; `meant` as above.
[[nodiscard]] inline Problem no_such_body(std::string_view name, std::span<const std::string> bodies,
                                          const std::string& meant) {
  return {.code = ProblemCode::no_such_name,
          .subjects = {{"what", "body"},
                       {"name", shortened(name)},
                       meant.empty() ? Subject{"bodies", listed(bodies)} : Subject{"meant", meant}}};
}

/// A word to put in place of another; none where it is empty.
[[nodiscard]] inline std::optional<std::string> suggested(const std::string& meant) {
  return meant.empty() ? std::nullopt : std::optional(meant);
}

}  // namespace zwidth::internal
