#include "sampling/bilinear_plant.hpp"

#include <algorithm>
#include <cmath>

namespace zwidth::internal {
namespace {

// c[0] + c[1] s + ... times (delta + 2)^degree at s = rate delta / (delta + 2): coefficients of delta, degree + 1 of
// them.
void substitute(const double* c, std::size_t count, std::size_t degree, double rate, double* result) {
  for (std::size_t i = 0; i < count; ++i) {
    // c_i rate^i delta^i (delta + 2)^(degree - i) by the binomial theorem
    double coefficient = c[i] * std::pow(rate, static_cast<double>(i));
    const std::size_t rest = degree - i;
    for (std::size_t j = rest + 1; j-- > 0;) {  // delta^j 2^(rest - j)
      result[i + j] += coefficient;
      coefficient *= 2.0 * static_cast<double>(j) / static_cast<double>(rest - j + 1);
    }
  }
}

// An unstable real pole near s = rate has no image.
bool maps_to_infinity(const ModalForm& form, double rate) {
  return std::any_of(form.terms.begin(), form.terms.end(), [rate](const ModalTerm& term) {
    double value = 1.0;
    double size = 1.0;
    for (std::size_t i = term.degree; i-- > 0;) {
      value = value * rate + term.denominator[i];
      size = size * rate + std::abs(term.denominator[i]);
    }
    return std::abs(value) < 1e-3 * size;
  });
}

}  // namespace

SampledPlant bilinear_plant(const ModalForm& form) {
  // The geometric mean of the poles' magnitudes sits at angle pi/2.
  double log_sum = 0.0;
  std::size_t poles = 0;
  for (const ModalTerm& term : form.terms) {
    const auto zeros = static_cast<std::size_t>(term.integrators);
    if (zeros == term.degree) continue;
    log_sum += std::log(std::abs(term.denominator[zeros]));
    poles += term.degree - zeros;
  }
  double rate = poles > 0 ? std::exp(log_sum / static_cast<double>(poles)) : 1.0;
  while (maps_to_infinity(form, rate)) rate *= 1.25;
  SampledPlant plant;
  plant.period = 2.0 / rate;
  for (const ModalTerm& term : form.terms) {
    double numerator[ModalTerm::max_degree + 1] = {};
    double denominator[ModalTerm::max_degree + 1] = {};
    double monic[ModalTerm::max_degree + 1] = {};
    for (std::size_t i = 0; i < term.degree; ++i) monic[i] = term.denominator[i];
    monic[term.degree] = 1.0;
    substitute(term.numerator, term.degree, term.degree, rate, numerator);
    substitute(monic, term.degree + 1, term.degree, rate, denominator);
    SampledTerm sampled;
    sampled.degree = term.degree;
    sampled.mode = term.mode;
    sampled.integrators = term.integrators;
    sampled.unstable_poles = term.unstable_poles;
    sampled.undamped_pairs = term.undamped_pairs;
    const double leading = denominator[term.degree];
    for (std::size_t i = 0; i < term.degree; ++i) sampled.denominator[i] = denominator[i] / leading;
    for (std::size_t i = 0; i <= term.degree; ++i) sampled.numerator[i] = numerator[i] / leading;
    plant.terms.push_back(sampled);
  }
  return plant;
}

}  // namespace zwidth::internal
