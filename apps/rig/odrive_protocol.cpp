#include "rig/odrive_protocol.hpp"

#include <algorithm>
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

std::size_t odrive_unended_answer_size(std::string_view bytes) noexcept {
  constexpr std::size_t most_digits = 3;
  const std::size_t begin = std::min(bytes.find_first_not_of("\r\n"), bytes.size());
  const std::size_t end = bytes.find('\n', begin);
  const std::size_t star = bytes.find('*', begin);
  if (star == bytes.npos || end < star) return end == bytes.npos ? 0 : end + 1;
  const unsigned sum = checksum_of(bytes.substr(begin, star - begin));
  unsigned stated = 0;
  for (std::size_t i = star + 1; i <= star + most_digits; ++i) {
    if (i == bytes.size()) return 0;
    if (bytes[i] < '0' || bytes[i] > '9') return i;  // of no checksum of its own: broken
    stated = 10 * stated + static_cast<unsigned>(bytes[i] - '0');
    if (stated == sum) return i + 1;
  }
  return star + 1 + most_digits;
}

std::optional<std::string_view> odrive_answer(std::string_view line) noexcept {
  const auto is_end = [](char c) { return c == '\n' || c == '\r'; };
  while (!line.empty() && is_end(line.back())) line.remove_suffix(1);
  while (!line.empty() && is_end(line.front())) line.remove_prefix(1);
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
