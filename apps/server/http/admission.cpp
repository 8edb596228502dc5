#include "server/http/admission.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/random.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <system_error>

#include "server/api/digest.hpp"

namespace zwidth::server {
namespace {

bool same_letters(std::string_view one, std::string_view other) {
  return std::ranges::equal(one, other,
                            [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
}

/// "application/json" of "application/json; charset=utf-8".
std::string_view media_type(std::string_view header) {
  header = header.substr(0, header.find(';'));
  while (header.ends_with(' ') || header.ends_with('\t')) header.remove_suffix(1);
  return header;
}

bool is_allowed_host(const RequestHead& head, const Site& site) {
  return head.hosts.size() == 1 && std::ranges::find(site.hosts, head.hosts.front()) != site.hosts.end();
}

bool is_own_origin(const RequestHead& head) {
  return head.origins.empty() ||
         (head.origins.size() == 1 && head.origins.front() == fmt::format("http://{}", head.hosts.front()));
}

bool has_token(const RequestHead& head, const std::string& token) {
  constexpr std::string_view scheme = "Bearer ";
  if (head.authorizations.size() != 1) return false;
  std::string_view given = head.authorizations.front();
  if (given.size() != scheme.size() + token.size() || !same_letters(given.substr(0, scheme.size()), scheme))
    return false;
  given.remove_prefix(scheme.size());
  return equal_in_constant_time(given, token);
}

std::optional<Refusal> refusal_of_body(const RequestHead& head, const Route& route) {
  if (head.has_transfer_encoding || head.content_lengths.size() > 1) {
    return Refusal{400, {"Transfer-Encoding", "is not taken", "one Content-Length"}};
  }
  if (head.content_length > route.body_limit) {
    return Refusal{413, {"body", "is too large", fmt::format("at most {}", size_in_words(route.body_limit))}};
  }
  if (route.method != "POST") return std::nullopt;
  if (head.content_lengths.empty()) return Refusal{400, {"Content-Length", "is missing", "one Content-Length"}};
  if (head.has_content_encoding) return Refusal{415, {"Content-Encoding", "is not taken", "the bytes as they are"}};
  if (!same_letters(media_type(head.content_type), route.content_type)) {
    return Refusal{415, {"Content-Type", "is not what is taken here", route.content_type}};
  }
  return std::nullopt;
}

}  // namespace

std::string size_in_words(std::size_t bytes) {
  if (bytes >= std::size_t{1} << 20) return fmt::format("{} MiB", bytes >> 20);
  return bytes >= std::size_t{1} << 10 ? fmt::format("{} KiB", bytes >> 10) : fmt::format("{} bytes", bytes);
}

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

std::optional<Refusal> find_refusal(const RequestHead& head, const Site& site, const Route* route, bool is_file) {
  if (!is_allowed_host(head, site)) {
    return Refusal{421, {"Host", "is not this server", fmt::format("{}", fmt::join(site.hosts, " or "))}};
  }
  if (!is_own_origin(head)) return Refusal{403, {"Origin", "is foreign", "a page of this server, or none"}};
  if (!head.target.starts_with('/')) return Refusal{400, {"target", "is no path", "a path from /"}};
  const std::string_view path = path_of(head.target);
  const bool is_api = path.starts_with("/api/");
  if (is_api && !site.token.empty() && !has_token(head, site.token)) {
    return Refusal{403, {"Authorization", "has no token, or not this server's", "Bearer and the token it printed"}};
  }
  if (route == nullptr && !is_file) return Refusal{404, {"target", "is nothing here", "GET / and /api/v1/..."}};
  const Route file{std::string(path), "GET", "", 0};
  const Route& asked = route != nullptr ? *route : file;
  if (is_api && path.size() != head.target.size()) {
    return Refusal{400, {"target", "has a query", "options in the document"}};
  }
  const bool is_get = asked.method == "GET" && (head.method == "GET" || head.method == "HEAD");
  if (head.method != asked.method && !is_get) {
    const std::string allow = asked.method == "GET" ? "GET, HEAD" : asked.method;
    return Refusal{405, {"method", "is not taken here", allow}, allow};
  }
  return refusal_of_body(head, asked);
}

std::span<const std::pair<const char*, const char*>> security_headers() {
  static constexpr std::pair<const char*, const char*> headers[] = {
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data: blob:; "
       "font-src 'self'; media-src 'self' blob:; worker-src 'self' blob:; manifest-src 'self'; base-uri 'none'; "
       "form-action 'none'; frame-ancestors 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"X-Frame-Options", "DENY"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
  };
  return headers;
}

std::string random_token() {
  unsigned char bytes[32];
  std::size_t filled = 0;
  while (filled < sizeof bytes) {
    const ssize_t got = ::getrandom(bytes + filled, sizeof bytes - filled, 0);
    if (got < 0 && errno != EINTR)
      throw std::system_error(errno, std::generic_category(), "no random bytes for a token");
    if (got > 0) filled += static_cast<std::size_t>(got);
  }
  std::string token;
  for (const unsigned char each : bytes) token += fmt::format("{:02x}", each);
  return token;
}

}  // namespace zwidth::server
