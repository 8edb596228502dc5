#include "cli/served.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <cstdlib>
#include <stdexcept>

namespace zwidth::cli {
namespace {

constexpr int longest_answer_ms = 120'000;

/// The value of "Content-Length: 12" in a head; 0 where there is none.
std::size_t length_in(const std::string& head) {
  const std::size_t at = head.find("Content-Length: ");
  return at == std::string::npos ? 0 : std::strtoul(head.c_str() + at + 16, nullptr, 10);
}

}  // namespace

Client::Client(int port, const char* from) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  ::inet_pton(AF_INET, from, &address.sin_addr);
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("cannot bind");
  }
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("cannot connect");
  }
}

Client::~Client() { leave(); }

void Client::leave() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

void Client::send(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;  // the server has had enough; its answer tells why
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

bool Client::receive() {
  pollfd wait{socket_, POLLIN, 0};
  if (::poll(&wait, 1, longest_answer_ms) <= 0) return false;
  char piece[1 << 16];
  const ssize_t got = ::recv(socket_, piece, sizeof piece, 0);
  if (got <= 0) return false;
  received_.append(piece, static_cast<std::size_t>(got));
  return true;
}

HttpAnswer Client::answer() {
  std::size_t end = std::string::npos;
  while ((end = received_.find("\r\n\r\n")) == std::string::npos) {
    if (!receive()) return {0, "", received_};
  }
  HttpAnswer answer{std::atoi(received_.c_str() + 9), received_.substr(0, end + 4), ""};
  received_.erase(0, end + 4);
  if (answer.head.find("Transfer-Encoding: chunked") != std::string::npos) {
    while (received_.find("0\r\n\r\n") == std::string::npos && receive()) {
    }
    for (std::size_t size = 1; size > 0;) {
      std::size_t digits = 0;
      size = std::stoul(received_, &digits, 16);
      answer.body += received_.substr(digits + 2, size);
      received_.erase(0, digits + 2 + size + 2);
    }
    return answer;
  }
  const std::size_t length = length_in(answer.head);
  while (received_.size() < length && receive()) {
  }
  answer.body = received_.substr(0, length);
  received_.erase(0, length);
  return answer;
}

bool Client::is_ended_within(std::chrono::seconds time) {
  pollfd wait{socket_, POLLIN, 0};
  const auto milliseconds = std::chrono::duration_cast<std::chrono::milliseconds>(time).count();
  if (::poll(&wait, 1, static_cast<int>(milliseconds)) <= 0) return false;
  char next = 0;
  return ::recv(socket_, &next, 1, 0) <= 0;
}

Served::~Served() {
  if (process_ > 0) stop(SIGKILL);
}

void Served::start(const std::vector<std::string>& arguments) {
  int pipe[2];
  if (::pipe(pipe) != 0) throw std::runtime_error("no pipe");
  std::vector<std::string> all{"zwidth", "serve", "--port", "0"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& each : all) pointers.push_back(each.data());
  pointers.push_back(nullptr);
  process_ = ::fork();
  if (process_ == 0) {
    ::dup2(pipe[1], STDOUT_FILENO);
    ::close(pipe[0]);
    ::close(pipe[1]);
    if (::chdir(directory().c_str()) != 0) ::_exit(127);
    ::execv(ZWIDTH_PROGRAM_DIR "/zwidth", pointers.data());
    ::_exit(127);
  }
  ::close(pipe[1]);
  output_ = pipe[0];
  address_.clear();
  for (char letter = 0; ::read(output_, &letter, 1) == 1 && letter != '\n';) address_ += letter;
  const std::size_t colon = address_.find(':', 7);
  if (colon == std::string::npos) throw std::runtime_error("no address: " + address_);
  port_ = std::atoi(address_.c_str() + colon + 1);
}

int Served::stop(int signal) {
  ::kill(process_, signal);
  int raw = 0;
  ::waitpid(process_, &raw, 0);
  process_ = 0;
  ::close(output_);
  return WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
}

bool Served::is_alive() const {
  return ::waitpid(process_, nullptr, WNOHANG) == 0 && get("/api/v1/health").status == 200;
}

std::string Served::request(const std::string& method, const std::string& path, const std::string& body,
                            const std::string& headers) const {
  const std::string length = method == "POST" ? fmt::format("Content-Length: {}\r\n", body.size()) : "";
  return fmt::format("{} {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}{}\r\n{}", method, path, port_, length, headers, body);
}

HttpAnswer Served::exchange(std::string_view bytes) const {
  Client client(port_);
  client.send(bytes);
  return client.answer();
}

HttpAnswer Served::post(const std::string& command, const std::string& document, const std::string& headers) const {
  return exchange(request("POST", "/api/v1/" + command, document, "Content-Type: application/json\r\n" + headers));
}

HttpAnswer Served::upload(std::string_view bytes) const {
  return exchange(
      request("POST", "/api/v1/recordings", std::string(bytes), "Content-Type: application/octet-stream\r\n"));
}

}  // namespace zwidth::cli
