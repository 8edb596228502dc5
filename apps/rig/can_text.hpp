#pragma once

#include <optional>
#include <string_view>

#include "rig/can_bus.hpp"
#include "rig/serial_frame.hpp"

namespace zwidth::rig {

/// A frame as SLCAN adapters take it: tIIILDD, T with an identifier of 8 digits, r and R for remote frames, b and B for
/// CAN FD with its rate switched (CANable 2.0); L: the length's code; ended by a carriage return.
[[nodiscard]] SerialFrame slcan_line(const CanFrame& frame) noexcept;
/// What such a line holds, its end left off or not; nothing for any other text, and where it is longer or shorter than its
/// length says.
[[nodiscard]] std::optional<CanFrame> slcan_frame(std::string_view line) noexcept;

/// A frame as an fdcanusb takes it, "can std 009 0000000000000000 bfR"; of CAN FD, which is its default, without flags.
[[nodiscard]] SerialFrame fdcanusb_line(const CanFrame& frame) noexcept;
/// What such a line asks an fdcanusb to send, that of "can send" too, whose identifier is extended where it needs to be.
[[nodiscard]] std::optional<CanFrame> fdcanusb_order(std::string_view line) noexcept;
/// A frame as an fdcanusb hands it on: "rcv 009 0000803f00000000 e b f r".
[[nodiscard]] SerialFrame fdcanusb_report(const CanFrame& frame) noexcept;
/// What such a line holds; nothing for any other text.
[[nodiscard]] std::optional<CanFrame> fdcanusb_frame(std::string_view line) noexcept;

}  // namespace zwidth::rig
