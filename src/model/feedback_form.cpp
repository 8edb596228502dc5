#include "model/feedback_form.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/found_poles.hpp"
#include "model/partial_fractions.hpp"
#include "model/pole_starts.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

// What the sum of terms may be off on the circle, relative: within the band, and at its end, where the terms cancel most.
constexpr double error_within = 1e-12;
constexpr double error_at_end = 1e-9;

template <typename Real>
struct ValueAndSlope {
  Complex<Real> value;
  Complex<Real> slope;
};

template <typename Real>
ValueAndSlope<Real> polynomial_at(const std::vector<Real>& p, const Complex<Real>& x) {
  ValueAndSlope<Real> result;
  for (std::size_t i = p.size(); i-- > 0;) {
    result.slope = result.slope * x + result.value;
    result.value = result.value * x;
    result.value.re += p[i];
  }
  return result;
}

template <typename Real>
Complex<Real> power(Complex<Real> base, std::size_t exponent) {
  Complex<Real> result(Real(1.0));
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result *= base;
    base *= base;
  }
  return result;
}

// As the pencils of pencil.hpp; open and fed_back without the roots at zero that they have in common.
template <typename Real>
struct FeedbackPencil {
  std::vector<Real> numerator;
  std::vector<Real> open;
  std::vector<Real> fed_back;
  std::size_t late = 0;
  Real at_once{0.0};
  Real lag{0.0};
  std::size_t zero_roots = 0;

  [[nodiscard]] Complex<Real> newton_step(const Complex<Real>& x) const {
    const auto [without, slope] = polynomial_at(open, x);
    const auto [fed, fed_slope] = polynomial_at(fed_back, x);
    Complex<Real> z = x;
    z.re += Real(1.0);
    if (late == 0) return (without + fed) / (slope + fed_slope);
    const Complex<Real> less = power(z, late - 1);
    const Complex<Real> turned = less * z;
    return (without * turned + fed) / (slope * turned + without * less * Real(static_cast<double>(late)) + fed_slope);
  }

  [[nodiscard]] Complex<Real> gain(const Complex<Real>& x) const {
    Complex<Real> z = x;
    z.re += Real(1.0);
    const Complex<Real> turned = power(z, late);
    Complex<Real> below = polynomial_at(open, x).value * turned + polynomial_at(fed_back, x).value;
    for (std::size_t i = 0; i < zero_roots; ++i) below *= x;
    Complex<Real> result = polynomial_at(numerator, x).value * turned / below;
    result.re -= at_once;
    return result;
  }
};

std::size_t roots_at_zero(const std::vector<Extended>& p) {
  const auto first = std::ranges::find_if(p, [](const Extended& c) { return leading(c) != 0.0; });
  return static_cast<std::size_t>(first - p.begin());
}

std::vector<double> rounded(const std::vector<Extended>& p) {
  std::vector<double> result;
  for (const Extended& c : p) result.push_back(leading(c));
  return result;
}

// The denominator in double, as one polynomial: for the search to begin with.
std::vector<double> rough_denominator(const FeedbackPencil<double>& pencil) {
  std::vector<double> result = pencil.open;
  for (std::size_t i = 0; i < pencil.late; ++i) {
    result.push_back(0.0);
    for (std::size_t k = result.size() - 1; k > 0; --k) result[k] += result[k - 1];
  }
  for (std::size_t k = 0; k < pencil.fed_back.size(); ++k) result[k] += pencil.fed_back[k];
  return result;
}

Complex<Extended> value_of(const ModalTerm& term, const Complex<Extended>& x) {
  Complex<Extended> numerator;
  Complex<Extended> denominator(Extended(1.0));
  for (std::size_t i = term.degree; i-- > 0;) {
    numerator = numerator * x;
    numerator.re += Extended(term.numerator[i]) + Extended(term.numerator_rest[i]);
    denominator = denominator * x;
    denominator.re += Extended(term.denominator[i]) + Extended(term.denominator_rest[i]);
  }
  return numerator / denominator;
}

struct ErrorOnCircle {
  double error = 0.0;
  double size = 0.0;  // of the loop
};

// Of the sum of the terms beside the loop, at z = e^{j angle}.
ErrorOnCircle error_at(const FeedbackForm& form, const FeedbackPencil<Extended>& pencil, double angle) {
  const double half = std::sin(0.5 * angle);
  const Complex<Extended> x(Extended(-2.0 * half * half), Extended(std::sin(angle)));
  Complex<Extended> whole = pencil.gain(x);
  Complex<Extended> error = Complex<Extended>() - whole;
  for (const ModalTerm& term : form.form.terms) error += value_of(term, x);
  whole.re += form.at_once;
  return {magnitude(error), magnitude(whole)};
}

bool add_up(const FeedbackForm& form, const FeedbackPencil<Extended>& pencil, double band) {
  const auto [error_at_band, size_at_band] = error_at(form, pencil, band);
  if (!(error_at_band <= error_at_end * size_at_band)) return false;
  for (double angle = 2.0 * band; angle < std::numbers::pi; angle *= 2.0) {
    if (!(error_at(form, pencil, angle).error <= error_at_end * size_at_band)) return false;
  }
  constexpr int octaves = 20;
  for (int octave = 1; octave <= octaves; ++octave) {
    const auto [error, size] = error_at(form, pencil, std::ldexp(band, -octave));
    if (!(error <= error_within * size)) return false;
  }
  return true;
}

}  // namespace

FeedbackForm feedback_form(const Feedback& loop, double band) {
  FeedbackForm result;
  if (loop.numerator.size() == loop.open.size()) result.at_once = loop.numerator.back();
  FeedbackPencil<Extended> extended;
  extended.zero_roots = std::min(roots_at_zero(loop.open), roots_at_zero(loop.fed_back));
  const auto without_roots = [&](const std::vector<Extended>& p) {
    return std::vector<Extended>(p.begin() + static_cast<std::ptrdiff_t>(extended.zero_roots), p.end());
  };
  extended.numerator = loop.numerator;
  extended.open = without_roots(loop.open);
  extended.fed_back = without_roots(loop.fed_back);
  extended.late = loop.late;
  extended.at_once = result.at_once;
  FeedbackPencil<double> pencil;
  pencil.numerator = rounded(extended.numerator);
  pencil.open = rounded(extended.open);
  pencil.fed_back = rounded(extended.fed_back);
  pencil.late = loop.late;
  pencil.zero_roots = extended.zero_roots;
  const std::vector<double> rough = rough_denominator(pencil);
  if (rough.size() > 1) result.poles = find_poles(pencil, extended, newton_polygon_start(rough));
  result.form = partial_fractions::expand(extended, result.poles, PoleLabels{});
  if (!add_up(result, extended, band)) {
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::poles_not_found});
  }
  return result;
}

}  // namespace zwidth::internal
