#include "zwidth/rig/session.hpp"

#include "zwidth/quantity.hpp"
#include "zwidth/words/drive_problem_text.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth {

Finding finding_of(const Nudge& nudge, Motion motion) {
  const Units units = units_of(motion);
  Finding finding{.code = FindingCode::moves_under_no_force, .evidence = {{"force", nudge.force, units.force}}};
  if (nudge.reading != NudgeReading::against_force) return finding;
  finding.code = FindingCode::moves_against_force;
  finding.evidence.push_back({"moved", -nudge.moved, units.length});
  if (nudge.mending_force_sign) finding.evidence.push_back({"mending_force_sign", *nudge.mending_force_sign});
  return finding;
}

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
      if (!session.trouble) return Finding{.code = lost_link};
      return Finding{.code = drive_in_trouble, .subjects = {{"trouble", text(*session.trouble)}}};
    case StopReason::watchdog:
      return Finding{.code = watchdog_fired};
    case StopReason::oscillation:
      return Finding{.code = oscillation_grew};
    case StopReason::wrong_sign:
    case StopReason::unknown_sign:
      return finding_of(session.nudge.value_or(Nudge{}), session.motion);
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
