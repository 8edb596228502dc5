#include "rig/serial_port.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <vector>

#include "rig/driver.hpp"
#include "rig/real_time.hpp"

namespace zwidth::rig {
namespace {

struct Speed {
  int baud;
  speed_t code;
};

constexpr std::array<Speed, 20> speeds{
    {{1200, B1200},       {2400, B2400},       {4800, B4800},       {9600, B9600},       {19200, B19200},
     {38400, B38400},     {57600, B57600},     {115200, B115200},   {230400, B230400},   {460800, B460800},
     {500000, B500000},   {576000, B576000},   {921600, B921600},   {1000000, B1000000}, {1152000, B1152000},
     {1500000, B1500000}, {2000000, B2000000}, {2500000, B2500000}, {3000000, B3000000}, {4000000, B4000000}}};

speed_t speed_of(int baud) {
  const auto* const found = std::ranges::find(speeds, baud, &Speed::baud);
  if (found != speeds.end()) return found->code;
  std::vector<int> all;
  for (const Speed& each : speeds) all.push_back(each.baud);
  throw DriverFailed(DriveProblemCode::speed_unknown, {{"baud", static_cast<double>(baud)}},
                     {{"known", fmt::format("{}", fmt::join(all, ", "))}});
}

void configure(int file, speed_t speed) {
  termios settings{};
  if (tcgetattr(file, &settings) != 0) throw DriverFailed(DriveProblemCode::not_a_serial_port);
  cfmakeraw(&settings);
  settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB | HUPCL);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  termios got{};
  if (cfsetspeed(&settings, speed) != 0 || tcsetattr(file, TCSANOW, &settings) != 0 || tcgetattr(file, &got) != 0 ||
      cfgetospeed(&got) != speed) {
    throw DriverFailed(DriveProblemCode::speed_refused, {}, {{"reason", std::strerror(errno)}});
  }
  tcflush(file, TCIOFLUSH);
  serial_struct line{};  // an adapter that gathers bytes for 16 ms is asked not to, where its driver can be
  if (ioctl(file, TIOCGSERIAL, &line) == 0) {
    line.flags |= static_cast<int>(ASYNC_LOW_LATENCY);
    (void)ioctl(file, TIOCSSERIAL, &line);
  }
}

}  // namespace

SerialPort::SerialPort(const std::string& path, int baud, char line_end) : line_end_(line_end) {
  const speed_t speed = speed_of(baud);
  if (path.empty()) throw DriverFailed(DriveProblemCode::no_port_named);
  file_ = open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (file_ < 0) {
    const int error = errno;
    throw DriverFailed(error == EACCES  ? DriveProblemCode::port_not_permitted
                       : error == EBUSY ? DriveProblemCode::port_busy
                                        : DriveProblemCode::port_not_opened,
                       {}, {{"reason", std::strerror(error)}});
  }
  try {
    if (isatty(file_) == 0) throw DriverFailed(DriveProblemCode::not_a_serial_port);
    // Two ways: programs that know nothing of locks are kept off by the second, the superuser's by the first alone.
    if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
      throw DriverFailed(DriveProblemCode::port_held);
    }
    (void)ioctl(file_, TIOCEXCL);
    configure(file_, speed);
  } catch (...) {
    close(file_);
    throw;
  }
}

SerialPort::~SerialPort() {
  (void)ioctl(file_, TIOCNXCL);
  close(file_);
}

bool SerialPort::write(std::string_view bytes) noexcept {
  if (is_torn_.load(std::memory_order_relaxed)) {
    if (::write(file_, &line_end_, 1) != 1) return false;
    is_torn_.store(false, std::memory_order_relaxed);
  }
  const ssize_t written = ::write(file_, bytes.data(), bytes.size());
  if (written == static_cast<ssize_t>(bytes.size())) return true;
  if (written > 0) is_torn_.store(true, std::memory_order_relaxed);
  return false;
}

std::ptrdiff_t SerialPort::read(std::span<char> bytes, std::int64_t until) noexcept {
  for (;;) {
    const ssize_t count = ::read(file_, bytes.data(), bytes.size());
    if (count > 0) return count;
    if (count < 0 && errno != EAGAIN && errno != EINTR) return -1;
    const std::int64_t left = std::max<std::int64_t>(0, until - clock_now());
    pollfd waiting{file_, POLLIN, 0};
    const timespec longest{left / 1'000'000'000, left % 1'000'000'000};
    const int ready = ppoll(&waiting, 1, &longest, nullptr);
    if (ready > 0 && (waiting.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0)
      return -1;  // readable for ever, of nothing
    if (left == 0 && ready <= 0) return 0;
  }
}

void SerialPort::drop_unsent() noexcept {
  int waiting = 0;
  const bool is_empty = ioctl(file_, TIOCOUTQ, &waiting) == 0 && waiting == 0;
  tcflush(file_, TCOFLUSH);
  // Perhaps in the middle of a line. An empty one does no harm but behind a carriage return: a CANable sends its last frame anew.
  if (line_end_ != '\r' || !is_empty) is_torn_.store(true, std::memory_order_relaxed);
}

}  // namespace zwidth::rig
