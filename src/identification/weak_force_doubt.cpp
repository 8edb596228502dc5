#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/friction_test.hpp"
#include "identification/nonlinear_forces.hpp"
#include "identification/weak_force_test.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

using Kind = WeakForceEvidence::Kind;

// Deviations: the most of hundreds of frequencies. Of 137 right fits 5.6 were seen, and one of 7.3 that moved nothing.
constexpr double clear_suspect = 6.0;

// Of an interval's lower end: a force beside which the critical stiffness lies hardly below it does not matter.
constexpr double notable = 0.99;

/// The critical stiffness beside such a force.
void add_beside(double stiffness, Motion motion, Finding& found) {
  found.evidence.push_back({"beside", stiffness, units_of(motion).stiffness});
  found.effect.push_back({"critical_stiffness", stiffness});
}

std::optional<Finding> doubt_of_mode(const WeakForceEvidence& mode, double lower, Motion motion,
                                     const std::string& source) {
  // One mode may not be all that lacks, where it is large and plain.
  constexpr double large = 0.1;    // of the response
  constexpr double plain = 20.0;   // 13 were seen at the upper end of a right fit's band, of an encoder's counts
  constexpr double least = 0.003;  // smaller ones stand for what drifts, at the low end of the band
  // What moves the answer far needs to be less clear: of right fits one of 4.9 was seen.
  constexpr double far = 0.9;
  constexpr double clear_and_far = 5.5;
  const double clear = mode.stiffness_beside < far * lower ? clear_and_far : clear_suspect;
  const bool lowers = mode.stiffness_beside < notable * lower && mode.share > least;
  const bool is_large = mode.share > large && mode.ratio > plain;
  if (!(mode.ratio > clear) || !(lowers || is_large)) return std::nullopt;
  Finding found{.code = FindingCode::unmodelled_mode,
                .evidence = {{"frequency", hertz(mode.frequency)},
                             {mode.share > 1.0 ? "times" : "share", mode.share},
                             {"deviations", mode.ratio},
                             {"threshold", clear}},
                .subjects = {{"source", source}}};
  if (lowers) add_beside(mode.stiffness_beside, motion, found);
  return found;
}

std::optional<Finding> doubt_of_skew(const WeakForceEvidence& skew, const std::string& source) {
  if (!(skew.ratio > clear_suspect)) return std::nullopt;
  return Finding{
      .code = FindingCode::delay_changes,
      .evidence = {{"change", std::abs(skew.change), "s"}, {"deviations", skew.ratio}, {"threshold", clear_suspect}},
      .subjects = {{"source", source}}};
}

std::optional<Finding> doubt_of_change(const WeakForceEvidence& change, double lower, Motion motion,
                                       const std::string& source) {
  constexpr double far = 0.97;
  if (!(change.ratio > clear_suspect) || !(change.stiffness_beside < far * lower)) return std::nullopt;
  Finding found{.code = FindingCode::damping_changes,
                .evidence = {{"change", std::abs(change.change), units_of(motion).damping},
                             {"deviations", change.ratio},
                             {"threshold", clear_suspect}},
                .subjects = {{"source", source}, {"body", change.body}}};
  add_beside(change.stiffness_beside, motion, found);
  return found;
}

FindingCode code_of(Kind kind) {
  if (kind == Kind::drag) return FindingCode::drag;
  return kind == Kind::presliding ? FindingCode::friction_not_coulombs : FindingCode::link_friction;
}

std::optional<Finding> doubt_of(const WeakForceEvidence& force, const Analysis& analysis, Motion motion,
                                const std::string& source) {
  const double value = analysis.critical.stiffness;
  const double lower = analysis.interval ? analysis.interval->lower : value;
  const double upper = analysis.interval ? analysis.interval->upper : value;
  if (force.kind == Kind::mode) return doubt_of_mode(force, lower, motion, source);
  if (force.kind == Kind::clock_skew) return doubt_of_skew(force, source);
  if (force.kind == Kind::changing_damping) return doubt_of_change(force, lower, motion, source);
  // Without friction: of 70 linear records 1.8 at most. With friction, fitted in time: drag of 98 right fits of linear records
  // 4.4 at most, above 3 in four; friction as the motion turns 3.2 at most of 28. Of drag that made an answer 6 to 19 % too high 3.4 and
  // more; of friction that bends before it slips, 23 to 580 % too high, 10 and more; in a link, 24 to 90 % too high, 20 and more.
  constexpr double possible = 3.0;
  if (force.ratio < possible) return std::nullopt;
  Finding found{
      .code = code_of(force.kind), .evidence = {{"deviations", force.ratio}}, .subjects = {{"source", source}}};
  const double beside = force.stiffness_beside;
  if (force.ratio < significant_friction) {
    constexpr double little_of_a_link = 0.97;  // one that does not limit hardly counts
    if (!(beside < (force.kind == Kind::link_friction ? little_of_a_link : notable) * lower)) return std::nullopt;
    found.evidence.push_back({"below", significant_friction});
    add_beside(beside, motion, found);
    return found;
  }
  // Of friction of another kind one step does not tell how far away the device is. In a link it makes intervals wide.
  const double far_beside = force.kind == Kind::link_friction ? std::max(lower, 0.9 * value) : notable * lower;
  if (force.kind != Kind::presliding && far_beside <= beside && beside <= upper) return std::nullopt;
  found.evidence.push_back({"threshold", significant_friction});
  if (beside < value) add_beside(beside, motion, found);
  return found;
}

}  // namespace

std::optional<Finding> doubt_of_weak_forces(std::span<const WeakForceEvidence> forces, const Analysis& analysis,
                                            Motion motion, const std::string& source) {
  std::vector<WeakForceEvidence> clearest(forces.begin(), forces.end());
  std::ranges::sort(clearest, std::ranges::greater{}, &WeakForceEvidence::ratio);
  for (const WeakForceEvidence& each : clearest) {  // one that does not matter hides no other
    if (auto doubt = doubt_of(each, analysis, motion, source)) return doubt;
  }
  return std::nullopt;
}

}  // namespace zwidth::internal
