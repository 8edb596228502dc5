#include "identification/model/presliding_step.hpp"

#include <algorithm>
#include <cmath>

namespace zwidth::internal {
namespace {

using End = PreslidingStep::End;

End sum(const End& a, double by_a, const End& b, double by_b) {
  return {by_a * a.value + by_b * b.value,
          by_a * a.by_before + by_b * b.by_before,
          by_a * a.by_free + by_b * b.by_free,
          by_a * a.by_limit + by_b * b.by_limit,
          by_a * a.by_compliance + by_b * b.by_compliance,
          by_a * a.by_bend + by_b * b.by_bend,
          by_a * a.by_length + by_b * b.by_length};
}

/// The travel over the length, along the motion, at which the velocity `reach` less the friction is what travels so far:
///
///     a / rate + (1 - (1 - bend) e^-a) strength = reach,  with strength * bend < reach
///
/// The left side is concave in a: Newton's steps from below never pass the root.
double travel(double reach, double strength, double bend, double rate) {
  constexpr int most_steps = 60;
  constexpr double close = 1e-14;
  double a = std::max(0.0, (reach - strength) * rate);
  for (int step = 0; step < most_steps; ++step) {
    const double left = strength * (1.0 - bend) * std::exp(-a);
    const double move = (reach - strength + left - a / rate) / (1.0 / rate + left);
    a += move;
    if (!(move > close * (1.0 + a))) break;
  }
  return a;
}

/// One part: `share` of the step.
PreslidingStep part(const PreslidingStep& from, const End& change, double limit, double compliance, double length,
                    double duration, double share) {
  const double strength = share * compliance * limit;
  const double rate = share * duration / length;
  const End reach = sum(from.velocity, 1.0, change, share);
  const double sign = reach.value >= strength * from.bend.value ? 1.0 : -1.0;
  const double bend = sign * from.bend.value;
  const double a = travel(sign * reach.value, strength, bend, rate);
  const double left = std::exp(-a);
  PreslidingStep to;
  // value of the bend's slopes by velocity, former bend and length; then the velocity's, whose friction has the bend
  const double by_velocity = (1.0 - bend) * left * rate;
  const double by_length = -sign * (1.0 - bend) * left * a / length;
  const double weight = 1.0 / (1.0 + strength * by_velocity);
  End pushed = sum(reach, 1.0, from.bend, -strength * left);
  pushed.by_length -= strength * by_length;
  to.bend.value = sign * (1.0 - (1.0 - bend) * left);
  pushed.by_limit -= to.bend.value * share * compliance;
  pushed.by_compliance -= to.bend.value * share * limit;
  to.velocity = sum(pushed, weight, {}, 0.0);
  to.velocity.value = sign * a / rate;
  const double value = to.bend.value;
  to.bend = sum(from.bend, left, to.velocity, by_velocity);
  to.bend.value = value;
  to.bend.by_length += by_length;
  return to;
}

}  // namespace

PreslidingStep presliding_step(double before, double free, double limit, double compliance, double bend, double length,
                               double duration) {
  constexpr int parts_of_turn = 8;
  constexpr int parts_of_slide = 2;
  constexpr double slid = 1e-9;  // of the bend: less is left
  const double direction = bend < 0.0 ? -1.0 : 1.0;
  const double slides_to = free - direction * compliance * limit;
  PreslidingStep step{.velocity = {.value = before, .by_before = 1.0}, .bend = {.value = bend, .by_bend = 1.0}};
  if (1.0 - direction * bend < slid && before * direction > 0.0 && slides_to * direction > 0.0) {
    step.velocity = {slides_to, 0.0, 1.0, -direction * compliance, -direction * limit};
    return step;
  }
  const double forward = before < 0.0 ? -1.0 : 1.0;
  const bool may_turn = before == 0.0 || free * forward <= compliance * limit;
  const int parts = may_turn ? parts_of_turn : parts_of_slide;
  const End change{.value = free - before, .by_before = -1.0, .by_free = 1.0};
  for (int i = 0; i < parts; ++i)
    step = part(step, change, limit, compliance, length, duration, 1.0 / static_cast<double>(parts));
  return step;
}

}  // namespace zwidth::internal
