#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::report {

/// A number, or null where there is none: JSON has no infinity.
[[nodiscard]] inline nlohmann::ordered_json number_or_null(std::optional<double> value) {
  return value && std::isfinite(*value) ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// {"kind":"rigid_body"} or {"kind":"vibration_mode","mode":1}.
[[nodiscard]] inline nlohmann::ordered_json mechanism_json(const Mechanism& mechanism) {
  if (mechanism.kind == Mechanism::Kind::rigid_body) return {{"kind", "rigid_body"}};
  return {{"kind", "vibration_mode"}, {"mode", mechanism.mode}};
}

/// "finite", "none_stable" or "unbounded".
[[nodiscard]] inline const char* status_name(StiffnessStatus status) {
  switch (status) {
    case StiffnessStatus::finite:
      return "finite";
    case StiffnessStatus::none_stable:
      return "none_stable";
    case StiffnessStatus::unbounded:
      break;
  }
  return "unbounded";
}

}  // namespace zwidth::report
