#include "report/identified_device.hpp"

#include <fmt/format.h>

#include <utility>

#include "report/text/quantity.hpp"

namespace zwidth::report {

IdentifiedDevice identified_device(Identification identified) {
  AnalysedDevice analysed{identified.fit.device, std::move(identified.analysis)};
  return {std::move(identified.source), std::move(identified.response), std::move(identified.fit),
          std::move(analysed),          std::move(identified.remarks),  identified.basis,
          std::move(identified.trust)};
}

std::string basis_text(const StiffnessBasis& basis, Motion motion) {
  std::string text = "without a virtual damper";
  if (basis.virtual_damping > 0.0) {
    text =
        fmt::format("with the wall's damper of {} closed", quantity(basis.virtual_damping, units_of(motion).damping));
    if (basis.velocity_filter_hz > 0.0) {
      text += fmt::format(" behind its {} filter", quantity(basis.velocity_filter_hz, "Hz"));
    }
  }
  if (basis.filters > 0) text += fmt::format(", through the wall's {} filter(s)", basis.filters);
  return text;
}

std::string_view unit_of_parameter(std::string_view key, Motion motion) {
  const Units units = units_of(motion);
  if (key.ends_with("mass")) return units.mass;
  if (key.ends_with(".damping") || key == "viscous") return units.damping;
  if (key.ends_with(".stiffness")) return units.stiffness;
  if (key == "coulomb" || key == "offset") return units.force;
  return "s";  // a delay, actuator.time_constant
}

}  // namespace zwidth::report
