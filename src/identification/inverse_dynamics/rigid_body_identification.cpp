#include "zwidth/identification/rigid_body_identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "counted.hpp"
#include "identification/device_file_trust.hpp"
#include "identification/response/plausibility.hpp"
#include "identification/verdict/plausible_device.hpp"
#include "identification/verdict/verdict.hpp"
#include "model/loop_keys.hpp"
#include "model/option_beyond.hpp"
#include "model/uncertainty_problem.hpp"
#include "signal/clipping.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/model/device_key.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"
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
        Place{"body.body.coulomb", &body.coulomb, 2}, Place{key_of_delay, &parameters.loop.delay, delay_row}}) {
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

/// The record's own statements that contradict what it is taken for: a rate, a column's quantity, its motion.
void judge_statements(RigidBodyIdentification& identified, const Recording& recording) {
  for (const Finding& each : recording.doubts) identified.trust.doubt(each);
  const Motion motion = identified.device.parameters().motion;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    const Channel& channel = recording.channels[i];
    const StatedQuantity taken_for = i == 0 ? StatedQuantity::force : StatedQuantity::position;
    if (channel.quantity != StatedQuantity::nothing && channel.quantity != taken_for) {
      const bool is_unknown = channel.quantity == StatedQuantity::other;
      identified.trust.doubt(
          {.code = is_unknown ? FindingCode::channel_unit_unknown : FindingCode::channel_of_other_quantity,
           .subjects = {{"channel", channel.name}, {"unit", channel.unit}, {"role", i == 0 ? "force" : "motion"}}});
    }
    Recording alone;
    alone.channels.push_back({.name = "", .samples = {}, .base_unit = channel.base_unit});
    const std::optional<Motion> stated = stated_motion(std::span(&alone, 1));
    if (!stated || *stated == motion) continue;
    const bool is_rotary = motion == Motion::rotary;
    identified.trust.doubt({.code = FindingCode::channel_of_other_motion,
                            .subjects = {{"channel", channel.name},
                                         {"unit", channel.base_unit},
                                         {"of_channel", is_rotary ? "linear" : "rotary"},
                                         {"of_structure", is_rotary ? "rotary" : "linear"}},
                            .key = "motion"});
  }
}

/// Most of the force must be that of the body; the interval counts errors that are a small part of it only.
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
}

/// What one passive rigid body cannot do: friction that drives it, a response that turns back.
void judge_body(RigidBodyIdentification& identified) {
  const RigidBodyFit& fit = identified.fit;
  for (const ParameterEstimate* each : {&fit.viscous, &fit.coulomb}) {
    if (!each->upper || *each->upper >= 0.0) continue;
    identified.trust.doubt({.code = FindingCode::friction_below_zero,
                            .evidence = {{"value", each->value}, {"upper", *each->upper}},
                            .subjects = {{"friction", each->key}}});
  }
  if (!fit.first_mode_hz && !fit.compliant_mode_hz) return;
  identified.trust.doubt({.code = FindingCode::device_not_rigid,
                          .evidence = {fit.first_mode_hz ? Evidence{"first_mode", *fit.first_mode_hz}
                                                         : Evidence{"mode_above", *fit.compliant_mode_hz}}});
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
      note({.code = FindingCode::force_acts_later, .evidence = {{"milliseconds", 1e3 * later}}, .key = key_of_delay}));
}

/// The interval must be narrow, and what limits excited: no number of a rigid body stands for what lies beyond.
void judge_limit(RigidBodyIdentification& identified) {
  const Analysis analysis = analyze(identified.device, {.any_user = false});
  const double lowest = radians_per_second(identified.fit.lowest_hz);
  const double highest = radians_per_second(identified.fit.highest_hz);
  if (const auto& limit = analysis.critical.limit; limit && (limit->frequency < lowest || limit->frequency > highest)) {
    identified.trust.doubt(
        {.code = FindingCode::limit_outside_band,
         .evidence = {{"frequency", hertz(limit->frequency)}, {"lowest", hertz(lowest)}, {"highest", hertz(highest)}},
         .subjects = {{"side", limit->frequency > highest ? "above" : "below"}}});
  }
  if (!analysis.interval) return;
  VerdictInput known;
  known.limit = Interval{analysis.interval->lower, analysis.interval->upper};
  const Loop& loop = identified.device.parameters().loop;
  const auto& deviation = identified.fit.delay.standard_deviation;
  constexpr double notable = 0.2;  // of what delays the loop: K_CR goes with it
  Trust of_width = verdict_of(known).trust;
  for (Finding& doubt : of_width.findings) {
    if (deviation && 2.0 * *deviation > notable * (0.5 * loop.sampling_period + loop.delay)) {
      doubt.evidence.push_back({"delay_within_ms", 2e3 * *deviation});
    }
    identified.trust.doubt(std::move(doubt));
  }
}

}  // namespace

std::optional<OptionProblem> find_problem(const RigidBodyOptions& options) {
  const InverseDynamicsOptions& inverse = options.inverse_dynamics;
  if (inverse.cutoff_hz && !(std::isfinite(*inverse.cutoff_hz) && *inverse.cutoff_hz > 0.0)) {
    return option_problem("inverse_dynamics.cutoff_hz",
                          {.code = ProblemCode::frequency_out_of_range, .evidence = {{"hertz", *inverse.cutoff_hz}}});
  }
  if (inverse.decimation && *inverse.decimation < 1) {
    return option_problem("inverse_dynamics.decimation", {.code = ProblemCode::none_asked});
  }
  if (!options.sampling_period) return std::nullopt;
  return option_beyond("sampling_period", *options.sampling_period, positive_numbers, "s");
}

RigidBodyIdentification identify_rigid_body(const Recording& recording, const RigidBodyOptions& options,
                                            const Progress& progress) {
  require_valid(find_problem(options));
  if (recording.channels.size() != 2) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::recording_without_two_channels,
                                              .evidence = {counted("channels", recording.channels.size())}});
  }
  const double period = recording.sampling_period;
  RigidBodyFit fit = identify_rigid_body(recording.channels[0].samples, recording.channels[1].samples, period,
                                         options.inverse_dynamics, progress);
  if (!(fit.mass.value > 0.0)) {
    throw Error(ErrorCode::invalid_argument,
                {.code = ProblemCode::force_against_motion, .evidence = {{"value", fit.mass.value}}});
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
  judge_statements(identified, recording);
  judge_residual(identified);
  judge_body(identified);
  judge_delay(identified, period);
  judge_limit(identified);
  identified.device = with_trust(identified.device, identified.trust);
  return identified;
}

}  // namespace zwidth
