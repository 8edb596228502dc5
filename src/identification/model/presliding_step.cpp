#include "identification/model/presliding_step.hpp"

#include <algorithm>
#include <cmath>

namespace zwidth::internal {
namespace {

using End = PreslidingStep::End;

template <bool with_slopes>
End sum(const End& a, double by_a, const End& b, double by_b) {
  if constexpr (!with_slopes) return {by_a * a.value + by_b * b.value};
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
/// The left side is concave in a: Newton's steps from below never pass the root, and leave half the square of the last.
double travel(double reach, double strength, double bend, double rate) {
  constexpr int most_steps = 60;
  constexpr double close = 1e-8;
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
template <bool with_slopes>
PreslidingStep part(const PreslidingStep& from, const End& change, double limit, double compliance, double length,
                    double duration, double share) {
  const double strength = share * compliance * limit;
  const double rate = share * duration / length;
  const End reach = sum<with_slopes>(from.velocity, 1.0, change, share);
  const double sign = reach.value >= strength * from.bend.value ? 1.0 : -1.0;
  const double bend = sign * from.bend.value;
  const double a = travel(sign * reach.value, strength, bend, rate);
  const double left = std::exp(-a);
  PreslidingStep to;
  // value of the bend's slopes by velocity, former bend and length; then the velocity's, whose friction has the bend
  const double by_velocity = (1.0 - bend) * left * rate;
  const double by_length = -sign * (1.0 - bend) * left * a / length;
  const double weight = 1.0 / (1.0 + strength * by_velocity);
  End pushed = sum<with_slopes>(reach, 1.0, from.bend, -strength * left);
  pushed.by_length -= strength * by_length;
  to.bend.value = sign * (1.0 - (1.0 - bend) * left);
  pushed.by_limit -= to.bend.value * share * compliance;
  pushed.by_compliance -= to.bend.value * share * limit;
  to.velocity = sum<with_slopes>(pushed, weight, {}, 0.0);
  to.velocity.value = sign * a / rate;
  const double value = to.bend.value;
  to.bend = sum<with_slopes>(from.bend, left, to.velocity, by_velocity);
  to.bend.value = value;
  to.bend.by_length += by_length;
  return to;
}

/// The whole step of a body that does not turn: its way is that of the mean velocity, its friction the mean over that way,
///
///     mean bend = s - (s - bend) (1 - e^-a) / a,  s: direction
template <bool with_slopes>
PreslidingStep slide(const PreslidingStep& from, const End& change, double limit, double compliance, double length,
                     double duration) {
  constexpr int most_steps = 60;
  constexpr double close = 1e-9;  // of a step of Newton's, which leaves its square
  constexpr double small = 1e-3;
  const double strength = compliance * limit;
  const double sign = from.velocity.value < 0.0 ? -1.0 : 1.0;
  const double rate = 0.5 * duration / length;
  const End reach = sum<with_slopes>(from.velocity, 1.0, change, 1.0);
  const double unbent = 1.0 - sign * from.bend.value;
  double speed = sign * reach.value - strength;  // below the root
  double a = 0.0;
  double left = 1.0;
  double mean = 1.0;   // (1 - e^-a) / a
  double slope = 0.5;  // - d mean / da
  for (int step = 0; step < most_steps; ++step) {
    a = rate * (std::abs(from.velocity.value) + speed);
    left = std::exp(-a);
    mean = a < small ? 1.0 - a / 2.0 + a * a / 6.0 : (1.0 - left) / a;
    slope = a < small ? 0.5 - a / 3.0 + a * a / 8.0 : (1.0 - left * (1.0 + a)) / (a * a);
    const double move =
        (sign * reach.value - strength * (1.0 - unbent * mean) - speed) / (1.0 + strength * unbent * slope * rate);
    if (!(move > close * std::abs(speed))) break;
    speed += move;
  }
  const double by_way = sign * unbent * slope;  // of the mean bend
  const double by_velocity = sign * rate;       // of the way over the length, former and later alike
  const double by_length = -a / length;
  const double mean_bend = sign * (1.0 - unbent * mean);
  End pushed = sum<with_slopes>(reach, 1.0, from.bend, -strength * mean);
  pushed = sum<with_slopes>(pushed, 1.0, from.velocity, -strength * by_way * by_velocity);
  pushed.by_length -= strength * by_way * by_length;
  pushed.by_limit -= mean_bend * compliance;
  pushed.by_compliance -= mean_bend * limit;
  PreslidingStep to;
  to.velocity = sum<with_slopes>(pushed, 1.0 / (1.0 + strength * by_way * by_velocity), {}, 0.0);
  to.velocity.value = sign * speed;
  to.bend = sum<with_slopes>(from.bend, left, sum<with_slopes>(from.velocity, 1.0, to.velocity, 1.0),
                             sign * unbent * left * by_velocity);
  to.bend.by_length += sign * unbent * left * by_length;
  to.bend.value = sign * (1.0 - unbent * left);
  return to;
}

template <bool with_slopes>
PreslidingStep whole_step(double before, double free, double limit, double compliance, double bend, double length,
                          double duration) {
  constexpr int parts = 4;
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
  const End change{.value = free - before, .by_before = -1.0, .by_free = 1.0};
  if (!may_turn) return slide<with_slopes>(step, change, limit, compliance, length, duration);
  for (int i = 0; i < parts; ++i)
    step = part<with_slopes>(step, change, limit, compliance, length, duration, 1.0 / parts);
  return step;
}

}  // namespace

PreslidingStep presliding_step(double before, double free, double limit, double compliance, double bend, double length,
                               double duration, bool with_slopes) {
  return with_slopes ? whole_step<true>(before, free, limit, compliance, bend, length, duration)
                     : whole_step<false>(before, free, limit, compliance, bend, length, duration);
}

}  // namespace zwidth::internal
