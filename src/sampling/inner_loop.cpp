#include "sampling/inner_loop.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "model/feedback_form.hpp"
#include "sampling/decimation.hpp"
#include "sampling/extended_sampling.hpp"
#include "sampling/plant_of_terms.hpp"
#include "sampling/sampling_instants.hpp"

namespace zwidth::internal {
namespace {

using PolynomialX = std::vector<Extended>;  // of delta, by rising powers

PolynomialX product(const PolynomialX& a, const PolynomialX& b) {
  PolynomialX result(a.size() + b.size() - 1, Extended(0.0));
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  return result;
}

void drop_leading_zeros(PolynomialX& p) {
  while (p.size() > 1 && leading(p.back()) == 0.0) p.pop_back();
}

// z^-samples numerator/denominator, of the whole device.
struct Response {
  PolynomialX numerator;
  PolynomialX denominator{Extended(1.0)};
  std::size_t samples = 0;
};

Response sampled_response(const ModalForm& form, const Sampling& sampling) {
  const SamplingInstants instants = sampling_instants(sampling);
  std::vector<ExtendedTerm> terms;
  Response response;
  for (const ModalTerm& term : form.terms) {
    if (std::all_of(term.numerator, term.numerator + term.degree, [](double n) { return n == 0.0; })) continue;
    terms.push_back(sample_precisely(term, instants));
    std::fill_n(terms.back().denominator.begin(), term.integrators, Extended(0.0));
    response.denominator = product(response.denominator, terms.back().denominator);
  }
  response.numerator = extended_common_numerator(terms);
  drop_leading_zeros(response.numerator);
  response.samples = instants.whole_samples + (instants.with_old > 0.0 ? 1U : 0U);
  return response;
}

ExtendedTerm extended_term(const ModalTerm& term) {
  ExtendedTerm result;
  for (std::size_t i = 0; i < term.degree; ++i) {
    result.numerator.push_back(Extended(term.numerator[i]) + Extended(term.numerator_rest[i]));
    result.denominator.push_back(Extended(term.denominator[i]) + Extended(term.denominator_rest[i]));
  }
  result.denominator.emplace_back(1.0);
  return result;
}

int poles_outside(const std::vector<Complex<Extended>>& poles) {
  return static_cast<int>(std::ranges::count_if(poles, [](const Complex<Extended>& pole) {
    return leading(Extended(2.0) * pole.re + pole.re * pole.re + pole.im * pole.im) > 0.0;
  }));
}

// The closed inner loop from the outer force to the position, z^-samples apart.
struct ClosedInner {
  Feedback loop;
  std::size_t samples = 0;
};

ClosedInner closed_inner(const ModalForm& form, const Sampling& outer, const InnerLoop& inner) {
  const Response by_outer = sampled_response(form, outer);
  const bool is_as_late = outer.delay == inner.sampling.delay && outer.period == inner.sampling.period;
  const Response by_inner = is_as_late ? by_outer : sampled_response(form, inner.sampling);
  const double period = inner.sampling.period;
  PolynomialX filter{Extended(1.0)};  // delta + c with a damper
  PolynomialX force{Extended(inner.stiffness)};
  if (inner.damping > 0.0) {
    const Extended c = inner.velocity_filter_hz > 0.0
                           ? Extended(-std::expm1(-2.0 * std::numbers::pi * inner.velocity_filter_hz * period))
                           : Extended(1.0);
    filter = {c, Extended(1.0)};
    force = product(force, filter);
    force[1] += Extended(inner.damping) * c / Extended(period);
  }
  return {{product(by_outer.numerator, filter), product(by_inner.denominator, filter),
           product(by_inner.numerator, force), by_inner.samples},
          by_outer.samples};
}

}  // namespace

std::size_t steps_within(const Sampling& outer, const Sampling& inner) {
  return static_cast<std::size_t>(std::max(0.0, std::round(outer.period / inner.period)));
}

SampledPlant sample_behind(const ModalForm& form, const Sampling& outer, const InnerLoop& inner) {
  const std::size_t steps = steps_within(outer, inner.sampling);
  InnerLoop fast = inner;
  fast.sampling.period = outer.period / static_cast<double>(steps);  // without its rounding
  const auto [loop, samples] = closed_inner(form, {fast.sampling.period, outer.delay}, fast);
  const FeedbackForm closed = feedback_form(loop, std::numbers::pi / static_cast<double>(steps));

  const std::size_t late = samples % steps;
  SampledPlant plant;
  plant.period = outer.period;
  plant.delay_samples = samples / steps + (late > 0 ? 1U : 0U);
  std::vector<ExtendedTerm> terms;
  for (const ModalTerm& term : closed.form.terms) {
    terms.push_back(decimated(extended_term(term), static_cast<std::size_t>(term.integrators), steps, late));
    SampledTerm sampled;
    sampled.degree = term.degree;
    sampled.integrators = term.integrators;
    plant.terms.push_back(sampled);
  }
  for (std::size_t i = 0; i < terms.front().numerator.size(); ++i) {
    terms.front().numerator[i] += closed.at_once * terms.front().denominator[i];
  }
  plant.terms.front().unstable_poles = poles_outside(closed.poles);
  fill_in(terms, plant);
  return plant;
}

}  // namespace zwidth::internal
