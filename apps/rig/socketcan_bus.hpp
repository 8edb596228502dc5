#pragma once

#include <string>

#include "rig/can_bus.hpp"

namespace zwidth::rig {

/// A CAN bus behind an interface of Linux's SocketCAN, whose rates are those that `ip link` gave it.
///
/// Untried: no machine of this project's has CAN in its kernel. The kernel keeps an interface for no one program alone.
class SocketcanBus : public CanBus {
 public:
  /// Throws DriverFailed where there is no such interface, it is down, or has no CAN FD though `has_fd`.
  SocketcanBus(const std::string& interface, bool has_fd);
  ~SocketcanBus() override;

  bool send(const CanFrame& frame) noexcept override;
  [[nodiscard]] std::optional<CanFrame> receive(std::int64_t until) noexcept override;
  [[nodiscard]] bool is_gone() const noexcept override { return is_gone_; }
  void drop_unsent() noexcept override {}  // what the kernel's queue holds leaves within a frame's time

 private:
  int socket_ = -1;
  bool is_gone_ = false;
};

}  // namespace zwidth::rig
