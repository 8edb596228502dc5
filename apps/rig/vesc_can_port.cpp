#include "rig/vesc_can_port.hpp"

#include <algorithm>

#include "rig/vesc_protocol.hpp"

namespace zwidth::rig {
namespace {

// datatypes.h: COMM_SET_CURRENT, and of CAN_PACKET_ID
constexpr unsigned char set_current_command = 6;
constexpr unsigned set_current_frame = 1;
constexpr unsigned fill_buffer = 5;
constexpr unsigned fill_long_buffer = 6;
constexpr unsigned process_buffer = 7;
constexpr unsigned process_short_buffer = 8;
constexpr unsigned char answer_me = 0;  // commands_send: to commands_process_packet(), whose answer comes back
constexpr std::size_t most_in_one_frame = 6;
constexpr std::size_t current_bytes = 4;
constexpr std::size_t head = 2;        // of a short buffer: who sends it, and what for
constexpr std::size_t tail_bytes = 6;  // who sends it, what for, length and CRC

CanFrame extended(unsigned command, unsigned id, std::string_view data) {
  CanFrame frame{.id = command << 8U | id, .is_extended = true, .size = data.size()};
  std::ranges::transform(data, frame.bytes.begin(), [](char c) { return static_cast<unsigned char>(c); });
  return frame;
}

}  // namespace

std::size_t VescCanPort::piece(std::string_view bytes) const noexcept { return vesc_packet_size(bytes); }

std::optional<CanFrame> VescCanPort::frame_of(std::string_view piece) const noexcept {
  const auto payload = vesc_payload(piece);
  if (!payload) return std::nullopt;
  if (static_cast<unsigned char>(payload->front()) == set_current_command && payload->size() == 1 + current_bytes) {
    return extended(set_current_frame, id_, payload->substr(1));
  }
  if (payload->size() > most_in_one_frame) return std::nullopt;
  SerialFrame data;
  data.add_byte(vesc_can_host);
  data.add_byte(answer_me);
  data.add(*payload);
  return extended(process_short_buffer, id_, data.view());
}

SerialFrame VescCanPort::bytes_of(const CanFrame& frame) noexcept {
  if (!frame.is_extended || frame.is_remote || frame.is_fd || (frame.id & 0xffU) != vesc_can_host) return {};
  const unsigned command = frame.id >> 8U;
  const auto data = frame.data();
  const auto text = [](std::span<const unsigned char> bytes) {
    SerialFrame copied;
    for (const unsigned char each : bytes) copied.add_byte(each);
    return copied;
  };
  if (command == process_short_buffer && data.size() > head && data[0] == id_) {
    return vesc_packet(text(data.subspan(head)).view());
  }
  const std::size_t before = command == fill_buffer ? 1 : 2;  // the offset
  if ((command == fill_buffer || command == fill_long_buffer) && data.size() > before) {
    const std::size_t offset = before == 1 ? data[0] : static_cast<std::size_t>(data[0]) << 8U | data[1];
    if (offset == 0) filled_ = 0;
    if (offset != filled_ || offset + data.size() - before > payload_.size()) {
      filled_ = 0;  // one was lost
      return {};
    }
    for (const unsigned char each : data.subspan(before)) payload_.at(filled_++) = static_cast<char>(each);
  }
  if (command == process_buffer && data.size() == tail_bytes && data[0] == id_) {
    const std::size_t length = static_cast<std::size_t>(data[2]) << 8U | data[3];
    const std::size_t filled = std::exchange(filled_, 0);
    if (length == 0 || length != filled) return {};
    return vesc_packet({payload_.data(), length}, static_cast<unsigned>(data[4]) << 8U | data[5]);
  }
  return {};
}

}  // namespace zwidth::rig
