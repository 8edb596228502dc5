#include "zwidth/rig/session.hpp"

#include "zwidth/words/finding_text.hpp"

namespace zwidth {

std::optional<Finding> finding_of(const RigSession& session) {
  using enum FindingCode;
  switch (session.stop) {
    case StopReason::none:
      return std::nullopt;
    case StopReason::interrupted:
      return Finding{.code = interrupted};
    case StopReason::not_a_number:
      return Finding{.code = position_not_a_number};
    case StopReason::position_limit:
      return Finding{.code = beyond_position_limit};
    case StopReason::velocity_limit:
      return Finding{.code = beyond_velocity_limit};
    case StopReason::saturation:
      return Finding{.code = force_limited_too_long};
    case StopReason::missed_cycles:
      return Finding{.code = missed_cycles};
    case StopReason::lost_link:
      if (session.trouble.empty()) return Finding{.code = lost_link};
      return Finding{.code = drive_in_trouble, .subjects = {{"trouble", session.trouble}}};
    case StopReason::watchdog:
      return Finding{.code = watchdog_fired};
    case StopReason::oscillation:
      return Finding{.code = oscillation_grew};
  }
  return std::nullopt;
}

std::string explanation(const RigSession& session) {
  const std::optional<Finding> finding = finding_of(session);
  return finding ? text(*finding) : std::string();
}

std::string explanation(StopReason reason) {
  RigSession session;
  session.stop = reason;
  return explanation(session);
}

}  // namespace zwidth
