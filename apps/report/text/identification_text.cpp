#include "report/text/identification_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"

namespace zwidth::report {
namespace {

std::string fit_quality(const ParameterFit& fit) {
  std::string text = fmt::format("{} points from {:.4g} to {:.4g} Hz", fit.frequencies.size(),
                                 hertz(fit.frequencies.front()), hertz(fit.frequencies.back()));
  if (fit.misfit) text += fmt::format("; residuals {:.3g} times the noise (1: the noise explains them)", *fit.misfit);
  if (fit.model_error > 1e-4) {
    text += fmt::format("; {:.3g} % of the response unexplained beyond it", 100.0 * std::min(fit.model_error, 10.0));
  }
  return text + ".";
}

std::string correlations(const std::vector<StrongCorrelation>& strong) {
  std::string text;
  for (const StrongCorrelation& each : strong) {
    text += wrap(
        fmt::format("{} and {} are hardly told apart: correlation {:.3f}", each.first, each.second, each.correlation),
        line_width, 2);
  }
  return text.empty() ? "" : "\n" + text;
}

/// "without a virtual damper", "with the wall's damper of 5 N s/m closed": what a K_CR is given with.
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

/// The verdict of an answer that nothing speaks against.
std::string sound_line(const Trust& trust) { return trust.sound() ? "Trust: sound.\n" : ""; }

/// Value, unit, standard deviation and 95 % interval of each parameter.
TextTable estimate_table(std::span<const ParameterEstimate> estimates, Motion motion) {
  TextTable table{{Align::left, Align::right, Align::left, Align::right, Align::right, Align::right},
                  {{"parameter", "value", "unit", "+-1 sigma", "95 % from", "to"}}};
  for (const ParameterEstimate& each : estimates) {
    std::vector<std::string> row = {each.key, number(each.value), parameter_unit(each.key, motion)};
    if (each.standard_deviation) {
      row.insert(row.end(), {number(*each.standard_deviation), number(*each.lower), number(*each.upper)});
    } else {
      row.insert(row.end(), {"not determined", "-", "-"});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// K_CR with what it is given with, its interval and what limits it.
std::string limit_text(const Device& device, const Analysis& analysis, const StiffnessBasis& basis) {
  const AnalysedDevice analysed{device, analysis};
  const Motion motion = device.parameters().motion;
  std::string text = wrap(fmt::format("Critical stiffness of this device as recorded, {}: {}.",
                                      basis_text(basis, motion), critical_stiffness_text(analysis.critical, motion)),
                          line_width, 0);
  if (const auto interval = interval_note(analysed)) text += wrap("95 % interval: " + *interval + ".", line_width, 0);
  if (const auto limit = what_limits(analysed)) text += wrap("Limited by " + *limit + ".", line_width, 0);
  return text;
}

}  // namespace

std::string identification_text(const Identification& identified, ShownFindings shown) {
  const ParameterFit& fit = identified.fit;
  std::string text = fmt::format("{}, identified from {}\n", display_name(fit.device), identified.source);
  const FindingsText findings = findings_text(identified.trust, identified.remarks, shown);
  text += findings.against;
  text += layout(estimate_table(fit.estimates, fit.device.parameters().motion)) + correlations(fit.correlations) +
          "\n" + wrap(fit_quality(fit), line_width, 0) + "\n";
  if (identified.trust.refused()) return text + findings.remarks;
  return text + limit_text(fit.device, identified.analysis, identified.basis) + sound_line(identified.trust) +
         findings.remarks;
}

std::string identification_text(const TimeDomainIdentification& identified, ShownFindings shown) {
  const Motion motion = identified.device.parameters().motion;
  std::string text =
      fmt::format("{}, identified in time from {}", display_name(identified.device), identified.motions.front().source);
  if (identified.motions.size() > 1) text += fmt::format(" and {} more", identified.motions.size() - 1);
  const FindingsText findings = findings_text(identified.trust, identified.remarks, shown);
  text += "\n" + findings.against;
  text += layout(estimate_table(identified.estimates, motion)) + correlations(identified.correlations) + "\n";
  for (const FittedMotion& each : identified.motions) {
    text +=
        wrap(fmt::format("{}: {:.3g} {} of noise per sample; {:.3g} % of the linear response unexplained beyond it.",
                         each.source, each.noise, motion == Motion::rotary ? "rad" : "m", 100.0 * each.unexplained),
             line_width, 0);
  }
  text += "\n";
  if (identified.trust.refused()) return text + findings.remarks;
  return text + limit_text(identified.device, identified.analysis, identified.basis) + sound_line(identified.trust) +
         findings.remarks;
}

std::string identification_text(const RigidBodyIdentification& identified, ShownFindings shown) {
  const RigidBodyFit& fit = identified.fit;
  std::string text = fmt::format("A rigid body, identified from {}\n", identified.source);
  const FindingsText findings = findings_text(identified.trust, identified.remarks, shown);
  text += findings.against;
  text += layout(estimate_table(estimates(fit), identified.device.parameters().motion)) + "\n";
  text += wrap(fmt::format("Inverse dynamics: low-pass of {:.4g} Hz without phase, every {}. sample, {} equations; the "
                           "residual force is {:.3g} % of the force (both rms). Intervals allow for residuals that are "
                           "correlated in time.",
                           fit.cutoff_hz, fit.decimation, fit.equations, 100.0 * fit.relative_residual),
               line_width, 0);
  return text + sound_line(identified.trust) + findings.remarks;
}

}  // namespace zwidth::report
