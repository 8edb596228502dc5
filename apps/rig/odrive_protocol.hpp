#pragma once

#include <optional>
#include <string_view>

#include "rig/serial_frame.hpp"

namespace zwidth::rig {

/// What ODrive's `f` answers.
struct OdriveFeedback {
  double position = 0.0;  ///< turns
  double velocity = 0.0;  ///< turns/s
};

/// A line to the drive: the command, "*" and the XOR of its bytes, which makes the drive check it and answer with one.
[[nodiscard]] SerialFrame odrive_line(std::string_view command) noexcept;
/// `c AXIS TORQUE` in N m, without a checksum: "c 0 0.1".
[[nodiscard]] SerialFrame odrive_torque(int axis, double torque) noexcept;
/// `v AXIS 0 TORQUE`: the same beside the drive's own damper, in velocity control: "v 0 0 0.1".
[[nodiscard]] SerialFrame odrive_damped_torque(int axis, double torque) noexcept;
/// How many bytes the first answer has where answers with a checksum have no end of a line: firmware 0.5.2. Up to the digits
/// after "*" that are the checksum of what stands before; 0: it is not whole yet. Ends of lines before it belong to it.
[[nodiscard]] std::size_t odrive_unended_answer_size(std::string_view bytes) noexcept;
/// What stands in an answer's line before its checksum; nothing where that is wrong or missing.
[[nodiscard]] std::optional<std::string_view> odrive_answer(std::string_view line) noexcept;
/// "POSITION VELOCITY"; nothing for any other text.
[[nodiscard]] std::optional<OdriveFeedback> odrive_feedback(std::string_view answer) noexcept;

}  // namespace zwidth::rig
