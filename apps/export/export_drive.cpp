#include "export/export_drive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "report/text/explanation.hpp"
#include "report/text/holder_limit_text.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth::report {
namespace {

/// K_CR with each holder.
std::string limits_text(const HoldingLimits& limits, std::string_view unit) {
  const auto with = [&](const HolderLimit& limit, Holder holder) {
    return fmt::format("{} with {}", holder_limit_text(limit, unit), words_of(holder));
  };
  std::string text = with(limits.nobody, Holder::nobody);
  if (limits.user) text += ", " + with(*limits.user, Holder::user);
  if (limits.any_user && std::isfinite(limits.any_user->critical_stiffness)) {
    text +=
        fmt::format(", {} with {}", quantity(limits.any_user->critical_stiffness, unit), words_of(Holder::any_user));
  }
  return text;
}

std::string verdict_text_on_drive(const StableFor& wall) {
  const std::string unstable = unstable_with(wall);
  return unstable.empty() ? std::string(words_of(stability_of(wall))) : "UNSTABLE " + unstable;
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
  text += comment(fmt::format("Closed on the drive at {}, at the most: {}; this wall is {}",
                              quantity(1.0 / gains.sampling_period, "Hz"),
                              limits_text(gains.on_drive.limits, units.stiffness),
                              verdict_text_on_drive(gains.on_drive.wall_stable_for.value())));
  for (const Remark& each : gains.remarks) text += comment(each.what);
  if (const auto note = trust_note(gains.on_drive.trust)) text += comment(*note);
  for (const DriveNumber& each : gains.numbers) {
    text += fmt::format("{} = {:.6g}{}\n", each.name, each.value, each.unit.empty() ? "" : "  # " + each.unit);
  }
  return text;
}

}  // namespace zwidth::report
