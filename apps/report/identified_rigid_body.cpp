#include "report/identified_rigid_body.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "report/text/frf_text.hpp"
#include "report/text/identification_text.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "results/frf_json.hpp"
#include "results/identification_json.hpp"
#include "zwidth/error.hpp"

namespace zwidth::report {
namespace {

/// One parameter of the body, where it stands in the device and in the covariance.
struct Place {
  std::string_view key;
  double* value;
  const ParameterEstimate* estimate;
  Eigen::Index row;
};

std::string method_text(const RigidBodyFit& fit) {
  return fmt::format(
      "Inverse dynamics: low-pass of {:.4g} Hz without phase, every {}. sample, {} equations; the residual force is "
      "{:.3g} % of the force (both rms). Intervals allow for residuals that are correlated in time.",
      fit.cutoff_hz, fit.decimation, fit.equations, 100.0 * fit.relative_residual);
}

/// A force that acts later than one that is held delays the loop, too.
void remark_delay(IdentifiedRigidBody& identified) {
  const ParameterEstimate& delay = identified.fit.delay;
  const double hold = 0.5 * identified.device.loop().sampling_period;
  if (!delay.lower || *delay.lower <= hold) return;
  identified.remarks.push_back(
      {Remark::Severity::warning,
       fmt::format("the force acts {} later than a held force does", quantity(delay.value - hold, "s")),
       fmt::format("where that delay is the actuator's or the sensor's, add it to the device: --set loop.delay={:.3g}",
                   delay.value - hold)});
}

}  // namespace

std::vector<ParameterEstimate> estimates_of(const RigidBodyFit& fit) {
  return {fit.mass, fit.viscous, fit.coulomb, fit.offset, fit.delay};
}

IdentifiedRigidBody identified_rigid_body(std::string source, RigidBodyFit fit, Motion motion, double sampling_period) {
  if (!(fit.mass.value > 0.0)) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("the fitted mass is {:.4g}: force and motion have opposite signs, or are not of one body; "
                            "turn one with --force-scale or --position-scale",
                            fit.mass.value));
  }
  std::vector<Remark> remarks = std::exchange(fit.remarks, {});
  Body body;
  body.name = "body";
  Uncertainty uncertainty;
  std::vector<Eigen::Index> rows;
  for (const Place& place : {Place{"mass", &body.mass, &fit.mass, 0}, Place{"damping", &body.damping, &fit.viscous, 1},
                             Place{"coulomb", &body.coulomb, &fit.coulomb, 2}}) {
    if (place.estimate->value < 0.0) {
      remarks.push_back({Remark::Severity::warning,
                         fmt::format("{} = {:.4g} is below 0", place.estimate->key, place.estimate->value),
                         "taken as 0 in the device"});
      continue;
    }
    *place.value = place.estimate->value;
    uncertainty.parameters.push_back(fmt::format("body.{}.{}", body.name, place.key));
    rows.push_back(place.row);
  }
  for (const Eigen::Index i : rows) {
    uncertainty.covariance.emplace_back();
    for (const Eigen::Index j : rows) uncertainty.covariance.back().push_back(fit.covariance(i, j));
  }
  DeviceParameters parameters;
  parameters.name = "rigid body";
  parameters.motion = motion;
  parameters.bodies = {body};
  parameters.loop.sampling_period = sampling_period;
  parameters.uncertainty = std::move(uncertainty);
  IdentifiedRigidBody identified{std::move(source), std::move(fit), Device(std::move(parameters)), std::move(remarks)};
  remark_delay(identified);
  return identified;
}

std::string rigid_body_text(const IdentifiedRigidBody& identified) {
  constexpr std::size_t width = 100;
  const std::vector<ParameterEstimate> estimates = estimates_of(identified.fit);
  std::string text = fmt::format("A rigid body, identified from {}\n", identified.source);
  text += layout(estimate_table(estimates, identified.device.parameters().motion)) + "\n";
  text += wrap(method_text(identified.fit), width, 0);
  if (!identified.remarks.empty()) text += "\nRemarks\n" + remarks_text(identified.remarks);
  return text;
}

results::Json rigid_body_json(const IdentifiedRigidBody& identified) {
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
  document["remarks"] = remarks_json(identified.remarks);
  return document;
}

}  // namespace zwidth::report
