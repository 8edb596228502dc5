#include "rig/can_port.hpp"

#include <algorithm>

#include "rig/can_text.hpp"

namespace zwidth::rig {

bool CanPort::write(std::string_view bytes) noexcept {
  bool has_sent = true;
  for (std::size_t size = piece(bytes); size > 0; size = piece(bytes)) {
    const auto frame = frame_of(bytes.substr(0, size));
    has_sent = frame && bus_->send(*frame) && has_sent;
    bytes.remove_prefix(size);
  }
  return has_sent;
}

std::ptrdiff_t CanPort::read(std::span<char> bytes, std::int64_t until) noexcept {
  while (read_ == said_.view().size()) {
    const auto frame = bus_->receive(until);
    if (!frame) return bus_->is_gone() ? -1 : 0;
    said_ = bytes_of(*frame);
    read_ = 0;
  }
  const std::string_view rest = said_.view().substr(read_, bytes.size());
  std::ranges::copy(rest, bytes.begin());
  read_ += rest.size();
  return static_cast<std::ptrdiff_t>(rest.size());
}

std::size_t CanLinePort::piece(std::string_view bytes) const noexcept {
  const std::size_t end = bytes.find('\n');
  return end == std::string_view::npos ? 0 : end + 1;
}

std::optional<CanFrame> CanLinePort::frame_of(std::string_view piece) const noexcept { return fdcanusb_order(piece); }

SerialFrame CanLinePort::bytes_of(const CanFrame& frame) noexcept { return fdcanusb_report(frame); }

}  // namespace zwidth::rig
