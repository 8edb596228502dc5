#include "cli/request_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "cli/usage_error.hpp"

namespace zwidth::cli {
namespace {

constexpr std::string_view in_options = "options.";

/// What errors call the file that a study came from.
std::string study_file(const std::variant<std::string, std::filesystem::path>& study) {
  const auto* path = std::get_if<std::filesystem::path>(&study);
  return path != nullptr ? path->string() : study_name;
}

}  // namespace

std::string listed(std::string option, server::CommandRequest::Naming naming) {
  if (naming == server::CommandRequest::Naming::keyword) std::ranges::replace(option, '-', '_');
  return option;
}

server::Problem with_names(server::Problem problem, server::CommandRequest::Naming naming,
                           const std::vector<std::string>& options, std::string_view recording) {
  for (server::Problem& each : problem.others) each = with_names(std::move(each), naming, options, recording);
  if (problem.where.starts_with(in_options)) problem.where = listed(problem.where, naming);
  problem.place.option = listed(problem.place.option, naming);
  const bool is_document = naming == server::CommandRequest::Naming::document;
  problem.name_options([&](const std::string& option) -> std::optional<std::string> {
    const std::string name = option.starts_with("--") ? option.substr(2) : "";
    if (std::ranges::find(options, name) == options.end()) return std::nullopt;
    const bool has_prefix = is_document && name != recording;
    return (has_prefix ? std::string(in_options) : "") + listed(name, naming);
  });
  return problem;
}

server::Problem problem_in(const InputProblem& told, const server::CommandRequest& request) {
  InputProblem problem = told;
  InputPlace& place = problem.place;
  const bool is_override = place.option == "--set";
  const auto has_name = [&](const auto& recorded) { return recorded.name == place.file; };
  const bool is_recording = std::ranges::any_of(request.recordings, has_name);
  const bool is_device = is_override || (place.file == device_name && !is_recording);
  const bool is_study = request.study && place.file == study_file(*request.study);
  if (is_study) place.file = study_name;
  if (is_device) place.file = device_name;
  if (is_device && !request.device_is_text) place.line = place.column = 0;
  const std::string line = place.line > 0 ? fmt::format(":{}:{}", place.line, place.column) : "";
  std::string where = "options";
  bool tells_key = place.key.empty();
  if (!place.option.empty() && !(is_override && !place.key.empty())) {
    if (place.option.starts_with("--")) where = "options." + place.option.substr(2);
  } else if (is_recording && !is_override) {  // whatever its name
    where = "recording" + line;
  } else if (is_device || is_study) {
    where = place.file + (place.key.empty() ? line : "." + place.key);
    tells_key = true;
  }
  // What `where` does not say.
  if (!tells_key) problem.begin_with(place.key + ": ");
  const bool is_known = is_device || is_study || is_recording || place.file.empty();
  if (!is_known) problem.begin_with(place.file + ": ");
  if (is_override) place.option.clear();
  if (place.option.starts_with("--")) place.option.erase(0, 2);
  return {std::move(where), std::move(problem)};
}

server::Problem problem_in(const BadInput& refused, const server::CommandRequest& request) {
  server::Problem first = problem_in(refused.problems.front(), request);
  for (std::size_t i = 1; i < refused.problems.size(); ++i) {
    first.others.push_back(problem_in(refused.problems[i], request));
  }
  return first;
}

server::Problem failure_in(const WorkFailed& failure) {
  InputProblem problem{{}, failure.reason.text, {}, {}, failure.reason.options};
  for (std::size_t end = problem.what.find('\n'); end != std::string::npos; end = problem.what.find('\n', end)) {
    problem.what.replace(end, 1, "; ");
    for (NamedOption& option : problem.options_of_what) option.at += option.at > end ? 1 : 0;
  }
  return {"", std::move(problem)};
}

server::Problem problem_of_cli11(const std::string& message, std::string_view file,
                                 const server::CommandRequest& request) {
  constexpr std::string_view required = " is required";
  if (!message.ends_with(required)) {
    const InputProblem told = problem_of_cli11(message);
    const std::size_t begin = message.find("--");
    server::Problem problem = problem_in(told, request);
    if (!told.place.option.empty() || begin == std::string::npos) return problem;
    const std::size_t end = std::min(message.find_first_of(" :,", begin), message.size());
    problem.place.option = message.substr(begin + 2, end - begin - 2);
    problem.where = "options." + problem.place.option;
    return problem;
  }
  if (!message.starts_with("--")) {
    return {std::string(file), "is missing",
            file == device_name ? "device_toml, or device" : "the id that POST /api/v1/recordings returned"};
  }
  const std::string option = message.substr(0, message.size() - required.size());
  if (option == "--study") return {study_name, "is missing", "study_toml, or study"};
  return problem_in(problem_of_value(option, "is missing", "a value: the command needs it"), request);
}

}  // namespace zwidth::cli
