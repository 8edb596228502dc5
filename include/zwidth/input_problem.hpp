#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "zwidth/option_problem.hpp"
#include "zwidth/option_text.hpp"

namespace zwidth {

/// Where a problem of the input lies, as far as it is known.
struct InputPlace {
  std::string file = {};    ///< file name, "standard input", or the name of what came in its place; may be empty
  std::size_t line = 0;     ///< from 1; 0 where there is no line
  std::size_t column = 0;   ///< from 1, in bytes; 0 where there is none
  std::string key = {};     ///< dotted key as in an override, or the name of a recording's column; may be empty
  std::string option = {};  ///< member of an options struct, "duration"; in a front, its name for that; may be empty
};

/// What is wrong with an input, and what to write instead: the one form in which refusals travel.
struct InputProblem {
  InputPlace place;                               ///< where
  std::string what;                               ///< what is wrong: "is -1"
  std::string allowed;                            ///< what is allowed, or the remedy; may be empty
  std::optional<std::string> suggestion;          ///< a value to put there, as an override takes it: "0.5 ms", "handle"
  std::vector<NamedOption> options_of_what = {};  ///< that `what` names
  std::vector<NamedOption> options_of_allowed = {};  ///< that `allowed` names
  std::optional<Problem> problem = {};               ///< what these are the words of, where it is data

  /// What is allowed, and the options that it names.
  void allow(OptionText remedy);
  /// Puts a text ahead of `what`.
  void begin_with(const std::string& text);
  /// Calls every option that the sentences name as `called` says; one for which it has no name stays as it is.
  void name_options(const std::function<std::optional<std::string>(const std::string&)>& called);

  /// One line: "OPTION: FILE:LINE:COLUMN: KEY: WHAT; ALLOWED", as far as there is each.
  [[nodiscard]] std::string str() const;
};

/// A place's problem, in the words of words/problem_text.hpp. What its phrase has in `backquotes` are options.
[[nodiscard]] InputProblem input_problem(InputPlace place, Problem problem, std::optional<std::string> suggestion = {});

/// What was found wrong with options, a device or a number with its unit, at a place.
template <typename FoundProblem>  // OptionProblem, DeviceProblem, UnitProblem
[[nodiscard]] InputProblem input_problem_of(const FoundProblem& found, InputPlace place = {}) {
  InputProblem told{std::move(place), found.what, found.allowed, {}};
  if constexpr (requires { found.suggestion; }) told.suggestion = found.suggestion;
  told.problem = found.problem;
  return told;
}

}  // namespace zwidth
