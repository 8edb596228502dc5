#include "server/http/connection.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/ip/network_v6.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <exception>
#include <sstream>
#include <utility>

namespace zwidth::server {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using tcp = net::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds between_lines{100};     // of progress
constexpr std::size_t largest_body = std::size_t{1} << 40;  // each route has its own limit
constexpr std::size_t kept_by_allocator = std::size_t{1} << 20;
constexpr std::size_t most_drained = std::size_t{16} << 20;
constexpr const char* stream_type = "application/x-ndjson";
constexpr std::string_view head_end = "\r\n\r\n";

template <typename Message>
void put_security_headers(Message& response) {
  for (const auto& [name, value] : security_headers()) response.set(name, value);
}

std::string_view view(boost::string_view text) { return {text.data(), text.size()}; }

std::string host_and_port(const tcp::endpoint& endpoint) {
  net::ip::address address = endpoint.address();
  if (address.is_v6() && address.to_v6().is_v4_mapped())
    address = net::ip::make_address_v4(net::ip::v4_mapped, address.to_v6());
  const std::string host = address.is_v6() ? "[" + address.to_string() + "]" : address.to_string();
  return fmt::format("{}:{}", host, endpoint.port());
}

/// Who calls: the address; of IPv6 its network of 64 bits, all of which one host may have.
std::string client_of(const tcp::socket& socket) {
  beast::error_code ignored;
  const net::ip::address address = socket.remote_endpoint(ignored).address();
  if (!address.is_v6() || address.to_v6().is_v4_mapped()) return address.to_string();
  return net::ip::make_network_v6(address.to_v6(), 64).canonical().to_string();
}

/// Of 80, browsers leave the port out.
void add_host(std::vector<std::string>& hosts, const std::string& host) {
  hosts.push_back(host);
  if (host.ends_with(":80")) hosts.push_back(host.substr(0, host.size() - 3));
}

/// By the state of the connection: bytes of a next request that were not read would hide its end from a reader.
bool is_there(int socket) {
  tcp_info state{};
  socklen_t size = sizeof state;
  return ::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &state, &size) == 0 && state.tcpi_state == TCP_ESTABLISHED;
}

std::string_view bytes_of(const beast::flat_buffer& buffer) {
  return {static_cast<const char*>(buffer.data().data()), buffer.size()};
}

/// A header that goes on in the next line: RFC 9112 has a server refuse it.
bool has_folded_line(const beast::flat_buffer& buffer) {
  const std::string_view bytes = bytes_of(buffer);
  const std::string_view head = bytes.substr(0, bytes.find(head_end));
  return head.find("\r\n ") != head.npos || head.find("\r\n\t") != head.npos;
}

std::string chunk(const std::string& text) { return fmt::format("{:x}\r\n{}\r\n", text.size(), text); }

}  // namespace

Connection::Connection(tcp::socket socket, Shared& shared)
    : stream_(std::move(socket)), late_(stream_.get_executor()), shared_(shared), client_(client_of(stream_.socket())) {
  shared_.connections.insert(this);
}

Connection::~Connection() {
  release_body();
  shared_.connections.erase(this);
  if (shared_.stops && shared_.connections.empty()) shared_.all_gone();
}

void Connection::start() {
  Error ignored;
  stream_.socket().set_option(tcp::no_delay(true), ignored);
  read_head();
}

void Connection::stop() {
  if (works_) {
    keeps_ = false;
  } else if (!writes_) {
    stream_.close();
  }
}

void Connection::cancel() {
  if (cancelled_) *cancelled_ = true;
}

void Connection::close() { stream_.close(); }

void Connection::release_body() { shared_.bodies -= std::exchange(body_, 0); }

/// The stream's own time would close the socket, and nobody be told why.
void Connection::end_reading_after(std::chrono::seconds time) {
  stream_.expires_never();
  is_late_ = false;
  late_.expires_after(time);
  late_.async_wait([self = shared_from_this()](Error error) {
    if (error) return;
    self->is_late_ = true;
    self->stream_.cancel();
  });
}

void Connection::refuse_late(const char* what, std::chrono::seconds time) {
  keeps_ = false;
  refuse({408, {what, "took too long", fmt::format("whole within {} s", time.count())}});
}

void Connection::refuse_large_head() {
  refuse({413, {"head", "is too large", fmt::format("at most {}", size_in_words(shared_.limits.head))}});
}

void Connection::read_head() {
  if (shared_.stops) return stream_.close();
  release_body();
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(shared_.limits.head));
  parser_->body_limit(largest_body);
  end_reading_after(shared_.limits.head_time);
  read_more_of_head();
}

void Connection::read_more_of_head() {
  constexpr std::size_t piece = 4096;
  if (bytes_of(buffer_).find(head_end) != std::string_view::npos) return on_head({});
  if (buffer_.size() >= shared_.limits.head) return on_head(http::error::header_limit);
  stream_.async_read_some(buffer_.prepare(piece), [self = shared_from_this()](Error error, std::size_t count) {
    self->buffer_.commit(count);
    error ? self->on_head(error) : self->read_more_of_head();
  });
}

RequestHead Connection::head() const {
  const auto& request = parser_->get();
  RequestHead head;
  head.method = view(request.method_string());
  head.target = view(request.target());
  head.content_type = view(request[http::field::content_type]);
  const auto all = [&](http::field name) {
    std::vector<std::string_view> values;
    const auto range = request.equal_range(name);
    for (auto each = range.first; each != range.second; ++each) values.push_back(view(each->value()));
    return values;
  };
  head.hosts = all(http::field::host);
  head.origins = all(http::field::origin);
  head.authorizations = all(http::field::authorization);
  head.content_lengths = all(http::field::content_length);
  head.has_content_encoding = request.count(http::field::content_encoding) > 0;
  head.has_transfer_encoding = request.count(http::field::transfer_encoding) > 0;
  head.content_length = parser_->content_length().value_or(0);
  return head;
}

Site Connection::site() const {
  Site site;
  Error ignored;
  const tcp::endpoint local = stream_.socket().local_endpoint(ignored);
  add_host(site.hosts, host_and_port(local));
  add_host(site.hosts, fmt::format("localhost:{}", local.port()));
  site.token = shared_.token;
  return site;
}

const Route* Connection::route() const {
  const std::string_view path = path_of(view(parser_->get().target()));
  for (const Route& each : shared_.api.routes()) {
    if (each.path == path) return &each;
  }
  return nullptr;
}

void Connection::on_head(Error error) {
  late_.cancel();
  keeps_ = false;  // until the request is known to be one
  if (error == http::error::header_limit) return refuse_large_head();
  if (is_late_ && buffer_.size() > 0) return refuse_late("head", shared_.limits.head_time);
  if (error) return stream_.close();
  parse_head();
}

void Connection::parse_head() {
  if (has_folded_line(buffer_)) return refuse({400, {"head", "has a folded line", "each header on a line of its own"}});
  Error error;
  buffer_.consume(parser_->put(buffer_.data(), error));
  if (error == http::error::header_limit) return refuse_large_head();
  if (error && !parser_->is_header_done())
    return refuse({400, {"request", "is no HTTP: " + error.message(), "HTTP/1.1"}});
  const RequestHead request = head();
  const Route* const asked = route();
  const std::string_view path = path_of(request.target);
  if (const auto refusal = find_refusal(request, site(), asked, shared_.pages.contains(path))) return refuse(*refusal);
  if (shared_.bodies + request.content_length > shared_.limits.bodies) {
    return refuse({503, {"", "busy: too much is being sent", "the same later"}});
  }
  body_ = request.content_length;
  shared_.bodies += body_;
  const std::string_view expected = view(parser_->get()[http::field::expect]);
  if (!expected.empty() && !beast::iequals(parser_->get()[http::field::expect], "100-continue")) {
    return refuse({400, {"Expect", "is not taken", "100-continue"}});
  }
  expected.empty() ? read_body() : invite_body();
}

void Connection::invite_body() {
  static constexpr std::string_view invitation = "HTTP/1.1 100 Continue\r\n\r\n";
  net::async_write(
      stream_, net::buffer(invitation.data(), invitation.size()),
      [self = shared_from_this()](Error error, std::size_t) { error ? self->stream_.close() : self->read_body(); });
}

void Connection::read_body() {
  // Mostly it came with the head: without another turn of the sockets.
  if (parser_->is_done()) return on_body({});
  if (buffer_.size() >= parser_->content_length().value_or(buffer_.size() + 1)) {
    Error error;
    parser_->eager(true);
    buffer_.consume(parser_->put(buffer_.data(), error));
    if (error || parser_->is_done()) return on_body(error);
  }
  end_reading_after(shared_.limits.body_time);
  http::async_read(stream_, buffer_, *parser_,
                   [self = shared_from_this()](Error error, std::size_t) { self->on_body(error); });
}

void Connection::on_body(Error error) {
  late_.cancel();
  if (is_late_) return refuse_late("body", shared_.limits.body_time);
  if (error) return stream_.close();
  keeps_ = parser_->get().keep_alive();
  dispatch();
}

void Connection::dispatch() {
  const Route* const asked = route();
  if (asked == nullptr) return send_page(shared_.pages.find(path_of(view(parser_->get().target())))->second);
  if (asked->method == "POST") return dispatch_work(*asked);
  ApiAnswer answer = shared_.api.answer(asked->path, "");
  send(answer.status, std::move(answer.document));
}

void Connection::dispatch_work(const Route& route) {
  works_ = true;
  cancelled_ = std::make_shared<std::atomic<bool>>(false);
  streams_ = parser_->get().version() >= 11 &&
             view(parser_->get()[http::field::accept]).find(stream_type) != std::string_view::npos;
  stream_.expires_never();
  const auto begin = Clock::now();
  struct Told {
    Clock::time_point next;
    double most = 0.0;  // of a command of several parts, each of which begins at 0
  };
  const auto told = std::make_shared<Told>(Told{begin + between_lines});
  // Called from other threads, one at a time, while the work holds this connection.
  const Progress progress = [this, cancelled = cancelled_, begin, told, streams = streams_](double fraction) {
    const auto now = Clock::now();
    if (*cancelled) throw Cancelled("cancelled");
    if (now - begin > shared_.limits.work_time) throw Cancelled("took too long");
    if (!streams || now < told->next) return;
    *told = {now + between_lines, std::max(told->most, fraction)};
    net::post(stream_.get_executor(), [self = shared_from_this(), most = told->most] {
      self->put_in_stream(fmt::format("{{\"progress\":{:.4f}}}\n", most));
    });
  };
  // Gives the connection back to the sockets' thread, where alone it may end.
  auto work = [self = shared_from_this(), path = route.path, progress,
               keeps_running = net::make_work_guard(stream_.get_executor())]() mutable {
    ApiAnswer answer;
    try {
      if (*self->cancelled_) throw Cancelled("cancelled");
      answer = self->shared_.api.answer(path, self->parser_->get().body(), progress);
    } catch (const Cancelled& cancelled) {
      answer = {503, error_document({"", cancelled.what(), "less work, or the same later"})};
    } catch (const std::exception& mistake) {
      answer = {500, error_document({"", mistake.what(), ""})};
    }
    const auto sockets = self->stream_.get_executor();
    net::post(sockets, [self = std::move(self), answer = std::move(answer)] { self->on_answer(answer); });
  };
  const bool is_over_share = shared_.tells_clients() && shared_.work_of(client_) > shared_.limits.waiting / 2;
  if (is_over_share || !shared_.work.add(static_cast<std::size_t>(route.haste), std::move(work))) {
    works_ = streams_ = false;
    Response busy(is_over_share ? http::status::too_many_requests : http::status::service_unavailable, 11);
    busy.set(http::field::retry_after, "1");
    busy.body() = is_over_share
                      ? error_document({"", "too many requests of yours wait", "the same when they are answered"})
                      : error_document({"", "busy: too many requests wait", "the same later"});
    return send(std::move(busy));
  }
  if (streams_) begin_stream();
  shared_.work_runs();
}

bool Connection::look() {
  if (works_ && !is_there(stream_.socket().native_handle())) cancel();
  return works_;
}

void Connection::on_answer(const ApiAnswer& answer) {
  works_ = false;
  if (streams_) return end_stream(answer.document);
  send(answer.status, answer.document);
}

void Connection::send(int status, std::string document, const std::string& allow) {
  Response response(static_cast<http::status>(status), 11);
  if (!allow.empty()) response.set(http::field::allow, allow);
  response.body() = std::move(document);
  send(std::move(response));
}

void Connection::send_page(const Page& page) {
  Response response(http::status::ok, 11);
  response.set(http::field::content_type, beast::string_view(page.content_type.data(), page.content_type.size()));
  response.set(http::field::cache_control, beast::string_view(page.cache_control.data(), page.cache_control.size()));
  response.set(http::field::vary, "Accept-Encoding");
  if (takes_gzip(view(parser_->get()[http::field::accept_encoding]))) {
    response.set(http::field::content_encoding, "gzip");
    response.body() = page.gzipped;
  } else {
    response.body() = page.plain;
  }
  send(std::move(response));
}

void Connection::send(Response response) {
  if (response.count(http::field::content_type) == 0) {
    response.set(http::field::content_type, "application/json");
    response.set(http::field::cache_control, "no-store");
  }
  put_security_headers(response);
  keeps_ = keeps_ && !shared_.stops;
  response.version(parser_->get().version() >= 11 ? 11 : 10);
  response.keep_alive(keeps_);
  response.content_length(response.body().size());
  if (parser_->get().method() == http::verb::head) response.body().clear();
  writes_ = true;
  response_ = std::make_shared<Response>(std::move(response));
  stream_.expires_after(shared_.limits.write_time);
  http::async_write(stream_, *response_, [self = shared_from_this()](Error error, std::size_t) {
    const std::size_t size = std::exchange(self->response_, nullptr)->body().size();
    if (size > kept_by_allocator) ::malloc_trim(0);  // or the heap stays as large as the largest answer
    self->on_sent(!error && self->keeps_);
  });
}

void Connection::on_sent(bool keeps) {
  writes_ = false;
  keeps ? read_head() : drain();
}

void Connection::refuse(const Refusal& refusal) {
  keeps_ = false;  // its body, if it has one, is not read
  send(refusal.status, error_document(refusal.problem), refusal.allow);
}

/// The end: what the client still sends is read for a moment, or the system would throw our answer away with it.
void Connection::drain() {
  Error ignored;
  if (drained_ == 0) {
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    if (shared_.stops) return stream_.close();
    stream_.expires_after(std::chrono::seconds(2));
  }
  buffer_.clear();
  constexpr std::size_t piece = 1 << 16;
  stream_.async_read_some(buffer_.prepare(piece), [self = shared_from_this()](Error error, std::size_t count) {
    self->drained_ += count + 1;
    if (error || self->drained_ > most_drained || self->shared_.stops) return self->stream_.close();
    self->drain();
  });
}

void Connection::begin_stream() {
  keeps_ = keeps_ && !shared_.stops;
  http::response<http::string_body> head(http::status::ok, 11);
  head.set(http::field::content_type, stream_type);
  head.set(http::field::cache_control, "no-store");
  put_security_headers(head);
  head.keep_alive(keeps_);
  head.chunked(true);
  std::ostringstream text;
  text << head.base();
  stream_ends_ = false;
  lines_.push_back(text.str());
  write_stream();
}

/// Left out where the client has not yet taken the line before.
void Connection::put_in_stream(const std::string& line) {
  if (!works_ || !streams_ || writes_) return;
  lines_.push_back(chunk(line));
  write_stream();
}

void Connection::end_stream(const std::string& document) {
  stream_ends_ = true;
  lines_.push_back(chunk(document) + "0\r\n\r\n");
  if (!writes_) write_stream();
}

void Connection::write_stream() {
  writes_ = true;
  stream_.expires_after(shared_.limits.write_time);
  net::async_write(stream_, net::buffer(lines_.front()), [self = shared_from_this()](Error error, std::size_t) {
    self->lines_.pop_front();
    self->stream_.expires_never();
    if (error) {
      self->cancel();
      self->lines_.clear();
    }
    if (!error && !self->lines_.empty()) return self->write_stream();
    self->writes_ = false;
    if (self->stream_ends_) {
      self->streams_ = false;
      self->on_sent(!error && self->keeps_);
    }
  });
}

}  // namespace zwidth::server
