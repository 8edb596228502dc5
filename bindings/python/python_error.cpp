#include "python_error.hpp"

#include <pybind11/stl.h>

#include <utility>

#include "results/json.hpp"
#include "zwidth/words/problem_text.hpp"

namespace zwidth::python {
namespace py = pybind11;
namespace {

py::object error_class(const char* name) { return py::module_::import("zwidth._errors").attr(name); }

[[noreturn]] void raise(const char* name, const py::tuple& arguments) {
  const py::object raised = error_class(name);
  PyErr_SetObject(raised.ptr(), raised(*arguments).ptr());
  throw py::error_already_set();
}

py::object python_problem(const server::Problem& problem) {
  const auto text = [](const std::string& given) { return given.empty() ? py::object(py::none()) : py::str(given); };
  const auto number = [](std::size_t given) { return given == 0 ? py::object(py::none()) : py::int_(given); };
  const InputPlace& place = problem.place;
  return error_class("Problem")(
      problem.where, problem.what, problem.allowed, problem.suggestion,
      error_class("Place")(text(place.file), number(place.line), number(place.column), text(place.key),
                           text(place.option)),
      problem.problem ? py::object(py::str(std::string(name_of(problem.problem->code)))) : py::object(py::none()));
}

/// Where is "FILE:LINE:COLUMN: KEY", as far as there is each, or "device.KEY" of an override.
server::Problem placed(InputProblem problem) {
  InputPlace& place = problem.place;
  if (place.file == override_source) {
    place.file = "device";
    return {"device." + place.key, std::move(problem)};
  }
  std::string where = place.file;
  if (place.line > 0) where += ":" + std::to_string(place.line);
  if (place.column > 0) where += ":" + std::to_string(place.column);
  if (!place.key.empty()) where += (where.empty() ? "" : ": ") + place.key;
  return {std::move(where), std::move(problem)};
}

}  // namespace

void raise_input_error(const server::Problem& problem) {
  py::list problems;
  problems.append(python_problem(problem));
  for (const server::Problem& each : problem.others) problems.append(python_problem(each));
  raise("InputError", py::make_tuple(problem.where, problem.what, problem.allowed, problems));
}

void raise_input_error(const std::string& where, const std::string& what, const std::string& allowed) {
  raise_input_error(server::Problem{where, what, allowed});
}

void raise_input_error(const InputError& error) {
  server::Problem first = placed(error);
  for (const InputProblem& each : error.others) first.others.push_back(placed(each));
  raise_input_error(first);
}

void raise_input_error(const DeviceProblem& problem) {
  raise_input_error(
      server::Problem{problem.key, InputProblem{{"", 0, 0, problem.key, ""}, problem.what, problem.allowed, {}}});
}

void raise_input_error(const Error& error, const std::string& where) {
  if (error.problems().empty()) raise_input_error(where, error.what(), "");
  std::vector<server::Problem> placed_problems;
  for (const InputProblem& each : error.problems()) {
    server::Problem made = placed(each);
    if (made.where.empty()) made.where = where;
    placed_problems.push_back(std::move(made));
  }
  server::Problem first = placed_problems.front();
  first.others.assign(placed_problems.begin() + 1, placed_problems.end());
  raise_input_error(first);
}

void raise_work_failed(const std::string& what) { raise("WorkFailed", py::make_tuple(what)); }

void warn_of(const Trust& trust) {
  if (trust.sound()) return;
  const py::object warn = py::module_::import("zwidth._errors").attr("warn_of_trust");
  warn(results::name_of(trust.verdict), py::cast(trust.reasons));
}

}  // namespace zwidth::python
