#include "identification/time_domain_judgement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "identification/fit_judgement.hpp"
#include "identification/fit_weights.hpp"
#include "identification/held_device.hpp"
#include "identification/interval_narrowing.hpp"
#include "identification/lateness.hpp"
#include "identification/motion_residuals.hpp"
#include "identification/nonlinearity_test.hpp"
#include "identification/response/plausibility.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {
namespace {

constexpr double refused_share = 0.5;
constexpr double clear_feedback = 5.0;
// Of the response, which moves a critical stiffness by about as much and more.
constexpr double doubtful_share = 0.05;
constexpr double negligible_share = 0.005;

/// The least relative error e of the fitted device's linear response that explains what the residuals have of the
/// force; 0 where noise does.
double unexplained_response(const Device& fitted, const Recording& recording, const FittedMotion& motion,
                            const std::vector<std::string>& locked) {
  FrequencyResponseOptions options;
  options.excitation = FrequencyResponseOptions::Excitation::aperiodic;
  try {
    const FrequencyResponse left =
        frequency_response(recording.channels[0].samples, motion.residuals, recording.sampling_period, options);
    const SampledPlant plant = sampled_plant(device_in_experiment(fitted, locked, recording.sampling_period));
    std::vector<ResponsePoint> points;
    std::vector<std::complex<double>> values;
    for (ResponsePoint point : left.points) {
      values.push_back(response(plant, point.frequency));
      point.value += values.back();
      points.push_back(point);
    }
    if (points.empty()) return 0.0;
    return model_error_of(points,
                          Eigen::Map<const Eigen::VectorXcd>(values.data(), static_cast<Eigen::Index>(values.size())));
  } catch (const Error&) {  // a residual of nothing has no response
    return 0.0;
  }
}

/// Mean squares of the changes of the residuals near the velocity's reversals and elsewhere; friction that is not
/// Coulomb's (rising before it slips, or falling with speed) shows there.
double reversal_ratio(const Recording& recording, const FittedMotion& motion) {
  const std::vector<double>& position = recording.channels[1].samples;
  constexpr std::size_t reach = 4;
  double near = 0.0;
  double far = 0.0;
  std::size_t near_count = 0;
  std::size_t far_count = 0;
  const auto rises = [&](std::size_t k) { return position[k + reach] - position[k - reach] > 0.0; };
  for (std::size_t k = 2 * reach; k + 2 * reach < position.size(); ++k) {
    const double change = motion.residuals[k + 1] - 2.0 * motion.residuals[k] + motion.residuals[k - 1];
    const bool turns = rises(k - reach) != rises(k + reach);
    (turns ? near : far) += change * change;
    ++(turns ? near_count : far_count);
  }
  constexpr std::size_t enough = 100;
  if (near_count < enough || far_count < enough || !(far > 0.0)) return 1.0;
  return near / static_cast<double>(near_count) / (far / static_cast<double>(far_count));
}

Finding nothing_determined() { return {.code = FindingCode::nothing_determined, .subjects = {{"by", "recordings"}}}; }

/// Whether of masses, dampings and stiffnesses, some of which are free, none is known to within half its size.
bool knows_nothing(const std::vector<ParameterEstimate>& estimates) {
  const auto is_of_device = [](const ParameterEstimate& each) {
    return each.key != delay_key && each.key != lag_key && !each.key.ends_with(".coulomb");
  };
  const auto is_known = [&](const ParameterEstimate& each) {
    return is_of_device(each) && each.identifiable && each.standard_deviation &&
           *each.standard_deviation < 0.5 * std::abs(each.value);
  };
  return std::ranges::any_of(estimates, is_of_device) && std::ranges::none_of(estimates, is_known);
}

class Judge {
 public:
  Judge(TimeDomainIdentification& fit, const JudgedTimeFit& judged) : fit_(fit), judged_(judged) {}

  void judge() {
    fit_.analysis = analyze(fit_.device, {.any_user = false});
    refuse_what_is_none();
    judge_misfit();
    judge_feedback();
    judge_search();
    judge_hand();
    judge_delay();
    judge_what_was_given();
    const std::vector<std::string> open = open_numbers();
    const auto& interval = fit_.analysis.interval;
    if (knows_nothing(fit_.estimates) && (!interval || is_inconclusive(*interval) || !(interval->upper > 0.0))) {
      trust_.refuse(nothing_determined());
    }
    if (!open.empty()) {
      trust_.doubt({.code = FindingCode::numbers_undetermined,
                    .subjects = {{"keys", fmt::format("{}", fmt::join(open, ", "))}, {"taken_from", "start"}}});
    }
    judge_band();
    judge_interval();
    fit_.device = with_trust(fit_.device, trust_);
    keep_what_is_assumed(judged_.structure, fit_.estimates,
                         unseen_placeholders(judged_.options.locked, judged_.options.structure_values), fit_.device,
                         {&trust_});
    fit_.analysis = analyze(fit_.device, {.any_user = false});
    const Wall& wall = fit_.device.parameters().wall;
    fit_.basis = {wall.damping, wall.velocity_filter_hz, wall.filters.size()};
    fit_.trust = trust_;
    if (!trust_.refused() && fit_.analysis.critical.trust.refused()) fit_.trust.inherit(fit_.analysis.critical.trust);
    describe();
  }

 private:
  void refuse_what_is_none() {
    if (judged_.is_turned) trust_.refuse({.code = FindingCode::motion_against_force});
    if (std::ranges::none_of(fit_.estimates, &ParameterEstimate::identifiable)) {
      trust_.refuse(nothing_determined());
    }
  }

  void judge_misfit() {
    for (std::size_t r = 0; r < fit_.motions.size(); ++r) {
      FittedMotion& motion = fit_.motions[r];
      const Recording& recording = judged_.recordings[r];
      motion.unexplained = unexplained_response(fit_.device, recording, motion, judged_.options.locked);
      fit_.model_error = std::max(fit_.model_error, motion.unexplained);
      if (motion.unexplained > refused_share) {
        trust_.refuse({.code = FindingCode::response_in_time_unexplained,
                       .evidence = {{"unexplained", motion.unexplained}, {"threshold", refused_share}},
                       .subjects = {{"source", motion.source}}});
      } else if (motion.unexplained > std::clamp(known_share(), negligible_share, doubtful_share)) {
        trust_.doubt({.code = FindingCode::residual_in_time_beyond_noise,
                      .evidence = {{"unexplained", motion.unexplained},
                                   {"threshold", std::clamp(known_share(), negligible_share, doubtful_share)}},
                      .subjects = {{"source", motion.source}}});
      }
      constexpr double clear = 6.0;
      const double ratio = reversal_ratio(recording, motion);
      if (ratio > clear) {
        trust_.doubt({.code = FindingCode::residuals_larger_at_reversals,
                      .evidence = {{"ratio", std::sqrt(ratio)}, {"threshold", std::sqrt(clear)}},
                      .subjects = {{"source", motion.source}}});
      }
      judge_nonlinearity(r);
    }
  }

  /// How well the critical stiffness is known if the structure is right, relative; 0 where there is none to speak of.
  [[nodiscard]] double known_share() const {
    const auto& interval = fit_.analysis.interval;
    const double stiffness = fit_.analysis.critical.stiffness;
    return interval && stiffness > 0.0 && std::isfinite(stiffness) ? 1.0 - interval->lower / stiffness : 0.0;
  }

  void judge_nonlinearity(std::size_t r) {
    const Recording& recording = judged_.recordings[r];
    const FittedMotion& motion = fit_.motions[r];
    for (Finding& doubt : doubts_of_recording(recording, judged_.recordings, OutputQuantity::position, fit_.device)) {
      trust_.doubt(std::move(doubt));
    }
    if (auto doubt = doubt_of_lag(fit_.estimates, recording.sampling_period)) trust_.doubt(*std::move(doubt));
    std::vector<Shot> shots;
    std::ranges::copy_if(judged_.shots, std::back_inserter(shots), [r](const Shot& shot) { return shot.record == r; });
    if (motion.feedback > clear_feedback) return;  // the force answers to the errors: doubtful for that
    const Device device = device_in_experiment(fit_.device, judged_.options.locked, recording.sampling_period);
    auto found = find_nonlinearity(
        {device, recording.channels[0].samples, recording.channels[1].samples, motion.residuals, shots});
    if (found) return trust_.doubt(shown_by(motion.source, std::move(found->finding)));
    auto weak = doubt_of_weak_forces(judged_.weak_forces[r], fit_.analysis, device.parameters().motion, motion.source);
    if (weak) trust_.doubt(*std::move(weak));
  }

  void judge_feedback() {
    for (const FittedMotion& each : fit_.motions) {
      if (each.feedback <= clear_feedback) continue;
      trust_.doubt({.code = FindingCode::recorded_in_feedback,
                    .evidence = {{"correlation", each.feedback}, {"threshold", clear_feedback}},
                    .subjects = {{"source", each.source}}});
    }
  }

  void judge_search() {
    if (fit_.settled) return;
    trust_.doubt({.code = FindingCode::search_stopped});
  }

  void judge_hand() {
    const bool is_known = judged_.options.structure_values == IdentifyOptions::StructureValues::known;
    for (Remark& remark : remarks_of_experiment(judged_.structure, is_known, judged_.options.locked)) {
      fit_.remarks.push_back(std::move(remark));
    }
    const double recorded_period = judged_.recordings.front().sampling_period;
    for (Remark& remark : implausible_device(fit_.device, is_known ? &judged_.structure : nullptr, recorded_period)) {
      fit_.remarks.push_back(std::move(remark));
    }
    if (auto doubt = is_known ? std::nullopt : doubt_of_weight(fit_.device)) trust_.doubt(*std::move(doubt));
    if (!is_known) return;
    if (auto doubt = doubt_of_masses(fit_.device, judged_.structure)) trust_.doubt(*std::move(doubt));
    if (auto doubt = doubt_of_hand(judged_.structure, fit_.estimates, judged_.options.locked)) {
      trust_.doubt(*std::move(doubt));
    }
    if (auto doubt = doubt_of_lost_delay(judged_.structure, fit_.estimates)) trust_.doubt(*std::move(doubt));
  }

  void judge_delay() {
    if (judged_.open_delay) trust_.doubt(*judged_.open_delay);
    if (!judged_.other_delay) return;
    trust_.doubt(ignored_delay(*judged_.other_delay, judged_.structure.loop().delay));
  }

  void judge_what_was_given() {
    if (judged_.disagreement) trust_.doubt(*judged_.disagreement);
    for (const ContradictedNumber& each : judged_.contradicted) {
      trust_.doubt(contradiction(each));
    }
  }

  [[nodiscard]] std::vector<std::string> open_numbers() const {
    std::vector<std::string> keys;
    for (const ParameterEstimate& each : fit_.estimates) {
      // The linear device's limit does not hang on friction.
      if (!each.identifiable && !each.key.ends_with(".coulomb")) keys.push_back(each.key);
    }
    return keys;
  }

  void judge_band() {
    const auto& limit = fit_.analysis.critical.limit;
    if (!limit || !(fit_.highest > 0.0)) return;
    if (limit->frequency >= fit_.lowest && limit->frequency <= fit_.highest) return;
    trust_.doubt(limit_outside_band(limit->frequency, fit_.lowest, fit_.highest));
  }

  void judge_interval() {
    const auto& interval = fit_.analysis.interval;
    if (interval && is_inconclusive(*interval)) trust_.doubt(interval_left_open(*interval));
    // Friction makes a linear fit's too high, never too low: a second route, on the safe side.
    const auto& linear = judged_.linear;
    if (!linear || !interval) return;
    const double value = fit_.analysis.critical.stiffness;
    const double apart = std::hypot(value - interval->lower, linear->upper - linear->value);  // that chance allows
    const bool shows_friction = std::ranges::any_of(fit_.estimates, [](const ParameterEstimate& each) {
      return each.key.ends_with(".coulomb") && each.lower.value_or(0.0) > 0.0;
    });
    if (linear->leaves_too_much && !shows_friction && value > linear->value) {
      trust_.doubt({.code = FindingCode::linear_fit_leaves_more});
    }
    if (value - linear->value <= apart) return;
    const auto unit = units_of(fit_.device.parameters().motion).stiffness;
    trust_.doubt({.code = FindingCode::linear_fit_gives_less,
                  .evidence = {{"linear", linear->value, unit}, {"fitted", value, unit}},
                  .effect = {{"critical_stiffness", linear->value}}});
  }

  void describe() {
    const char* unit = fit_.device.parameters().motion == Motion::rotary ? "N m" : "N";
    for (const ParameterEstimate& each : fit_.estimates) {
      if (!each.key.ends_with(".coulomb") || !each.lower || !(*each.lower > 0.0)) continue;
      fit_.remarks.push_back(note({.code = FindingCode::dry_friction_fitted,
                                   .evidence = {{"force", each.value}},
                                   .subjects = {{"unit", unit}},
                                   .key = each.key}));
    }
    for (const FittedMotion& each : fit_.motions) {
      constexpr double significant = 4.0;
      if (std::abs(each.constant_force) <= significant * each.constant_force_deviation) continue;
      fit_.remarks.push_back(note({.code = FindingCode::constant_force,
                                   .evidence = {{"force", each.constant_force}},
                                   .subjects = {{"unit", unit}, {"source", each.source}}}));
    }
    for (const std::string& reason : trust_.reasons) {
      fit_.remarks.push_back(warning({.code = FindingCode::limit_may_be_wrong, .subjects = {{"reason", reason}}}));
    }
  }

  TimeDomainIdentification& fit_;
  const JudgedTimeFit& judged_;
  Trust trust_;
};

}  // namespace

void judge_in_time(TimeDomainIdentification& fit, const JudgedTimeFit& judged) { Judge(fit, judged).judge(); }

}  // namespace zwidth::internal
