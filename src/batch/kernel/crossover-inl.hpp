// A crossover's stiffness, angle and mechanism from the modal terms themselves, with the digits that the polynomial
// does not have. Included once per instruction set.
//
//     W = 1/P = W_e + j sin W_o:   W_o + B v_o = 0,   K = -W_e - B v_e
#if defined(ZWIDTH_BATCH_CROSSOVER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ZWIDTH_BATCH_CROSSOVER_INL_HPP
#undef ZWIDTH_BATCH_CROSSOVER_INL_HPP
#else
#define ZWIDTH_BATCH_CROSSOVER_INL_HPP
#endif

#include "batch/kernel/kernel_terms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace zwidth::internal::HWY_NAMESPACE {

// A value and its derivative by x.
struct Jet {
  V value, slope;
};
HWY_INLINE Jet operator+(const Jet& a, const Jet& b) { return {a.value + b.value, a.slope + b.slope}; }
HWY_INLINE Jet operator-(const Jet& a, const Jet& b) { return {a.value - b.value, a.slope - b.slope}; }
HWY_INLINE Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, hn::MulAdd(a.value, b.slope, a.slope * b.value)};
}
HWY_INLINE Jet over(const Jet& a, const Jet& b) {
  const V quotient = a.value / b.value;
  return {quotient, (a.slope - quotient * b.slope) / b.value};
}
HWY_INLINE Jet scaled(V factor, const Jet& a) { return {factor * a.value, factor * a.slope}; }

struct OnCircleJet {
  Jet even, odd;
};

// c0 + c1 delta + c2 delta² on the circle
HWY_INLINE OnCircleJet polynomial_at(V c0, V c1, V c2, V x) {
  const V half = number(0.5);
  const V linear = hn::MulAdd(half, c1, c2);
  return {{hn::MulAdd(hn::MulSub(half * c2, x, linear), x, c0), hn::MulSub(c2, x, linear)},
          {hn::NegMulAdd(c2, x, c1), hn::Neg(c2)}};
}

HWY_INLINE OnCircleJet quotient(const OnCircleJet& n, const OnCircleJet& d, const Jet& sine_squared) {
  const Jet size = d.even * d.even + sine_squared * (d.odd * d.odd);
  return {over(n.even * d.even + sine_squared * (n.odd * d.odd), size), over(n.odd * d.even - n.even * d.odd, size)};
}

HWY_INLINE V magnitude(const OnCircleJet& a, V sine_squared) {
  return hn::Sqrt(hn::MulAdd(a.even.value, a.even.value, sine_squared * a.odd.value * a.odd.value));
}

// Bounds of rounding in units of double: of the even part, and of the odd one.
struct Noise {
  V even, odd;
};

struct TermAt {
  OnCircleJet value;
  Noise noise;
};

// (n0 + n1 delta + n2 delta²)/(d0 + d1 delta + delta²), or over d0 + delta.
HWY_INLINE TermAt term_at(const V* n, const V* d, bool second, V x, const Jet& sine_squared) {
  const V zero = number(0.0);
  const V one = number(1.0);
  const V n2 = second ? n[2] : zero;
  const V d1 = second ? d[1] : one;
  const V d2 = second ? one : zero;
  const OnCircleJet numerator = polynomial_at(n[0], n[1], n2, x);
  const OnCircleJet denominator = polynomial_at(d[0], d1, d2, x);
  TermAt term{quotient(numerator, denominator, sine_squared), {zero, zero}};
  // What was added up in each part, without signs.
  const auto size_of = [x](V c0, V c1, V c2) HWY_ATTR {
    const V a1 = hn::Abs(c1);
    const V a2 = hn::Abs(c2);
    return Noise{hn::MulAdd(hn::MulAdd(number(0.5), a1 + a2 * x, a2), x, hn::Abs(c0)), hn::MulAdd(a2, x, a1)};
  };
  const Noise of_n = size_of(n[0], n[1], n2);
  const Noise of_d = size_of(d[0], d1, d2);
  const V ne = hn::Abs(numerator.even.value);
  const V no = hn::Abs(numerator.odd.value);
  const V de = hn::Abs(denominator.even.value);
  const V dd = hn::Abs(denominator.odd.value);
  const V s2 = sine_squared.value;
  const V scale = one / hn::MulAdd(de, de, s2 * dd * dd);
  const V of_scale = scale * number(2.0) * hn::MulAdd(de, of_d.even, s2 * dd * of_d.odd);
  term.noise = {scale * (of_n.even * de + ne * of_d.even + s2 * (of_n.odd * dd + no * of_d.odd)) +
                    of_scale * hn::Abs(term.value.even.value),
                scale * (of_n.odd * de + no * of_d.even + of_n.even * dd + ne * of_d.odd) +
                    of_scale * hn::Abs(term.value.odd.value)};
  return term;
}

struct CrossoverAt {
  Jet phase;      // zero at the crossover
  Jet stiffness;  // K there
  V noise;        // of K, relative, in rounding units
  V inverse;      // |W|
  V rigid, mode;  // magnitudes of the mechanisms
};

HWY_INLINE OnCircleJet plus(const OnCircleJet& a, const OnCircleJet& b) { return {a.even + b.even, a.odd + b.odd}; }

HWY_INLINE CrossoverAt crossover_at(const KernelGroup& group, const V* row, V x) {
  const V one = number(1.0);
  const V half = number(0.5);
  const V quarter = number(0.25);
  const Jet sine_squared{hn::NegMulAdd(quarter * x, x, x), hn::NegMulAdd(half, x, one)};
  const V s2 = sine_squared.value;
  const TermAt rigid = term_at(row + rigid_n0, row + rigid_d0, true, x, sine_squared);
  OnCircleJet sum = rigid.value;
  Noise noise = rigid.noise;
  const auto add_noise = [&noise](const Noise& more, V times) HWY_ATTR {
    noise = {hn::MulAdd(times, more.even, noise.even), hn::MulAdd(times, more.odd, noise.odd)};
  };
  CrossoverAt at{};
  at.rigid = magnitude(rigid.value, s2);
  at.mode = number(0.0);
  TermAt mode{};
  if (group.two_bodies) {
    mode = term_at(row + mode_n0, row + mode_d0, true, x, sine_squared);
    sum = plus(sum, mode.value);
    add_noise(mode.noise, row[condition]);
    at.mode = magnitude(mode.value, s2);
  }
  if (group.lag) {
    const TermAt lag = term_at(row + lag_n0, row + lag_d0, false, x, sine_squared);
    const V residues[] = {row[rigid_residue], row[mode_residue]};
    const OnCircleJet of_rigid{scaled(residues[0], lag.value.even), scaled(residues[0], lag.value.odd)};
    const OnCircleJet of_mode{scaled(residues[1], lag.value.even), scaled(residues[1], lag.value.odd)};
    add_noise(lag.noise, (hn::Abs(residues[0]) + hn::Abs(residues[1])) * row[condition]);
    at.rigid = magnitude(plus(rigid.value, of_rigid), s2);
    sum = plus(sum, of_rigid);
    if (group.two_bodies) {
      at.mode = magnitude(plus(mode.value, of_mode), s2);
      sum = plus(sum, of_mode);
    }
  }
  if (group.delay_samples > 0) {
    const Jet cosine{hn::NegMulAdd(half, x, one), hn::Neg(half)};
    const V zero = number(0.0);
    OnCircleJet turn{cosine, {hn::Neg(one), zero}};  // 1/z = cos - j sin
    for (std::size_t i = 1; i < group.delay_samples; ++i) {
      turn = {turn.even * cosine + sine_squared * turn.odd, turn.odd * cosine - turn.even};
    }
    const V c = hn::Abs(turn.even.value);
    const V s = hn::Abs(turn.odd.value);
    const V size = number(static_cast<double>(group.delay_samples)) * magnitude(sum, s2);
    noise = {c * noise.even + s2 * s * noise.odd + size, c * noise.odd + s * noise.even + size * (c + s)};
    sum = {sum.even * turn.even - sine_squared * (sum.odd * turn.odd), sum.even * turn.odd + sum.odd * turn.even};
  }
  const Jet size = sum.even * sum.even + sine_squared * (sum.odd * sum.odd);
  const V scale = one / size.value;
  at.inverse = hn::Sqrt(scale);
  at.phase = scaled(number(-1.0), over(sum.odd, size));
  at.stiffness = scaled(number(-1.0), over(sum.even, size));
  const V of_size =
      number(2.0) * scale * (hn::Abs(sum.even.value) * noise.even + s2 * hn::Abs(sum.odd.value) * noise.odd);
  V of_phase = scale * noise.odd + of_size * hn::Abs(at.phase.value);
  V of_stiffness = scale * noise.even + of_size * hn::Abs(at.stiffness.value);
  if (group.damper) {
    const V c = row[damper_c];
    const Jet filter{hn::MulAdd(one - c, x, c * c), one - c};
    const V rate = row[damper_rate];
    const V real = rate * (one - half * c);
    const Jet along = over({real * x, real}, filter);
    const Jet across = over({rate * c, number(0.0)}, filter);
    at.stiffness = at.stiffness - along;
    at.phase = at.phase + across;
    of_stiffness = of_stiffness + number(4.0) * along.value;
    of_phase = of_phase + number(4.0) * across.value;
  }
  at.noise = (of_stiffness + of_phase * hn::Abs(at.stiffness.slope / at.phase.slope)) / hn::Abs(at.stiffness.value);
  return at;
}

// At z = -1: a real pole leaves there.
struct AtNyquist {
  V stiffness;        // K there, or any number <= 0 where there is none
  V least_stiffness;  // what it may be at least, rounding considered
  V noise;            // relative
  V rigid, mode;
};

HWY_INLINE AtNyquist at_nyquist(const KernelGroup& group, const V* row) {
  const V two = number(2.0);
  const V four = number(4.0);
  AtNyquist at{};
  const auto term = [&](std::size_t n, std::size_t d, bool second, V& noise) HWY_ATTR {
    const V n2 = second ? row[n + 2] : number(0.0);
    const V denominator = second ? (four - two * row[d + 1]) + row[d] : row[d] - two;
    noise = (hn::Abs(row[n]) + two * hn::Abs(row[n + 1]) + four * hn::Abs(n2)) / hn::Abs(denominator);
    return (row[n] - two * row[n + 1] + four * n2) / denominator;
  };
  V noise;
  V rigid = term(rigid_n0, rigid_d0, true, noise);
  V size = noise;
  V mode = number(0.0);
  if (group.two_bodies) {
    mode = term(mode_n0, mode_d0, true, noise);
    size = size + noise;
  }
  if (group.lag) {
    const V lag = term(lag_n0, lag_d0, false, noise);
    rigid = rigid + row[rigid_residue] * lag;
    mode = mode + row[mode_residue] * lag;
    size = size + noise * (hn::Abs(row[rigid_residue]) + hn::Abs(row[mode_residue]));
  }
  at.rigid = hn::Abs(rigid);
  at.mode = hn::Abs(mode);
  V plant = rigid + mode;
  if (group.delay_samples % 2 == 1) plant = hn::Neg(plant);
  const V rounding = number(1e-14) * row[condition] * size;
  V damper = number(0.0);
  if (group.damper) damper = row[damper_rate] * two / (two - row[damper_c]);
  at.stiffness = number(-1.0) / plant - damper;
  // Where the plant may be of either sign, K is as great as its size allows at least.
  at.least_stiffness = number(1.0) / (hn::Abs(plant) + rounding) - damper;
  const M surely_none = plant > rounding;
  at.least_stiffness = choose(surely_none, number(1e300), at.least_stiffness);
  at.noise = row[condition] * (size / hn::Abs(plant)) * ((hn::Abs(at.stiffness) + damper) / hn::Abs(at.stiffness));
  return at;
}

}  // namespace zwidth::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
