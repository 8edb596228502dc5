// Any bytes sent to any path of the API: never a crash, always one line of JSON, an error with its place or a document;
// and no file is opened but those in memory.
//
// Input: a byte that chooses the path, then the body.
#include <fcntl.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include "cli/request_commands.hpp"
#include "results/json.hpp"
#include "server/api/api.hpp"

namespace {

using zwidth::results::Json;

constexpr const char* recording = "t,force,position\n0,1,0\n0.1,-1,0.1\n0.2,1,0\n0.3,-1,0.1\n0.4,1,0\n";
constexpr std::chrono::milliseconds longest{300};

void require(bool holds) {
  if (!holds) std::abort();
}

std::atomic<bool> answers = false;

bool in_memory(std::string_view path) { return path.starts_with("/proc/self/fd/"); }

zwidth::server::Api& api() {
  static const zwidth::cli::RequestCommands commands;
  static zwidth::server::Api one(commands, {});
  static const bool is_stored = one.answer("/api/v1/recordings", recording).status == 200;
  require(is_stored);
  return one;
}

}  // namespace

// The linker leads these calls here (CMakeLists.txt), the fuzzer's own too: they fail where a request reaches the disk.
extern "C" {
std::FILE* __real_fopen(const char* path, const char* mode);
int __real_unlink(const char* path);
int __real_rename(const char* from, const char* to);
std::FILE* __wrap_fopen(const char* path, const char* mode) {
  require(!answers || in_memory(path));
  return __real_fopen(path, mode);
}
int __wrap_open(const char*, int, ...) { std::abort(); }
int __wrap_unlink(const char* path) {
  require(!answers);
  return __real_unlink(path);
}
int __wrap_rename(const char* from, const char* to) {
  require(!answers);
  return __real_rename(from, to);
}
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto& routes = api().routes();
  const auto& route = routes[data[0] % routes.size()];
  const auto begin = std::chrono::steady_clock::now();
  const zwidth::Progress progress = [begin](double) {
    if (std::chrono::steady_clock::now() - begin > longest) throw zwidth::server::Cancelled("too long");
  };
  try {
    answers = true;
    const auto answer = api().answer(route.path, {reinterpret_cast<const char*>(data) + 1, size - 1}, progress);
    answers = false;
    require(answer.status == 200 || answer.status == 400 || answer.status == 503);
    require(answer.document.find('\n') == answer.document.size() - 1);
    const Json document = Json::parse(answer.document);
    require(document.contains("error") == (answer.status != 200));
    if (answer.status == 200) return 0;
    const Json& error = document["error"];
    require(error["where"].is_string());
    const bool has_place = error.contains("line") && error["line"] > 0 && error["column"] > 0;
    require(error.size() == (has_place ? 5 : 3));
  } catch (const zwidth::server::Cancelled&) {
    answers = false;
  }
  return 0;
}
