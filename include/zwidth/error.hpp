#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "zwidth/input_problem.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth {

/// What a caller did wrong, or what could not be computed.
enum class ErrorCode {
  invalid_argument,  ///< a value outside its documented domain (NaN, negative mass, wrong index)
  no_such_body,      ///< a body is named that the device does not have
  needs_bodies,      ///< asked of a transfer-function device what only a device of bodies has
  did_not_converge,  ///< an iteration hit its documented cap
};

/// The one exception of the library: a bug of the caller, or a computation that failed.
///
/// Bad *input files* never throw: they return `tl::expected` with the place (see io/device_file.hpp).
class Error : public std::runtime_error {
 public:
  /// A message of one line, with the value that offends.
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  /// The same of arguments, with what is wrong with each.
  Error(ErrorCode code, const std::string& message, std::vector<InputProblem> problems)
      : std::runtime_error(message), code_(code), problems_(std::move(problems)) {}
  /// In the words of a problem: "what; allowed".
  Error(ErrorCode code, const Problem& problem);
  /// What kind of failure it is.
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  /// What is wrong with the arguments: members of an options struct or keys of a device; empty where no more is known
  /// than the message.
  [[nodiscard]] const std::vector<InputProblem>& problems() const noexcept { return problems_; }

 private:
  ErrorCode code_;
  std::vector<InputProblem> problems_;
};

}  // namespace zwidth
