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

#include "batch/kernel_terms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace zwidth::internal {
namespace HWY_NAMESPACE {

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

// A term, what a rigid body or mode makes of it, and its size times the rounding that it carries.
struct TermAt {
  OnCircleJet value;
  V noise;
};

HWY_INLINE TermAt term_at(const V* n, const V* d, bool second, V x, const Jet& sine_squared) {
  const V zero = number(0.0);
  const V one = number(1.0);
  const V r = hn::Sqrt(x);
  const OnCircleJet numerator = polynomial_at(n[0], n[1], second ? n[2] : zero, x);
  const OnCircleJet denominator = polynomial_at(d[0], second ? d[1] : one, second ? one : zero, x);
  TermAt term{quotient(numerator, denominator, sine_squared), zero};
  const V size_d = hn::Abs(d[0]) + (second ? (hn::Abs(d[1]) + r) * r : r);
  const V size_n = hn::Abs(n[0]) + r * (hn::Abs(n[1]) + (second ? r * hn::Abs(n[2]) : zero));
  const V of_d = magnitude(denominator, sine_squared.value);
  term.noise = (magnitude(term.value, sine_squared.value) * (of_d + size_d) + size_n) / of_d;
  return term;
}

struct CrossoverAt {
  Jet phase;      // zero at the crossover
  Jet stiffness;  // K there
  V plant_noise;  // of P, relative, in rounding units
  V inverse;      // |W|
  V rigid, mode;  // magnitudes of the mechanisms
};

HWY_INLINE CrossoverAt crossover_at(const KernelGroup& group, const V* row, V x) {
  const V one = number(1.0);
  const V half = number(0.5);
  const V quarter = number(0.25);
  const Jet sine_squared{hn::NegMulAdd(quarter * x, x, x), hn::NegMulAdd(half, x, one)};
  const TermAt rigid = term_at(row + rigid_n0, row + rigid_d0, true, x, sine_squared);
  OnCircleJet sum = rigid.value;
  V noise = rigid.noise;
  CrossoverAt at{};
  at.rigid = magnitude(rigid.value, sine_squared.value);
  at.mode = number(0.0);
  TermAt mode{};
  if (group.two_bodies) {
    mode = term_at(row + mode_n0, row + mode_d0, true, x, sine_squared);
    sum = {sum.even + mode.value.even, sum.odd + mode.value.odd};
    noise = noise + mode.noise;
    at.mode = magnitude(mode.value, sine_squared.value);
  }
  if (group.lag) {
    const TermAt lag = term_at(row + lag_n0, row + lag_d0, false, x, sine_squared);
    const V residues[] = {row[rigid_residue], row[mode_residue]};
    const OnCircleJet of_rigid{scaled(residues[0], lag.value.even), scaled(residues[0], lag.value.odd)};
    const OnCircleJet of_mode{scaled(residues[1], lag.value.even), scaled(residues[1], lag.value.odd)};
    noise = noise + lag.noise * (hn::Abs(residues[0]) + hn::Abs(residues[1]));
    at.rigid = magnitude({rigid.value.even + of_rigid.even, rigid.value.odd + of_rigid.odd}, sine_squared.value);
    sum = {sum.even + of_rigid.even, sum.odd + of_rigid.odd};
    if (group.two_bodies) {
      at.mode = magnitude({mode.value.even + of_mode.even, mode.value.odd + of_mode.odd}, sine_squared.value);
      sum = {sum.even + of_mode.even, sum.odd + of_mode.odd};
    }
  }
  const Jet cosine{hn::NegMulAdd(half, x, one), hn::Neg(half)};
  for (std::size_t i = 0; i < group.delay_samples; ++i) {  // times 1/z = cos - j sin
    sum = {sum.even * cosine + sine_squared * sum.odd, sum.odd * cosine - sum.even};
  }
  const Jet size = sum.even * sum.even + sine_squared * (sum.odd * sum.odd);
  const V size_of_plant = hn::Sqrt(size.value);
  at.plant_noise = noise * row[condition] / size_of_plant + number(static_cast<double>(group.delay_samples));
  at.inverse = one / size_of_plant;
  at.phase = scaled(number(-1.0), over(sum.odd, size));
  at.stiffness = scaled(number(-1.0), over(sum.even, size));
  if (group.damper) {
    const V c = row[damper_c];
    const Jet filter{hn::MulAdd(one - c, x, c * c), one - c};
    const V rate = row[damper_rate];
    const V real = rate * (one - half * c);
    at.stiffness = at.stiffness - over({real * x, real}, filter);
    at.phase = at.phase + over({rate * c, number(0.0)}, filter);
  }
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

}  // namespace HWY_NAMESPACE
}  // namespace zwidth::internal
HWY_AFTER_NAMESPACE();
#endif
