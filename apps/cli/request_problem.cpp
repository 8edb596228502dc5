#include "cli/request_problem.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <utility>
#include <variant>

#include "cli/usage_error.hpp"
#include "zwidth/io/input_error.hpp"

namespace zwidth::cli {
namespace {

constexpr std::string_view no_number = "Could not convert: ";  // of CLI11

/// Takes "PLACE: " from the front of the message where `is_place` says yes to PLACE.
template <typename IsPlace>
std::string take_place(std::string& message, const IsPlace& is_place) {
  const std::size_t end = message.find(": ");
  if (end == std::string::npos || !is_place(std::string_view(message).substr(0, end))) return "";
  std::string place = message.substr(0, end);
  message.erase(0, end + 2);
  return place;
}

bool is_option(std::string_view text) { return text.starts_with("--") && text.find(' ') == text.npos; }

/// NAME or NAME:LINE:COLUMN
bool names(std::string_view text, std::string_view name) {
  if (!text.starts_with(name)) return false;
  const std::string_view rest = text.substr(name.size());
  return rest.empty() || (rest.front() == ':' && rest.find_first_not_of(":0123456789") == rest.npos);
}

bool is_key(std::string_view text) {  // names of bodies may be of any letters
  return !text.empty() && (text.starts_with("body.") || text.find_first_of(" '\"(") == text.npos);
}

/// "WHAT; ALLOWED"
server::Problem split(const std::string& where, const std::string& message) {
  const std::size_t end = message.find("; ");
  if (end == std::string::npos) return {where, message, ""};
  return {where, message.substr(0, end), message.substr(end + 2)};
}

/// Of "NAME:LINE:COLUMN".
void put_place(std::string_view text, server::Problem& problem) {
  const std::size_t begin = text.find(':');
  if (begin == text.npos) return;
  const char* const end = text.data() + text.size();
  const auto line = std::from_chars(text.data() + begin + 1, end, problem.line);
  if (line.ptr != end) std::from_chars(line.ptr + 1, end, problem.column);
}

constexpr std::string_view in_options = "options.";
constexpr std::string_view letters_of_options = "abcdefghijklmnopqrstuvwxyz0123456789-";

}  // namespace

std::string listed(std::string option, server::CommandRequest::Naming naming) {
  if (naming == server::CommandRequest::Naming::keyword) std::ranges::replace(option, '-', '_');
  return option;
}

server::Problem with_names(server::Problem problem, server::CommandRequest::Naming naming,
                           const std::vector<std::string>& options, std::string_view recording) {
  if (problem.where.starts_with(in_options)) problem.where = listed(problem.where, naming);
  const bool is_document = naming == server::CommandRequest::Naming::document;
  for (std::string* text : {&problem.what, &problem.allowed}) {
    for (std::size_t at = text->find("--"); at != std::string::npos; at = text->find("--", at + 1)) {
      const std::size_t end = std::min(text->find_first_not_of(letters_of_options, at), text->size());
      const std::string name = text->substr(at + 2, end - at - 2);
      if (std::ranges::find(options, name) == options.end()) continue;
      const bool has_prefix = is_document && name != recording;
      text->replace(at, end - at, (has_prefix ? std::string(in_options) : "") + listed(name, naming));
    }
  }
  return problem;
}

server::Problem problem_in(std::string message, const server::CommandRequest& request) {
  message.erase(std::min(message.find('\n'), message.size()));  // what follows is further advice
  std::string where;
  const std::string option = take_place(message, is_option);
  if (!option.empty()) where = "options." + option.substr(2);
  for (const auto& recording : request.recordings) {
    const std::string name = take_place(message, [&](std::string_view text) { return names(text, recording.name); });
    if (!name.empty() && where.empty()) where = "recording" + name.substr(recording.name.size());
  }
  const std::string device = take_place(message, [](std::string_view text) { return names(text, device_name); });
  if (option == "--set" || (option.empty() && !device.empty())) {
    const std::string key = take_place(message, is_key);
    if (!key.empty()) {
      where = std::string(device_name) + "." + key;
    } else if (option.empty()) {
      where = request.device_is_text ? device : device_name;  // with line and column
    }
  }
  std::string study;
  if (request.study && where.empty()) {
    const auto* path = std::get_if<std::filesystem::path>(&*request.study);
    const std::string name = path != nullptr ? path->string() : study_name;
    study = take_place(message, [&](std::string_view text) { return names(text, name); });
    if (!study.empty()) {
      study.erase(0, name.size());
      const std::string key = take_place(message, is_key);
      where = study_name + (key.empty() ? study : "." + key);
    }
  }
  server::Problem problem = split(where.empty() ? "options" : where, message);
  put_place(study, problem);
  if (request.device_is_text) put_place(device, problem);
  return problem;
}

server::Problem failure_in(std::string message, const server::CommandRequest& request) {
  (void)take_place(message, [&](std::string_view text) {
    return names(text, device_name) ||
           std::ranges::any_of(request.recordings, [&](const auto& recording) { return names(text, recording.name); });
  });
  for (std::size_t end = message.find('\n'); end != std::string::npos; end = message.find('\n', end)) {
    message.replace(end, 1, "; ");
  }
  return {"", std::move(message), ""};
}

server::Problem problem_of_option(const std::string& told, std::string_view file) {
  const std::string message = clear_problem(told);
  constexpr std::string_view required = " is required";
  if (message.ends_with(required) && !message.starts_with("--"))
    return {std::string(file), "is missing",
            file == device_name ? "device_toml, or device" : "the id that POST /api/v1/recordings returned"};
  const std::size_t begin = message.find("--");
  if (begin == std::string::npos) return {"options", message, ""};
  const std::size_t end = std::min(message.find_first_of(" :,", begin), message.size());
  const std::string where = "options." + message.substr(begin + 2, end - begin - 2);
  if (where == "options.study" && message.ends_with(required))
    return {study_name, "is missing", "study_toml, or study"};
  if (message.ends_with(required)) return {where, "is missing", "a value: the command needs it"};
  if (message.starts_with(no_number)) {
    const std::size_t value = message.find(" = ");
    return {where, "is " + (value == std::string::npos ? "no number" : message.substr(value + 3)), "a number"};
  }
  if (begin != 0 || !message.substr(end).starts_with(": ")) return {where, message, ""};
  return split(where, message.substr(end + 2));
}

}  // namespace zwidth::cli
