#include "results/export_json.hpp"

#include <vector>

#include "results/device_json.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"
#include "results/wall_filter_json.hpp"

namespace zwidth::results {
namespace {

Json rows(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Eigen::MatrixXd plus_identity(const Eigen::MatrixXd& matrix) {
  return matrix + Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols());
}

Json coefficients(const double* values, std::size_t count) { return std::vector<double>(values, values + count); }

/// The stored coefficients of a monic polynomial, and its leading 1.
Json monic(const double* values, std::size_t degree) {
  Json all = coefficients(values, degree);
  all.push_back(1.0);
  return all;
}

Json modal_terms(const ModalForm& form) {
  Json terms = Json::array();
  for (const ModalTerm& term : form.terms) {
    terms.push_back({{"mode", term.mode},
                     {"numerator", coefficients(term.numerator, term.degree)},
                     {"denominator", monic(term.denominator, term.degree)}});
  }
  return terms;
}

Json sampled_terms(const SampledPlant& plant) {
  Json terms = Json::array();
  for (const SampledTerm& term : plant.terms) {
    terms.push_back({{"mode", term.mode},
                     {"numerator", coefficients(term.numerator, term.degree + 1)},
                     {"denominator", monic(term.denominator, term.degree)}});
  }
  return terms;
}

Json state_names(const Device& device) {
  Json names = Json::array();
  if (!device.has_bodies()) return names;
  for (const Body& body : device.bodies()) names.push_back("position of " + body.name);
  for (const Body& body : device.bodies()) names.push_back("velocity of " + body.name);
  if (device.parameters().actuator.time_constant > 0.0) names.push_back("lagged force");
  if (device.parameters().sensor.tracking_bandwidth > 0.0) {
    names.push_back("tracked position");
    names.push_back("tracked velocity over the bandwidth");
  }
  return names;
}

Json with_delay_states_json(const DeviceModel& model) {
  if (!model.with_delay_states) return nullptr;
  const DiscreteStateSpace& augmented = *model.with_delay_states;
  return {{"Phi", rows(augmented.Phi)},
          {"F", rows(plus_identity(augmented.Phi))},
          {"Gamma", rows(augmented.Gamma1)},
          {"C", rows(augmented.C)}};
}

Json wall_json(const DeviceModel& model) {
  const Wall& wall = model.wall;
  const double period = model.discrete.period;
  return {{"equation",
           "u = -C(z) y, C(z) = F(z) (K + B v(z)), v(z) = (1 - a)/T (z - 1)/(z - a), F the product of the filters"},
          {"stiffness", wall.stiffness},
          {"damping", wall.damping},
          {"velocity_filter_hz", wall.velocity_filter_hz},
          {"a", velocity_filter_pole(wall.velocity_filter_hz, period)},
          {"filters", wall_filters_json(wall, period)}};
}

}  // namespace

Json export_json(const DeviceModel& model) {
  const Device& device = model.device;
  const DiscreteStateSpace& discrete = model.discrete;
  const Units units = units_of(device.parameters().motion);
  const CriticalStiffness& critical = model.analysis.critical;
  return {{"schema", "zwidth.model/1"},
          {"device", device.name()},
          {"device_file", device_json(device.parameters())},
          {"units", {{"force", units.force}, {"position", units.length}, {"time", "s"}}},
          {"sampling_period_s", discrete.period},
          {"delay_s", device.loop().delay},
          {"continuous",
           {{"states", state_names(device)},
            {"A", rows(model.continuous.A)},
            {"B", rows(model.continuous.B)},
            {"C", rows(model.continuous.C)},
            {"D", Json::array({Json::array({0.0})})}}},
          {"discrete",
           {{"equation", "x[k+1] = F x[k] + Gamma1 u[k-l] + Gamma2 u[k-l-1], y[k] = C x[k], F = I + Phi"},
            {"Phi", rows(discrete.Phi)},
            {"F", rows(plus_identity(discrete.Phi))},
            {"Gamma1", rows(discrete.Gamma1)},
            {"Gamma2", rows(discrete.Gamma2)},
            {"C", rows(discrete.C)},
            {"delay_samples", discrete.delay_samples}}},
          {"with_delay_states", with_delay_states_json(model)},
          {"modal_terms", modal_terms(model.modal)},
          {"sampled_terms",
           {{"equation", "z^-l sum N(d)/D(d), d = z - 1, coefficients ascending"},
            {"delay_samples", model.sampled.delay_samples},
            {"terms", sampled_terms(model.sampled)}}},
          {"wall", wall_json(model)},
          {"status", critical.status},
          {"critical_stiffness", critical.stiffness},
          {"limits", model.analysis.limits},
          {"crossovers", critical.crossovers},
          {"trust", critical.trust},
          {"findings", findings_json(critical.trust, model.remarks)}};
}

}  // namespace zwidth::results
