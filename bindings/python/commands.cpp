#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "answer.hpp"
#include "cli/request_commands.hpp"
#include "interruptible.hpp"
#include "parts.hpp"
#include "python_error.hpp"
#include "server/api/device_toml.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::python {
namespace py = pybind11;
namespace {

using server::CommandRequest;
using Options = std::vector<std::pair<std::string, std::vector<std::string>>>;
using Held = std::variant<std::filesystem::path, std::shared_ptr<RecordedColumns>>;
using StudyHeld = std::optional<std::variant<std::string, std::filesystem::path>>;

/// Runs a command of the program: the same declarations parse and check its options, the same answer comes back.
Answer run(const std::string& command, const Options& options, const Device* device,
           const std::vector<std::pair<std::string, Held>>& recordings, const py::object& progress,
           const StudyHeld& study, bool prints_text) {
  cli::RequestBounds bounds;
  bounds.files = FilesBeside::read;
  CommandRequest request;
  request.command = command;
  request.naming = CommandRequest::Naming::keyword;
  request.prints_text = prints_text;
  for (const auto& [name, values] : options) request.options.push_back({name, values});
  if (device != nullptr) request.device = write_device(device->parameters());
  request.study = study;
  for (const auto& [name, held] : recordings) {
    CommandRequest::Recorded recorded{name, {}};
    if (const auto* path = std::get_if<std::filesystem::path>(&held)) {
      recorded.held = *path;
    } else {
      recorded.held = std::shared_ptr<const RecordedColumns>(std::get<std::shared_ptr<RecordedColumns>>(held));
    }
    request.recordings.push_back(std::move(recorded));
  }
  auto answer =
      interruptible(progress, [&](const Progress& told) { return cli::RequestCommands(bounds).answer(request, told); });
  if (answer) return Answer(*std::move(answer));
  const server::Problem& problem = answer.error();
  if (problem.where.empty()) raise_work_failed(problem.what + (problem.allowed.empty() ? "" : "; ") + problem.allowed);
  raise_input_error(problem);
}

std::string study_toml(const std::string& json) {
  auto toml = server::device_toml(results::Json::parse(json), "study");
  if (!toml) raise_input_error(toml.error());
  return *std::move(toml);
}

std::shared_ptr<RecordedColumns> recorded(const std::string& source,
                                          const std::vector<std::pair<std::string, std::vector<double>>>& columns,
                                          std::optional<double> sampling_period) {
  auto made = std::make_shared<RecordedColumns>(RecordedColumns{source, {}, sampling_period});
  for (const auto& [name, samples] : columns) made->columns.push_back({name, samples});
  if (const auto problem = find_problem(*made)) raise_input_error(*problem);
  return made;
}

}  // namespace

void bind_commands(py::module_& module) {
  py::class_<Answer> answer(module, "Answer");
  refuse_pickling(answer);
  answer.def_property_readonly("printed", &Answer::printed)
      .def_property_readonly("is_document", &Answer::is_document)
      .def_property_readonly("device", &Answer::device)
      .def("series", &Answer::series)
      .def("value", &Answer::value)
      .def("array", &Answer::array);
  py::class_<RecordedColumns, std::shared_ptr<RecordedColumns>> columns(module, "RecordedColumns");
  refuse_pickling(columns);
  columns.def(py::init(&recorded));
  module.def("run", &run);
  module.def("study_toml", &study_toml);
  module.def("commands", [] { return cli::RequestCommands().names(); });
  module.def("options", [](const std::string& command) {
    std::vector<std::tuple<std::string, std::string, std::string>> all;
    for (const auto& each : cli::RequestCommands().options(command)) all.emplace_back(each.name, each.value, each.text);
    return all;
  });
}

}  // namespace zwidth::python
