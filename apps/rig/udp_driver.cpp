#include "rig/udp_driver.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <ctime>
#include <limits>
#include <system_error>

#include "rig/real_time.hpp"

namespace zwidth::rig {
namespace {

constexpr std::int64_t first_patience = 1'000'000'000;  // ns
constexpr int first_questions = 10;                     // within it
constexpr double watchdog = 0.1;                        // s, of the protocol
constexpr std::int64_t silence = 250'000'000;           // ns, after which it must have let go
constexpr double share_of_period = 0.5;                 // for a position
constexpr std::int64_t lock_step_patience = 500'000'000;
constexpr int most_port = 65535;
constexpr int idle_frames = 3;  // one may be lost
constexpr double question = std::numeric_limits<double>::quiet_NaN();

int connected_socket(const std::string& text) {
  const auto address = udp_address(text);
  if (!address) throw DriverFailed(address.error());
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_DGRAM;
  wanted.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (const int failure = getaddrinfo(address->host.c_str(), address->port.c_str(), &wanted, &found); failure != 0) {
    throw DriverFailed(DriveProblemCode::address_unknown, {}, {{"reason", gai_strerror(failure)}});
  }
  int connected = -1;
  for (const addrinfo* each = found; each != nullptr && connected < 0; each = each->ai_next) {
    const int candidate = socket(each->ai_family, each->ai_socktype | SOCK_CLOEXEC, each->ai_protocol);
    if (candidate < 0) continue;
    if (connect(candidate, each->ai_addr, each->ai_addrlen) == 0) {
      connected = candidate;
    } else {
      close(candidate);
    }
  }
  freeaddrinfo(found);
  if (connected < 0) throw DriverFailed(DriveProblemCode::address_not_reached, {}, {{"reason", std::strerror(errno)}});
  return connected;
}

}  // namespace

tl::expected<UdpAddress, DriveProblem> udp_address(std::string_view text) {
  const auto wrong = [](DriveProblemCode code) { return tl::unexpected(DriveProblem{code}); };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || text.ends_with(']')) return wrong(DriveProblemCode::address_without_port);
  std::string_view host = text.substr(0, colon);
  const std::string_view port = text.substr(colon + 1);
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find_first_of(":[]") != std::string_view::npos) {
    return wrong(DriveProblemCode::address_without_brackets);
  }
  if (host.empty()) return wrong(DriveProblemCode::address_without_host);
  if (port.empty()) return wrong(DriveProblemCode::address_without_port);
  int number = 0;  // getaddrinfo() takes 99999 for 34463
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (error != std::errc{} || end != port.data() + port.size() || number < 1 || number > most_port) {
    return tl::unexpected(DriveProblem{
        DriveProblemCode::no_port_number, {{"most", static_cast<double>(most_port)}}, {{"port", std::string(port)}}});
  }
  return UdpAddress{std::string(host), std::string(port)};
}

UdpDriver::UdpDriver(const std::string& address, double sampling_period, bool lock_step)
    : facts_{.name = "udp:" + address, .lock_step = lock_step, .watchdog = watchdog},
      socket_(connected_socket(address)),
      patience_(lock_step ? lock_step_patience : std::llround(1e9 * share_of_period * sampling_period)) {
  for (int i = 0; i < first_questions; ++i) {
    const std::int64_t begin = clock_now();
    if (answer(question, first_patience / first_questions)) return;
    sleep_until(begin + first_patience / first_questions);  // a refused port answers at once
  }
  close(socket_);
  throw DriverFailed(DriveProblemCode::silent_udp);
}

UdpDriver::~UdpDriver() { close(socket_); }

std::uint32_t UdpDriver::send_frame(double force) noexcept {
  UdpFrame frame;
  frame.sequence = sequence_.fetch_add(1, std::memory_order_relaxed) + 1;
  frame.time = 1e-9 * static_cast<double>(clock_now());
  frame.force = force;
  const auto bytes = encoded(frame);
  (void)::send(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);  // one that is lost is missed above
  return frame.sequence;
}

std::optional<UdpFrame> UdpDriver::answer(double force, std::int64_t patience) noexcept {
  const std::uint32_t sequence = send_frame(force);
  const std::int64_t until = clock_now() + patience;
  for (;;) {
    std::array<std::byte, UdpFrame::size + 1> bytes;  // NOLINT(*-member-init): recv() fills it
    const ssize_t size = recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size >= 0) {
      const auto frame = decoded_udp_frame({bytes.data(), static_cast<std::size_t>(size)});
      if (frame && frame->sequence == sequence) return frame;
      continue;  // an answer to an older frame, or none at all
    }
    if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) return std::nullopt;
    const std::int64_t left = until - clock_now();
    if (left <= 0) return std::nullopt;
    pollfd waiting{socket_, POLLIN, 0};
    const timespec longest{left / 1'000'000'000, left % 1'000'000'000};
    ppoll(&waiting, 1, &longest, nullptr);
  }
}

std::optional<double> UdpDriver::measure() noexcept {
  const auto frame = answer(question, patience_);
  if (!frame) return std::nullopt;
  // What the loop sends then moves nothing. (A simulation in lock step waits for no clock, nor does its watchdog matter.)
  has_let_go_ = has_sent_ && !facts_.lock_step && !is_disarmed() && std::isnan(frame->force);
  if (has_let_go_) return std::nullopt;
  return frame->position;
}

std::optional<DriveProblem> UdpDriver::trouble() const {
  if (!has_let_go_) return std::nullopt;
  return DriveProblem{DriveProblemCode::udp_let_go};
}

void UdpDriver::send(double force) noexcept {
  has_sent_ = true;
  send_frame(force);
}

void UdpDriver::send_idle() noexcept {
  for (int i = 0; i < idle_frames; ++i) send_frame(0.0);
}

std::optional<bool> UdpDriver::proves_watchdog() {
  if (facts_.lock_step) return std::nullopt;
  const auto ask = [&](double force) {
    const auto frame = answer(force, first_patience);
    if (!frame) throw DriverFailed(DriveProblemCode::silent_now);
    return *frame;
  };
  bool has_taken_hold = false;
  for (int i = 0; i < proofs; ++i) {
    (void)ask(0.0);
    if (std::isnan(ask(question).force)) continue;  // it never does, or a pause made it let go again
    has_taken_hold = true;
    sleep_until(clock_now() + silence);
    if (std::isnan(ask(question).force)) return true;
  }
  if (!has_taken_hold) throw DriverFailed(DriveProblemCode::udp_takes_no_force);
  facts_.watchdog.reset();
  return false;
}

}  // namespace zwidth::rig
