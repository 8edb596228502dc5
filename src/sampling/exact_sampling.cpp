#include "sampling/exact_sampling.hpp"

#include <cmath>

#include "model/balls.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

constexpr slong first_precision = 256;
constexpr slong last_precision = 8192;

std::optional<ExtendedTerm> sample_in_balls(const ModalTerm& term, const SamplingInstants& instants, slong precision) {
  const std::size_t n = term.degree;
  // Companion form with its input: d/dt (x, u) = [[A, e_n], [0, 0]] (x, u).
  BallMatrix generator(n + 1, n + 1);
  for (std::size_t i = 0; i + 1 < n; ++i) arb_one(generator(i, i + 1));
  for (std::size_t i = 0; i < n; ++i) {
    arb_neg(generator(n - 1, i), exact_ball(Extended(term.denominator[i]) + Extended(term.denominator_rest[i])));
  }
  arb_one(generator(n - 1, n));
  const auto exponential = [&](BallMatrix& result, double first, double second) {
    RealBall time;
    RealBall more;
    arb_set_d(time, first);
    arb_set_d(more, second);
    arb_add(time, time, more, precision);
    arb_mat_scalar_mul_arb(result, generator, time, precision);
    arb_mat_exp(result, result, precision);
  };
  BallMatrix whole(n + 1, n + 1);
  BallMatrix first(n + 1, n + 1);
  exponential(whole, instants.with_new, instants.with_old);
  exponential(first, instants.with_new, 0.0);
  BallMatrix phi(n, n);  // F - I
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) arb_set(phi(i, j), whole(i, j));
    arb_sub_ui(phi(i, i), phi(i, i), 1, precision);
  }
  RealBallPolynomial denominator;
  arb_mat_charpoly(denominator, phi, precision);

  // With h_k = c (F - I)^k g the numerator is the polynomial part of D(delta) sum h_k delta^-(k+1).
  const auto numerator_of = [&](auto input) {
    std::vector<RealBall> state(n);
    for (std::size_t i = 0; i < n; ++i) input(state[i], i);
    RealBallPolynomial numerator;
    RealBall response;
    RealBall sum;
    RealBall coefficient;
    for (std::size_t k = 0; k < n; ++k) {
      arb_zero(response);
      for (std::size_t i = 0; i < n; ++i) {
        arb_addmul(response, exact_ball(Extended(term.numerator[i]) + Extended(term.numerator_rest[i])), state[i],
                   precision);
      }
      for (std::size_t j = 0; j + k + 1 <= n; ++j) {
        arb_poly_get_coeff_arb(coefficient, denominator, static_cast<slong>(j + k + 1));
        arb_poly_get_coeff_arb(sum, numerator, static_cast<slong>(j));
        arb_addmul(sum, coefficient, response, precision);
        arb_poly_set_coeff_arb(numerator, static_cast<slong>(j), sum);
      }
      std::vector<RealBall> next(n);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) arb_addmul(next[i], phi(i, j), state[j], precision);
      state = next;
    }
    return numerator;
  };
  RealBallPolynomial numerator = numerator_of([&](arb_struct* value, std::size_t i) { arb_set(value, first(i, n)); });
  if (instants.with_old > 0.0) {  // (1 + delta) N_new + N_old
    const RealBallPolynomial old =
        numerator_of([&](arb_struct* value, std::size_t i) { arb_sub(value, whole(i, n), first(i, n), precision); });
    RealBallPolynomial shifted;
    arb_poly_shift_left(shifted, numerator, 1);
    arb_poly_add(numerator, numerator, shifted, precision);
    arb_poly_add(numerator, numerator, old, precision);
  }
  // Coefficients compare at the distance of the poles from z = 1.
  double scale = 0.0;
  RealBall coefficient;
  for (std::size_t i = 0; i < n; ++i) {
    arb_poly_get_coeff_arb(coefficient, denominator, static_cast<slong>(i));
    const double size = std::abs(arf_get_d(arb_midref(coefficient), ARF_RND_NEAR));
    scale = std::max(scale, std::pow(size, 1.0 / static_cast<double>(n - i)));
  }
  if (!(scale > 0.0) || !std::isfinite(scale)) scale = 1.0;
  const auto above = rounded_coefficients(numerator, n + 1, scale);
  const auto below = rounded_coefficients(denominator, n, scale);
  if (!above || !below) return std::nullopt;
  ExtendedTerm sampled{*above, *below};
  sampled.denominator.emplace_back(1.0);
  return sampled;
}

}  // namespace

ExtendedTerm sample_exactly(const ModalTerm& term, const SamplingInstants& instants) {
  for (slong precision = first_precision; precision <= last_precision; precision *= 2) {
    if (std::optional<ExtendedTerm> sampled = sample_in_balls(term, instants, precision)) return *sampled;
  }
  throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::response_not_computed});
}

}  // namespace zwidth::internal
