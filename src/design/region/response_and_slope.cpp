#include "design/region/response_and_slope.hpp"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include "sampling/term_on_circle.hpp"

namespace zwidth::internal {
namespace {

using Phasor = std::complex<double>;

constexpr double at_nyquist = 1e-14;  // of the half angle

// leading delta^count + ... + c[0], and its slope over delta.
ResponseAndSlope polynomial_and_slope(const double* c, std::size_t count, double leading, Phasor delta) {
  double re = leading;
  double im = 0.0;
  double slope_re = 0.0;
  double slope_im = 0.0;
  for (std::size_t i = count; i-- > 0;) {
    const double turned = slope_re * delta.real() - slope_im * delta.imag() + re;
    slope_im = slope_re * delta.imag() + slope_im * delta.real() + im;
    slope_re = turned;
    const double next = re * delta.real() - im * delta.imag() + c[i];
    im = re * delta.imag() + im * delta.real();
    re = next;
  }
  return {{re, im}, {slope_re, slope_im}};
}

// Of N/D over delta.
ResponseAndSlope quotient_and_slope(const ResponseAndSlope& numerator, const ResponseAndSlope& denominator) {
  const Phasor value = quotient(numerator.value, denominator.value);
  return {value, quotient(numerator.slope - value * denominator.slope, denominator.value)};
}

// The delay left out, over delta.
ResponseAndSlope undelayed(const SampledPlant& plant, Phasor delta) {
  ResponseAndSlope sum;
  if (plant.numerator.empty()) {
    for (const SampledTerm& term : plant.terms) {
      const ResponseAndSlope each =
          quotient_and_slope(polynomial_and_slope(term.numerator, term.degree, term.numerator[term.degree], delta),
                             polynomial_and_slope(term.denominator, term.degree, 1.0, delta));
      sum.value += each.value;
      sum.slope += each.slope;
    }
    return sum;
  }
  sum = polynomial_and_slope(plant.numerator.data(), plant.numerator.size() - 1, plant.numerator.back(), delta);
  for (const SampledTerm& term : plant.terms) {
    sum = quotient_and_slope(sum, polynomial_and_slope(term.denominator, term.degree, 1.0, delta));
  }
  return sum;
}

// Whether double does not hold the coefficients.
bool has_rests(const SampledPlant& plant) {
  return !plant.numerator_rest.empty() || std::ranges::any_of(plant.terms, keeps_rests);
}

// z^-delay
Phasor delay_of(std::size_t samples, Phasor back) {
  Phasor result = 1.0;
  for (; samples > 0; samples /= 2) {
    if (samples % 2 == 1) result *= back;
    back *= back;
  }
  return result;
}

}  // namespace

ResponseAndSlope response_and_slope(const SampledPlant& plant, const HalfTurn& turn) {
  const Phasor delta = turn.delta();
  const Phasor turning = Phasor(0.0, 1.0) * (1.0 + delta);  // d delta/d angle
  const auto samples = static_cast<double>(plant.delay_samples);
  ResponseAndSlope result = undelayed(plant, delta);
  const Phasor late = delay_of(plant.delay_samples, turn.back());
  result.slope = (result.slope * turning - Phasor(0.0, samples) * result.value) * late;
  result.value *= late;
  const bool is_nyquist = plant.at_nyquist && std::abs(turn.cosine) < at_nyquist;
  if (is_nyquist) {
    result.value = *plant.at_nyquist;
  } else if (has_rests(plant)) {
    const double angle = 2.0 * std::atan2(turn.sine, std::abs(turn.cosine));  // below pi
    const Phasor upper = response(plant, angle / plant.period);
    result.value = turn.cosine < 0.0 ? std::conj(upper) : upper;
  }
  return result;
}

ResponseAndSlope velocity_and_slope(double filter_pole, double period, const HalfTurn& turn) {
  const double gain = (1.0 - filter_pole) / period;
  if (filter_pole == 0.0) return {gain * turn.one_minus_back(), Phasor(0.0, gain) * turn.back()};
  const Phasor back = turn.back();
  const Phasor below = 1.0 - filter_pole * back;
  const Phasor value = quotient(gain * turn.one_minus_back(), below);
  // d(1/z)/d angle = -j/z
  return {value, quotient(Phasor(0.0, gain * (1.0 - filter_pole)) * back, below * below)};
}

}  // namespace zwidth::internal
