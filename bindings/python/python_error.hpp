#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "server/api/command_request.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/input_error.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::python {

/// Raises zwidth.InputError with the problem, and the others of the same input.
[[noreturn]] void raise_input_error(const server::Problem& problem);

/// The same of a place that is no more than a name.
[[noreturn]] void raise_input_error(const std::string& where, const std::string& what, const std::string& allowed);

/// The same of what the library refuses: where is "FILE:LINE:COLUMN: key", as far as there is each.
[[noreturn]] void raise_input_error(const InputError& error);
[[noreturn]] void raise_input_error(const DeviceProblem& problem);
/// The same of an error with its problems; `where` of what has no place.
[[noreturn]] void raise_input_error(const Error& error, const std::string& where);

/// Raises zwidth.WorkFailed.
[[noreturn]] void raise_work_failed(const std::string& what);

/// Warns with zwidth.DoubtfulResult unless it is sound; raises that where warnings are errors.
void warn_of(const Trust& trust);

}  // namespace zwidth::python
