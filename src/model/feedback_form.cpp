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

// Its value alone, two products a coefficient: p mod (t² - 2 t Re x + |x|²) at x.
template <typename Real>
Complex<Real> value_at(const std::vector<Real>& p, const Complex<Real>& x) {
  const Real twice = x.re + x.re;
  const Real squared = x.re * x.re + x.im * x.im;
  Real slope(0.0);
  Real before(0.0);
  for (std::size_t i = p.size(); i-- > 1;) {
    const Real next = p[i] + twice * slope - squared * before;
    before = slope;
    slope = next;
  }
  return {p[0] + x.re * slope - squared * before, x.im * slope};
}

template <typename Real>
Complex<Real> power(Complex<Real> base, std::size_t exponent) {
  Complex<Real> result(Real(1.0));
  bool is_first = true;
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result = is_first ? base : result * base;
    is_first = is_first && exponent % 2 == 0;
    if (exponent > 1) base *= base;
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
  DrivePath drive;  // none
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
    Complex<Real> below = value_at(open, x) * turned + value_at(fed_back, x);
    for (std::size_t i = 0; i < zero_roots; ++i) below *= x;
    Complex<Real> result = value_at(numerator, x) * turned / below;
    result.re -= at_once;
    return result;
  }
};

std::size_t roots_at_zero(const std::vector<Extended>& p) {
  const auto first = std::ranges::find_if(p, [](const Extended& c) { return leading(c) != 0.0; });
  return static_cast<std::size_t>(first - p.begin());
}

template <typename Real>
Real rounded_to(const Extended& c) {
  return Real(c.x[0]) + Real(c.x[1]);
}

template <typename Real>
FeedbackPencil<Real> rounded(const FeedbackPencil<Extended>& exact) {
  const auto all = [](const std::vector<Extended>& p) {
    std::vector<Real> result;
    result.reserve(p.size());
    for (const Extended& c : p) result.push_back(rounded_to<Real>(c));
    return result;
  };
  FeedbackPencil<Real> pencil;
  pencil.numerator = all(exact.numerator);
  pencil.open = all(exact.open);
  pencil.fed_back = all(exact.fed_back);
  pencil.late = exact.late;
  pencil.at_once = rounded_to<Real>(exact.at_once);
  pencil.zero_roots = exact.zero_roots;
  return pencil;
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

template <typename Real>
Complex<Real> value_of(const ModalTerm& term, const Complex<Real>& x) {
  Complex<Real> numerator;
  Complex<Real> denominator(Real(1.0));
  for (std::size_t i = term.degree; i-- > 0;) {
    numerator = numerator * x;
    numerator.re += Real(term.numerator[i]) + Real(term.numerator_rest[i]);
    denominator = denominator * x;
    denominator.re += Real(term.denominator[i]) + Real(term.denominator_rest[i]);
  }
  return numerator / denominator;
}

double rounded_size(const Complex<long double>& a) { return static_cast<double>(std::hypot(a.re, a.im)); }
double rounded_size(const Complex<Extended>& a) { return magnitude(a); }

struct ErrorOnCircle {
  double error = 0.0;
  double size = 0.0;  // of the loop
};

// Of the sum of the terms beside the loop, at z = e^{j angle}.
template <typename Real>
ErrorOnCircle error_at(const FeedbackForm& form, const FeedbackPencil<Real>& pencil, double angle) {
  const double half = std::sin(0.5 * angle);
  const Complex<Real> x(Real(-2.0 * half * half), Real(std::sin(angle)));
  Complex<Real> whole = pencil.gain(x);
  Complex<Real> error = Complex<Real>() - whole;
  for (const ModalTerm& term : form.form.terms) error += value_of(term, x);
  whole.re += pencil.at_once;
  return {rounded_size(error), rounded_size(whole)};
}

template <typename Real>
bool add_up(const FeedbackForm& form, const FeedbackPencil<Real>& pencil, double band) {
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
  const auto pencil = rounded<double>(extended);
  const std::vector<double> rough = rough_denominator(pencil);
  if (rough.size() > 1) result.poles = find_poles(pencil, extended, newton_polygon_start(rough));
  result.form = partial_fractions::expand(extended, result.poles, PoleLabels{});
  // Rounding of long double is far below what the terms may be off, unless they cancel.
  if (!add_up(result, rounded<long double>(extended), band) && !add_up(result, extended, band)) {
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::poles_not_found});
  }
  return result;
}

}  // namespace zwidth::internal
