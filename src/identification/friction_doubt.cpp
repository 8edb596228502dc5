#include "identification/friction_doubt.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "identification/response_choice.hpp"
#include "identification/response_friction.hpp"
#include "identification/stated_units.hpp"
#include "zwidth/identification/excitation.hpp"

namespace zwidth::internal {
namespace {

/// A friction that the recordings show, or leave open.
struct ShownOrHidden {
  FrictionEstimate friction;
  double share = 1.0;   ///< the whole friction of a device may be so many times what shows
  bool bounds = false;  ///< there is no more of it
};

constexpr double clear = 3.5;  // deviations, of a few looks

bool are_of_one_force(std::span<const Recording> recordings) {
  constexpr double different = 1.5;
  std::vector<double> sizes;
  for (const Recording& each : recordings) sizes.push_back(crest_factor(each.channels[0].samples).rms);
  return std::ranges::max(sizes) < different * std::ranges::min(sizes);
}

/// What the motion of a body shows.
struct Slidings {
  std::optional<HiddenBody> body;
  std::vector<RecordedSliding> of_records;
  std::vector<ShownOrHidden> estimates;
  std::optional<FrictionEstimate> between;  ///< two amplitudes
};

Slidings slidings_of(std::span<const Recording> recordings, std::span<const FrequencyResponse> responses,
                     const SlidingQuestion& question) {
  // What shows of the friction of a body that is not known well is a part of it, between amplitudes less so.
  constexpr double by_harmonics = 3.0;
  constexpr double by_amplitude = 2.0;
  Slidings found;
  found.body = question.body;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    auto sliding = recorded_sliding(responses[r], recordings[r], question);
    if (!sliding) return Slidings{};
    if (sliding->friction) found.estimates.push_back({*sliding->friction, by_harmonics, sliding->is_followed});
    found.of_records.push_back(*std::move(sliding));
  }
  found.between = friction_between(responses, found.of_records, found.body);
  if (found.between) found.estimates.push_back({*found.between, by_amplitude, true});
  return found;
}

class FrictionDoubt {
 public:
  FrictionDoubt(MeasuredResponse& measured, std::span<const Recording> recordings,
                std::span<const FrequencyResponse> responses, const FrequencyResponseOptions& options)
      : measured_(measured), of_lines_(is_of_lines(recordings, options)), of_one_force_(are_of_one_force(recordings)) {
    SlidingQuestion question{options.output, of_lines_};
    slidings_.push_back(slidings_of(recordings, responses, question));
    for (const HiddenBody& body : hidden_bodies(measured.response)) {
      question.body = body;
      slidings_.push_back(slidings_of(recordings, responses, question));
    }
  }

  void size_dependence() {
    const auto& between = slidings_.front().between;
    if (!measured_.dependence || !measured_.dependence->grows_with_force || !between) return;
    if (between->force < clear * between->deviation) return;
    measured_.dependence->friction = between->force;
    measured_.dependence->friction_deviation = between->deviation;
  }

  void judge() {
    if (!measured_.stiffness || measured_.trust.refused()) return;
    const auto interval = stiffness_interval(*measured_.stiffness);
    if (!interval) return;
    stiffness_ = measured_.stiffness->limit->stiffness;
    constexpr double part_of_interval = 0.5;
    constexpr double negligible = 0.02;
    tolerance_ = std::max(part_of_interval * (stiffness_ - interval->lower), negligible * stiffness_);
    const ShownOrHidden* found = nullptr;
    for (const Slidings& slidings : slidings_) {
      for (const ShownOrHidden& each : slidings.estimates) {
        const double force = each.friction.force;
        const bool shows = force > clear * each.friction.deviation && !is_harmless(slidings, each.share * force);
        if (shows && (!found || force > found->friction.force)) found = &each;
      }
    }
    if (found) {
      measured_.trust.doubt({.code = FindingCode::motion_shows_friction,
                             .evidence = {{"friction", found->friction.force}},
                             .subjects = {{"force", force_in_words(found->friction.force, measured_)}}});
      return;
    }
    for (const Slidings& slidings : slidings_) {
      if (auto open = open_friction(slidings)) return measured_.trust.doubt(*std::move(open));
    }
  }

 private:
  [[nodiscard]] static double most_of(const ShownOrHidden& estimate) {
    return estimate.share * (estimate.friction.force + 2.0 * estimate.friction.deviation);
  }

  /// Why these do not bound the friction's effect; nothing where they do.
  [[nodiscard]] std::optional<Finding> open_friction(const Slidings& slidings) const {
    const ShownOrHidden* least = nullptr;
    for (const ShownOrHidden& each : slidings.estimates) {
      if (!each.bounds) continue;
      if (is_harmless(slidings, most_of(each))) return std::nullopt;
      if (!least || most_of(each) < most_of(*least)) least = &each;
    }
    if (!least || (of_lines_ && of_one_force_)) return unknown();
    const auto without = stiffness_without(slidings, most_of(*least));
    Finding found{.code = FindingCode::friction_would_pass_unseen,
                  .evidence = {{"friction", most_of(*least)}},
                  .subjects = {{"force", force_in_words(most_of(*least), measured_)}}};
    if (without) {
      found.subjects.push_back({"stiffness", stiffness_in_words(*without, measured_)});
      found.effect.push_back({"critical_stiffness", *without});
    }
    return found;
  }

  /// The critical stiffness without so much friction; nothing where the response does not say.
  [[nodiscard]] std::optional<double> stiffness_without(const Slidings& slidings, double force) const {
    const MeasuredStiffness without =
        measured_stiffness(without_friction(measured_.response, slidings.of_records, force, slidings.body));
    if (without.status != MeasuredStiffnessStatus::found || !without.limit) return std::nullopt;
    return without.limit->stiffness;
  }

  [[nodiscard]] bool is_harmless(const Slidings& slidings, double force) const {
    const auto without = stiffness_without(slidings, force);
    return without && *without >= stiffness_ - tolerance_;
  }

  [[nodiscard]] Finding unknown() const {
    if (of_lines_ && of_one_force_) return {.code = FindingCode::repeating_force_hides_friction};
    const bool rests = std::ranges::any_of(
        slidings_.front().of_records, [](const RecordedSliding& each) { return each.friction && !each.is_followed; });
    return {.code = rests ? FindingCode::friction_unknown_of_resting : FindingCode::friction_unknown};
  }

  MeasuredResponse& measured_;
  bool of_lines_;
  bool of_one_force_;
  std::vector<Slidings> slidings_;  ///< of the sensed body, of hidden ones
  double stiffness_ = 0.0;
  double tolerance_ = 0.0;
};

}  // namespace

void judge_friction(MeasuredResponse& measured, std::span<const Recording> recordings,
                    std::span<const FrequencyResponse> responses, const FrequencyResponseOptions& options) {
  FrictionDoubt doubt(measured, recordings, responses, options);
  doubt.size_dependence();
  doubt.judge();
}

}  // namespace zwidth::internal
