#include "rig/odrive_can_protocol.hpp"

#include <algorithm>
#include <bit>

namespace zwidth::rig {
namespace {

constexpr unsigned command_bits = 5;
constexpr std::uint32_t command_mask = (1U << command_bits) - 1;
constexpr std::size_t whole = 8;  // bytes of what an axis sends
constexpr std::uint32_t torque_control = 1;
constexpr std::uint32_t passthrough = 1;

CanFrame frame_to(int node, OdriveMessage message, std::size_t size) noexcept {
  CanFrame frame;
  frame.id = static_cast<std::uint32_t>(node) << command_bits | static_cast<std::uint32_t>(message);
  frame.size = size;
  return frame;
}

void put(CanFrame& frame, std::size_t at, std::uint32_t value) noexcept {  // little-endian
  for (std::size_t i = 0; i < 4; ++i) frame.bytes.at(at + i) = static_cast<unsigned char>(value >> (8 * i));
}

std::uint32_t value_at(const CanFrame& frame, std::size_t at) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(frame.bytes.at(at + i)) << (8 * i);
  return value;
}

}  // namespace

CanFrame odrive_question(int node, OdriveMessage message) noexcept {
  CanFrame frame = frame_to(node, message, whole);
  frame.is_remote = true;
  return frame;
}

CanFrame odrive_state(int node, std::uint32_t state) noexcept {
  CanFrame frame = frame_to(node, OdriveMessage::axis_state, 4);
  put(frame, 0, state);
  return frame;
}

CanFrame odrive_torque_mode(int node) noexcept {
  CanFrame frame = frame_to(node, OdriveMessage::controller_mode, 8);
  put(frame, 0, torque_control);
  put(frame, 4, passthrough);
  return frame;
}

CanFrame odrive_input_torque(int node, double torque) noexcept {
  CanFrame frame = frame_to(node, OdriveMessage::input_torque, 4);
  put(frame, 0, std::bit_cast<std::uint32_t>(static_cast<float>(torque)));
  return frame;
}

CanFrame odrive_clear_errors(int node) noexcept {
  return frame_to(node, OdriveMessage::clear_errors, 1);  // 0.6: without blinking
}

std::optional<OdriveMessage> odrive_message(const CanFrame& frame, int node) noexcept {
  if (frame.is_extended || frame.is_remote || frame.is_fd || frame.size != whole) return std::nullopt;
  if (frame.id >> command_bits != static_cast<std::uint32_t>(node)) return std::nullopt;
  return static_cast<OdriveMessage>(frame.id & command_mask);
}

OdriveHeartbeat odrive_heartbeat(const CanFrame& frame) noexcept { return {value_at(frame, 0), frame.bytes[4]}; }

double odrive_position(const CanFrame& frame) noexcept {
  return static_cast<double>(std::bit_cast<float>(value_at(frame, 0)));
}

OdriveVersion odrive_version(const CanFrame& frame) noexcept { return {frame.bytes[4], frame.bytes[5]}; }

}  // namespace zwidth::rig
