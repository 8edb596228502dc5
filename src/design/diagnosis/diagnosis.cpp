#include "zwidth/design/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "design/diagnosis/diagnosis_changes.hpp"
#include "design/diagnosis/oscillation_causes.hpp"
#include "design/sensitivities/loops_of_wall.hpp"
#include "design/sensitivities/number_limit.hpp"
#include "design/synthesis/absolute_stability_check.hpp"
#include "design/synthesis/users_at_frequency.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "model/known_structure.hpp"
#include "stability/users/any_grasp.hpp"
#include "stability/wall_judgement.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_key.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/signal/dominant_oscillation.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;

constexpr double of_a_user = 0.05;       // |ln f| that a user's grasp counts as: it fits a whole band
constexpr double of_a_crossover = 0.25;  // of apart, where K is not known
constexpr double of_linear_loop = 0.15;  // of an unstable loop: farther away something else moves its frequency
constexpr double of_a_step = 0.02;       // the same, of a cycle of about a step of the encoder
constexpr double ambiguous = 0.1;        // |ln f| of two causes beside each other

/// What the loop is looked at with: B, and K where it is known.
ObservedLoop observed(const Device& device, const DiagnosisOptions& options) {
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty.reset();
  if (options.stiffness) parameters.wall.stiffness = options.stiffness;
  if (options.damping) parameters.wall.damping = *options.damping;
  const std::optional<double> stiffness = parameters.wall.stiffness;
  ObservedLoop loop{Device(std::move(parameters)), options.frequency, options.amplitude, stiffness};
  if (stiffness && *stiffness == 0.0) {
    // Without a damper there is no wall either.
    if (loop.device.parameters().wall.damping > 0.0) {
      loop.number = WallNumber::damping;
    } else {
      loop.stiffness.reset();
    }
  }
  return loop;
}

double apart_from(const OscillationCandidate& candidate, const ObservedLoop& loop) {
  return std::abs(std::log(candidate.frequency / loop.frequency));
}

/// How badly a candidate that fits does so; what is proven comes before what is possible.
double mismatch(const OscillationCandidate& candidate, const ObservedLoop& loop) {
  const double apart = apart_from(candidate, loop);
  switch (candidate.cause) {
    case OscillationCause::device:
    case OscillationCause::with_user:
      if (!loop.stiffness) return of_a_crossover * apart;
      return apart <= of_linear_loop ? apart - 1.0 : apart;  // unstable with this wall: nothing else is needed
    case OscillationCause::passive_user:
      return of_a_user;
    case OscillationCause::quantisation:
      // So small a swing is the encoder's; where it is not known, the frequency alone tells.
      return loop.amplitude ? std::min(apart, of_a_step) : apart;
    case OscillationCause::friction:
      return apart;
  }
  return apart;
}

void rank(std::vector<OscillationCandidate>& candidates, const ObservedLoop& loop) {
  std::ranges::stable_sort(candidates, [&](const OscillationCandidate& a, const OscillationCandidate& b) {
    if (a.fits != b.fits) return a.fits;
    return a.fits ? mismatch(a, loop) < mismatch(b, loop) : distance_to_fit(a) < distance_to_fit(b);
  });
}

/// With the user the loop oscillates, and without too, at nearly the same frequency: the user does nothing.
void compare_with_nobody(OscillationCandidate& held, const OscillationCandidate& nobody) {
  if (!held.fits || !nobody.fits) return;
  held.fits = false;
  held.why.evidence.push_back({"without_operator", 1.0});
}

void collect(const ObservedLoop& loop, Diagnosis& diagnosis) {
  std::vector<OscillationCandidate>& candidates = diagnosis.candidates;
  if (device_has_user(loop.device)) {
    candidates.push_back(linear_candidate(loop, OscillationCause::device, device_without_user(loop.device)));
    candidates.push_back(linear_candidate(loop, OscillationCause::with_user, loop.device));
    compare_with_nobody(candidates[1], candidates[0]);
    if (loop.stiffness && is_stable(loop.device) && candidates[0].fits) {
      candidates[0].why.evidence.push_back({"user_stabilises", 1.0});
    }
  } else {
    candidates.push_back(linear_candidate(loop, OscillationCause::device, loop.device));
  }
  tell(loop.progress, 0.2);
  if (auto friction = friction_candidate(loop)) candidates.push_back(*std::move(friction));
  tell(loop.progress, 0.6);
  if (auto steps = quantisation_candidate(loop)) candidates.push_back(*std::move(steps));
  tell(loop.progress, 0.8);
  if (knows_users_of(loop.device)) candidates.push_back(user_candidate(loop));
  rank(candidates, loop);
}

void remark_on(const ObservedLoop& loop, Diagnosis& diagnosis) {
  const std::vector<OscillationCandidate>& candidates = diagnosis.candidates;
  if (!loop.stiffness) {
    diagnosis.remarks.push_back(note({.code = FindingCode::wall_stiffness_unknown, .key = "wall.stiffness"}));
  }
  if (has_two_loops(loop.device)) {
    const bool has_steps = loop.device.parameters().sensor.resolution > 0.0;
    if (has_steps && loop.stiffness) diagnosis.remarks.push_back(left_out_beside_damper_loop("steps"));
    if (can_be_held(loop.device) && !knows_users_of(loop.device) && !is_of_mechanism(loop.device)) {
      diagnosis.remarks.push_back(left_out_beside_damper_loop("any_user"));
    }
  }
  for (Remark& each : any_grasp_remarks(loop.device, knows_users_of(loop.device))) {
    diagnosis.remarks.push_back(std::move(each));
  }
  if (!diagnosis.cause && diagnosis.nearest) {
    diagnosis.trust.doubt({.code = FindingCode::no_cause_fits});
  }
  if (!diagnosis.cause) return;
  const bool is_linear = diagnosis.cause == OscillationCause::device || diagnosis.cause == OscillationCause::with_user;
  if (is_linear && loop.stiffness && apart_from(candidates[0], loop) > of_linear_loop) {
    diagnosis.trust.doubt(
        {.code = FindingCode::grows_at_another_frequency,
         .evidence = {{"log_frequency_ratio", apart_from(candidates[0], loop)}, {"threshold", of_linear_loop}}});
  }
  if (candidates.size() < 2 || !candidates[1].fits) return;
  const double closer_by = mismatch(candidates[1], loop) - mismatch(candidates[0], loop);
  if (closer_by > ambiguous) return;
  diagnosis.trust.doubt(
      {.code = FindingCode::two_causes_fit, .evidence = {{"closer_by", closer_by}, {"threshold", ambiguous}}});
}

std::optional<OptionProblem> find_problem(const DiagnosisOptions& options) {
  const auto beyond = [](const char* member, const std::optional<double>& value) -> std::optional<OptionProblem> {
    if (!value || not_negative_numbers.contains(*value)) return std::nullopt;
    return option_problem(member, {.code = ProblemCode::not_between,
                                   .evidence = {{"value", *value},
                                                {"least", not_negative_numbers.least},
                                                {"most", not_negative_numbers.greatest}}});
  };
  const auto finite = [](double value) { return std::isfinite(value) && value >= 0.0; };
  if (options.amplitude && !(finite(*options.amplitude) && *options.amplitude > 0.0)) {
    return option_problem("amplitude",
                          {.code = ProblemCode::not_finite_and_positive, .evidence = {{"value", *options.amplitude}}});
  }
  if (options.stiffness && !finite(*options.stiffness)) {
    return option_problem(
        "stiffness", {.code = ProblemCode::negative, .evidence = {{"value", *options.stiffness}, {"or_damper", 1.0}}});
  }
  if (options.damping && !finite(*options.damping)) {
    return option_problem("damping", {.code = ProblemCode::negative, .evidence = {{"value", *options.damping}}});
  }
  if (auto problem = beyond("amplitude", options.amplitude)) return problem;
  if (auto problem = beyond("stiffness", options.stiffness)) return problem;
  return beyond("damping", options.damping);
}

/// The oscillation of a recording that dominant_oscillation() reads; nothing where nothing oscillates: the strongest line
/// holds hardly anything of what moves, as in noise and in a sweep, or is rounding.
std::optional<DominantOscillation> recorded_oscillation(const Recording& recording) {
  if (recording.channels.empty())
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::recording_without_channel});
  const std::vector<double>& position = recording.channels.front().samples;
  const auto found = dominant_oscillation(position, recording.sampling_period);
  constexpr double least_share = 0.1;
  constexpr double rounding = 1e-9;  // of the position
  if (!found || found->share < least_share) return std::nullopt;
  const double most = std::abs(*std::ranges::max_element(position, {}, [](double value) { return std::abs(value); }));
  if (found->amplitude < rounding * most) return std::nullopt;
  return found;
}

/// With what the recording shows.
DiagnosisOptions with_recorded(DiagnosisOptions options, const DominantOscillation& found) {
  options.frequency = found.frequency;
  if (!options.amplitude) options.amplitude = found.amplitude;
  return options;
}

/// What moves beside the oscillation, and one that nothing keeps up.
void doubt_recorded(const DominantOscillation& found, Trust& trust) {
  constexpr double clear_share = 0.5;
  constexpr double kept = 0.7;
  if (found.share < clear_share) {
    trust.doubt({.code = FindingCode::oscillation_beside_other_motion,
                 .evidence = {{"share", found.share}, {"threshold", clear_share}}});
  }
  if (found.change < kept) {
    trust.doubt(
        {.code = FindingCode::oscillation_dies_out, .evidence = {{"change", found.change}, {"threshold", kept}}});
  }
}

}  // namespace

std::optional<OptionProblem> find_problem(const DiagnosisOptions& options, const Device& device) {
  // The position is looked at by whichever of spring and damper runs oftener.
  const double period = std::min(device.loop().sampling_period, damper_timing(device.loop()).sampling_period);
  const double nyquist = pi / period;
  if (!(options.frequency > 0.0 && options.frequency <= nyquist * (1.0 + 1e-9))) {
    return option_problem("frequency", {.code = ProblemCode::oscillation_beyond_nyquist,
                                        .evidence = {{"frequency_hz", options.frequency / (2.0 * pi)},
                                                     {"most_hz", nyquist / (2.0 * pi)}}});
  }
  if (options.stiffness == 0.0 && options.damping.value_or(device.parameters().wall.damping) == 0.0) {
    return option_problem("stiffness", {.code = ProblemCode::neither_stiffness_nor_damping});
  }
  return find_problem(options);
}

std::optional<OptionProblem> find_problem(const DiagnosisOptions& options, const Device& device,
                                          const Recording& recording) {
  const auto found = recorded_oscillation(recording);
  auto problem = found ? find_problem(with_recorded(options, *found), device) : find_problem(options);
  if (problem && problem->member == "frequency") problem->member = "recording";
  return problem;
}

Diagnosis diagnose(const Device& device, const DiagnosisOptions& options) {
  require_known_structure(device);
  require_valid(find_problem(options, device));
  Diagnosis diagnosis;
  diagnosis.frequency = options.frequency;
  diagnosis.amplitude = options.amplitude;
  diagnosis.trust = trust_of(device);
  if (diagnosis.trust.refused()) return diagnosis;
  StagedProgress stages(options.progress);
  ObservedLoop loop = observed(device, options);
  loop.progress = stages.stage();
  stages.next(0.05);
  diagnosis.limits = holding_limits(device, {.progress = stages.stage()});
  stages.next(0.1);
  diagnosis.stiffness = loop.stiffness;
  diagnosis.damping = loop.device.parameters().wall.damping;
  diagnosis.limit_of = loop.number;
  diagnosis.trust.inherit(number_limit(loop.device, loop.number).trust);
  if (diagnosis.trust.refused()) return diagnosis;
  stages.next(0.3);
  collect(loop, diagnosis);
  stages.next(1.0);
  if (!diagnosis.candidates.empty() && is_near(diagnosis.candidates.front())) {
    const OscillationCandidate& first = diagnosis.candidates.front();
    if (first.fits) diagnosis.cause = first.cause;
    diagnosis.nearest = first.cause;
    const AbsoluteStabilityCheck users(loop.device, loop.number, loop.progress);
    diagnosis.absolute_stability_limit_now = users.now();
    diagnosis.changes = changes_of(loop, first, users);
  }
  remark_on(loop, diagnosis);
  stages.done();
  return diagnosis;
}

Diagnosis diagnose(const Device& device, const Recording& recording, const DiagnosisOptions& options) {
  require_known_structure(device);
  require_valid(find_problem(options, device, recording));
  Diagnosis diagnosis;
  if (const auto found = recorded_oscillation(recording)) {
    diagnosis = diagnose(device, with_recorded(options, *found));
    if (!diagnosis.trust.refused()) doubt_recorded(*found, diagnosis.trust);
  } else {
    diagnosis.amplitude = options.amplitude;
    diagnosis.trust.refuse({.code = FindingCode::nothing_oscillates});
  }
  diagnosis.remarks.insert(diagnosis.remarks.begin(), recording.remarks.begin(), recording.remarks.end());
  return diagnosis;
}

}  // namespace zwidth
