#include "model/rational_form.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/found_poles.hpp"
#include "model/partial_fractions.hpp"
#include "model/pencil.hpp"
#include "model/pole_starts.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

// What the sum of terms may be off on the circle, relative.
constexpr double quotient_error = 1e-12;

Complex<Extended> value_of(const std::vector<Extended>& polynomial, const Complex<Extended>& at) {
  Complex<Extended> value;
  for (std::size_t i = polynomial.size(); i-- > 0;) {
    value = value * at;
    value.re += polynomial[i];
  }
  return value;
}

Complex<Extended> value_of(const ModalTerm& term, const Complex<Extended>& at) {
  Complex<Extended> numerator;
  Complex<Extended> denominator(Extended(1.0));
  for (std::size_t i = term.degree; i-- > 0;) {
    numerator = numerator * at;
    numerator.re += Extended(term.numerator[i]) + Extended(term.numerator_rest[i]);
    denominator = denominator * at;
    denominator.re += Extended(term.denominator[i]) + Extended(term.denominator_rest[i]);
  }
  return numerator / denominator;
}

// Of the sum of the terms beside the quotient, the largest relative error at angles from 2^-20 pi to pi.
double largest_error(const ModalForm& form, const std::vector<Extended>& numerator,
                     const std::vector<Extended>& denominator) {
  double largest = 0.0;
  for (int octave = 0; octave <= 20; ++octave) {
    const double angle = std::ldexp(std::numbers::pi, -octave);
    const double half = std::sin(0.5 * angle);
    const Complex<Extended> at(Extended(-2.0 * half * half), Extended(std::sin(angle)));
    const Complex<Extended> quotient = value_of(numerator, at) / value_of(denominator, at);
    Complex<Extended> error = Complex<Extended>() - quotient;
    for (const ModalTerm& term : form.terms) error += value_of(term, at);
    largest = std::max(largest, magnitude(error) / magnitude(quotient));
  }
  return largest;
}

}  // namespace

RationalForm rational_form(std::vector<Extended> numerator, std::vector<Extended> denominator) {
  PolynomialPencil<Extended> extended;
  extended.numerator = numerator;
  const auto first = std::ranges::find_if(denominator, [](const Extended& c) { return leading(c) != 0.0; });
  extended.zero_roots = static_cast<std::size_t>(first - denominator.begin());
  extended.denominator.assign(first, denominator.end());
  PolynomialPencil<double> pencil;
  pencil.zero_roots = extended.zero_roots;
  for (const Extended& c : extended.numerator) pencil.numerator.push_back(leading(c));
  for (const Extended& c : extended.denominator) pencil.denominator.push_back(leading(c));
  RationalForm result;
  if (pencil.denominator.size() > 1) {
    result.poles = find_poles(pencil, extended, newton_polygon_start(pencil.denominator));
  }
  result.form = partial_fractions::expand(extended, result.poles, PoleLabels{});
  result.poles.resize(result.poles.size() + extended.zero_roots);
  if (!(largest_error(result.form, numerator, denominator) <= quotient_error)) {
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::poles_not_found});
  }
  return result;
}

}  // namespace zwidth::internal
