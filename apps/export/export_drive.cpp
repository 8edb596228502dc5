#include "export/export_drive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::report {
namespace {

std::string limit_text(const CriticalStiffness& critical, Units units) {
  if (critical.status == StiffnessStatus::unbounded) return "every wall is stable";
  if (critical.status == StiffnessStatus::none_stable) return "no wall is stable from K = 0 on";
  return fmt::format("K_CR {}", quantity(critical.stiffness, units.stiffness));
}

std::string any_user_text(const std::optional<AnyUserLimit>& limit, Units units) {
  if (!limit || !std::isfinite(limit->stiffness)) return {};
  return fmt::format(", {} with any passive user", quantity(limit->stiffness, units.stiffness));
}

/// Where the wall stands among the limits.
std::string wall_text(const DriveGains& gains) {
  if (!gains.on_drive.wall->stable) return "UNSTABLE";
  const auto& held = gains.on_drive.any_user;
  const bool is_beyond = held && !(gains.stiffness < held->stiffness);
  return is_beyond ? "stable by itself, but UNSTABLE in some passive user's hand" : "below that";
}

/// A line that no text of a device file can end early.
std::string comment(std::string text) {
  for (char& character : text) {
    if (static_cast<unsigned char>(character) < 0x20 || character == 0x7f) character = ' ';
  }
  return "# " + text + "\n";
}

}  // namespace

std::string export_drive(const Device& device, const DriveGains& gains, const std::string& source) {
  const Units units = units_of(device.parameters().motion);
  std::string text = comment(fmt::format("{}: by zwidth {}", display_name(device), ZWIDTH_VERSION));
  text += comment(fmt::format("Wall: K {} ({}), B {}", quantity(gains.stiffness, units.stiffness), source,
                              quantity(device.parameters().wall.damping, units.damping)));
  text += comment(fmt::format("Closed on the drive at {}, at the most: {}{}; this wall is {}",
                              quantity(1.0 / gains.sampling_period, "Hz"), limit_text(gains.on_drive.critical, units),
                              any_user_text(gains.on_drive.any_user, units), wall_text(gains)));
  for (const Remark& each : gains.remarks) text += comment(each.what);
  if (const auto note = trust_note(gains.on_drive.trust)) text += comment(*note);
  for (const DriveNumber& each : gains.numbers) {
    text += fmt::format("{} = {:.6g}{}\n", each.name, each.value, each.unit.empty() ? "" : "  # " + each.unit);
  }
  return text;
}

}  // namespace zwidth::report
