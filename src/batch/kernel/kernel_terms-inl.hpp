// The sampled modal terms of rigid and two-mass devices, one device per lane. Included once per instruction set.
#if defined(ZWIDTH_BATCH_KERNEL_TERMS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ZWIDTH_BATCH_KERNEL_TERMS_INL_HPP
#undef ZWIDTH_BATCH_KERNEL_TERMS_INL_HPP
#else
#define ZWIDTH_BATCH_KERNEL_TERMS_INL_HPP
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "batch/kernel/stiffness_kernel.hpp"

HWY_BEFORE_NAMESPACE();
namespace zwidth::internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;
using V = hn::Vec<Tag>;
using M = hn::Mask<Tag>;

HWY_INLINE V number(double value) { return hn::Set(Tag(), value); }
HWY_INLINE V choose(M where, V yes, V no) { return hn::IfThenElse(where, yes, no); }

// What the stages after this one read of a device, as rows of doubles.
enum TermRow : std::size_t {
  rigid_n0,
  rigid_n1,
  rigid_n2,
  rigid_d0,
  rigid_d1,
  mode_n0,
  mode_n1,
  mode_n2,
  mode_d0,
  mode_d1,
  lag_n0,
  lag_n1,
  lag_d0,  // of a residue of 1
  rigid_residue,
  mode_residue,  // of the lag's term, from each mode
  condition,     // rounding of the terms' coefficients, in units of double
  damper_rate,
  damper_c,  // B c / T and c = 1 - a
  sample_period,
  term_rows
};

struct Terms {
  V row[term_rows];
};

struct Hold {  // as HoldIntegrals
  V h, g;
};

// s² + c1 s + c0 with w = sqrt(c0 - c1²/4) > 0: hold_integrals().
HWY_INLINE Hold hold_of_pair(V c1, V c0, V w, V t) {
  const Tag tag;
  const V zero = hn::Zero(tag);
  const V half = number(0.5);
  const M slow = hn::Max(c1, hn::Sqrt(c0)) * t < number(1.0);
  Hold result{zero, zero};
  if (!hn::AllFalse(tag, slow)) {
    constexpr int terms = 20;  // 1/k! falls below rounding
    V previous = zero;
    V current = t * t * half;
    V g = current;
    V ht = current + current;
    const V a = c1 * t;
    const V b = c0 * t * t;
    for (int k = 1; k < terms; ++k) {
      const V next =
          hn::Neg(hn::MulAdd(a * number(k + 1.0), current, b * previous)) * number(1.0 / ((k + 2.0) * (k + 1.0)));
      previous = current;
      current = next;
      g = g + current;
      ht = hn::MulAdd(number(k + 2.0), current, ht);
    }
    result = {ht / t, g};
  }
  if (!hn::AllTrue(tag, slow)) {
    const V sigma = half * c1;
    const V decay = hn::Exp(tag, hn::Neg(sigma * t));
    const V y = half * w * t;
    const V sine = hn::Sin(tag, y);
    const V h = decay * (sine + sine) * hn::Cos(tag, y) / w;
    const V g = (number(2.0) * decay * sine * sine - hn::Expm1(tag, hn::Neg(sigma * t)) - sigma * h) / c0;
    result = {choose(slow, result.h, h), choose(slow, result.g, g)};
  }
  return result;
}

// (1 - e^{-p t}) / p, p > 0
HWY_INLINE V decay_integral_of(V p, V t) { return hn::Neg(hn::Expm1(Tag(), hn::Neg(p * t))) / p; }

// s (s + q), q > 0
HWY_INLINE Hold hold_of_integrator(V q, V t) {
  const V x = q * t;
  const V h = decay_integral_of(q, t);
  V series = number(0.0);  // sum of (-x)^k / (k + 2)!
  constexpr int terms = 19;
  double factorial = 2.0;
  double coefficients[terms];
  for (int k = 0; k < terms; factorial *= k + 3.0, ++k) coefficients[k] = (k % 2 == 0 ? 1.0 : -1.0) / factorial;
  for (int k = terms; k-- > 0;) series = hn::MulAdd(series, x, number(coefficients[k]));
  return {h, choose(x < number(1.0), series * t * t, (t - h) / q)};
}

struct Second {  // (r1 s + r0) / (s² + c1 s + c0)
  V r1, r0, c1, c0;
};

// sample_second_order() of the library; rows n0 n1 n2 d0 d1.
HWY_INLINE void sample_second(const KernelGroup& group, const Second& s, const Hold& whole, const Hold& recent,
                              const Hold& old, V* rows) {
  const V q = s.c1 * whole.h + s.c0 * whole.g;
  rows[4] = number(2.0) * s.c0 * whole.g + s.c1 * whole.h;
  rows[3] = s.c0 * (whole.g * q + whole.h * whole.h);
  const V constant = s.r0 * (whole.h * whole.h + q * whole.g);
  rows[0] = constant;
  if (!group.fractional) {
    rows[1] = s.r0 * whole.g + s.r1 * whole.h;
    rows[2] = number(0.0);
    return;
  }
  const V one = number(1.0);
  const V p2 = (one - s.c0 * recent.g) * old.g + recent.h * old.h;
  const V v2 = (one - s.c1 * recent.h - s.c0 * recent.g) * old.h - s.c0 * recent.h * old.g;
  const V slope1 = s.r0 * recent.g + s.r1 * recent.h;
  const V slope2 = s.r0 * p2 + s.r1 * v2;
  const V constant1 =
      s.r0 * (whole.h * recent.h + q * recent.g) + s.r1 * s.c0 * (whole.g * recent.h - whole.h * recent.g);
  rows[2] = slope1;
  rows[1] = slope1 + constant1 + slope2;
}

// Behind the lag: (r1 s + r0)/d times rate/(s + rate), less residue/(s + rate).
HWY_INLINE V take_lag_out(V rate, Second& s) {
  const V at_pole = (rate - s.c1) * rate + s.c0;
  const V residue = rate * (s.r0 - s.r1 * rate) / at_pole;
  s.r0 = s.r0 - residue * s.c0 / rate;
  s.r1 = hn::Neg(residue);
  return residue;
}

// Of the cubic (s + q)(s² + p1 s + p0) of a two-mass device, q its slow real pole.
struct Poles {
  V q, p1, p0;
};
HWY_INLINE Poles poles_of(V a3, V a2, V a1) {
  constexpr int steps = 8;
  V q = a1 / a2;
  for (int i = 0; i < steps; ++i) {
    const V value = ((a3 - q) * q - a2) * q + a1;
    const V slope = (a3 + a3 - number(3.0) * q) * q - a2;
    q = q - value / slope;
  }
  const V p1 = a3 - q;
  const V p0 = a2 - q * p1;
  return {a1 / p0, p1, p0};
}

// False where the device is of a kind for which the rest does not stand.
HWY_INLINE M terms_of(const KernelGroup& group, const V* in, Terms& out) {
  const Tag tag;
  const V zero = hn::Zero(tag);
  const V one = number(1.0);
  const auto input = [in](KernelInput which) HWY_ATTR { return in[static_cast<std::size_t>(which)]; };
  const V period = input(KernelInput::period);
  const V recent_time = input(KernelInput::with_new);
  const V old_time = input(KernelInput::with_old);
  for (V& row : out.row) row = zero;
  Second rigid{zero, zero, zero, zero};
  Second mode{zero, zero, zero, one};
  V lost = one;  // digits of the residues
  M fits;
  V turning = zero;  // of the fastest mode within a period
  if (group.two_bodies) {
    const V m1 = input(KernelInput::actuated_mass);
    const V m2 = input(KernelInput::other_mass);
    const V g1 = input(KernelInput::actuated_damping);
    const V g2 = input(KernelInput::other_damping);
    const V k = input(KernelInput::link_stiffness);
    const V b = input(KernelInput::link_damping);
    const V a4 = one / (m1 * m2);
    const V a3 = (m1 * (g2 + b) + m2 * (g1 + b)) * a4;
    const V a2 = (k * (m1 + m2) + g1 * g2 + b * (g1 + g2)) * a4;
    const V a1 = k * (g1 + g2) * a4;
    const Poles poles = poles_of(a3, a2, a1);
    const V q = poles.q;
    const V n2 = group.collocated ? m2 : zero;
    const V n1 = group.collocated ? g2 + b : b;
    const V scale = a4 / (poles.p0 * ((q - poles.p1) * q + poles.p0));
    rigid = {(k * (q - poles.p1) + poles.p0 * (n1 - n2 * q)) * scale, k * a4 / poles.p0, q, zero};
    mode = {hn::Neg(rigid.r1), n2 * a4 - rigid.r0 - rigid.r1 * (poles.p1 - q), poles.p1, poles.p0};
    lost = one + (n2 * a4 + hn::Abs(rigid.r0) + hn::Abs(rigid.r1) * (poles.p1 + q)) / hn::Abs(mode.r0) +
           (a3 + q) / poles.p1;
    // An oscillating mode, and a real pole apart from it.
    fits = hn::And(q > zero, hn::And(poles.p1 * poles.p1 < number(3.6) * poles.p0, q * q < number(0.25) * poles.p0));
    const V w = hn::Sqrt(hn::Max(poles.p0 - number(0.25) * poles.p1 * poles.p1, zero));
    turning = hn::Sqrt(poles.p0) * period;
    if (group.lag) {
      const V rate = one / input(KernelInput::lag);
      out.row[mode_residue] = take_lag_out(rate, mode);
    }
    const Hold whole = hold_of_pair(poles.p1, poles.p0, w, period);
    Hold recent = whole;
    Hold old = whole;
    if (group.fractional) {
      recent = hold_of_pair(poles.p1, poles.p0, w, recent_time);
      old = hold_of_pair(poles.p1, poles.p0, w, old_time);
    }
    sample_second(group, mode, whole, recent, old, out.row + mode_n0);
  } else {
    const V m = input(KernelInput::actuated_mass);
    rigid = {zero, one / m, input(KernelInput::actuated_damping) / m, input(KernelInput::actuated_stiffness) / m};
    fits = rigid.c1 > zero;
  }
  const M free = rigid.c0 == zero;
  fits = hn::And(fits, hn::Or(free, rigid.c1 * rigid.c1 < number(3.6) * rigid.c0));
  const V rate = group.lag ? one / input(KernelInput::lag) : one;
  const V c0 = rigid.c0;
  if (group.lag) out.row[rigid_residue] = take_lag_out(rate, rigid);
  const V safe_c0 = choose(free, rigid.c1 * rigid.c1, c0);  // any pair, where it is not used
  const V w = hn::Sqrt(hn::Max(safe_c0 - number(0.25) * rigid.c1 * rigid.c1, zero));
  const bool some_tied = !hn::AllTrue(tag, free);
  Hold holds[3];
  const V times[3] = {period, recent_time, old_time};
  for (int i = 0; i < (group.fractional ? 3 : 1); ++i) {
    holds[i] = hold_of_integrator(rigid.c1, times[i]);
    if (some_tied) {
      const Hold tied = hold_of_pair(rigid.c1, safe_c0, w, times[i]);
      holds[i] = {choose(free, holds[i].h, tied.h), choose(free, holds[i].g, tied.g)};
    }
  }
  sample_second(group, rigid, holds[0], holds[1], holds[2], out.row + rigid_n0);
  turning = hn::Max(turning, hn::Sqrt(c0) * period);
  if (group.lag) {
    out.row[lag_d0] = hn::Neg(hn::Expm1(tag, hn::Neg(rate * period)));
    if (group.fractional) {
      const V g1 = decay_integral_of(rate, recent_time);
      const V g2 = hn::Exp(tag, hn::Neg(rate * recent_time)) * decay_integral_of(rate, old_time);
      out.row[lag_n1] = g1;
      out.row[lag_n0] = g1 + g2;
    } else {
      out.row[lag_n0] = decay_integral_of(rate, period);
    }
  }
  out.row[condition] = lost + turning;
  out.row[sample_period] = period;
  out.row[damper_c] = one;
  if (group.filter) {
    const V turn = number(2.0 * 3.14159265358979323846) * input(KernelInput::velocity_filter_hz) * period;
    out.row[damper_c] = hn::Neg(hn::Expm1(tag, hn::Neg(turn)));
  }
  if (group.damper) out.row[damper_rate] = input(KernelInput::damper) * out.row[damper_c] / period;
  constexpr double most_turning = 1e3;  // the phase of a faster mode is lost
  return hn::And(fits, turning < number(most_turning));
}

}  // namespace zwidth::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
