#include "export/export_drive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "report/text/explanation.hpp"
#include "report/text/holder_limit_text.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/model/damper_timing.hpp"
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
  const bool damper_alone = has_damper_loop(device.loop());
  const bool has_stiffness = device.parameters().wall.stiffness.has_value();
  const std::string stiffness =
      has_stiffness ? fmt::format("K {} ({})", quantity(gains.stiffness, units.stiffness), source) : "K of the host's";
  text += comment(fmt::format("Wall: {}, B {}", stiffness, quantity(device.parameters().wall.damping, units.damping)));
  const auto& stable_for = gains.on_drive.wall_stable_for;
  text += comment(fmt::format(
      "{} on the drive at {}{}, at the most: {}; this wall is {}", damper_alone ? "The damper alone closed" : "Closed",
      quantity(1.0 / gains.sampling_period, "Hz"),
      damper_alone ? fmt::format(", the spring by the host at {}", quantity(1.0 / device.loop().sampling_period, "Hz"))
                   : "",
      limits_text(gains.on_drive.limits, units.stiffness),
      has_stiffness && stable_for ? verdict_text_on_drive(*stable_for) : "not judged"));
  for (const Remark& each : gains.remarks) text += comment(each.what);
  if (const auto note = trust_note(gains.on_drive.trust)) text += comment(*note);
  for (const DriveNumber& each : gains.numbers) {
    text += fmt::format("{} = {:.6g}{}\n", each.name, each.value, each.unit.empty() ? "" : "  # " + each.unit);
  }
  return text;
}

}  // namespace zwidth::report
