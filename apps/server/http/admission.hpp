#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/api/api.hpp"

namespace zwidth::server {

/// What of a request's head decides whether it is let in.
struct RequestHead {
  std::string_view method;
  std::string_view target;
  std::vector<std::string_view> hosts;  ///< every Host header; so the next three
  std::vector<std::string_view> origins;
  std::vector<std::string_view> authorizations;
  std::vector<std::string_view> content_lengths;
  std::string_view content_type;
  bool has_content_encoding = false;
  bool has_transfer_encoding = false;
  std::uint64_t content_length = 0;
};

/// How this server may be called.
struct Site {
  std::vector<std::string> hosts;  ///< "127.0.0.1:8713", "localhost:8713"
  std::string token;               ///< empty: none is needed
};

struct Refusal {
  int status = 400;
  Problem problem;
  std::string allow = {};  ///< of status 405: the methods
};

/// Of whole KiB or MiB: "64 MiB".
[[nodiscard]] std::string size_in_words(std::size_t bytes);

/// The path without a query.
[[nodiscard]] std::string_view path_of(std::string_view target);

/// Status 421 where Host is not one of the site's, 403 for a foreign Origin or a missing or wrong token, 404, 405, 413 and
/// 415 by the route, 400 for what is malformed. `route`: of the API; `is_file`: the path is one of the front end's.
[[nodiscard]] std::optional<Refusal> find_refusal(const RequestHead& head, const Site& site, const Route* route,
                                                  bool is_file);

/// Names and values that stand in every answer: nothing foreign is loaded, no frame, no guessed types, no referrer.
[[nodiscard]] std::span<const std::pair<const char*, const char*>> security_headers();

/// 32 random bytes in hexadecimal.
[[nodiscard]] std::string random_token();

}  // namespace zwidth::server
