#include "stability/limit/gain_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "sampling/cancellation.hpp"
#include "stability/loop/response_bound.hpp"
#include "stability/roots/root_isolation.hpp"

namespace zwidth::internal {
namespace {

// A root of the phase condition this close, relative, to an undamped pole may be that pole, at kappa = 0.
constexpr double same_angle = 1e-6;

// Of each root whether it is an undamped pole of kappa = 0: the nearest to it. A mode that the loop hardly sees has a
// crossover of its own beside its pole. Poles that coincide share all the roots that are near.
std::vector<bool> undamped_poles(const FilteredPlant& plant, const GainLocus& locus,
                                 const std::vector<CircleRoot>& roots) {
  std::vector<bool> is_pole(roots.size(), false);
  if (!locus.begins_at_plant_poles()) return is_pole;
  for (const SampledTerm& term : plant.terms) {
    const auto distance = [&term](const CircleRoot& root) { return std::abs(root.angle - term.undamped_angle); };
    const auto is_near = [&](const CircleRoot& root) { return distance(root) <= same_angle * root.angle; };
    if (term.undamped_pairs == 1) {
      const auto nearest = std::min_element(roots.begin(), roots.end(),
                                            [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
      if (nearest != roots.end() && is_near(*nearest))
        is_pole[static_cast<std::size_t>(nearest - roots.begin())] = true;
    } else if (term.undamped_pairs > 1) {
      for (std::size_t i = 0; i < roots.size(); ++i) is_pole[i] = is_pole[i] || is_near(roots[i]);
    }
  }
  return is_pole;
}

// P is zero to rounding (an undamped antiresonance, a numerator with a factor s): no gain, however large, has a pole
// there. Where terms cancel by nature they were added up with more digits.
bool vanishes(const FilteredPlant& plant, const GainLocus::TermSum& response) {
  return plant.numerator.empty() && response.cancellation >= 1e13;
}

// A gain that rounding may move by more than this, relative, is found again in double-double.
constexpr double sure_gain = 1e-10;

// Where the controller of a gain, K + B v or B v, is too small for |P C| = 1: every crossing there has a greater gain.
class SmallerGains {
 public:
  SmallerGains(const FilteredPlant& plant, const GainLocus& locus, double stiffness, double damping)
      : bound_(plant), locus_(locus), stiffness_(stiffness), damping_(damping) {}

  bool leaves_out(double begin, double end) {
    const double controller = stiffness_ + damping_ * locus_.velocity_size(end);  // greatest there
    const bool out = controller * bound_.greatest(begin, end) < certainly_less;
    if (out && !first_) first_ = begin;
    return out;
  }
  // Where what is left out begins, x.
  [[nodiscard]] std::optional<double> first() const { return first_; }

 private:
  static constexpr double certainly_less = 1.0 - 1e-9;
  ResponseBound bound_;
  const GainLocus& locus_;
  double stiffness_;
  double damping_;
  std::optional<double> first_;
};

GainCrossings crossings_of(const FilteredPlant& plant, const GainLocus& locus, const std::vector<CircleRoot>& roots,
                           double before_first) {
  GainCrossings result;
  result.initially_unstable = locus.initially_unstable(locus.value(before_first));
  result.crossings.reserve(roots.size() + 1);
  const std::vector<bool> is_pole = undamped_poles(plant, locus, roots);
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const CircleRoot& root = roots[i];
    // f falling through zero: a pole leaves (Im of -den/num rises with the angle).
    const int poles_leaving = -2 * root.direction;
    if (is_pole[i]) {
      if (poles_leaving > 0) result.initially_unstable += poles_leaving;
      continue;
    }
    const GainLocus::TermSum response = locus.by_terms(root.angle);
    GainCrossing crossing{root.angle, locus.gain(root.angle), poles_leaving, response.gain_noise()};
    if (!(crossing.noise <= sure_gain * std::abs(crossing.gain)) && root.direction != 0) {
      if (const auto again = locus.polished_root(root.angle)) {
        crossing.angle = again->angle;
        crossing.gain = again->gain;
      }
    }
    if (crossing.gain > 0.0 && std::isfinite(crossing.gain) && !vanishes(plant, response)) {
      result.crossings.push_back(crossing);
    }
  }
  // z = 1 and z = -1 are real: crossings where the gain is positive. At z = 1 that takes a negative static response.
  const double at_rest = locus.gain(0.0);
  if (at_rest > 0.0 && std::isfinite(at_rest) && !(cancellation(plant, 0.0) >= 1e13)) {
    result.crossings.insert(result.crossings.begin(), {0.0, at_rest, locus.value(0.0) < 0.0 ? 1 : -1, 0.0});
  }
  const double gain = locus.gain(std::numbers::pi);
  if (gain > 0.0 && std::isfinite(gain)) {
    result.crossings.push_back({std::numbers::pi, gain, locus.value(std::numbers::pi) > 0.0 ? 1 : -1,
                                locus.by_terms(std::numbers::pi).gain_noise()});
  }
  return result;
}

// Poles outside at K = 0 beside the plant's own: the locus of B. The one that the damper leaves at z = 1 is counted by the
// locus of K.
int left_by_damper(const FilteredPlant& plant, const VirtualDamper& damper, const GainCrossings& by_damping) {
  int open_loop = 0;
  for (const SampledTerm& term : plant.terms) open_loop += term.unstable_poles;
  return unstable_poles(by_damping, damper.damping) - open_loop;
}

// Those with a gain of at most the region's.
GainCrossings smaller_crossings(const FilteredPlant& plant, const GainLocus& locus, SmallerGains region) {
  const std::vector<CircleRoot> roots = roots_on_circle(locus, std::max<std::size_t>(1, plant.delay_samples), region);
  double before_first = roots.empty() ? 1.0 : 0.5 * roots.front().angle;
  if (region.first()) before_first = std::min(before_first, 0.5 * angle_of(*region.first()));
  return crossings_of(plant, locus, roots, before_first);
}

}  // namespace

GainCrossings gain_crossings(const FilteredPlant& plant, const GainLocus& locus) {
  const std::vector<CircleRoot> roots = roots_on_circle(locus, std::max<std::size_t>(1, plant.delay_samples));
  return crossings_of(plant, locus, roots, roots.empty() ? 1.0 : 0.5 * roots.front().angle);
}

int unstable_poles(const GainCrossings& crossings, double gain) {
  int unstable = crossings.initially_unstable;
  for (const GainCrossing& crossing : crossings.crossings) {
    if (crossing.gain < gain) unstable += crossing.poles_leaving;
  }
  return unstable;
}

GainCrossings damping_crossings(const FilteredPlant& plant, const VirtualDamper& damper) {
  return gain_crossings(plant, GainLocus(plant, GainLocus::Gain::damping, 0.0, damper));
}

GainCrossings stiffness_crossings(const FilteredPlant& plant, const VirtualDamper& damper) {
  return stiffness_crossings(plant, damper, damper.damping > 0.0 ? damping_crossings(plant, damper) : GainCrossings{});
}

GainCrossings stiffness_crossings(const FilteredPlant& plant, const VirtualDamper& damper,
                                  const GainCrossings& by_damping) {
  GainCrossings result = gain_crossings(plant, GainLocus(plant, GainLocus::Gain::stiffness, 0.0, damper));
  if (damper.damping > 0.0) result.initially_unstable += left_by_damper(plant, damper, by_damping);
  return result;
}

GainCrossings stiffness_crossings_up_to(const FilteredPlant& plant, const VirtualDamper& damper, double most) {
  const GainLocus locus(plant, GainLocus::Gain::stiffness, 0.0, damper);
  GainCrossings found = smaller_crossings(plant, locus, {plant, locus, most, damper.damping});
  std::erase_if(found.crossings, [most](const GainCrossing& each) { return !(each.gain <= most); });
  if (damper.damping > 0.0) {
    const GainLocus by_damping(plant, GainLocus::Gain::damping, 0.0, damper);
    found.initially_unstable +=
        left_by_damper(plant, damper, smaller_crossings(plant, by_damping, {plant, by_damping, 0.0, damper.damping}));
  }
  return found;
}

double stiffness_limit(const FilteredPlant& plant, const VirtualDamper& damper, double most) {
  const GainCrossings found = stiffness_crossings_up_to(plant, damper, most);
  if (found.initially_unstable > 0) return 0.0;
  double least = most;
  for (const GainCrossing& crossing : found.crossings) least = std::min(least, crossing.gain);
  return least;
}

}  // namespace zwidth::internal
