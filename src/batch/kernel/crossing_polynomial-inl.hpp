// The phase condition as a polynomial in x = |z - 1|², one device per lane. Included once per instruction set.
//
//     f(x) = |delta + c|² Im[z^L D conj S]/sin + B (c²/T) |S|²
//
// of stability/gain_locus.hpp. With delta conj(delta) = x, delta^m = e_m(x) + j sin u_m(x), D = sum of d_i delta^i and
// S = sum of s_i delta^i
//
//     Im[D conj S]/sin = sum_m u_m sum_j x^j (d_{j+m} s_j - d_j s_{j+m}),   Re[D conj S] likewise with e_m and a sum
#if defined(ZWIDTH_BATCH_CROSSING_POLYNOMIAL_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ZWIDTH_BATCH_CROSSING_POLYNOMIAL_INL_HPP
#undef ZWIDTH_BATCH_CROSSING_POLYNOMIAL_INL_HPP
#else
#define ZWIDTH_BATCH_CROSSING_POLYNOMIAL_INL_HPP
#endif

#include <algorithm>

#include "batch/kernel/kernel_terms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace zwidth::internal::HWY_NAMESPACE {

// Most coefficients: of delta^5 with its power of z, twelve samples of delay, and the damper.
inline constexpr std::size_t most_coefficients = 20;

// Coefficients by rising powers, each with the sum of the sizes of what was added up in it.
struct SizedPolynomial {
  std::size_t count = 0;
  V value[most_coefficients];
  V size[most_coefficients];

  HWY_INLINE void add(std::size_t power, V term, V term_size) {
    for (; count <= power; ++count) value[count] = size[count] = number(0.0);
    value[power] = value[power] + term;
    size[power] = size[power] + term_size;
  }
};

HWY_INLINE SizedPolynomial of_rows(const V* rows, std::size_t count, bool monic) {
  SizedPolynomial p;
  for (std::size_t i = 0; i < count; ++i) p.add(i, rows[i], hn::Abs(rows[i]));
  if (monic) p.add(count, number(1.0), number(1.0));
  return p;
}

HWY_INLINE void add_product(const SizedPolynomial& a, const SizedPolynomial& b, SizedPolynomial& sum) {
  for (std::size_t i = 0; i < a.count; ++i) {
    for (std::size_t j = 0; j < b.count; ++j) sum.add(i + j, a.value[i] * b.value[j], a.size[i] * b.size[j]);
  }
}

HWY_INLINE SizedPolynomial product(const SizedPolynomial& a, const SizedPolynomial& b) {
  SizedPolynomial p;
  add_product(a, b, p);
  return p;
}

// Plain numbers, the same for every device: even + j sin odd of a power, as polynomials in x.
struct PowerOnCircle {
  std::size_t count = 1;  // of coefficients of both
  double even[most_coefficients] = {1.0};
  double odd[most_coefficients] = {};
};

// times factor, whose even part is c0 + c1 x and whose odd part is 1: sin² = x - x²/4
HWY_INLINE PowerOnCircle times(const PowerOnCircle& p, double c0, double c1) {
  PowerOnCircle result;
  result.count = std::min(p.count + 1, most_coefficients);
  for (std::size_t i = 0; i < result.count; ++i) {
    result.even[i] =
        c0 * p.even[i] + (i > 0 ? c1 * p.even[i - 1] - p.odd[i - 1] : 0.0) + (i > 1 ? 0.25 * p.odd[i - 2] : 0.0);
    result.odd[i] = p.even[i] + c0 * p.odd[i] + (i > 0 ? c1 * p.odd[i - 1] : 0.0);
  }
  return result;
}

// Of the powers that the polynomial of a group is made of.
struct GroupPowers {
  static constexpr std::size_t most_order = 5;  // of the plant's denominator
  PowerOnCircle of_delta[most_order + 1];
  PowerOnCircle of_delay;  // z^L
};

HWY_INLINE GroupPowers powers_of(const KernelGroup& group) {
  GroupPowers powers;
  for (std::size_t m = 1; m <= GroupPowers::most_order; ++m) {
    powers.of_delta[m] = times(powers.of_delta[m - 1], 0.0, -0.5);
  }
  for (std::size_t i = 0; i < group.delay_samples; ++i) powers.of_delay = times(powers.of_delay, 1.0, -0.5);
  return powers;
}

HWY_INLINE void add_scaled(const double* factors, std::size_t count, const SizedPolynomial& p, SizedPolynomial& sum) {
  for (std::size_t i = 0; i < count; ++i) {
    if (factors[i] == 0.0) continue;
    const V factor = number(factors[i]);
    const V size = hn::Abs(factor);
    for (std::size_t j = 0; j < p.count; ++j) sum.add(i + j, factor * p.value[j], size * p.size[j]);
  }
}

// sum_j x^j (a_{j+m} b_j + sign a_j b_{j+m}); of m = 0 the first alone
HWY_INLINE SizedPolynomial correlation(const SizedPolynomial& a, const SizedPolynomial& b, std::size_t m, double sign) {
  SizedPolynomial p;
  const V factor = number(sign);
  for (std::size_t j = 0; j < a.count || j < b.count; ++j) {
    if (j < b.count && j + m < a.count) p.add(j, a.value[j + m] * b.value[j], a.size[j + m] * b.size[j]);
    if (m == 0 || j >= a.count || j + m >= b.count) continue;
    p.add(j, factor * a.value[j] * b.value[j + m], a.size[j] * b.size[j + m]);
  }
  return p;
}

struct PlantPolynomials {
  SizedPolynomial s, d;
};

HWY_INLINE PlantPolynomials plant_of(const KernelGroup& group, const Terms& terms) {
  const std::size_t numerator = group.fractional ? 3 : 2;
  PlantPolynomials plant{of_rows(terms.row + rigid_n0, numerator, false), of_rows(terms.row + rigid_d0, 2, true)};
  if (group.two_bodies) {
    const SizedPolynomial n = of_rows(terms.row + mode_n0, numerator, false);
    const SizedPolynomial d = of_rows(terms.row + mode_d0, 2, true);
    SizedPolynomial s = product(plant.s, d);
    add_product(n, plant.d, s);
    plant = {s, product(plant.d, d)};
  }
  if (group.lag) {
    SizedPolynomial n = of_rows(terms.row + lag_n0, group.fractional ? 2 : 1, false);
    const V residue = terms.row[rigid_residue] + terms.row[mode_residue];
    for (std::size_t i = 0; i < n.count; ++i) {
      n.value[i] = n.value[i] * residue;
      n.size[i] = n.size[i] * (hn::Abs(terms.row[rigid_residue]) + hn::Abs(terms.row[mode_residue]));
    }
    const SizedPolynomial d = of_rows(terms.row + lag_d0, 1, true);
    SizedPolynomial s = product(plant.s, d);
    add_product(n, plant.d, s);
    plant = {s, product(plant.d, d)};
  }
  return plant;
}

HWY_INLINE SizedPolynomial crossing_polynomial(const KernelGroup& group, const GroupPowers& powers,
                                               const Terms& terms) {
  const PlantPolynomials plant = plant_of(group, terms);
  SizedPolynomial even;
  SizedPolynomial odd;
  SizedPolynomial seen;  // |S|²
  for (std::size_t m = 0; m < plant.d.count; ++m) {
    const PowerOnCircle& power = powers.of_delta[m];
    if (m > 0) add_scaled(power.odd, power.count, correlation(plant.d, plant.s, m, -1.0), odd);
    if (group.delay_samples > 0) add_scaled(power.even, power.count, correlation(plant.d, plant.s, m, 1.0), even);
    if (group.damper && m < plant.s.count) {
      add_scaled(power.even, power.count, correlation(plant.s, plant.s, m, 1.0), seen);
    }
  }
  SizedPolynomial f;
  add_scaled(powers.of_delay.even, powers.of_delay.count, odd, f);
  add_scaled(powers.of_delay.odd, powers.of_delay.count, even, f);
  if (group.damper) {
    const V c = terms.row[damper_c];
    if (group.filter) {
      const V rest = number(1.0) - c;
      SizedPolynomial factor;
      factor.add(0, c * c, c * c);
      factor.add(1, rest, hn::Abs(rest));
      f = product(f, factor);
    }
    const V scale = terms.row[damper_rate] * c;
    for (std::size_t i = 0; i < seen.count; ++i) f.add(i, scale * seen.value[i], scale * seen.size[i]);
  }
  return f;
}

}  // namespace zwidth::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
