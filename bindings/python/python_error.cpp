#include "python_error.hpp"

#include <pybind11/stl.h>

#include "results/json.hpp"

namespace zwidth::python {
namespace py = pybind11;
namespace {

py::object error_class(const char* name) { return py::module_::import("zwidth._errors").attr(name); }

[[noreturn]] void raise(const char* name, const py::tuple& arguments) {
  const py::object raised = error_class(name);
  PyErr_SetObject(raised.ptr(), raised(*arguments).ptr());
  throw py::error_already_set();
}

}  // namespace

void raise_input_error(const std::string& where, const std::string& what, const std::string& allowed) {
  raise("InputError", py::make_tuple(where, what, allowed));
}

void raise_input_error(const InputError& error) {
  if (error.source == override_source) raise_input_error("device." + error.key, error.what, error.allowed);
  std::string where = error.source;
  if (error.line > 0) where += ":" + std::to_string(error.line);
  if (error.column > 0) where += ":" + std::to_string(error.column);
  if (!error.key.empty()) where += (where.empty() ? "" : ": ") + error.key;
  raise_input_error(where, error.what, error.allowed);
}

void raise_input_error(const DeviceProblem& problem) { raise_input_error(problem.key, problem.what, problem.allowed); }

void raise_work_failed(const std::string& what) { raise("WorkFailed", py::make_tuple(what)); }

void warn_of(const Trust& trust) {
  if (trust.sound()) return;
  const py::object warn = py::module_::import("zwidth._errors").attr("warn_of_trust");
  warn(results::name_of(trust.verdict), py::cast(trust.reasons));
}

}  // namespace zwidth::python
