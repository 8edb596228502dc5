#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/api/command_request.hpp"
#include "server/api/recording_store.hpp"

namespace zwidth::server {

/// How long a person waits for it, and so what gives way to what.
enum class Haste : std::uint8_t {
  answer,  ///< milliseconds: the limits, which the page always shows
  plot,    ///< a tenth of a second: what follows a drag
  search,  ///< a second and more
};
constexpr std::size_t count_of_hastes = 3;

/// What a path of the API takes.
struct Route {
  std::string path;          ///< "/api/v1/analyze"
  std::string method;        ///< GET or POST
  std::string content_type;  ///< of the body; empty: none
  std::size_t body_limit = 0;
  Haste haste = Haste::search;
};

struct ApiAnswer {
  int status = 200;
  std::string document;  ///< one line of JSON
};

/// {"error": {"where", "what", "allowed", "place": {"file", "line", "column", "key", "option"}, "suggestion", "code",
/// "problems"}}: the first problem, and all of them; with "line" and "column" beside it where they are known.
[[nodiscard]] std::string error_document(const Problem& problem);

/// A device to begin with.
struct OfferedDevice {
  std::string file;  ///< its name, "lhifam.toml"
  std::string toml;
  bool is_opened = false;  ///< asked for where the server was started
};

/// The API as a function from request document to result document: no socket, no file. For any number of threads.
class Api {
 public:
  /// `commands` must outlive this. Devices that cannot be read are left out.
  Api(const Commands& commands, const std::vector<OfferedDevice>& devices, const RecordingLimits& limits = {});

  [[nodiscard]] const std::vector<Route>& routes() const { return routes_; }

  /// Answers `body` sent to a route's path. Statuses: 200; 400, the request is refused or its work failed; 503, no
  /// memory. Throws what `progress` throws.
  [[nodiscard]] ApiAnswer answer(std::string_view path, std::string_view body, const Progress& progress = {});

 private:
  [[nodiscard]] ApiAnswer answer_command(std::string_view command, std::string_view body, const Progress& progress);
  [[nodiscard]] ApiAnswer answer_recording(std::string_view body, const Progress& progress);

  const Commands& commands_;
  std::vector<Route> routes_;
  std::string devices_;  // the document
  RecordingStore recordings_;
};

}  // namespace zwidth::server
