#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

#include "rig/udp_frame.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth::test {

/// A drive on a UDP socket as examples/udp_drive is one, around a simulated device: its time moves one sampling period
/// with each force, and its watchdog runs on the clock.
class UdpEmulator {
 public:
  enum class Fault { none, silent, unplugged, half_frames, wrong_checksum, not_a_number, late, stalled, no_watchdog };
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds watchdog{100};

  explicit UdpEmulator(const Device& device)
      : loop_(device, {}), socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof own;
    const timeval wake{0, 2000};
    if (socket_ < 0 || bind(socket_, as_address(own), size) != 0 || getsockname(socket_, as_address(own), &size) != 0 ||
        setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &wake, sizeof wake) != 0) {
      throw std::runtime_error("no UDP socket");
    }
    port_ = ntohs(own.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  ~UdpEmulator() {
    is_ending_ = true;
    thread_.join();
    close(socket_);
  }
  UdpEmulator(const UdpEmulator&) = delete;
  UdpEmulator& operator=(const UdpEmulator&) = delete;

  [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  void set_fault(Fault fault) { fault_ = fault; }
  /// Where frames are cut off or falsified: any number.
  void set_place(unsigned place) { place_ = place; }
  /// Of the motor; 0 after the watchdog has let go.
  [[nodiscard]] double force() const { return force_; }
  [[nodiscard]] bool has_let_go() const { return has_let_go_; }
  /// Forces that were taken, and those of them that are not zero.
  [[nodiscard]] int forces() const { return forces_; }
  [[nodiscard]] int nonzero_forces() const { return nonzero_forces_; }
  [[nodiscard]] int times_let_go() const { return times_let_go_; }

 private:
  static sockaddr* as_address(sockaddr_in& address) { return reinterpret_cast<sockaddr*>(&address); }

  void run() {
    sched_param priority{};  // where that is allowed: firmware has a processor of its own
    priority.sched_priority = 90;
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
    std::array<std::byte, 64> bytes{};
    sockaddr_in peer{};
    while (!is_ending_) {
      socklen_t size = sizeof peer;
      const ssize_t count = recvfrom(socket_, bytes.data(), bytes.size(), 0, as_address(peer), &size);
      if (!has_let_go_ && fault_ != Fault::no_watchdog && Clock::now() - last_force_ > watchdog) {
        has_let_go_ = true;
        force_ = 0.0;
        ++times_let_go_;
      }
      if (fault_ == Fault::stalled) {  // frames wait in the socket
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        continue;
      }
      if (count < 0 || fault_ == Fault::unplugged) continue;
      const auto frame = rig::decoded_udp_frame({bytes.data(), static_cast<std::size_t>(count)});
      const bool is_owner = peer.sin_port == owner_.sin_port;
      if (frame && (has_let_go_ || is_owner)) answer(*frame, peer);
    }
  }

  void answer(rig::UdpFrame frame, sockaddr_in& peer) {
    if (std::isfinite(frame.force)) {
      owner_ = peer;
      has_let_go_ = false;
      last_force_ = Clock::now();
      force_ = frame.force;
      loop_.move(frame.force);
      ++forces_;
      if (frame.force != 0.0) ++nonzero_forces_;
    }
    const Fault fault = fault_;
    if (fault == Fault::silent) return;
    frame.position = fault == Fault::not_a_number ? std::numeric_limits<double>::quiet_NaN() : loop_.measure();
    frame.force = has_let_go_ ? std::numeric_limits<double>::quiet_NaN() : force_.load();
    auto bytes = rig::encoded(frame);
    const std::size_t place = place_ % bytes.size();
    if (fault == Fault::wrong_checksum) bytes[place] ^= std::byte{1};
    if (fault == Fault::late) std::this_thread::sleep_for(std::chrono::milliseconds(60));
    const std::size_t size = fault == Fault::half_frames ? place : bytes.size();
    sendto(socket_, bytes.data(), size, 0, as_address(peer), sizeof peer);
  }

  HybridLoop loop_;
  int socket_;
  int port_ = 0;
  sockaddr_in owner_{};
  Clock::time_point last_force_;
  std::atomic<bool> is_ending_ = false;
  std::atomic<Fault> fault_ = Fault::none;
  std::atomic<unsigned> place_ = 20;
  std::atomic<bool> has_let_go_ = true;
  std::atomic<double> force_ = 0.0;
  std::atomic<int> forces_ = 0;
  std::atomic<int> nonzero_forces_ = 0;
  std::atomic<int> times_let_go_ = 0;
  std::thread thread_;
};

}  // namespace zwidth::test
