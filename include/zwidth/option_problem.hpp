#pragma once

#include <string>

namespace zwidth {

/// Why an options struct cannot be used: what find_problem(options) of each of them answers.
struct OptionProblem {
  std::string member;   ///< of the options struct, as in C++: "duration", "controller.position"
  std::string what;     ///< "is -1 s"
  std::string allowed;  ///< "must be finite and > 0"
};

}  // namespace zwidth
