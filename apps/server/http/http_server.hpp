#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "server/api/api.hpp"

namespace zwidth::server {

/// Of connections and of requests that wait one client may hold half, where clients are told apart.
struct HttpLimits {
  std::size_t head = 16 << 10;                  ///< bytes
  std::size_t bodies = std::size_t{256} << 20;  ///< bytes of all requests together
  std::size_t connections = 256;
  std::size_t waiting = 64;            ///< requests, beside as many at work as there are cores
  std::chrono::seconds head_time{10};  ///< until a head is whole; also how long a connection may idle
  std::chrono::seconds body_time{60};
  std::chrono::seconds write_time{60};
  std::chrono::seconds work_time{600};
  std::chrono::seconds last_time{10};          ///< that work still has when the server is to end
  std::chrono::milliseconds last_answer{400};  ///< for answers after that, before they and all else are dropped
};

struct HttpOptions {
  std::string host = "127.0.0.1";  ///< an IP address, or localhost
  unsigned short port = 8713;      ///< 0: any free one
  HttpLimits limits = {};
};

/// Whether `host` is an IP address or localhost.
[[nodiscard]] bool is_address(const std::string& host);

/// How a server that was started is reached.
struct Started {
  std::string address;             ///< can be opened; the token is in its fragment where one is needed
  std::vector<std::string> hosts;  ///< where it listens at every address of this machine: what Host may be
};

/// Serves the API and the embedded front end until SIGINT or SIGTERM, and then finishes what can be within last_time; the
/// rest, and with a second signal all of it at once, is cancelled, and the process ended where work does not heed that.
/// `started` is called once.
///
/// Throws std::system_error where the address cannot be bound.
void serve(Api& api, const HttpOptions& options, const std::function<void(const Started&)>& started);

}  // namespace zwidth::server
