#include "zwidth/identification/identification.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "identification/contradicted_number.hpp"
#include "identification/fit_comparison.hpp"
#include "identification/fit_judgement.hpp"
#include "identification/friction_in_time.hpp"
#include "identification/friction_test.hpp"
#include "identification/further_body.hpp"
#include "identification/interval_judgement.hpp"
#include "identification/lateness.hpp"
#include "identification/misfit_doubt.hpp"
#include "identification/period_choice.hpp"
#include "identification/recording_agreement.hpp"
#include "identification/response/response_choice.hpp"
#include "identification/ringing_mode.hpp"
#include "identification/unseen_limit.hpp"
#include "model/uncertainty_problem.hpp"
#include "require_valid.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/record_fit.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// A structure on its way to the device: the record, the fit so far, and what is free.
class Fitting {
 public:
  Fitting(const MeasuredResponse& measured, std::span<const Recording> recordings, const Device& structure,
          const IdentifyOptions& options)
      : recordings_(recordings), options_(options), fit_options_(options.fit) {
    fit_options_.free = free_parameters(structure, fit_options_.free, fit_options_.locked);
    if (!is_free(delay_key)) {
      const bool is_unknown = options.structure_values == IdentifyOptions::StructureValues::placeholders;
      const std::size_t lines = measured.response.points.size();
      const bool tells_none = lines <= fit_options_.free.size() + 1;
      if (may_free() && is_unknown && !tells_none) fit_options_.free.emplace_back(delay_key);
      assumes_delay_ = assumes_delay(structure, options.structure_values, options.loop_delay);
      if (assumes_delay_ && tells_none) open_delay_ = hidden_delay(lines, fit_options_.free.size());
    }
    if (is_drowned(measured.response, fit_options_.free.size())) {  // then nothing is worth a second fit
      fit_ = RecordFit{fit_parameters(structure, measured.response, fit_options_), measured.response};
      is_hopeless_ = true;
      return;
    }
    fit_ = whole_fit(structure, measured.response, fit_options_);
    is_hopeless_ = fit_->fit.model_error_if_turned.has_value();
    if (is_hopeless_) return;
    look_for_lateness();
    go_on();
    leave_side_minimum();
    go_on();
  }

  /// A delay that the record shows, which was not to be fitted, in s; and why one that nobody stated may lower K_CR.
  [[nodiscard]] std::optional<double> ignored_delay() const { return ignored_delay_; }
  [[nodiscard]] const std::optional<Finding>& open_delay() const { return open_delay_; }
  [[nodiscard]] const RecordFit& fit() const { return *fit_; }
  [[nodiscard]] std::vector<Remark>& remarks() { return remarks_; }

  /// The same numbers from a device near which they are; whether that is possible.
  [[nodiscard]] bool begin_anew(const Device& start) try {
    fit_options_.free = keys_of(fit_->fit);
    fit_options_.start = ParameterFitOptions::Start::from_structure;
    fit_ = whole_fit(start, fit_->response, fit_options_);
    look_for_lateness();
    go_on();
    return true;
  } catch (const Error&) {
    return false;
  }

  /// Where the limit lies above the band, delay and lag count with what the data leave open of them.
  void widen_above_the_band() {
    if (is_hopeless_) return;
    const CriticalStiffness critical = limit_of(fit_->fit.device);
    if (!critical.limit || critical.limit->frequency <= fit_->fit.frequencies.back()) return;
    std::optional<RecordFit> wider;
    for (const std::vector<std::string>& keys : {std::vector<std::string>{delay_key, lag_key}, {delay_key}}) {
      wider = with_free(keys, ParameterFitOptions::Start::from_structure);
      if (wider && determines(*wider, keys)) break;
    }
    if (!wider || !wider->fit.device.parameters().uncertainty) return;
    wider->fit.device = with_shared_lateness(wider->fit.device);
    if (may_free()) {
      fit_ = std::move(wider);
      return;
    }
    DeviceParameters parameters = fit_->fit.device.parameters();
    parameters.uncertainty = wider->fit.device.parameters().uncertainty;
    fit_->fit.device = Device(std::move(parameters));
  }

  /// What the record shows of a delay that is not fitted is as open as it is far from the structure's.
  void open_ignored_delay() {
    if (!ignored_delay_) return;
    const double beyond = *ignored_delay_ - fit_->fit.device.loop().delay;
    fit_->fit.device = with_open_delay(fit_->fit.device, beyond * beyond);
  }

  /// Masses, dampings and links that were taken from the structure although the record shows others.
  [[nodiscard]] std::vector<ContradictedNumber> contradicted() const {
    std::vector<ContradictedNumber> found;
    if (is_hopeless_) return found;
    std::vector<std::string> keys = fittable_parameters(fit_->fit.device, fit_options_.locked);
    std::erase_if(keys, [&](const std::string& key) { return is_free(key) || key == delay_key || key == lag_key; });
    if (keys.empty()) return found;
    const std::optional<RecordFit> wider =
        with_free({keys.begin(), keys.end()}, ParameterFitOptions::Start::from_structure);
    if (!wider) return found;
    for (const ParameterEstimate& each : wider->fit.estimates) {
      constexpr double significant = 3.0;
      constexpr double notable = 0.02;
      if (std::ranges::count(keys, each.key) == 0 || !each.identifiable || !each.standard_deviation) continue;
      const double given = parameter(fit_->fit.device.parameters(), each.key).value_or(0.0);
      const double apart = std::abs(each.value - given);
      if (apart > significant * *each.standard_deviation && apart > notable * given) {
        found.push_back({each.key, given, each.value});
      }
    }
    return found;
  }

  [[nodiscard]] std::optional<ShownFriction> friction() const {
    if (is_hopeless_ || options_.response.output != OutputQuantity::position) return std::nullopt;
    std::optional<FrictionEvidence> found;
    // Friction acts where the device moves fast, mostly far below the highest line: over all lines the noise hides it.
    for (const double share : {1.0, 0.1}) {
      for (const Recording& each : recordings_) {
        const auto next = friction_up_to(share * fit_->fit.frequencies.back(), each);
        if (next && (!found || next->force * found->deviation > found->force * next->deviation)) found = next;
      }
    }
    // Its size is no reason to pass over it: where a body rests for long, a linear device explains little of it.
    if (!found || found->force <= significant_friction * found->deviation) return std::nullopt;
    return ShownFriction{found->body, found->force, found->deviation};
  }

 private:
  [[nodiscard]] std::optional<FrictionEvidence> friction_up_to(double highest, const Recording& recording) const {
    const std::vector<std::string> keys = keys_of(fit_->fit);
    try {
      return find_friction({fit_->fit.device, fit_options_.locked, keys, recording.sampling_period,
                            fit_->fit.frequencies.front(), highest},
                           recording.channels[0].samples, recording.channels[1].samples);
    } catch (const Error&) {  // a device that cannot be played says nothing
      return std::nullopt;
    }
  }

  [[nodiscard]] static bool determines(const RecordFit& fit, const std::vector<std::string>& keys) {
    const auto& uncertainty = fit.fit.device.parameters().uncertainty;
    return uncertainty && std::ranges::all_of(keys, [&](const std::string& key) {
             return std::ranges::count(uncertainty->parameters, key) > 0;
           });
  }

  [[nodiscard]] bool may_free() const {
    using enum IdentifyOptions::LoopDelay;
    return options_.loop_delay == by_free ? frees_all(options_.fit.free) : options_.loop_delay == from_data;
  }
  [[nodiscard]] bool is_free(const std::string& key) const { return std::ranges::count(fit_options_.free, key) > 0; }

  [[nodiscard]] RecordFit whole_fit(const Device& structure, const FrequencyResponse& response,
                                    const ParameterFitOptions& options) const {
    RecordFit fit{fit_parameters(structure, response, options), response};
    if (recordings_.empty()) return fit;
    return without_leakage(std::move(fit), recordings_, options_.response, options);
  }

  /// The same fit with these parameters free beside the others; nothing where that is impossible.
  [[nodiscard]] std::optional<RecordFit> with_free(const std::vector<std::string>& keys,
                                                   ParameterFitOptions::Start start) const {
    ParameterFitOptions options = fit_options_;
    options.start = start;
    options.search_widely = false;  // was done
    for (const std::string& key : keys) {
      if (!is_free(key)) options.free.emplace_back(key);
    }
    if (fit_->response.points.size() <= options.free.size()) return std::nullopt;
    try {
      return whole_fit(fit_->fit.device, fit_->response, options);
    } catch (const Error&) {
      return std::nullopt;
    }
  }

  /// A search that was stopped goes on. Along what the data leave open it hardly ends, nor needs to.
  void go_on() {
    constexpr int most_rounds = 3;
    for (int round = 0; round < most_rounds && !fit_->fit.settled; ++round) {
      auto further = with_free({}, ParameterFitOptions::Start::from_structure);
      if (!further || is_contradicted(further->fit, fit_->fit, fit_->response.line_correlation)) return;
      further->fit.settled = further->fit.settled || stands_still(fit_->fit, further->fit);
      fit_ = std::move(further);
    }
  }

  /// What is left beyond the noise may be a side minimum's, or one that a delay alone led into where there is a lag as well.
  void leave_side_minimum() {
    if (fit_options_.start != ParameterFitOptions::Start::from_data) return;
    const auto is_poor = [&] { return leaves_too_much(fit_->fit, fit_->response); };
    std::vector<std::string> free = fit_options_.free;
    if (is_poor()) search_anew(free);
    if (!may_free()) return;
    for (const char* key : {delay_key, lag_key}) {
      if (!is_free(key)) free.emplace_back(key);
    }
    if (is_poor() && free.size() > fit_options_.free.size()) search_anew(free);
  }

  void search_anew(const std::vector<std::string>& free) {
    ParameterFitOptions options = fit_options_;
    options.free = free;
    if (fit_->response.points.size() <= free.size()) return;
    try {
      RecordFit other = whole_fit(fit_->fit.device, fit_->response, options);
      constexpr double much = 0.9;
      const bool is_better = other.fit.misfit < much * *fit_->fit.misfit || !leaves_too_much(other.fit, other.response);
      if (!is_better || other.fit.model_error > fit_->fit.model_error) return;
      fit_ = std::move(other);
      fit_options_.free = free;
    } catch (const Error&) {  // then there is no other
    }
  }

  void look_for_lateness() {
    if (may_free()) {
      free_what_shows();
    } else {
      look_for_delay();
    }
  }

  /// Whether the structure's delay is the record's.
  void look_for_delay() {
    ignored_delay_.reset();
    if (is_free(delay_key)) return;
    const std::optional<RecordFit> wider = with_free({delay_key}, ParameterFitOptions::Start::from_structure);
    if (!wider) return;
    ignored_delay_ = other_delay(wider->fit.estimates.back(), fit_->fit.device.loop());
    if (assumes_delay_ && !ignored_delay_) open_delay_ = doubt_of_open_delay(wider->fit.device, fit_->fit.device);
  }

  /// Delay, then lag, where the record shows them.
  void free_what_shows() {
    for (const char* key : {delay_key, lag_key}) {
      if (is_free(key)) continue;
      if (std::string_view(key) == lag_key && !is_free(delay_key)) return;
      constexpr double poor = 0.02;
      const auto start = fit_->fit.model_error > poor ? ParameterFitOptions::Start::from_data
                                                      : ParameterFitOptions::Start::from_structure;
      std::optional<RecordFit> wider = with_free({key}, start);
      if (!wider) return;
      const ParameterEstimate& estimate = wider->fit.estimates.back();
      const double given = parameter(fit_->fit.device.parameters(), key).value_or(0.0);
      constexpr double significant = 3.0;
      const bool shows = estimate.identifiable && estimate.standard_deviation &&
                         std::abs(estimate.value - given) > significant * *estimate.standard_deviation;
      // Beside other numbers that are open a lag may have no deviation, and yet explain what nothing else does.
      const bool explains = is_contradicted(fit_->fit, wider->fit, fit_->response.line_correlation);
      if (!(shows || explains) || wider->fit.model_error > 1.02 * fit_->fit.model_error + 1e-9) return;
      Finding fitted{.code = FindingCode::fitted_too, .key = std::string(key)};
      if (shows) fitted.evidence.push_back({"given", given});
      remarks_.push_back(note(std::move(fitted)));
      fit_options_.free.emplace_back(key);
      fit_ = std::move(wider);
    }
  }

  std::span<const Recording> recordings_;
  const IdentifyOptions& options_;
  ParameterFitOptions fit_options_;
  std::optional<RecordFit> fit_;
  std::vector<Remark> remarks_;
  std::optional<double> ignored_delay_;
  bool assumes_delay_ = false;  // nobody states it
  std::optional<Finding> open_delay_;
  bool is_hopeless_ = false;  ///< to be refused, whatever else is fitted
};

void judge_what_was_given(const Fitting& fitting, Judgement& judgement) {
  if (fitting.ignored_delay()) {
    const Finding ignored = ignored_delay(*fitting.ignored_delay(), fitting.fit().fit.device.loop().delay);
    judgement.trust.doubt(ignored);
    judgement.remarks.push_back(warning(ignored));
  }
  if (fitting.open_delay()) judgement.trust.doubt(*fitting.open_delay());
  for (const ContradictedNumber& each : fitting.contradicted()) judgement.trust.doubt(contradiction(each));
  judgement.device_trust.inherit(judgement.trust);
}

Identification identified(const MeasuredResponse& measured, std::span<const Recording> recordings,
                          const Device& structure, const IdentifyOptions& options);

/// The same with longer segments, where a mode of the fitted device rings on from one to the next.
std::optional<Identification> with_longer_segments(const RecordFit& fit, std::span<const Recording> recordings,
                                                   const Device& structure, const IdentifyOptions& options) {
  const std::optional<std::size_t> length = segment_for_modes(fit, recordings, options);
  if (!length) return std::nullopt;
  IdentifyOptions longer = options;
  longer.response.excitation = FrequencyResponseOptions::Excitation::aperiodic;
  longer.response.segment_length = *length;
  try {
    Identification other = identified(frequency_response(recordings, longer.response), recordings, structure, longer);
    if (!other.trust.refused()) return other;
  } catch (const Error&) {  // too few of them
  }
  return std::nullopt;
}

Identification judged(Fitting& fitting, const MeasuredResponse& measured, std::span<const Recording> recordings,
                      const Device& structure, const IdentifyOptions& options, bool has_begun_anew) {
  fitting.widen_above_the_band();
  fitting.open_ignored_delay();
  const CriticalStiffness critical = limit_of(fitting.fit().fit.device);
  std::optional<ShownFriction> friction = fitting.friction();
  Judgement judgement = judge({fitting.fit(), structure, options, critical, friction});
  judge_what_was_given(fitting, judgement);
  judge_measured(measured, judgement);
  Identification result{.source = measured.source,
                        .response = fitting.fit().response,
                        .fit = fitting.fit().fit,
                        .friction = std::move(friction),
                        .ignored_delay = fitting.ignored_delay(),
                        .trust = std::move(judgement.trust)};
  result.remarks = measured.remarks;
  for (std::vector<Remark>* more : {&result.fit.remarks, &fitting.remarks(), &judgement.remarks})
    result.remarks.insert(result.remarks.end(), more->begin(), more->end());
  const Wall& wall = result.fit.device.parameters().wall;
  result.basis = {wall.damping, wall.velocity_filter_hz, wall.filters.size()};
  result.fit.device = with_trust(result.fit.device, judgement.device_trust);
  result.analysis = analyze(result.fit.device, {.any_user = false});
  if (!result.trust.refused() && result.analysis.critical.trust.refused()) {
    result.trust.inherit(result.analysis.critical.trust);
  }
  std::optional<Device> better = judge_interval(result, judgement.is_measured, recordings, options);
  if (!better || has_begun_anew) {
    if (const auto further = find_further_body(result, options)) {
      better = further->without;
      result.trust.doubt(doubt_of_further_body(*further, result));
    }
  }
  if (better && !has_begun_anew && fitting.begin_anew(*better)) {
    return judged(fitting, measured, recordings, structure, options, true);
  }
  if (better && result.trust.sound()) result.trust.doubt({.code = FindingCode::local_minimum});
  judge_agreement(result, recordings, options);
  judge_friction_in_time(result, recordings, options);
  judge_nonlinearity(result, recordings, options);
  result.analysis.trust.inherit(result.trust);
  judgement.device_trust.inherit(result.trust);
  result.fit.device = with_trust(result.fit.device, judgement.device_trust);
  keep_what_is_assumed(structure, result.fit.estimates,
                       unseen_placeholders(options.fit.locked, options.structure_values), result.fit.device,
                       {&result.trust, &result.analysis.trust});
  return result;
}

Identification identified(const MeasuredResponse& measured, std::span<const Recording> recordings,
                          const Device& structure, const IdentifyOptions& options) {
  Fitting fitting(measured, recordings, structure, options);
  if (auto longer = with_longer_segments(fitting.fit(), recordings, structure, options)) return *std::move(longer);
  return judged(fitting, measured, recordings, structure, options, false);
}

}  // namespace

Identification identify(const Recording& recording, const Device& structure, const IdentifyOptions& options,
                        const Progress& progress) {
  return identify(std::span(&recording, 1), structure, options, progress);
}

Identification identify(std::span<const Recording> recordings, const Device& structure, const IdentifyOptions& options,
                        const Progress& progress) {
  require_valid(find_problem(options));
  IdentifyOptions decided = options;
  decided.response.excitation = excitation_of(options.response);
  const auto with = [&](const IdentifyOptions& chosen, const Progress& told) {
    return identified(response_with_enough_lines(recordings, structure, chosen, told), recordings, structure, chosen);
  };
  const bool is_detected = decided.response.excitation == FrequencyResponseOptions::Excitation::detect &&
                           is_of_lines(recordings, decided.response);
  return is_detected ? with_periods_chosen(decided, progress, with) : with(decided, progress);
}

Identification identify(const MeasuredResponse& measured, const Device& structure, const IdentifyOptions& options) {
  require_valid(find_problem(options));
  return identified(measured, {}, structure, options);
}

}  // namespace zwidth
