#include "model/exact_poles.hpp"

#include <acb_poly.h>
#include <flint/fmpz_poly_factor.h>

#include <algorithm>

namespace zwidth::internal {
namespace {

// The roots of a squarefree p, none of them 0, in balls that are apart with proof. False where the bits do not suffice.
// Arb's own arb_fmpz_poly_complex_roots doubles its bits without end once two approximations of 32 bits have met, as they
// do where the roots' magnitudes span more.
bool isolate(acb_ptr roots, const IntegerPolynomial& p, slong precision) {
  constexpr slong first_bits = 64;
  constexpr slong last_bits = 4 * most_precision;
  const slong degree = fmpz_poly_degree(p);
  const auto all = [&](auto holds) { return std::all_of(roots, roots + degree, holds); };
  ComplexBallPolynomial balls;
  bool go_on = false;
  for (slong bits = first_bits; bits <= last_bits; bits *= 2) {
    acb_poly_set_fmpz_poly(balls, p, bits);
    const slong most_iterations = std::min(4 * degree + 64, bits);
    const slong isolated = acb_poly_find_roots(roots, balls, go_on ? roots : nullptr, most_iterations, bits);
    go_on = all([](const acb_struct& root) { return acb_is_finite(&root) != 0; });
    if (isolated < degree) continue;
    if (!all([&](const acb_struct& root) { return acb_rel_accuracy_bits(&root) >= precision; })) continue;
    if (acb_poly_validate_real_roots(roots, balls, bits) == 0) continue;
    for (slong i = 0; i < degree; ++i) {
      if (arb_contains_zero(acb_imagref(roots + i)) != 0) arb_zero(acb_imagref(roots + i));
    }
    return true;
  }
  return false;
}

}  // namespace

std::optional<std::vector<ExactPole>> find_poles(const IntegerPolynomial& p, slong precision) {
  fmpz_poly_factor_t factors;
  fmpz_poly_factor_init(factors);
  fmpz_poly_factor_squarefree(factors, p);
  std::vector<ExactPole> poles;
  bool are_isolated = true;
  for (slong k = 0; k < factors->num && are_isolated; ++k) {
    IntegerPolynomial factor;
    fmpz_poly_set(factor, factors->p + k);
    if (fmpz_poly_length(factor) > 1 && fmpz_is_zero(fmpz_poly_get_coeff_ptr(factor, 0))) {
      poles.push_back({{}, factors->exp[k], true, {}});
      fmpz_poly_shift_right(factor, factor, 1);
    }
    const slong degree = fmpz_poly_degree(factor);
    if (degree < 1) continue;
    acb_ptr roots = _acb_vec_init(degree);
    are_isolated = isolate(roots, factor, precision);
    for (slong i = 0; i < degree && are_isolated; ++i) {
      ExactPole pole;
      acb_set(pole.at, roots + i);
      pole.multiplicity = factors->exp[k];
      pole.is_real = arb_is_zero(acb_imagref(roots + i)) != 0;
      pole.rounded = {rounded(acb_realref(roots + i)), rounded(acb_imagref(roots + i))};
      if (pole.is_real || arb_is_positive(acb_imagref(roots + i))) poles.push_back(pole);
    }
    _acb_vec_clear(roots, degree);
  }
  fmpz_poly_factor_clear(factors);
  if (!are_isolated) return std::nullopt;
  return poles;
}

const std::optional<std::vector<ExactPole>>& KnownPoles::of(const IntegerPolynomial& p, slong precision) {
  for (const Known& each : known_) {
    if (each.precision == precision && fmpz_poly_equal(each.p, p) != 0) return each.poles;
  }
  known_.push_back({p, precision, find_poles(p, precision)});
  return known_.back().poles;
}

}  // namespace zwidth::internal
