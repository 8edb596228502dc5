#pragma once

#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <string>
#include <string_view>
#include <vector>

#include "cli/workspace.hpp"

namespace zwidth::cli {

/// An answer of the server, taken apart.
struct HttpAnswer {
  int status = 0;  ///< 0: the connection ended without an answer
  std::string head;
  std::string body;
};

/// A connection to the server, as bytes.
class Client {
 public:
  /// `from`: one of the addresses of loopback, all of which are this machine's.
  explicit Client(int port, const char* from = "127.0.0.1");
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send(std::string_view bytes) const;
  /// The next answer; what came beyond it is kept for the one after.
  [[nodiscard]] HttpAnswer answer();
  /// Whether the server ends the connection within that time, with nothing more to say.
  [[nodiscard]] bool is_ended_within(std::chrono::seconds time);
  /// Ends the connection at once.
  void leave();

 private:
  [[nodiscard]] bool receive();

  int socket_;
  std::string received_;
};

/// A workspace in which the program serves at a port of its own.
class Served : public Workspace {
 protected:
  ~Served() override;

  /// Starts `zwidth serve --port 0 ARGUMENTS...`, whatever the environment gives it before; waits for its address.
  void start(const std::vector<std::string>& arguments = {});
  /// Sends the signal, and returns the exit status; 128 + N when a signal ended it.
  int stop(int signal = SIGINT);
  [[nodiscard]] bool is_alive() const;

  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] pid_t process() const { return process_; }

  /// A whole request as bytes: HTTP/1.1, the right Host, Content-Length. `headers`: further lines, each with \r\n.
  [[nodiscard]] std::string request(const std::string& method, const std::string& path, const std::string& body = {},
                                    const std::string& headers = {}) const;
  /// One request on a connection of its own.
  [[nodiscard]] HttpAnswer exchange(std::string_view bytes) const;
  [[nodiscard]] HttpAnswer get(const std::string& path) const { return exchange(request("GET", path)); }
  /// POST /api/v1/COMMAND
  [[nodiscard]] HttpAnswer post(const std::string& command, const std::string& document,
                                const std::string& headers = {}) const;
  [[nodiscard]] HttpAnswer upload(std::string_view bytes) const;

 private:
  pid_t process_ = 0;
  int output_ = -1;
  std::string address_;
  int port_ = 0;
};

}  // namespace zwidth::cli
