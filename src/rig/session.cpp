#include "zwidth/rig/session.hpp"

namespace zwidth {

std::string explanation(StopReason reason) {
  switch (reason) {
    case StopReason::none:
      return "";
    case StopReason::interrupted:
      return "interrupted: the force is zero";
    case StopReason::not_a_number:
      return "a position or a force was not a number: the force is zero; check the sensor and the wall's filters";
    case StopReason::position_limit:
      return "the position went beyond its limit: the force is zero; render softer, or allow more";
    case StopReason::velocity_limit:
      return "the velocity went beyond its limit: the force is zero; render softer, or allow more";
    case StopReason::saturation:
      return "more force was wanted than is allowed, for too long: the force is zero; render softer, or allow more";
    case StopReason::missed_cycles:
      return "too many cycles in a row came late: the force is zero; give the loop a processor of its own and "
             "real-time "
             "priority, or a longer sampling period";
    case StopReason::lost_link:
      return "too many cycles in a row brought no position: the force is zero; check cable, port and baud rate";
    case StopReason::watchdog:
      return "the loop stood still and the watchdog set the force to zero; give it a processor of its own and "
             "real-time "
             "priority";
    case StopReason::oscillation:
      return "an oscillation grew: the force is zero; render softer";
  }
  return "";
}

std::string explanation(const RigSession& session) {
  if (session.stop != StopReason::lost_link || session.trouble.empty()) return explanation(session.stop);
  return "there was no position any more: the force is zero; " + session.trouble;
}

}  // namespace zwidth
