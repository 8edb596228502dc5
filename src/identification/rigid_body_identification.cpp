#include "zwidth/identification/rigid_body_identification.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "identification/fit_judgement.hpp"
#include "identification/interval_narrowing.hpp"
#include "identification/lateness.hpp"
#include "identification/nonlinearity_of_equations.hpp"
#include "identification/response/plausibility.hpp"
#include "model/option_beyond.hpp"
#include "model/uncertainty_problem.hpp"
#include "require_valid.hpp"
#include "signal/clipping.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/model/device_key.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// What of the fit is the device's, in the order of estimates(): all but the offset; its delay is later than a hold's.
struct LaterBody {
  Eigen::Vector<double, 5> values;
  Eigen::Matrix<double, 5, 5> covariance;
};

constexpr Eigen::Index delay_row = 4;

/// Delay not below 0: by chance it comes out so, and the others then follow. Where it is not clearly there, none is within
/// what the data leave open.
LaterBody later_body(const RigidBodyFit& fit, double recorded_period) {
  constexpr double clear = 4.0;
  constexpr double of_one_side = 1.645;  // deviations that 5 % of a normal distribution are beyond
  LaterBody body{{fit.mass.value, fit.viscous.value, fit.coulomb.value, fit.offset.value, 0.0}, fit.covariance};
  const double variance = fit.covariance(delay_row, delay_row);
  if (!(variance > 0.0)) return body;  // does not show
  const Eigen::Vector<double, 5> column = fit.covariance.col(delay_row) / variance;
  const double later = fit.delay.value - 0.5 * recorded_period;
  const double deviations = later / std::sqrt(variance);
  body.values(delay_row) = std::max(0.0, later);
  if (deviations < 0.0 && deviations > -clear) body.values.head(4) -= later * column.head(4);
  if (deviations > of_one_side && deviations < clear) {
    const double missing = std::pow(later / of_one_side, 2.0) - variance;
    body.covariance += missing * column * column.transpose();
  }
  return body;
}

/// One parameter of the device, where it stands there and among the estimates.
struct Place {
  std::string key;
  double* value;
  Eigen::Index row;
};

DeviceParameters device_of(const RigidBodyFit& fit, const RigidBodyOptions& options, Motion motion,
                           double recorded_period, std::vector<Remark>& remarks) {
  const LaterBody found = later_body(fit, recorded_period);
  DeviceParameters parameters;
  parameters.name = "rigid body";
  parameters.motion = motion;
  parameters.bodies.resize(1);
  parameters.loop.sampling_period = options.sampling_period.value_or(recorded_period);
  Body& body = parameters.bodies.front();
  body.name = "body";
  Uncertainty uncertainty;
  std::vector<Eigen::Index> rows;
  for (const Place& place :
       {Place{"body.body.mass", &body.mass, 0}, Place{"body.body.damping", &body.damping, 1},
        Place{"body.body.coulomb", &body.coulomb, 2}, Place{delay_key, &parameters.loop.delay, delay_row}}) {
    const double value = found.values(place.row);
    if (value < 0.0) {
      remarks.push_back(warning({.code = FindingCode::taken_as_zero,
                                 .evidence = {{"value", value}},
                                 .key = estimates(fit)[static_cast<std::size_t>(place.row)].key}));
      continue;
    }
    *place.value = value;
    if (place.row == delay_row && !fit.delay.identifiable) {
      uncertainty.assumed.emplace_back(place.key);
      continue;
    }
    uncertainty.parameters.push_back(place.key);
    rows.push_back(place.row);
  }
  for (const Eigen::Index i : rows) {
    uncertainty.covariance.emplace_back();
    for (const Eigen::Index j : rows) uncertainty.covariance.back().push_back(found.covariance(i, j));
  }
  parameters.uncertainty = without_rounding(std::move(uncertainty));
  return parameters;
}

/// Friction that drives the body is none: it is biased by more than its interval.
void judge_friction(RigidBodyIdentification& identified) {
  for (const ParameterEstimate* each : {&identified.fit.viscous, &identified.fit.coulomb}) {
    if (!each->upper || *each->upper >= 0.0) continue;
    identified.trust.doubt({.code = FindingCode::friction_below_zero,
                            .evidence = {{"value", each->value}, {"upper", *each->upper}},
                            .subjects = {{"friction", each->key}}});
  }
}

/// A force that acts later than one that is held delays the loop, too.
void judge_delay(RigidBodyIdentification& identified, double recorded_period) {
  const ParameterEstimate& delay = identified.fit.delay;
  if (!delay.identifiable) {
    identified.trust.doubt({.code = FindingCode::delay_not_shown});
    return;
  }
  const double later = delay.value - 0.5 * recorded_period;
  constexpr double clear = 4.0;
  if (later <= clear * *delay.standard_deviation) return;
  identified.remarks.push_back(
      note({.code = FindingCode::force_acts_later, .evidence = {{"milliseconds", 1e3 * later}}, .key = delay_key}));
}

/// What limits must have been excited, and the delay be known for it.
void judge_limit(RigidBodyIdentification& identified) {
  const CriticalStiffness critical = limit_of(identified.device);
  const double lowest = radians_per_second(identified.fit.lowest_hz);
  const double highest = radians_per_second(identified.fit.highest_hz);
  if (critical.limit && (critical.limit->frequency < lowest || critical.limit->frequency > highest)) {
    identified.trust.doubt(limit_outside_band(critical.limit->frequency, lowest, highest));
    if (critical.limit->frequency > highest) identified.device = with_shared_lateness(identified.device);
  }
  const auto interval = analyze(identified.device, {.any_user = false}).interval;
  if (!interval || !is_inconclusive(*interval)) return;
  Finding open = interval_left_open(*interval);
  const Loop& loop = identified.device.parameters().loop;
  const auto deviation = identified.fit.delay.standard_deviation;
  constexpr double notable = 0.2;  // of what delays the loop: K_CR goes with it
  if (deviation && 2.0 * *deviation > notable * (0.5 * loop.sampling_period + loop.delay)) {
    open.evidence.push_back({"delay_within_ms", 2e3 * *deviation});
  }
  identified.trust.doubt(std::move(open));
}

void judge_residual(RigidBodyIdentification& identified) {
  constexpr double doubtful = 0.1;
  constexpr double refused = 0.5;
  const double residual = identified.fit.relative_residual;
  if (residual <= doubtful) return;
  const Finding found{.code = FindingCode::force_unexplained,
                      .evidence = {{"unexplained", residual}, {"threshold", residual > refused ? refused : doubtful}}};
  if (residual > refused) {
    identified.trust.refuse(found);
  } else {
    identified.trust.doubt(found);
  }
  identified.remarks.push_back(warning(found));
}

/// A mode that limits the wall before the rigid body does is not in this model.
void judge_mode(RigidBodyIdentification& identified) {
  const RigidBodyFit& fit = identified.fit;
  if (!fit.first_mode_hz && !fit.compliant_mode_hz) return;
  const Finding found{.code = FindingCode::device_not_rigid,
                      .evidence = {fit.first_mode_hz ? Evidence{"first_mode", *fit.first_mode_hz}
                                                     : Evidence{"mode_above", *fit.compliant_mode_hz}}};
  identified.trust.doubt(found);
  identified.remarks.push_back(warning(found));
}

void judge_nonlinearity(RigidBodyIdentification& identified, const Recording& recording, Motion motion) {
  for (Finding& doubt :
       doubts_of_recording(recording, std::span(&recording, 1), OutputQuantity::position, identified.device)) {
    identified.trust.doubt(std::move(doubt));
  }
  auto found = find_nonlinearity_of_equations(identified.fit, recording.channels[0].samples,
                                              recording.channels[1].samples, recording.sampling_period, motion);
  if (!found) return;
  Finding shown = shown_by("the record", std::move(found->finding));
  shown.subjects.push_back({"taken_for", "friction"});
  identified.trust.doubt(shown);
  identified.remarks.push_back(warning(std::move(shown)));
}

}  // namespace

std::optional<OptionProblem> find_problem(const RigidBodyOptions& options) {
  const auto not_positive = [](const std::optional<double>& value) {
    return value && !(std::isfinite(*value) && *value > 0.0);
  };
  const InverseDynamicsOptions& inverse = options.inverse_dynamics;
  if (not_positive(inverse.cutoff_hz)) {
    return OptionProblem{"inverse_dynamics.cutoff_hz", fmt::format("is {} Hz", *inverse.cutoff_hz),
                         "must be above 0 and below half the rate"};
  }
  if (inverse.decimation && *inverse.decimation < 1) {
    return OptionProblem{"inverse_dynamics.decimation", "is 0", "must be at least 1"};
  }
  if (!options.sampling_period) return std::nullopt;
  return option_beyond("sampling_period", *options.sampling_period, positive_numbers, "s");
}

RigidBodyIdentification identify_rigid_body(const Recording& recording, const RigidBodyOptions& options,
                                            const Progress& progress) {
  require_valid(find_problem(options));
  if (recording.channels.size() != 2) {
    throw Error(
        ErrorCode::invalid_argument,
        fmt::format("the recording has {} channels; two, the force and the position", recording.channels.size()));
  }
  const double period = recording.sampling_period;
  RigidBodyFit fit = identify_rigid_body(recording.channels[0].samples, recording.channels[1].samples, period,
                                         options.inverse_dynamics, progress);
  if (!(fit.mass.value > 0.0)) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("the fitted mass is {:.4g}: force and motion have opposite signs, or are not of one body; "
                            "turn the sign of one of them",
                            fit.mass.value));
  }
  std::vector<Remark> remarks = recording.remarks;
  Trust trust;
  const std::array roles{SignalRole::force, SignalRole::position};
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const Channel& channel = recording.channels[i];
    for (Remark& remark : check_signal(channel, period, roles[i])) remarks.push_back(std::move(remark));
    if (is_clipped(channel, period, roles[i])) {
      trust.doubt({.code = FindingCode::clipped_for_equations, .subjects = {{"channel", channel.name}}});
    }
  }
  for (Remark& remark : implausible_recording(recording)) remarks.push_back(std::move(remark));
  std::vector<Remark> own = std::exchange(fit.remarks, {});
  remarks.insert(remarks.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
  const auto stated = stated_motion(std::span(&recording, 1));
  const Motion motion = options.motion.value_or(stated.value_or(Motion::linear));
  Device device(device_of(fit, options, motion, period, remarks));
  for (Remark& remark : implausible_device(device, nullptr, period)) remarks.push_back(std::move(remark));
  RigidBodyIdentification identified{recording.source, std::move(fit), std::move(device), std::move(remarks),
                                     std::move(trust)};
  judge_residual(identified);
  judge_friction(identified);
  judge_mode(identified);
  judge_delay(identified, period);
  judge_limit(identified);
  judge_nonlinearity(identified, recording, motion);
  identified.device = with_trust(identified.device, identified.trust);
  return identified;
}

}  // namespace zwidth
