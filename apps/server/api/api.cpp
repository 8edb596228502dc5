#include "server/api/api.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <system_error>
#include <utility>

#include "results/device_json.hpp"
#include "results/json.hpp"
#include "results/recording_json.hpp"
#include "server/api/request_document.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/recording_file.hpp"
#include "zwidth/words/problem_text.hpp"

namespace zwidth::server {
namespace {

using results::Json;

const std::string base = "/api/v1/";
constexpr std::size_t document_limit = std::size_t{1} << 20;
constexpr std::size_t recording_limit = std::size_t{64} << 20;
constexpr std::array<std::string_view, 3> plotted{"bode", "region", "simulate"};

Haste haste_of(std::string_view command) {
  if (command == "analyze") return Haste::answer;
  return std::ranges::find(plotted, command) != plotted.end() ? Haste::plot : Haste::search;
}

std::string devices_document(const std::vector<OfferedDevice>& offered) {
  Json document = results::document("zwidth.devices/1");
  document["devices"] = Json::array();
  for (const OfferedDevice& each : offered) {
    const auto device = parse_device(each.toml, each.file, {}, FilesBeside::refused);
    if (!device) continue;
    document["devices"].push_back({{"file", each.file},
                                   {"name", device->name()},
                                   {"opened", each.is_opened},
                                   {"device", results::device_json(device->parameters())},
                                   {"device_toml", each.toml}});
  }
  return results::line(document);
}

std::string contents_document(const std::string& id, std::size_t bytes, const RecordingContents& contents) {
  Json document = results::recording_json(contents);
  document["id"] = id;
  document["bytes"] = bytes;
  return results::line(document);
}

/// What has no document of its own: the code of `export --format c`, the samples of `excite --output -`.
std::string text_document(const std::string& text) {
  Json document = results::document("zwidth.text/1");
  document["text"] = text;
  return results::line(document);
}

Json problem_json(const Problem& problem) {
  const auto text = [](const std::string& given) { return given.empty() ? Json() : Json(given); };
  const auto number = [](std::size_t given) { return given == 0 ? Json() : Json(given); };
  const InputPlace& place = problem.place;
  return {{"where", problem.where},
          {"what", problem.what},
          {"allowed", problem.allowed},
          {"place",
           {{"file", text(place.file)},
            {"line", number(place.line)},
            {"column", number(place.column)},
            {"key", text(place.key)},
            {"option", text(place.option)}}},
          {"suggestion", problem.suggestion ? Json(*problem.suggestion) : Json()},
          {"code", problem.problem ? Json(std::string(name_of(problem.problem->code))) : Json()}};
}

}  // namespace

std::string error_document(const Problem& problem) {
  Json error = problem_json(problem);
  error["problems"] = Json::array({error});
  for (const Problem& each : problem.others) error["problems"].push_back(problem_json(each));
  if (problem.place.line > 0) {
    error["line"] = problem.place.line;
    error["column"] = problem.place.column;
  }
  return results::line({{"error", std::move(error)}});
}

Api::Api(const Commands& commands, const std::vector<OfferedDevice>& devices, const RecordingLimits& limits)
    : commands_(commands), devices_(devices_document(devices)), recordings_(limits) {
  routes_ = {{base + "health", "GET", "", 0},
             {base + "devices", "GET", "", 0},
             {base + "recordings", "POST", "application/octet-stream", recording_limit}};
  for (const std::string& name : commands.names()) {
    routes_.push_back({base + name, "POST", "application/json", document_limit, haste_of(name)});
  }
}

ApiAnswer Api::answer_command(std::string_view command, std::string_view body, const Progress& progress) {
  const auto request = read_request(command, body, recordings_);
  if (!request) return {400, error_document(request.error())};
  auto printed = commands_.run(*request, progress);
  if (!printed) return {400, error_document(printed.error())};
  return {200, printed->starts_with('{') ? *std::move(printed) : text_document(*printed)};
}

ApiAnswer Api::answer_recording(std::string_view body, const Progress& progress) {
  const RecordingStore::Stored stored = recordings_.put(body);
  RecordingOptions options;
  options.most_unpacked = recordings_.limits().unpacked;
  const auto contents = list_recording(stored.bytes->path(), options, progress);
  if (!contents) {
    InputProblem problem = contents.error();
    problem.place.file = "recording";  // not where the system has its bytes
    return {400, error_document({"recording", std::move(problem)})};
  }
  return {200, contents_document(stored.id, stored.bytes->size(), *contents)};
}

ApiAnswer Api::answer(std::string_view path, std::string_view body, const Progress& progress) try {
  const std::string_view name = path.substr(std::min(path.size(), base.size()));
  if (name == "health") return {200, results::line({{"status", "ok"}, {"version", ZWIDTH_VERSION}})};
  if (name == "devices") return {200, devices_};
  if (name == "recordings") return answer_recording(body, progress);
  return answer_command(name, body, progress);
} catch (const std::bad_alloc&) {
  return {503, error_document({"", "out of memory", "a smaller request, or the same later"})};
} catch (const std::system_error&) {
  return {503, error_document({"", "out of memory or descriptors", "the same later"})};
}

}  // namespace zwidth::server
