#pragma once

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "server/http/admission.hpp"
#include "server/http/http_server.hpp"
#include "server/http/page.hpp"
#include "server/http/work_queue.hpp"

namespace zwidth::server {

class Connection;

// Beast takes long to compile: included by connection.cpp and http_server.cpp alone, which are compiled as one.

/// What the connections share. All of it but `api` belongs to the one thread of the sockets.
struct Shared {
  Api& api;
  const HttpLimits limits;
  std::map<std::string, Page, std::less<>> pages;
  std::string token;
  WorkQueue& work;
  std::set<Connection*> connections = {};
  std::size_t bodies = 0;  ///< bytes that requests announced
  bool stops = false;
  std::function<void()> all_gone = {};   ///< called when it stops and the last connection has ended
  std::function<void()> work_runs = {};  ///< called when some begins: from now on who leaves is looked for

  /// By their addresses: on loopback all have that of this machine.
  [[nodiscard]] bool tells_clients() const { return !token.empty(); }
  [[nodiscard]] std::size_t connections_of(const std::string& client) const;
  /// Requests of theirs that are at work or wait.
  [[nodiscard]] std::size_t work_of(const std::string& client) const;
};

/// One client: reads a request, has it answered, writes the answer, and so on. Lives as long as something of it waits.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(boost::asio::ip::tcp::socket socket, Shared& shared);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start();
  /// The server ends: what runs is answered, what does not yet run goes.
  void stop();
  /// What runs is ended where it next tells its progress.
  void cancel();
  void close();
  /// Whether work runs; that of a client that has left is ended.
  bool look();
  [[nodiscard]] const std::string& client() const { return client_; }
  [[nodiscard]] bool works() const { return works_; }

 private:
  using Error = boost::beast::error_code;
  using Response = boost::beast::http::response<boost::beast::http::string_body>;

  void read_head();
  void read_more_of_head();
  void on_head(Error error);
  void parse_head();
  /// What is being read is given up after that time.
  void end_reading_after(std::chrono::seconds time);
  void refuse_late(const char* what, std::chrono::seconds time);
  void refuse_large_head();
  void invite_body();
  void read_body();
  void on_body(Error error);
  void dispatch();
  void dispatch_work(const Route& route);
  void on_answer(const ApiAnswer& answer);
  void send_page(const Page& page);
  void send(int status, std::string document, const std::string& allow = {});
  void send(Response response);
  void on_sent(bool keeps);
  void refuse(const Refusal& refusal);
  void drain();
  void release_body();

  // Progress as lines of JSON while the work runs, the document as the last.
  void begin_stream();
  void put_in_stream(const std::string& line);
  void end_stream(const std::string& document);
  void write_stream();

  [[nodiscard]] RequestHead head() const;
  [[nodiscard]] Site site() const;
  [[nodiscard]] const Route* route() const;

  boost::beast::tcp_stream stream_;
  boost::asio::steady_timer late_;
  bool is_late_ = false;
  Shared& shared_;
  const std::string client_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
  std::size_t body_ = 0;  // bytes announced
  bool works_ = false;
  bool keeps_ = true;
  std::shared_ptr<std::atomic<bool>> cancelled_;
  std::shared_ptr<Response> response_;
  bool streams_ = false;
  bool stream_ends_ = false;
  bool writes_ = false;
  std::deque<std::string> lines_;
  std::size_t drained_ = 0;
};

}  // namespace zwidth::server
