#include "rig/odrive_protocol.hpp"

#include <functional>
#include <numeric>

namespace zwidth::rig {
namespace {

unsigned checksum_of(std::string_view text) noexcept {
  return std::accumulate(text.begin(), text.end(), 0U,
                         [](unsigned sum, char c) { return sum ^ static_cast<unsigned char>(c); });
}

}  // namespace

SerialFrame odrive_line(std::string_view command) noexcept {
  SerialFrame frame;
  frame.add(command);
  frame.print("*{}\n", checksum_of(command));
  return frame;
}

SerialFrame odrive_torque(int axis, double torque) noexcept {
  SerialFrame command;
  command.print("c {} {:.6g}", axis, torque);
  return command;
}

SerialFrame odrive_damped_torque(int axis, double torque) noexcept {
  SerialFrame command;
  command.print("v {} 0 {:.6g}", axis, torque);
  return command;
}

std::optional<std::string_view> odrive_answer(std::string_view line) noexcept {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  const std::size_t star = line.rfind('*');
  if (star == std::string_view::npos) return std::nullopt;
  unsigned stated = 0;
  const std::string_view digits = line.substr(star + 1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), stated);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  line = line.substr(0, star);
  if (stated != checksum_of(line)) return std::nullopt;
  return line;
}

std::optional<OdriveFeedback> odrive_feedback(std::string_view answer) noexcept {
  const std::size_t space = answer.find(' ');
  if (space == std::string_view::npos) return std::nullopt;
  const auto position = as_number(answer.substr(0, space));
  const auto velocity = as_number(answer.substr(space + 1));
  if (!position || !velocity) return std::nullopt;
  return OdriveFeedback{*position, *velocity};
}

}  // namespace zwidth::rig
