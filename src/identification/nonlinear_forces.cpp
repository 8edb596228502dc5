#include "identification/nonlinear_forces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "identification/response/encoder_step.hpp"
#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

constexpr double clear_evidence = 40.0;
constexpr double notable_share =
    0.015;  // of linear records 0.0135 at most, where chi-squared is clear; weak cogging 0.0155 and more

template <class Function>
std::vector<double> mapped(std::span<const double> signal, Function function) {
  std::vector<double> result(signal.size());
  std::ranges::transform(signal, result.begin(), function);
  return result;
}

}  // namespace

Finding shown_by(std::string source, Finding finding) {
  finding.subjects.push_back({"source", std::move(source)});
  return finding;
}

std::optional<Nonlinearity> clearest_nonlinearity(
    std::span<const double> position, std::span<const double> force, Motion motion,
    const std::function<NonlinearEvidence(const NonlinearForce&)>& evidence_of) {
  const auto extremes = std::ranges::minmax(position);
  const double least = extremes.min;  // no structured binding: the closures below capture it
  const double range = extremes.max - least;
  const double middle = least + 0.5 * range;
  const double largest = std::abs(std::ranges::max(force, {}, [](double each) { return std::abs(each); }));
  if (!(range > 0.0 && largest > 0.0)) return std::nullopt;

  std::optional<Nonlinearity> found;
  const auto examine = [&](NonlinearForce candidate) {
    const NonlinearEvidence evidence = evidence_of(candidate);
    const bool shows = evidence.chi_squared > clear_evidence && evidence.share > notable_share;
    if (!shows) return;
    if (found && found->evidence.chi_squared >= evidence.chi_squared) return;
    candidate.finding.evidence.push_back({"chi_squared", evidence.chi_squared});
    candidate.finding.evidence.push_back({"threshold", clear_evidence});
    found = Nonlinearity{std::move(candidate.finding), evidence};
  };

  const auto power = [&](int exponent) {
    return mapped(position, [=](double x) { return std::pow((x - middle) / range, exponent); });
  };
  examine({{power(2), power(3)}, false, {.code = FindingCode::nonlinear_spring}});

  constexpr std::size_t span = 4;  // samples, over which a velocity is taken
  std::vector<double> drag(position.size(), 0.0);
  for (std::size_t k = span; k < position.size(); ++k) {
    const double velocity = (position[k] - position[k - span]) / range;
    drag[k] = velocity * std::abs(velocity);
  }
  examine({{std::move(drag)}, false, {.code = FindingCode::drag}});

  const auto beyond = [&](double share) {
    const double bound = share * largest;
    return mapped(force, [=](double u) { return std::copysign(std::max(0.0, std::abs(u) - bound), u); });
  };
  examine({{beyond(0.25), beyond(0.5), beyond(0.75)}, true, {.code = FindingCode::nonlinear_actuator}});

  constexpr int most_waves = 100;
  constexpr double least_steps = 20.0;  // of an encoder, per wave: less is its rounding
  const double step = encoder_step(position);
  for (int waves = 1; waves <= most_waves && range > least_steps * step * waves; ++waves) {
    const double wave_number = 2.0 * std::numbers::pi * waves / range;
    examine({{mapped(position, [=](double x) { return std::cos(wave_number * (x - least)); }),
              mapped(position, [=](double x) { return std::sin(wave_number * (x - least)); })},
             false,
             {.code = FindingCode::cogging,
              .evidence = {{"wavelength", range / waves}},
              .subjects = {{"unit", motion == Motion::rotary ? "rad" : "m"}}}});
  }
  return found;
}

Eigen::MatrixXd outside_linear_terms(Eigen::MatrixXd columns, const Eigen::MatrixXd& linear) {
  const Eigen::VectorXd before = columns.colwise().norm();
  columns -= linear * (linear.transpose() * columns).eval();
  constexpr double own = 1e-4;  // what is less is a linear term but for rounding
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const double norm = columns.col(j).norm();
    columns.col(j) *= norm > own * before(j) ? 1.0 / norm : 0.0;
  }
  return orthonormal_basis(columns, own);
}

}  // namespace zwidth::internal
