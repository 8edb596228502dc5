#include "server/api/request_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "results/json.hpp"
#include "server/api/device_toml.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::server {
namespace {

using results::Json;

constexpr int deepest = 32;  // a device file needs four levels
constexpr std::size_t longest_name = 200;
constexpr std::array<std::string_view, 7> request_keys{"device", "device_toml", "recording", "recordings",
                                                       "study",  "study_toml",  "options"};

struct Refused {
  Problem problem;
};

[[noreturn]] void refuse(std::string where, std::string what, std::string allowed) {
  throw Refused{{std::move(where), std::move(what), std::move(allowed)}};
}

std::string shown(std::string text) {
  constexpr std::size_t longest = 200;
  if (text.size() > longest) text = text.substr(0, longest) + "...";
  return text;
}

/// Watches a document while it is parsed: how deep it is, and that no object has a key twice.
class Watch {
 public:
  bool operator()(int depth, Json::parse_event_t event, const Json& value) {
    if (depth > deepest) refuse("request", "is nested too deep", fmt::format("at most {} levels", deepest));
    if (event == Json::parse_event_t::object_start) {
      objects_.emplace_back();
    } else if (event == Json::parse_event_t::object_end) {
      objects_.pop_back();
    } else if (event == Json::parse_event_t::key) {
      auto& [keys, last] = objects_.back();
      last = value.get_ref<const std::string&>();
      if (!keys.insert(last).second) refuse(shown(place()), "is given twice", "each key once");
    }
    return true;
  }

 private:
  struct Object {
    std::unordered_set<std::string> keys;
    std::string last;
  };
  /// "options.set"
  [[nodiscard]] std::string place() const {
    std::string place;
    for (const Object& each : objects_) place += (place.empty() ? "" : ".") + each.last;
    return place;
  }
  std::vector<Object> objects_;
};

Json parsed(std::string_view document) {
  try {
    return Json::parse(document, [watch = Watch()](int depth, Json::parse_event_t event, Json& value) mutable {
      return watch(depth, event, value);
    });
  } catch (const Json::exception& error) {
    const std::string_view message = error.what();  // "[json.exception.parse_error.101] parse error at line 1, ..."
    const std::size_t end = message.find("] ");
    refuse("request", "is no JSON: " + shown(std::string(message.substr(end == message.npos ? 0 : end + 2))),
           "one JSON object in UTF-8");
  }
}

/// A number with the digits that it takes, a text as it is.
std::string option_text(const std::string& where, const Json& value) {
  if (value.is_number()) return value.dump();
  if (!value.is_string()) refuse(where, "is neither number nor text", "what the option takes on the command line");
  const auto& text = value.get_ref<const std::string&>();
  if (text.empty()) refuse(where, "is empty", "what the option takes on the command line");
  if (text.find('\0') != std::string::npos) refuse(where, "has a character of code 0", "a text without");
  return text;
}

/// Nothing for a flag that is false.
std::optional<CommandRequest::Option> option_of(std::string key, const Json& value) {
  std::ranges::replace(key, '_', '-');
  const std::string where = "options." + key;
  if (value.is_boolean()) {
    return value.get<bool>() ? std::optional(CommandRequest::Option{std::move(key), {}}) : std::nullopt;
  }
  CommandRequest::Option option{std::move(key), {}};
  if (!value.is_array()) {
    option.values.push_back(option_text(where, value));
  } else if (value.empty()) {
    return std::nullopt;
  } else {
    for (const Json& each : value) option.values.push_back(option_text(where, each));
  }
  return option;
}

/// A label, for messages and the document: it begins as no option does, and is no path.
void check_name(const std::string& name) {
  const bool is_label = !name.empty() && name.size() <= longest_name && name.front() != '-' &&
                        std::ranges::none_of(name, [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '/'; });
  if (!is_label) {
    refuse("recording.name", "is no name for a recording",
           fmt::format("1 to {} bytes, without '/' and '-' in front", longest_name));
  }
}

CommandRequest::Recorded recorded(const Json& value, RecordingStore& recordings) {
  constexpr const char* allowed = "the id that POST /api/v1/recordings returned, or {\"id\": ..., \"name\": ...}";
  const bool is_named = value.is_object() && value.contains("id") && value["id"].is_string() &&
                        value.size() == (value.contains("name") ? 2 : 1);
  if (!value.is_string() && !is_named) refuse("recording", "is no recording", allowed);
  const std::string id = value.is_string() ? value.get<std::string>() : value["id"].get<std::string>();
  std::string name = id;
  if (is_named && value.contains("name")) {
    if (!value["name"].is_string()) refuse("recording.name", "is no text", "a name for the recording");
    name = value["name"].get<std::string>();
  }
  auto bytes = recordings.find(id);
  if (!bytes) refuse("recording", fmt::format("there is none of the id {}, or no longer", shown(id)), allowed);
  check_name(name);
  return {std::move(name), std::move(bytes)};
}

CommandRequest request_of(std::string_view command, const Json& document, RecordingStore& recordings) {
  if (!document.is_object()) refuse("request", "is no object", fmt::format("{{{}}}", fmt::join(request_keys, ", ")));
  for (const auto& [key, value] : document.items()) {
    if (std::ranges::find(request_keys, key) != request_keys.end()) continue;
    const std::string near = nearest_word(key, std::vector<std::string>(request_keys.begin(), request_keys.end()));
    refuse(shown(key), "is no key of a request",
           near.empty() ? fmt::format("{}", fmt::join(request_keys, ", ")) : fmt::format("did you mean {}?", near));
  }
  CommandRequest request;
  request.command = command;
  if (document.contains("device")) {
    auto toml = device_toml(document["device"]);
    if (!toml) throw Refused{toml.error()};
    request.device = *std::move(toml);
  }
  if (document.contains("device_toml")) {
    if (request.device) refuse("device_toml", "is given beside device", "one of them");
    if (!document["device_toml"].is_string()) refuse("device_toml", "is no text", "a device file's text");
    request.device = document["device_toml"].get<std::string>();
    request.device_is_text = true;
  }
  if (document.contains("recording")) request.recordings.push_back(recorded(document["recording"], recordings));
  if (document.contains("recordings")) {
    if (!document["recordings"].is_array()) refuse("recordings", "is no array", "ids of recordings");
    for (const Json& each : document["recordings"]) request.recordings.push_back(recorded(each, recordings));
  }
  if (document.contains("study")) {
    auto toml = device_toml(document["study"], "study");
    if (!toml) throw Refused{toml.error()};
    request.study = *std::move(toml);
  }
  if (document.contains("study_toml")) {
    if (request.study) refuse("study_toml", "is given beside study", "one of them");
    if (!document["study_toml"].is_string()) refuse("study_toml", "is no text", "a study file's text");
    request.study = document["study_toml"].get<std::string>();
  }
  if (document.contains("options")) {
    if (!document["options"].is_object()) refuse("options", "is no object", "options of the command, by their names");
    for (const auto& [key, value] : document["options"].items()) {
      if (auto option = option_of(key, value)) request.options.push_back(*std::move(option));
    }
  }
  return request;
}

}  // namespace

tl::expected<CommandRequest, Problem> read_request(std::string_view command, std::string_view document,
                                                   RecordingStore& recordings) try {
  return request_of(command, parsed(document), recordings);
} catch (const Refused& refused) {
  return tl::unexpected(refused.problem);
}

}  // namespace zwidth::server
