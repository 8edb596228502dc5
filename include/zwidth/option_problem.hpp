#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/finding.hpp"
#include "zwidth/problem_code.hpp"

namespace zwidth {

/// Why an option cannot be used, as data.
struct Problem {
  ProblemCode code = ProblemCode::of_the_device;  ///< what is wrong
  std::vector<Evidence> evidence = {};            ///< the value, and the bounds that it is held to
  std::vector<Subject> subjects = {};             ///< the names
  [[nodiscard]] bool operator==(const Problem&) const = default;
};

/// Why an options struct cannot be used: what find_problem(options) of each of them answers.
struct OptionProblem {
  std::string member;                   ///< of the options struct, as in C++: "duration", "controller.position"
  std::string what;                     ///< "is -1 s"
  std::string allowed;                  ///< "must be finite and > 0"
  std::optional<Problem> problem = {};  ///< what these are the words of, where it is data
};

/// A member's problem, in the words of words/problem_text.hpp.
[[nodiscard]] OptionProblem option_problem(std::string member, Problem problem);

}  // namespace zwidth
