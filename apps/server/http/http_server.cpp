#include "server/http/http_server.hpp"

#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include "server/http/connection.hpp"

namespace zwidth::server {
namespace {

constexpr std::chrono::milliseconds between_looks{50};  // whether clients are still there

/// The listening socket, and the signals that end it.
class Listener {
 public:
  Listener(net::io_context& sockets, Shared& shared, const tcp::endpoint& endpoint)
      : acceptor_(sockets),
        pause_(sockets),
        grace_(sockets),
        looks_(sockets),
        signals_(sockets, SIGINT, SIGTERM),
        shared_(shared) {
    acceptor_.open(endpoint.protocol());
    acceptor_.set_option(net::socket_base::reuse_address(true));
    acceptor_.bind(endpoint);
    acceptor_.listen();
    shared_.all_gone = [this] {
      signals_.cancel();
      grace_.cancel();
      looks_.cancel();
    };
    shared_.work_runs = [this] {
      if (!std::exchange(looks_around_, true)) look_around();
    };
    accept();
    wait_for_signal();
  }

  [[nodiscard]] tcp::endpoint endpoint() const { return acceptor_.local_endpoint(); }

 private:
  void accept() {
    acceptor_.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (shared_.stops) return;
      if (error) return accept_later();  // no descriptor is left, for one
      if (shared_.connections.size() >= shared_.limits.connections) {
        turn_away(socket, "503 Service Unavailable", {"", "busy: too many connections", "the same later"});
      } else if (shared_.tells_clients() &&
                 shared_.connections_of(client_of(socket)) >= shared_.limits.connections / 2) {
        turn_away(socket, "429 Too Many Requests", {"", "too many connections of yours", "the same on one of them"});
      } else {
        std::make_shared<Connection>(std::move(socket), shared_)->start();
      }
      accept();
    });
  }

  void accept_later() {
    pause_.expires_after(std::chrono::milliseconds(100));
    pause_.async_wait([this](beast::error_code) {
      if (!shared_.stops) accept();
    });
  }

  /// Without waiting for a client that may never read.
  static void turn_away(tcp::socket& socket, std::string_view status, const Problem& problem) {
    const std::string document = error_document(problem);
    std::string answer = fmt::format(
        "HTTP/1.1 {}\r\nContent-Type: application/json\r\nContent-Length: {}\r\nRetry-After: 1\r\n"
        "Connection: close\r\n",
        status, document.size());
    for (const auto& [name, value] : security_headers()) answer += fmt::format("{}: {}\r\n", name, value);
    answer += "\r\n" + document;
    (void)!::send(socket.native_handle(), answer.data(), answer.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  }

  void wait_for_signal() {
    signals_.async_wait([this](beast::error_code error, int) {
      if (error) return;
      if (!shared_.stops) return stop();
      cancel();
      wait_for_signal();
    });
  }

  void stop() {
    shared_.stops = true;
    beast::error_code ignored;
    acceptor_.close(ignored);
    pause_.cancel();
    if (shared_.connections.empty()) return;
    for (Connection* each : shared_.connections) each->stop();
    wait_for_signal();
    after(shared_.limits.last_time, [this] { cancel(); });
  }

  /// What heeds it answers for a moment yet; then the sockets are closed, and what still runs ends with the process:
  /// nothing of it lies on a disk.
  void cancel() {
    for (Connection* each : shared_.connections) each->cancel();
    after(shared_.limits.last_answer, [this] {
      for (Connection* each : shared_.connections) each->close();
      after(shared_.limits.last_answer, [] { std::_Exit(0); });
    });
  }

  /// Takes the place of what was to come before.
  template <typename Duration, typename Then>
  void after(Duration time, Then then) {
    grace_.expires_after(time);
    grace_.async_wait([then](beast::error_code error) {
      if (!error) then();
    });
  }

  /// As long as any work runs.
  void look_around() {
    looks_.expires_after(between_looks);
    looks_.async_wait([this](beast::error_code error) {
      if (error) return;
      looks_around_ = false;
      for (Connection* each : shared_.connections) {
        if (each->look()) looks_around_ = true;
      }
      if (looks_around_) look_around();
    });
  }

  tcp::acceptor acceptor_;
  net::steady_timer pause_;
  net::steady_timer grace_;
  net::steady_timer looks_;
  bool looks_around_ = false;
  net::signal_set signals_;
  Shared& shared_;
};

/// The addresses of this machine that are up, those of loopback last.
std::vector<net::ip::address> own_addresses(bool is_v6) {
  std::vector<net::ip::address> others;
  std::vector<net::ip::address> loopback;
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return {};
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || (each->ifa_flags & IFF_UP) == 0) continue;
    net::ip::address address;
    if (each->ifa_addr->sa_family == AF_INET) {
      const auto* found = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
      address = net::ip::address_v4(ntohl(found->sin_addr.s_addr));
    } else if (is_v6 && each->ifa_addr->sa_family == AF_INET6) {
      const auto* found = reinterpret_cast<const sockaddr_in6*>(each->ifa_addr);
      net::ip::address_v6::bytes_type bytes;
      std::memcpy(bytes.data(), &found->sin6_addr, bytes.size());
      address = net::ip::address_v6(bytes);
      if (address.to_v6().is_link_local()) continue;  // a browser cannot open it
    } else {
      continue;
    }
    (address.is_loopback() ? loopback : others).push_back(address);
  }
  ::freeifaddrs(first);
  others.insert(others.end(), loopback.begin(), loopback.end());
  return others;
}

/// Every address at once is none that a browser could open: then one of the machine's own is named.
Started started_at(const tcp::endpoint& endpoint, const std::string& token) {
  std::vector<net::ip::address> addresses{endpoint.address()};
  Started started;
  if (endpoint.address().is_unspecified()) {
    addresses = own_addresses(endpoint.address().is_v6());
    if (addresses.empty()) addresses = {net::ip::address_v4::loopback()};
    for (const net::ip::address& each : addresses) started.hosts.push_back(host_and_port({each, endpoint.port()}));
    started.hosts.push_back(fmt::format("localhost:{}", endpoint.port()));
  }
  started.address = fmt::format("http://{}/{}", host_and_port({addresses.front(), endpoint.port()}),
                                token.empty() ? "" : "#token=" + token);
  return started;
}

net::ip::address address_of(const std::string& host, beast::error_code& error) {
  return net::ip::make_address(host == "localhost" ? "127.0.0.1" : host, error);
}

}  // namespace

std::size_t Shared::connections_of(const std::string& client) const {
  return static_cast<std::size_t>(
      std::ranges::count_if(connections, [&](const Connection* each) { return each->client() == client; }));
}

std::size_t Shared::work_of(const std::string& client) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      connections, [&](const Connection* each) { return each->works() && each->client() == client; }));
}

bool is_address(const std::string& host) {
  beast::error_code error;
  (void)address_of(host, error);
  return !error;
}

void serve(Api& api, const HttpOptions& options, const std::function<void(const Started&)>& started) try {
  beast::error_code error;
  const net::ip::address address = address_of(options.host, error);
  if (error) throw boost::system::system_error(error);
  net::io_context sockets(1);
  WorkQueue work(count_of_hastes, std::max(1U, std::thread::hardware_concurrency()), options.limits.waiting);
  Shared shared{api, options.limits, embedded_pages(), address.is_loopback() ? "" : random_token(), work};
  Listener listener(sockets, shared, {address, options.port});
  started(started_at(listener.endpoint(), shared.token));
  sockets.run();
} catch (const boost::system::system_error& error) {
  throw std::system_error(error.code().value(), std::system_category(), options.host);
}

}  // namespace zwidth::server
