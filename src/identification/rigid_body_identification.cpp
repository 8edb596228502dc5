#include "zwidth/identification/rigid_body_identification.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "identification/fit_judgement.hpp"
#include "identification/nonlinearity_of_equations.hpp"
#include "identification/percent.hpp"
#include "identification/plausibility.hpp"
#include "require_valid.hpp"
#include "signal/clipping.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// One parameter of the body, where it stands in the device and in the covariance.
struct Place {
  std::string_view key;
  double* value;
  const ParameterEstimate* estimate;
  Eigen::Index row;
};

DeviceParameters device_of(const RigidBodyFit& fit, const RigidBodyOptions& options, double sampling_period,
                           std::vector<Remark>& remarks) {
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
  parameters.motion = options.motion;
  parameters.bodies = {body};
  parameters.loop.sampling_period = sampling_period;
  parameters.uncertainty = std::move(uncertainty);
  return parameters;
}

/// Friction that drives the body is none: it is biased by more than its interval.
void judge_friction(RigidBodyIdentification& identified) {
  for (const ParameterEstimate* each : {&identified.fit.viscous, &identified.fit.coulomb}) {
    if (!each->upper || *each->upper >= 0.0) continue;
    identified.trust.doubt(
        fmt::format("{} friction comes out as {:.3g}, below 0 by more than its interval: motion is too noisy, or "
                    "another force acts; "
                    "lower the cutoff, or fit in time",
                    each->key, each->value));
  }
}

/// A force that acts later than one that is held delays the loop, too.
void judge_delay(RigidBodyIdentification& identified, double recorded_period) {
  const ParameterEstimate& delay = identified.fit.delay;
  const double hold = 0.5 * recorded_period;
  if (!delay.lower) {
    identified.trust.doubt("the delay from force to motion does not show in this record; move at several frequencies");
    return;
  }
  if (*delay.lower <= hold) return;
  const double later = delay.value - hold;
  identified.remarks.push_back({Remark::Severity::warning,
                                fmt::format("the force acts {:.4g} ms later than a held force does", 1e3 * later),
                                "the device below has no such delay",
                                fmt::format("where that delay is the actuator's or the sensor's, give the device a "
                                            "loop.delay of {:.3g} s",
                                            later)});
  constexpr double notable = 0.02;  // of the hold: K_CR falls by about as much
  if (later > notable * hold) {
    identified.trust.doubt(fmt::format(
        "the record shows a delay of {:.3g} s that the device does not have; give it as its loop.delay", later));
  }
}

void judge_residual(RigidBodyIdentification& identified) {
  constexpr double doubtful = 0.1;
  constexpr double refused = 0.5;
  const double residual = identified.fit.relative_residual;
  const std::string what =
      fmt::format("{} of the force stays unexplained by one rigid body with dry friction", percent(residual));
  const char* remedy = "lower the cutoff below the first vibration mode, or fit a structure of several bodies";
  if (residual <= doubtful) return;
  if (residual > refused) {
    identified.trust.refuse(fmt::format("{}; {}", what, remedy));
  } else {
    identified.trust.doubt(fmt::format("{}; {}", what, remedy));
  }
  identified.remarks.push_back(
      {Remark::Severity::warning, what, "its parameters may be off by more than their intervals", remedy});
}

/// A mode that limits the wall before the rigid body does is not in this model.
void judge_mode(RigidBodyIdentification& identified) {
  if (!identified.fit.first_mode_hz) return;
  const std::string what =
      fmt::format("the device is not rigid: its response turns back near {:.4g} Hz", *identified.fit.first_mode_hz);
  const char* remedy = "fit a structure of several bodies to judge walls";
  identified.trust.doubt(fmt::format("{}; {}", what, remedy));
  identified.remarks.push_back(
      {Remark::Severity::warning, what, "a mode may limit the wall before the rigid body does", remedy});
}

void judge_nonlinearity(RigidBodyIdentification& identified, const Recording& recording, Motion motion) {
  if (auto doubt = doubt_of_counts(recording)) identified.trust.doubt(*std::move(doubt));
  const auto found = find_nonlinearity_of_equations(identified.fit, recording.channels[0].samples,
                                                    recording.channels[1].samples, recording.sampling_period, motion);
  if (!found) return;
  const std::string what = fmt::format("the record shows {}", found->what);
  identified.trust.doubt(fmt::format("{}; {}", what, found->remedy));
  identified.remarks.push_back(
      {Remark::Severity::warning, what, "the fit takes it for mass, friction and offset", found->remedy});
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
  if (not_positive(options.sampling_period)) {
    return OptionProblem{"sampling_period", fmt::format("is {}", *options.sampling_period),
                         "must be a number of seconds above 0"};
  }
  return std::nullopt;
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
      trust.doubt(fmt::format("{} is clipped: force and motion do not belong together there; reduce the amplitude",
                              channel.name));
    }
  }
  for (Remark& remark : implausible_recording(recording)) remarks.push_back(std::move(remark));
  std::vector<Remark> own = std::exchange(fit.remarks, {});
  remarks.insert(remarks.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
  Device device(device_of(fit, options, options.sampling_period.value_or(period), remarks));
  for (Remark& remark : implausible_device(device, nullptr, period)) remarks.push_back(std::move(remark));
  RigidBodyIdentification identified{recording.source, std::move(fit), std::move(device), std::move(remarks),
                                     std::move(trust)};
  judge_residual(identified);
  judge_friction(identified);
  judge_mode(identified);
  judge_delay(identified, period);
  judge_nonlinearity(identified, recording, options.motion);
  identified.device = with_trust(identified.device, identified.trust);
  return identified;
}

}  // namespace zwidth
