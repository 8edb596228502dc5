#include "rig/socketcan_bus.hpp"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "rig/driver.hpp"
#include "rig/real_time.hpp"

namespace zwidth::rig {
namespace {

DriverFailed failed(DriveProblemCode code, const std::string& interface) {
  return DriverFailed(code, {}, {{"interface", interface}, {"reason", std::strerror(errno)}});
}

/// Brings the socket to the interface, for frames of CAN FD too where `has_fd`.
void attach(int socket, const std::string& interface, bool has_fd) {
  ifreq request{};
  if (interface.size() >= sizeof(request.ifr_name)) {
    errno = ENODEV;
  } else {
    std::copy(interface.begin(), interface.end(), request.ifr_name);
  }
  if (interface.size() >= sizeof(request.ifr_name) || ioctl(socket, SIOCGIFINDEX, &request) != 0) {
    throw failed(DriveProblemCode::interface_unknown, interface);
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  if (ioctl(socket, SIOCGIFFLAGS, &request) != 0 || (request.ifr_flags & IFF_UP) == 0) {
    errno = ENETDOWN;
    throw failed(DriveProblemCode::interface_down, interface);
  }
  const int on = 1;
  if (has_fd) {
    if (ioctl(socket, SIOCGIFMTU, &request) != 0 || request.ifr_mtu != CANFD_MTU ||
        setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) != 0) {
      errno = EPROTONOSUPPORT;
      throw failed(DriveProblemCode::interface_without_can_fd, interface);
    }
  }
  if (bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw failed(DriveProblemCode::interface_not_opened, interface);
}

}  // namespace

SocketcanBus::SocketcanBus(const std::string& interface, bool has_fd)
    : socket_(socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW)) {
  if (socket_ < 0) throw failed(DriveProblemCode::no_socketcan, interface);
  try {
    attach(socket_, interface, has_fd);
  } catch (...) {
    close(socket_);
    throw;
  }
}

SocketcanBus::~SocketcanBus() { close(socket_); }

bool SocketcanBus::send(const CanFrame& frame) noexcept {
  canfd_frame sent{};
  sent.can_id = frame.id | (frame.is_extended ? CAN_EFF_FLAG : 0U) | (frame.is_remote ? CAN_RTR_FLAG : 0U);
  sent.len = static_cast<__u8>(frame.size);
  if (frame.is_fd) sent.flags = CANFD_BRS;
  std::copy_n(frame.bytes.begin(), frame.data().size(), sent.data);
  const std::size_t size = frame.is_fd ? CANFD_MTU : CAN_MTU;  // one begins as the other does
  return ::write(socket_, &sent, size) == static_cast<ssize_t>(size);
}

std::optional<CanFrame> SocketcanBus::receive(std::int64_t until) noexcept {
  for (;;) {
    canfd_frame got{};
    const ssize_t count = ::read(socket_, &got, sizeof got);
    if (count == CAN_MTU || count == CANFD_MTU) {
      if ((got.can_id & CAN_ERR_FLAG) != 0) continue;
      CanFrame frame;
      frame.is_extended = (got.can_id & CAN_EFF_FLAG) != 0;
      frame.is_remote = (got.can_id & CAN_RTR_FLAG) != 0;
      frame.is_fd = count == CANFD_MTU;
      frame.id = got.can_id & (frame.is_extended ? CAN_EFF_MASK : CAN_SFF_MASK);
      frame.size = std::min<std::size_t>(got.len, CanFrame::most_bytes);
      std::copy_n(got.data, frame.data().size(), frame.bytes.begin());
      return frame;
    }
    if (count < 0 && errno != EAGAIN && errno != EINTR) {
      is_gone_ = true;
      return std::nullopt;
    }
    const std::int64_t left = std::max<std::int64_t>(0, until - clock_now());
    pollfd waiting{socket_, POLLIN, 0};
    const timespec longest{left / 1'000'000'000, left % 1'000'000'000};
    const int ready = ppoll(&waiting, 1, &longest, nullptr);
    if (left == 0 && ready <= 0) return std::nullopt;
  }
}

}  // namespace zwidth::rig
