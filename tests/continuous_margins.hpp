#pragma once

// Margins of continuous loops, which textbooks and other programs print: the library's search after the bilinear map
// s = (2/T)(z - 1)/(z + 1), which keeps magnitudes and phases.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "zwidth/model/modal_form.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth::test {

// c[0] + c[1] s + ... times (delta + 2)^degree at s = rate delta / (delta + 2): coefficients of delta, degree + 1 of
// them.
inline void substitute(const double* c, std::size_t count, std::size_t degree, double rate, double* result) {
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
inline bool maps_to_infinity(const ModalForm& form, double rate) {
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

// The continuous response on the unit circle: angle t stands for the frequency (2/T) tan(t/2). T is chosen near the
// poles. Not a sampling of the plant.
inline SampledPlant bilinear_plant(const ModalForm& form) {
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

// No damping anywhere: L(jw) is real at every frequency, closed-loop poles lie symmetric to the imaginary axis, and no
// gain makes the loop asymptotically stable.
inline bool is_lossless(const ModalForm& form) {
  return std::all_of(form.terms.begin(), form.terms.end(), [](const ModalTerm& term) {
    const double rounding = 1e-14 * std::sqrt(std::abs(term.denominator[0]));
    return term.degree == 2 && std::abs(term.denominator[1]) <= rounding &&
           std::abs(term.numerator[1]) * std::sqrt(std::abs(term.denominator[0])) <=
               1e-14 * std::abs(term.numerator[0]);
  });
}

/// Margins of a strictly proper L(s) under unit negative feedback.
inline LoopMargins continuous_margins(const TransferFunction& loop) {
  DeviceParameters parameters;
  parameters.name = "loop";
  parameters.transfer_function = loop;
  parameters.loop.sampling_period = 1.0;  // not used: the bilinear map takes the place of sampling
  const ModalForm form = modal_form(Device(std::move(parameters)));
  if (is_lossless(form)) return {};
  const FilteredPlant plant = filtered_plant(bilinear_plant(form), {});
  LoopMargins margins = loop_margins(plant, {1.0, 0.0, 0.0});
  margins.delay_margin.reset();
  for (GainCrossover& crossover : margins.gain_crossovers) {
    crossover.frequency = 2.0 / plant.period * std::tan(0.5 * crossover.frequency * plant.period);
    if (!margins.stable) continue;
    const double lag = crossover.phase_margin + (crossover.phase_margin >= 0.0 ? 0.0 : 2.0 * std::numbers::pi);
    const double delay = lag / crossover.frequency;
    margins.delay_margin = std::min(margins.delay_margin.value_or(delay), delay);
  }
  return margins;
}

}  // namespace zwidth::test
