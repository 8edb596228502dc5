#include "report/identified_rigid_body.hpp"

#include <fmt/format.h>

#include "report/text/frf_text.hpp"
#include "report/text/identification_text.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "results/frf_json.hpp"
#include "results/identification_json.hpp"

namespace zwidth::report {
namespace {

std::string method_text(const RigidBodyFit& fit) {
  return fmt::format(
      "Inverse dynamics: low-pass of {:.4g} Hz without phase, every {}. sample, {} equations; the residual force is "
      "{:.3g} % of the force (both rms). Intervals allow for residuals that are correlated in time.",
      fit.cutoff_hz, fit.decimation, fit.equations, 100.0 * fit.relative_residual);
}

}  // namespace

std::vector<ParameterEstimate> estimates_of(const RigidBodyFit& fit) {
  return {fit.mass, fit.viscous, fit.coulomb, fit.offset, fit.delay};
}

std::string rigid_body_text(const RigidBodyIdentification& identified) {
  constexpr std::size_t width = 100;
  const std::vector<ParameterEstimate> estimates = estimates_of(identified.fit);
  std::string text = fmt::format("A rigid body, identified from {}\n", identified.source);
  text += layout(estimate_table(estimates, identified.device.parameters().motion)) + "\n";
  text += trust_lines(identified.trust);
  text += wrap(method_text(identified.fit), width, 0);
  if (!identified.remarks.empty()) text += "\nRemarks\n" + remarks_text(identified.remarks);
  return text;
}

results::Json rigid_body_json(const RigidBodyIdentification& identified) {
  const RigidBodyFit& fit = identified.fit;
  const Motion motion = identified.device.parameters().motion;
  results::Json document;
  document["schema"] = "zwidth.inverse_dynamics/1";
  document["source"] = identified.source;
  document["parameters"] = results::Json::array();
  for (const ParameterEstimate& estimate : estimates_of(fit)) {
    document["parameters"].push_back(estimate_json(estimate, motion));
  }
  document["relative_residual"] = fit.relative_residual;
  document["cutoff_hz"] = fit.cutoff_hz;
  document["decimation"] = fit.decimation;
  document["equations"] = fit.equations;
  document["trust"] = identified.trust;
  document["remarks"] = remarks_json(identified.remarks);
  return document;
}

}  // namespace zwidth::report
