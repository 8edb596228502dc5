// Any bytes, as lines of an adapter and as frames of a CAN bus: never a crash, nothing but a whole frame is read, and what is
// read is written as it came.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "rig/can_text.hpp"
#include "rig/moteus_protocol.hpp"
#include "rig/odrive_can_protocol.hpp"
#include "rig/vesc_can_port.hpp"
#include "rig/vesc_protocol.hpp"

namespace {

using namespace zwidth::rig;

void require(bool holds) {
  if (!holds) std::abort();
}

void check_frame(const CanFrame& frame) {
  require(slcan_frame(slcan_line(frame).view()) == frame);
  if (frame.data().empty()) return;
  require(fdcanusb_order(fdcanusb_line(frame).view()) == frame);
  require(fdcanusb_frame(fdcanusb_report(frame).view()) == frame);
}

void check_lines(std::string_view bytes) {
  for (std::string_view rest = bytes; !rest.empty();) {  // as an adapter's port is read
    const std::string_view line = rest.substr(0, rest.find_first_of("\r\n\a"));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    for (const auto& frame : {slcan_frame(line), fdcanusb_order(line), fdcanusb_frame(line)}) {
      if (frame && frame->data().size() == frame->size) check_frame(*frame);
    }
    (void)moteus_reply(line, 1);
  }
}

void check_odrive(const CanFrame& frame) {
  const auto message = odrive_message(frame, 3);
  if (!message) return;
  require(frame.size == 8 && frame.id >> 5U == 3);
  (void)odrive_heartbeat(frame);
  (void)odrive_position(frame);
  (void)odrive_version(frame);
}

/// Eleven bytes a frame: identifier, flags and size, data.
void check_frames(std::string_view bytes) {
  VescCanPort vesc(nullptr, 23);
  constexpr std::size_t piece = 11;
  for (; bytes.size() >= piece; bytes.remove_prefix(piece)) {
    const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
    CanFrame frame{.id = static_cast<std::uint32_t>(at(0) << 8U | at(1)), .is_extended = (at(2) & 0x80U) != 0};
    if (!frame.is_extended) frame.id &= 0x7ffU;
    frame.size = std::min<std::size_t>(at(2) & 0x0fU, 8);
    for (std::size_t i = 0; i < frame.size; ++i) frame.bytes.at(i) = at(3 + i);
    check_frame(frame);
    check_odrive(frame);
    const SerialFrame packet = vesc.bytes_of(frame);
    if (packet.view().empty()) continue;
    require(vesc_packet_size(packet.view()) == packet.view().size());
    if (const auto payload = vesc_payload(packet.view())) (void)vesc_values(*payload);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  check_lines(bytes);
  check_frames(bytes);
  return 0;
}
