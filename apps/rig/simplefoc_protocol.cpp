#include "rig/simplefoc_protocol.hpp"

namespace zwidth::rig {

SerialFrame simplefoc_line(std::string_view motor, std::string_view command) noexcept {
  SerialFrame frame;
  frame.add(motor);
  frame.add(command);
  frame.add("\n");
  return frame;
}

SerialFrame simplefoc_target(std::string_view motor, double target) noexcept {
  SerialFrame number;
  number.print("{:.6g}", target);
  return simplefoc_line(motor, number.view());
}

std::optional<std::string_view> simplefoc_answer(std::string_view line, std::string_view motor,
                                                 std::string_view echo) noexcept {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  if (!line.starts_with(motor)) return std::nullopt;
  line.remove_prefix(motor.size());
  if (!line.starts_with(echo)) return std::nullopt;
  return line.substr(echo.size());
}

}  // namespace zwidth::rig
