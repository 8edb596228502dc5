#include "cli/request_problem.hpp"

#include <algorithm>
#include <string_view>

#include "zwidth/io/input_error.hpp"

namespace zwidth::cli {
namespace {

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

}  // namespace

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
      where = device;  // with line and column
    }
  }
  const std::size_t end = message.find("; ");
  if (end == std::string::npos) return {where, message, ""};
  return {where, message.substr(0, end), message.substr(end + 2)};
}

server::Problem problem_of_option(const std::string& message, std::string_view file) {
  constexpr std::string_view required = " is required";
  if (message.ends_with(required) && !message.starts_with("--")) return {std::string(file), "is missing", ""};
  const std::size_t begin = message.find("--");
  if (begin == std::string::npos) return {"options", message, ""};
  const std::size_t end = std::min(message.find_first_of(" :,", begin), message.size());
  const std::string where = "options." + message.substr(begin + 2, end - begin - 2);
  if (message.ends_with(required)) return {where, "is missing", ""};
  return {where, begin == 0 && message.substr(end).starts_with(": ") ? message.substr(end + 2) : message, ""};
}

}  // namespace zwidth::cli
