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

bool is_key(std::string_view text) {
  return !text.empty() && text.find_first_of(" '\"(") == text.npos;  // names of bodies may be of any letters
}

}  // namespace

server::Problem problem_in(std::string message, const server::CommandRequest& request) {
  std::ranges::replace(message, '\n', ' ');
  std::string where;
  const std::string option = take_place(message, is_option);
  if (!option.empty()) where = "options." + option.substr(2);
  for (const auto& recording : request.recordings) {
    const std::string name = take_place(message, [&](std::string_view text) { return names(text, recording.name); });
    if (!name.empty() && where.empty()) where = "recording" + name.substr(recording.name.size());
  }
  const std::string device = take_place(message, [](std::string_view text) { return names(text, device_name); });
  const bool is_override = option == "--set";
  if (!device.empty() || is_override) {
    const std::string key = take_place(message, is_key);
    if (option.empty() || is_override) where = key.empty() ? "device" : "device." + key;
  }
  const std::size_t end = message.find("; ");
  if (end == std::string::npos) return {where, message, ""};
  return {where, message.substr(0, end), message.substr(end + 2)};
}

}  // namespace zwidth::cli
