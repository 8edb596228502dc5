#include "identification/fit_judgement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "identification/held_device.hpp"
#include "identification/lateness.hpp"
#include "identification/misfit_doubt.hpp"
#include "identification/motion_residuals.hpp"
#include "identification/nonlinearity_test.hpp"
#include "identification/response/plausibility.hpp"
#include "identification/response/response_choice.hpp"
#include "identification/weak_force_test.hpp"
#include "model/uncertainty_problem.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::internal {
namespace {

// A fit that leaves more of the response unexplained has identified nothing.
constexpr double refused_model_error = 0.5;
std::string_view stiffness_unit(const Device& device) { return units_of(device.parameters().motion).stiffness; }

/// Whether of masses, stiffnesses and dampings, some of which are free, the record says nothing.
bool shows_lateness_alone(const ParameterFit& fit) {
  const auto is_lateness = [](const ParameterEstimate& each) { return each.key == delay_key || each.key == lag_key; };
  const auto is_silent = [&](const ParameterEstimate& each) {
    return is_lateness(each) || std::ranges::any_of(fit.unidentifiable, [&](const UnidentifiableCombination& alone) {
             return alone.parameters.size() == 1 && alone.parameters.front() == each.key;
           });
  };
  return !std::ranges::all_of(fit.estimates, is_lateness) && std::ranges::all_of(fit.estimates, is_silent);
}

class Judge {
 public:
  explicit Judge(const JudgedFit& judged) : judged_(judged), fit_(judged.fit.fit) {}

  Judgement judge() && {
    refuse_what_is_none();
    judge_misfit();
    judge_band();
    judge_measured_crossover();
    judge_search();
    judge_friction();
    judge_hand();
    if (const Device* known = known_structure()) {
      if (auto doubt = doubt_of_masses(fit_.device, *known)) result_.trust.doubt(*std::move(doubt));
    } else if (auto doubt = doubt_of_weight(fit_.device)) {
      result_.trust.doubt(*std::move(doubt));
    }
    result_.device_trust = result_.trust;
    judge_open_numbers();
    for (Remark& remark : implausible_device(fit_.device, known_structure(), judged_.fit.response.sampling_period)) {
      result_.remarks.push_back(std::move(remark));
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] const Device* known_structure() const {
    return judged_.options.structure_values == IdentifyOptions::StructureValues::known ? &judged_.structure : nullptr;
  }

  void refuse_what_is_none() {
    if (fit_.model_error_if_turned) {
      result_.trust.refuse({.code = FindingCode::motion_against_force,
                            .evidence = {{"turned", *fit_.model_error_if_turned}, {"unexplained", fit_.model_error}}});
    }
    if (fit_.model_error > refused_model_error) {
      result_.trust.refuse({.code = FindingCode::response_unexplained,
                            .evidence = {{"unexplained", fit_.model_error}, {"threshold", refused_model_error}}});
    }
    if (is_drowned(judged_.fit.response, fit_.estimates.size())) {
      result_.trust.refuse({.code = FindingCode::response_drowned});
    }
    // Each is a direction in which nothing shows: as many as there are numbers leave nothing. A delay alone is no device.
    if (fit_.unidentifiable.size() >= fit_.estimates.size() || shows_lateness_alone(fit_)) {
      result_.trust.refuse({.code = FindingCode::nothing_determined, .subjects = {{"by", "record"}}});
    }
  }

  void judge_misfit() {
    if (auto doubt = doubt_of_lag(fit_.estimates,
                                  judged_.fit.response.sampling_period.value_or(fit_.device.loop().sampling_period))) {
      result_.trust.doubt(*std::move(doubt));
    }
    if (fit_.missing_mode) {
      result_.trust.doubt({.code = FindingCode::mode_missing, .evidence = {{"frequency", hertz(*fit_.missing_mode)}}});
    }
    if (auto doubt = doubt_of_misfit(fit_, judged_.fit.response)) result_.trust.doubt(*std::move(doubt));
  }

  /// What limits must have been excited.
  void judge_band() {
    if (!judged_.critical.limit) return;
    const double limiting = judged_.critical.limit->frequency;
    // A line stands for what is excited around it, up to the next.
    const std::vector<double>& lines = fit_.frequencies;
    const double spacing = lines.size() > 1 ? lines[1] - lines[0] : 0.0;
    const double last_spacing = lines.size() > 1 ? lines.back() - lines[lines.size() - 2] : 0.0;
    const double lowest = lines.front() - spacing;
    const double highest = lines.back() + last_spacing;
    is_in_band_ = limiting >= lowest && limiting <= highest;
    if (is_in_band_) return;
    Finding extrapolated = limit_outside_band(limiting, lines.front(), lines.back());
    result_.trust.doubt(extrapolated);
    extrapolated.code = FindingCode::limit_extrapolated;
    result_.remarks.push_back(warning(std::move(extrapolated)));
  }

  /// A fit whose critical stiffness lies above the one that the same data show without a model is not to be trusted.
  void judge_measured_crossover() {
    constexpr double tolerated = 1.05;
    const FrequencyResponse& response = judged_.fit.response;
    const auto& period = response.sampling_period;
    const bool same_loop = period && std::abs(*period - fit_.device.loop().sampling_period) <= 1e-6 * *period;
    if (!same_loop || response.points.size() < 2) return;
    const MeasuredStiffness measured = measured_stiffness(response);
    double proven = std::numeric_limits<double>::infinity();
    for (const MeasuredCrossover& each : measured.crossovers) {
      if (each.poles_leaving > 0) proven = std::min(proven, each.stiffness_interval.upper);
    }
    if (!std::isfinite(proven)) return;
    DeviceParameters recorded = device_in_experiment(fit_.device, judged_.options.fit.locked, *period).parameters();
    recorded.wall = {};
    recorded.uncertainty.reset();
    const double fitted = limit_of(Device(std::move(recorded))).stiffness;
    const bool is_found = judged_.options.fit.locked.empty() && measured.status == MeasuredStiffnessStatus::found;
    is_measured_ = is_found && std::abs(fitted / measured.limit->stiffness - 1.0) < tolerated - 1.0;
    if (is_found) {
      constexpr double widest = 2.0;
      const auto& shown = measured.limit->stiffness_interval;
      const bool agrees = is_measured_ || (fitted > shown.lower && fitted < shown.upper);
      result_.is_measured = agrees && shown.upper < widest * shown.lower;
    }
    if (!(fitted > tolerated * proven)) return;
    const Finding unsafe{.code = FindingCode::limit_above_measured,
                         .evidence = {{"fitted", fitted}, {"proven", proven}, {"threshold", tolerated}},
                         .subjects = {{"unit", std::string(stiffness_unit(fit_.device))}},
                         .effect = {{"critical_stiffness", proven}}};
    result_.trust.doubt(unsafe);
    result_.remarks.push_back(warning(unsafe));
  }

  void judge_open_numbers() {
    std::vector<std::string> keys;
    for (const ParameterEstimate& estimate : fit_.estimates) {
      if (!estimate.identifiable) keys.push_back(estimate.key);
    }
    if (!keys.empty()) {
      const Finding open{.code = FindingCode::numbers_undetermined,
                         .subjects = {{"keys", fmt::format("{}", fmt::join(keys, ", "))}, {"taken_from", "structure"}}};
      result_.device_trust.doubt(open);
      // Along what is open the response does not change, and within the band the critical stiffness is the response's.
      const bool is_responses = is_in_band_ && judged_.options.fit.locked.empty();
      if (!is_measured_ && !is_responses) result_.trust.doubt(open);
    }
    if (known_structure()) return;
    for (std::string& unseen : unseen_placeholders(judged_.options.fit.locked, judged_.options.structure_values)) {
      keys.push_back(std::move(unseen));
    }
    for (const std::string& key : keys) {
      result_.remarks.push_back(
          warning({.code = FindingCode::number_is_placeholder,
                   .evidence = {{"value", parameter(fit_.device.parameters(), key).value_or(0.0)}},
                   .key = key}));
    }
  }

  void judge_search() {
    if (!fit_.settled) {
      result_.trust.doubt({.code = FindingCode::search_stopped});
      result_.remarks.push_back(warning({.code = FindingCode::search_stopped}));
    }
    if (fit_.held_to_a_guess) {
      result_.trust.doubt({.code = FindingCode::critical_point_is_guess});
    }
  }

  void judge_friction() {
    if (!judged_.friction) return;
    const ShownFriction& friction = *judged_.friction;
    const char* unit = fit_.device.parameters().motion == Motion::rotary ? "N m" : "N";
    // What is left without it is not said: a linear fit of a body that rests at times knows neither its damping nor how
    // much it rubs, and came out five times too high.
    const Finding found{.code = FindingCode::dry_friction_taken_for_damping,
                        .evidence = {{"force", friction.force}},
                        .subjects = {{"unit", unit}, {"body", friction.body}},
                        .key = fmt::format("body.{}.coulomb", friction.body)};
    result_.trust.doubt(found);
    result_.remarks.push_back(warning(found));
  }

  void judge_hand() {
    const bool is_known = judged_.options.structure_values == IdentifyOptions::StructureValues::known;
    for (Remark& remark : remarks_of_experiment(judged_.structure, is_known, judged_.options.fit.locked)) {
      result_.remarks.push_back(std::move(remark));
    }
    if (is_known) {
      if (auto doubt = doubt_of_hand(judged_.structure, fit_.estimates, judged_.options.fit.locked)) {
        result_.trust.doubt(*std::move(doubt));
      }
      if (auto doubt = doubt_of_lost_delay(judged_.structure, fit_.estimates)) result_.trust.doubt(*std::move(doubt));
    }
    if (result_.trust.refused()) return;
    const std::optional<double> spring = missing_spring(judged_.fit, judged_.options.fit);
    if (!spring) return;
    const Body& held = fit_.device.bodies()[fit_.device.loop().held];
    result_.trust.doubt({.code = FindingCode::spring_to_ground,
                         .evidence = {{"stiffness", *spring}},
                         .subjects = {{"unit", std::string(stiffness_unit(fit_.device))}, {"body", held.name}},
                         .key = fmt::format("body.{}.stiffness", held.name)});
  }

  const JudgedFit& judged_;
  const ParameterFit& fit_;
  Judgement result_;
  bool is_in_band_ = false;   ///< the limiting crossover was excited
  bool is_measured_ = false;  ///< the response shows the fitted critical stiffness without any model
};

}  // namespace

std::vector<std::string> unseen_placeholders(const std::vector<std::string>& locked,
                                             IdentifyOptions::StructureValues values) {
  std::vector<std::string> keys;
  if (values == IdentifyOptions::StructureValues::known) return keys;
  for (const std::string& body : locked) {
    for (const char* number : {"mass", "damping"}) keys.push_back(fmt::format("body.{}.{}", body, number));
  }
  return keys;
}

bool is_drowned(const FrequencyResponse& response, std::size_t numbers) {
  constexpr double clear = 3.0;
  const auto standing_out = std::ranges::count_if(response.points, [](const ResponsePoint& point) {
    return std::norm(point.value) > clear * clear * point.variance;
  });
  return 2 * static_cast<std::size_t>(standing_out) < numbers;  // each is two numbers
}

void judge_nonlinearity(Identification& result, std::span<const Recording> recordings, const IdentifyOptions& options) {
  for (const Recording& each : recordings) {
    for (Finding& doubt : doubts_of_recording(each, recordings, options.response.output, result.fit.device)) {
      result.trust.doubt(std::move(doubt));
    }
  }
  if (options.response.window == Window::rectangular && !is_of_lines(recordings, options.response)) {
    result.trust.doubt({.code = FindingCode::rectangular_window_leaks});
  }
  if (options.scrutiny == IdentifyOptions::Scrutiny::of_fit) return;
  if (!result.trust.sound() || options.response.output != OutputQuantity::position) return;
  const std::vector<std::string> keys = keys_of(result.fit);
  const std::vector<double>& lines = result.fit.frequencies;
  const auto doubt = [&](Finding found) {
    found.subjects.push_back({"taken_for", "damping"});
    result.trust.doubt(found);
    result.remarks.push_back(warning(std::move(found)));
  };
  for (const Recording& each : recordings) {
    const Device device = device_in_experiment(result.fit.device, options.fit.locked, each.sampling_period);
    const DiscreteStateSpace system = sample(state_space(device), {each.sampling_period, device.loop().delay});
    std::vector<double> residuals = each.channels[1].samples;
    const std::vector<double> fitted = forced_response(system, each.channels[0].samples);
    for (std::size_t k = 0; k < residuals.size(); ++k) residuals[k] -= fitted[k];
    auto found = find_nonlinearity({.device = device,
                                    .force = each.channels[0].samples,
                                    .position = each.channels[1].samples,
                                    .residuals = residuals});
    if (found) return doubt(shown_by("the record", std::move(found->finding)));
    const auto forces = find_weak_forces(
        {result.fit.device, options.fit.locked, keys, each.sampling_period, lines.front(), lines.back()},
        each.channels[0].samples, each.channels[1].samples);
    auto weak = doubt_of_weak_forces(forces, result.analysis, device.parameters().motion, "the record");
    if (weak) return doubt(*std::move(weak));
  }
}

std::vector<std::string> keys_of(const ParameterFit& fit) {
  std::vector<std::string> keys;
  for (const ParameterEstimate& each : fit.estimates) keys.push_back(each.key);
  return keys;
}

CriticalStiffness limit_of(const Device& device) { return critical_stiffness(device); }

void keep_what_is_assumed(const Device& structure, std::span<const ParameterEstimate> estimates,
                          std::vector<std::string> placeholders, Device& fitted, std::initializer_list<Trust*> trusts) {
  const DeviceParameters& given = structure.parameters();
  const auto is_identified = [&](const std::string& key) {
    return std::ranges::any_of(estimates, [&](const ParameterEstimate& each) {
      return each.identifiable && each.key == full_parameter_key(given, key);
    });
  };
  const auto is_taken = [&](const std::string& key) {
    const bool is_of_the_mechanics = key.starts_with("body.") || key.starts_with("link.");
    return is_of_the_mechanics && !key.ends_with(".coulomb") && parameter(given, key).value_or(0.0) != 0.0 &&
           !is_identified(key);
  };
  std::vector<std::string> assumed = std::move(placeholders);
  if (given.uncertainty) {
    const std::vector<std::string>& of_structure = given.uncertainty->assumed;
    Trust stated = trust_of(structure);
    if (!of_structure.empty()) {
      std::erase(stated.reasons, text(assumed_numbers(of_structure)));
      std::erase_if(stated.findings, [](const Finding& each) { return each.code == FindingCode::assumed_numbers; });
    }
    if (!stated.reasons.empty() && std::ranges::any_of(parameter_keys(given), is_taken)) {
      for (Trust* trust : trusts) trust->inherit(stated);
      Trust device_trust = trust_of(fitted);
      device_trust.inherit(stated);
      fitted = with_trust(fitted, device_trust);
    }
    for (const std::string& key : of_structure) {
      if (std::ranges::find(assumed, key) == assumed.end()) assumed.push_back(key);
    }
  }
  std::erase_if(assumed, is_identified);
  if (assumed.empty()) return;
  for (Trust* trust : trusts) trust->doubt(assumed_numbers(assumed));
  DeviceParameters parameters = fitted.parameters();
  if (!parameters.uncertainty) parameters.uncertainty.emplace();
  parameters.uncertainty->assumed = std::move(assumed);
  fitted = Device(std::move(parameters));
}

Device with_trust(const Device& device, const Trust& trust) {
  if (trust.sound()) return device;
  DeviceParameters parameters = device.parameters();
  if (!parameters.uncertainty) parameters.uncertainty.emplace();
  parameters.uncertainty->verdict = trust.verdict;
  parameters.uncertainty->warning = fmt::format("{}", fmt::join(trust.reasons, "; "));
  return Device(std::move(parameters));
}

Judgement judge(const JudgedFit& judged) { return Judge(judged).judge(); }

}  // namespace zwidth::internal
