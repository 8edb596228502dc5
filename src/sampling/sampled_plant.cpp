#include "zwidth/sampling/sampled_plant.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sampling/cancellation.hpp"
#include "sampling/exact_sampling.hpp"
#include "sampling/extended_sampling.hpp"
#include "sampling/hold_integrals.hpp"
#include "sampling/plant_of_terms.hpp"
#include "sampling/sampling_instants.hpp"
#include "sampling/term_on_circle.hpp"
#include "sampling/unit_circle.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth {
using namespace internal;
namespace {

// n(s) = r, d(s) = s + d0: x[k+1] = q x + g1 u[k-l] + g2 u[k-l-1].
void sample_first_order(const ModalTerm& term, const SamplingInstants& split, SampledTerm& sampled) {
  const double pole = term.denominator[0];
  const double g1 = decay_integral(pole, split.with_new);
  sampled.denominator[0] = -std::expm1(-pole * (split.with_new + split.with_old));
  if (split.with_old == 0.0) {
    sampled.numerator[0] = term.numerator[0] * g1;
    return;
  }
  const double g2 = std::exp(-pole * split.with_new) * decay_integral(pole, split.with_old);
  sampled.numerator[1] = term.numerator[0] * g1;  // (z g1 + g2) = g1 delta + g1 + g2
  sampled.numerator[0] = term.numerator[0] * (g1 + g2);
}

// n(s) = r1 s + r0, d(s) = s² + c1 s + c0, in companion form: with g, h of the whole period
//   Phi = e^{AT} - I = [[-c0 g, h], [-c0 h, -(c1 h + c0 g)]]
//   det(delta I - Phi) = delta² + (2 c0 g + c1 h) delta + c0 (g (c1 h + c0 g) + h²)
// and for an input vector (p, v)
//   C adj(delta I - Phi) (p, v) = delta (r0 p + r1 v) + r0 (h v + (c1 h + c0 g) p) + r1 c0 (g v - h p).
void sample_second_order(const ModalTerm& term, const SamplingInstants& split, double period, SampledTerm& sampled) {
  const double c0 = term.denominator[0];
  const double c1 = term.denominator[1];
  const double r0 = term.numerator[0];
  const double r1 = term.numerator[1];
  const auto [h, g] = hold_integrals(c1, c0, period);
  const double q = c1 * h + c0 * g;  // 1 - h'
  sampled.denominator[1] = 2.0 * c0 * g + c1 * h;
  sampled.denominator[0] = c0 * (g * q + h * h);
  const double constant = r0 * (h * h + q * g);  // the r1 part vanishes for (p, v) = (g, h)
  if (split.with_old == 0.0) {
    sampled.numerator[1] = r0 * g + r1 * h;
    sampled.numerator[0] = constant;
    return;
  }
  const auto [h_new, g_new] = hold_integrals(c1, c0, split.with_new);
  const auto [h_old, g_old] = hold_integrals(c1, c0, split.with_old);
  // Gamma1 = (g_new, h_new), Gamma2 = e^{A (1-f) T} (g_old, h_old).
  const double p2 = (1.0 - c0 * g_new) * g_old + h_new * h_old;
  const double v2 = -c0 * h_new * g_old + (1.0 - c1 * h_new - c0 * g_new) * h_old;
  const double slope1 = r0 * g_new + r1 * h_new;
  const double slope2 = r0 * p2 + r1 * v2;
  const double constant1 = r0 * (h * h_new + q * g_new) + r1 * c0 * (g * h_new - h * g_new);
  // (1 + delta)(slope1 delta + constant1) + slope2 delta + constant2
  sampled.numerator[2] = slope1;
  sampled.numerator[1] = slope1 + constant1 + slope2;
  sampled.numerator[0] = constant;
}

bool is_seen(const ModalTerm& term) {
  return std::any_of(term.numerator, term.numerator + term.degree, [](double n) { return n != 0.0; });
}

// Whether rounding of the coefficients to double could move the poles noticeably towards or across the unit circle: they
// are cos and sin of an angle of wT, or its square where that is small, less a decay of c1 T.
bool is_near_circle(const ModalTerm& term, double period) {
  constexpr double kept = 1e-7;
  if (term.degree != 2 || term.integrators > 0) return false;
  const double angle_squared = term.denominator[0] * period * period;
  return std::abs(term.denominator[1]) * period <= kept * std::min(1.0, angle_squared) &&
         4.0 * term.denominator[0] > term.denominator[1] * term.denominator[1];
}

// What of the tracking's term stems from each mode.
void share_tracking(const ModalForm& form, const SamplingInstants& instants, SampledPlant& plant) {
  const auto tracking = std::ranges::find_if(form.terms, [](const ModalTerm& term) { return term.mode == -2; });
  if (tracking == form.terms.end() || tracking->degree != 2) return;
  auto sampled = plant.terms.begin();
  for (const ModalTerm& term : form.terms) {
    if (!is_seen(term)) continue;
    ModalTerm part = *tracking;
    std::copy_n(term.tracking_numerator, 2, part.numerator);
    SampledTerm of_part;
    sample_second_order(part, instants, plant.period, of_part);
    std::copy_n(of_part.numerator, 3, (sampled++)->tracking_numerator);
  }
}

// Fills in what rounding to double left out of the coefficients.
void keep_rests(const ModalForm& form, const SamplingInstants& instants, SampledPlant& plant) {
  auto sampled = plant.terms.begin();
  for (const ModalTerm& term : form.terms) {
    if (is_seen(term)) round_into(sample_precisely(term, instants), *sampled++);
  }
}

}  // namespace

SampledPlant sample(const ModalForm& form, Sampling sampling) {
  const SamplingInstants instants = sampling_instants(sampling);
  SampledPlant plant;
  plant.period = sampling.period;
  plant.delay_samples = instants.whole_samples + (instants.with_old > 0.0 ? 1U : 0U);
  plant.terms.reserve(form.terms.size());
  bool crowded = false;
  bool near_circle = false;
  double lag_numerator = 0.0;
  for (const ModalTerm& term : form.terms)
    if (term.mode == -1) lag_numerator = term.numerator[0];
  for (const ModalTerm& term : form.terms) {
    if (!is_seen(term)) continue;
    SampledTerm sampled;
    sampled.degree = term.degree;
    sampled.mode = term.mode;
    sampled.integrators = term.integrators;
    sampled.unstable_poles = term.unstable_poles;
    sampled.undamped_pairs = term.undamped_pairs;
    sampled.undamped_angle =
        std::abs(std::remainder(term.undamped_frequency * sampling.period, 2.0 * std::numbers::pi));
    if (lag_numerator != 0.0) sampled.lag_share = term.lag_numerator / lag_numerator;
    if (term.degree == 1) {
      sample_first_order(term, instants, sampled);
    } else if (is_near_circle(term, sampling.period)) {
      round_into(sample_extended(term, instants), sampled);
      near_circle = true;
    } else if (term.degree == 2) {
      sample_second_order(term, instants, sampling.period, sampled);
    } else {
      round_into(sample_exactly(term, instants), sampled);
      crowded = true;
    }
    check_range(sampled);
    plant.terms.push_back(sampled);
  }
  share_tracking(form, instants, plant);
  // Near an antiresonance between modes the terms cancel too. As products of small factors they tell more of an interval
  // than one polynomial does, as long as their own digits suffice.
  const double at_poles = crowded || plant.terms.size() > 2 ? cancellation_at_poles(plant) : 1.0;
  crowded = at_poles > carried_cancellation;
  const bool sum_cancels = plant.terms.size() > 1 && (crowded || worst_cancellation(plant) > tolerable_cancellation);
  if (!sum_cancels && at_poles > tolerable_cancellation) keep_rests(form, instants, plant);
  const bool nyquist_cancels = cancellation_at_nyquist(plant) > tolerable_cancellation_at_nyquist;
  if (sum_cancels || nyquist_cancels) {
    std::vector<ExtendedTerm> terms;
    for (const ModalTerm& term : form.terms)
      if (is_seen(term)) terms.push_back(sample_precisely(term, instants));
    if (sum_cancels) {
      add_up(terms, crowded || near_circle || terms.size() > rounded_terms, plant);
    }
    plant.at_nyquist = response_at_nyquist(terms, plant.delay_samples);
  }
  return plant;
}

SampledPlant sampled_plant(const Device& device) {
  return sample(modal_form(device), {device.loop().sampling_period, device.loop().delay});
}

FilteredPlant filtered_plant(SampledPlant plant, const std::vector<WallFilter>& filters) {
  return filtered_plant(FilteredPlant(std::move(plant)), filters);
}

FilteredPlant filtered_plant(FilteredPlant plant, const std::vector<WallFilter>& filters) {
  for (const WallFilter& filter : filters) plant.filters.push_back(filter_section(filter, plant.period));
  return plant;
}

FilteredPlant filtered_plant(const Device& device) {
  require_one_rate(device);
  return filtered_plant(sampled_plant(device), device.parameters().wall.filters);
}

std::complex<double> filter_response(const FilteredPlant& plant, double angle) {
  std::complex<double> product = 1.0;
  for (const FilterSection& section : plant.filters) product *= response(section, angle);
  return product;
}

std::complex<double> response(const SampledTerm& term, double angle) {
  const CirclePoint<double> point = circle_point(angle);
  const OnCircle<double> numerator = numerator_of(term, point);
  const OnCircle<double> denominator = denominator_of(term, 0, point);
  const OnCircle<double> product = multiply(numerator, conj(denominator), point);
  const double scale = 1.0 / squared_magnitude(denominator, point);
  return {product.even * scale, product.odd * std::sin(angle) * scale};
}

std::complex<double> response(const SampledPlant& plant, double frequency) {
  const double angle = frequency * plant.period;
  if (plant.at_nyquist && angle >= std::numbers::pi) return *plant.at_nyquist;
  std::complex<double> sum = 0.0;
  if (plant.numerator.empty()) {
    for (const SampledTerm& term : plant.terms) sum += response(term, angle);
  } else {
    const CirclePoint<double> point = circle_point(angle);
    const OnCircle<double> numerator = sum_of_numerators(plant, point);
    sum = {numerator.even, numerator.odd * std::sin(angle)};
    for (const SampledTerm& term : plant.terms) {
      const OnCircle<double> denominator = denominator_of(term, 0, point);
      sum /= std::complex<double>(denominator.even, denominator.odd * std::sin(angle));
    }
  }
  return sum * std::polar(1.0, -static_cast<double>(plant.delay_samples) * angle);
}

std::complex<double> response(const FilteredPlant& plant, double frequency) {
  const SampledPlant& unfiltered = plant;
  return response(unfiltered, frequency) * filter_response(plant, frequency * plant.period);
}

}  // namespace zwidth
