#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "rig/driver.hpp"
#include "rig/udp_frame.hpp"

namespace zwidth::rig {

/// Where a drive listens.
struct UdpAddress {
  std::string host;  ///< a name, or an address of IPv4 or IPv6, without brackets
  std::string port;
};

/// "HOST:PORT", "[::1]:PORT" for an address of IPv6; or what is wrong with it.
[[nodiscard]] tl::expected<UdpAddress, DriveProblem> udp_address(std::string_view text);

/// A drive that speaks UdpFrame: one question and one force per cycle. Its watchdog lets go after 100 ms without a force.
class UdpDriver : public Driver {
 public:
  /// `address` as of udp_address(). `lock_step`: the drive is a simulation whose time moves with the forces it gets.
  /// Throws DriverFailed for an address that is none, and where the drive does not answer within a second.
  UdpDriver(const std::string& address, double sampling_period, bool lock_step = false);
  ~UdpDriver() override;

  [[nodiscard]] const DriverFacts& facts() const noexcept override { return facts_; }
  void arm() override {}
  [[nodiscard]] std::optional<double> measure() noexcept override;
  [[nodiscard]] std::optional<DriveProblem> trouble() const override;
  [[nodiscard]] std::optional<bool> proves_watchdog() override;

 protected:
  void send(double force) noexcept override;
  void send_idle() noexcept override;

 private:
  /// The answer to a frame with this force, waiting that long.
  [[nodiscard]] std::optional<UdpFrame> answer(double force, std::int64_t patience) noexcept;
  std::uint32_t send_frame(double force) noexcept;

  DriverFacts facts_;
  int socket_ = -1;
  std::int64_t patience_ = 0;  // ns, for a position
  std::atomic<std::uint32_t> sequence_ = 0;
  bool has_sent_ = false;    // a force, in a cycle
  bool has_let_go_ = false;  // all the same, by the last answer
};

}  // namespace zwidth::rig
