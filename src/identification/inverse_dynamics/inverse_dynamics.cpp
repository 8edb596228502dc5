#include "zwidth/identification/inverse_dynamics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "counted.hpp"
#include "eigenvalues.hpp"
#include "identification/crossover/student_t.hpp"
#include "identification/inverse_dynamics/correlated_residuals.hpp"
#include "identification/inverse_dynamics/rigid_band.hpp"
#include "linear_systems.hpp"
#include "signal/zero_phase_filter.hpp"
#include "zwidth/error.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::size_t least_samples = 100;
constexpr std::size_t least_equations = 20;
constexpr double decimation_factor = 0.8;

[[noreturn]] void fail(const Problem& problem) { throw Error(ErrorCode::invalid_argument, problem); }

/// The terms of the model at the record's inner samples, all through the same low-pass.
struct Terms {
  std::vector<double> force;
  std::vector<double> force_slope;
  std::vector<double> acceleration;
  std::vector<double> velocity;
  std::vector<double> sign;
};

void check(std::span<const double> force, std::span<const double> position, double sampling_period,
           const InverseDynamicsOptions& options) {
  if (force.size() != position.size()) {
    fail({.code = ProblemCode::force_and_motion_of_two_lengths,
          .evidence = {counted("force", force.size()), counted("motion", position.size())}});
  }
  if (force.size() < least_samples) {
    fail({.code = ProblemCode::record_of_few_samples,
          .evidence = {counted("samples", force.size()), counted("least", least_samples)}});
  }
  for (const auto& [name, samples] : {std::pair{"the force", force}, std::pair{"the position", position}}) {
    if (std::ranges::all_of(samples, [](double value) { return std::isfinite(value); })) continue;
    fail({.code = ProblemCode::not_finite, .subjects = {{"name", name}}});
  }
  if (!(std::isfinite(sampling_period) && sampling_period > 0.0)) {
    fail({.code = ProblemCode::not_finite_and_positive,
          .evidence = {{"value", sampling_period}},
          .subjects = {{"name", "sampling period"}, {"unit", "s"}}});
  }
  if (options.cutoff_hz && !(*options.cutoff_hz > 0.0 && *options.cutoff_hz * sampling_period < 0.5)) {
    refuse_member("cutoff_hz", {.code = ProblemCode::cutoff_not_possible,
                                .evidence = {{"value", *options.cutoff_hz}, {"nyquist", 0.5 / sampling_period}}});
  }
  if (options.decimation && *options.decimation < 1) {
    refuse_member("decimation", {.code = ProblemCode::none_asked, .subjects = {{"name", "decimation"}}});
  }
  const auto [lowest, highest] = std::ranges::minmax(position);
  if (lowest == highest) fail({.code = ProblemCode::body_does_not_move});
}

/// Samples lost at each end to the differences.
constexpr std::size_t reach = 2;

/// signal[k + reach] combined with its neighbours by symmetric (even) or antisymmetric (odd) weights.
struct Stencil {
  double centre = 0.0;
  double first = 0.0;   ///< of signal[+1] + parity signal[-1]
  double second = 0.0;  ///< of signal[+2] + parity signal[-2]
  double parity = 1.0;
};

std::vector<double> combined(std::span<const double> signal, const Stencil& stencil) {
  std::vector<double> result(signal.size() - 2 * reach);
  for (std::size_t k = 0; k < result.size(); ++k) {
    const double* at = &signal[k + reach];
    result[k] = stencil.centre * at[0] + stencil.first * (at[1] + stencil.parity * at[-1]) +
                stencil.second * (at[2] + stencil.parity * at[-2]);
  }
  return result;
}

// Central differences of fourth order.
Stencil slope_stencil(double period) { return {0.0, 2.0 / (3.0 * period), -1.0 / (12.0 * period), -1.0}; }
Stencil curvature_stencil(double period) {
  const double unit = 1.0 / (12.0 * period * period);
  return {-30.0 * unit, 16.0 * unit, -unit, 1.0};
}
// A held force is the mean over a period of the signal through its samples, to fourth order; that the period lies after
// the sample is part of the delay.
constexpr Stencil hold_stencil{22.0 / 24.0, 1.0 / 24.0, 0.0, 1.0};

Terms filtered_terms(std::span<const double> force, std::span<const double> position, double period, double cutoff) {
  const auto filtered = [&](std::span<const double> signal) { return zero_phase_low_pass(signal, cutoff); };
  Terms terms;
  terms.acceleration = filtered(combined(position, curvature_stencil(period)));
  terms.velocity = filtered(combined(position, slope_stencil(period)));
  // Where the body reverses, the low-pass alone would round the velocity's kink and shift its zero.
  const double kink_cutoff = std::max(cutoff, std::min(4.0 * cutoff, 0.25));
  std::vector<double> sign = zero_phase_low_pass(combined(position, slope_stencil(period)), kink_cutoff);
  for (double& v : sign) v = v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
  terms.sign = filtered(sign);
  terms.force = filtered(combined(force, hold_stencil));
  terms.force_slope = filtered(combined(force, slope_stencil(period)));
  return terms;
}

/// Whether each sample belongs to a rest: slower than 1 % of the rms speed for longer than a period of the cutoff, and
/// as long around it, where the filter still feels it. A mere reversal is far shorter.
std::vector<bool> resting(const std::vector<double>& velocity, double cutoff) {
  constexpr double slow = 0.01;
  double power = 0.0;
  for (const double v : velocity) power += v * v;
  const double threshold = slow * std::sqrt(power / static_cast<double>(velocity.size()));
  const auto span = static_cast<std::size_t>(std::ceil(1.0 / cutoff));
  std::vector<bool> rests(velocity.size(), false);
  for (std::size_t k = 0; k < velocity.size();) {
    std::size_t end = k;
    while (end < velocity.size() && std::abs(velocity[end]) <= threshold) ++end;
    if (end - k > span) {
      const auto first = static_cast<std::ptrdiff_t>(k - std::min(k, span));
      const auto last = static_cast<std::ptrdiff_t>(std::min(end + span, velocity.size()));
      std::fill(rests.begin() + first, rests.begin() + last, true);
    }
    k = std::max(end, k + 1);
  }
  return rests;
}

/// Indices of the samples that become equations.
std::vector<std::size_t> kept_samples(const Terms& terms, double cutoff, std::size_t decimation) {
  const std::vector<bool> rests = resting(terms.velocity, cutoff);
  const auto transient = static_cast<std::size_t>(std::ceil(1.0 / cutoff));
  std::vector<std::size_t> kept;
  for (std::size_t k = transient; k + transient < terms.velocity.size(); k += decimation) {
    if (!rests[k]) kept.push_back(k);
  }
  if (kept.size() < least_equations) {
    fail({.code = ProblemCode::too_few_equations,
          .evidence = {counted("equations", kept.size()), counted("samples", terms.velocity.size() + 2 * reach),
                       counted("least", least_equations)}});
  }
  return kept;
}

void check_reversals(const Terms& terms, const std::vector<std::size_t>& kept) {
  constexpr double least_share = 0.02;
  const auto forwards = static_cast<double>(
      std::count_if(kept.begin(), kept.end(), [&](std::size_t k) { return terms.velocity[k] > 0.0; }));
  const double share = forwards / static_cast<double>(kept.size());
  if (std::min(share, 1.0 - share) < least_share) fail({.code = ProblemCode::moves_one_way});
}

/// The slope of a smooth signal between two samples, and its value: cubic through values and slopes.
double interpolated(const std::vector<double>& values, const std::vector<double>& slopes, double at, double step) {
  const auto last = static_cast<double>(values.size() - 2);
  const auto k = static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, last));
  const double u = std::clamp(at - static_cast<double>(k), 0.0, 1.0);
  const double difference = values[k + 1] - values[k];
  return values[k] + u * difference +
         u * (1.0 - u) * ((1.0 - u) * (step * slopes[k] - difference) - u * (step * slopes[k + 1] - difference));
}

enum Column : Eigen::Index { mass, viscous, coulomb, offset, delay, columns };

/// The least-squares solution with what its covariance needs.
struct DynamicsSolution {
  Eigen::MatrixXd regressors;
  Eigen::VectorXd parameters;
  Eigen::VectorXd force;
  Eigen::VectorXd residuals;
};

/// Columns scaled to unit length span their space unless the least singular value nearly vanishes.
bool independent(const Eigen::MatrixXd& regressors) {
  constexpr double least = 1e-3;
  const Eigen::RowVectorXd lengths = regressors.colwise().norm();
  if (lengths.minCoeff() == 0.0) return false;
  const Eigen::MatrixXd scaled = regressors * lengths.cwiseInverse().asDiagonal();
  return symmetric_eigenvalues(scaled.transpose() * scaled).minCoeff() > least * least;
}

/// L[F](t - tau) ~ L[F](t - tau_0) - (tau - tau_0) L[F]'(t - tau_0): the last column finds the step of the delay.
DynamicsSolution solve(const Terms& terms, const std::vector<std::size_t>& kept, double period, double delay_so_far,
                       Eigen::Index count) {
  DynamicsSolution solution{Eigen::MatrixXd(kept.size(), count), {}, Eigen::VectorXd(kept.size()), {}};
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const std::size_t k = kept[i];
    const double at = static_cast<double>(k) - delay_so_far / period;
    solution.force(row) = interpolated(terms.force, terms.force_slope, at, period);
    const std::array<double, columns> values{terms.acceleration[k], terms.velocity[k], terms.sign[k], 1.0,
                                             terms.force_slope[k]};
    for (Eigen::Index j = 0; j < count; ++j) solution.regressors(row, j) = values[static_cast<std::size_t>(j)];
  }
  solution.parameters = least_squares(solution.regressors, solution.force);
  solution.residuals = solution.force - solution.regressors * solution.parameters;
  return solution;
}

/// What a body behind a link that yields does to the solution, as far as the frequencies' squares go.
///
///     L[F] = mass L[a] + ... + c L[F''],    c = -m_2^2 / (k mass) where the driven body is sensed, m_1 m_2 / (k mass)
///
/// where the other is. F'' stands for mass a'', which encoder noise drowns.
struct Compliance {
  DynamicsSolution solution;  ///< with c as its last parameter
  Eigen::MatrixXd covariance;
  Eigen::VectorXd shift;  ///< of the rigid body's parameters, towards this solution
  bool shows = false;     ///< beyond chance, and by more than it matters
};

/// Nothing where the record's frequencies do not tell c from the rest.
std::optional<Compliance> compliance_of(const DynamicsSolution& rigid, const Terms& terms,
                                        const std::vector<std::size_t>& kept) {
  constexpr double deviations = 4.0;
  constexpr double notable = 0.01;  // of the mass
  constexpr double credible = 0.1;  // the series goes no further
  const Eigen::Index known = rigid.regressors.cols();
  Compliance found{{Eigen::MatrixXd(rigid.regressors.rows(), known + 1), {}, rigid.force, {}}, {}, {}};
  found.solution.regressors.leftCols(known) = rigid.regressors;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const double* at = &terms.force[kept[i]];
    found.solution.regressors(static_cast<Eigen::Index>(i), known) = at[1] - 2.0 * at[0] + at[-1];  // times period^2
  }
  if (!independent(found.solution.regressors)) return std::nullopt;
  found.solution.parameters = least_squares(found.solution.regressors, rigid.force);
  found.solution.residuals = rigid.force - found.solution.regressors * found.solution.parameters;
  found.covariance = covariance_with_correlated_residuals(found.solution.regressors, found.solution.residuals);
  found.shift = found.solution.parameters.head(known) - rigid.parameters;
  found.shows = std::abs(found.solution.parameters(known)) > deviations * std::sqrt(found.covariance(known, known)) &&
                std::abs(found.shift(mass)) > notable * rigid.parameters(mass);
  const double most = credible * std::abs(rigid.parameters(mass));
  if (std::abs(found.shift(mass)) > most) {
    found.shows = false;
    found.shift *= most / std::abs(found.shift(mass));
  }
  return found;
}

ParameterEstimate estimate(std::string key, double value, double deviation, double quantile) {
  ParameterEstimate result;
  result.key = std::move(key);
  result.value = value;
  result.standard_deviation = deviation;
  result.lower = value - quantile * deviation;
  result.upper = value + quantile * deviation;
  return result;
}

}  // namespace

std::vector<ParameterEstimate> estimates(const RigidBodyFit& fit) {
  return {fit.mass, fit.viscous, fit.coulomb, fit.offset, fit.delay};
}

RigidBodyFit identify_rigid_body(std::span<const double> force, std::span<const double> position,
                                 double sampling_period, const InverseDynamicsOptions& options,
                                 const Progress& progress) {
  check(force, position, sampling_period, options);
  const auto report = [&](double fraction) {
    if (progress) progress(fraction);
  };
  const RigidBand band = rigid_band(force, position);
  const double cutoff = options.cutoff_hz ? *options.cutoff_hz * sampling_period : band.cutoff;
  report(0.2);
  const std::size_t decimation =
      options.decimation.value_or(std::max<std::size_t>(1, static_cast<std::size_t>(decimation_factor * 0.5 / cutoff)));
  const Terms terms = filtered_terms(force, position, sampling_period, cutoff);
  report(0.7);
  const std::vector<std::size_t> kept = kept_samples(terms, cutoff, decimation);
  check_reversals(terms, kept);

  RigidBodyFit fit;
  fit.cutoff_hz = cutoff / sampling_period;
  fit.decimation = decimation;
  fit.equations = kept.size();
  fit.lowest_hz = band.lowest / sampling_period;
  fit.highest_hz = std::min(band.highest, cutoff) / sampling_period;
  if (band.first_mode) fit.first_mode_hz = *band.first_mode / sampling_period;

  DynamicsSolution solution = solve(terms, kept, sampling_period, 0.0, columns);
  double total_delay = 0.0;
  const bool delay_shows = independent(solution.regressors);
  if (delay_shows) {
    constexpr int most_steps = 5;
    constexpr double settled = 1e-4;  // of a period
    for (int i = 0; i < most_steps; ++i) {
      total_delay += solution.parameters(delay);
      if (std::abs(solution.parameters(delay)) < settled * sampling_period) break;
      solution = solve(terms, kept, sampling_period, total_delay, columns);
    }
  } else {
    total_delay = 0.5 * sampling_period;
    solution = solve(terms, kept, sampling_period, total_delay, delay);
    if (!independent(solution.regressors)) fail({.code = ProblemCode::equations_not_told_apart});
    fit.remarks.push_back(warning({.code = FindingCode::delay_not_shown}));
  }
  report(0.9);

  Eigen::MatrixXd covariance = covariance_with_correlated_residuals(solution.regressors, solution.residuals);
  if (const auto compliance = compliance_of(solution, terms, kept)) {
    const Eigen::Index known = solution.regressors.cols();
    // Of a series in squares of the frequency: what was left out is a part of what was found, or all of it.
    constexpr double next_term = 0.25;
    const Eigen::VectorXd open = (compliance->shows ? next_term : 1.0) * compliance->shift;
    if (compliance->shows) {
      const double c = compliance->solution.parameters(known);
      fit.compliant_mode_hz = 1.0 / (2.0 * std::numbers::pi * sampling_period * std::sqrt(std::abs(c)));
      if (delay_shows) total_delay += compliance->shift(delay);
      solution = compliance->solution;
      covariance = compliance->covariance.topLeftCorner(known, known);
    }
    covariance += open * open.transpose();
  }
  if (delay_shows) {
    // Friction while the body sticks is not Coulomb's: of the phase at the highest frequency this much is not known.
    constexpr double phase = 1e-3;
    const double open = phase / (2.0 * std::numbers::pi * fit.highest_hz);
    const Eigen::VectorXd column = covariance.col(delay) / covariance(delay, delay);
    covariance += open * open * column * column.transpose();
  }
  const auto freedom = static_cast<double>(solution.residuals.size() - solution.parameters.size());
  const double quantile = student_t_quantile(freedom);
  const auto of = [&](Column column, std::string key) {
    return estimate(std::move(key), solution.parameters(column), std::sqrt(covariance(column, column)), quantile);
  };
  fit.mass = of(mass, "mass");
  fit.viscous = of(viscous, "viscous");
  fit.coulomb = of(coulomb, "coulomb");
  fit.offset = of(offset, "offset");
  if (delay_shows) {
    fit.delay = estimate("delay", total_delay, std::sqrt(covariance(delay, delay)), quantile);
  } else {
    fit.delay.key = "delay";
    fit.delay.value = total_delay;
    fit.delay.identifiable = false;
  }
  const Eigen::Index known = covariance.rows();
  fit.covariance.setZero();
  fit.covariance.topLeftCorner(known, known) = covariance;
  fit.relative_residual = solution.residuals.norm() / solution.force.norm();
  for (const std::size_t k : kept) fit.times.push_back(static_cast<double>(k) * sampling_period);
  fit.forces.assign(solution.force.begin(), solution.force.end());
  fit.residual_forces.assign(solution.residuals.begin(), solution.residuals.end());
  report(1.0);
  return fit;
}

}  // namespace zwidth
