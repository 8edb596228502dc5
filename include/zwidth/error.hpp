#pragma once

#include <stdexcept>
#include <string>

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
  /// What kind of failure it is.
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace zwidth
