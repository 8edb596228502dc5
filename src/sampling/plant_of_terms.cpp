#include "sampling/plant_of_terms.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "sampling/cancellation.hpp"
#include "sampling/exact_sampling.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {

ExtendedTerm sample_precisely(const ModalTerm& term, const SamplingInstants& instants) {
  return term.degree > 2 ? sample_exactly(term, instants) : sample_extended(term, instants);
}

void round_into(const ExtendedTerm& term, SampledTerm& sampled) {
  const auto round = [](const Extended& exact, double& rounded, double& rest) {
    rounded = leading(exact);
    rest = leading(exact - Extended(rounded));
  };
  for (std::size_t i = 0; i <= sampled.degree; ++i)
    round(term.numerator[i], sampled.numerator[i], sampled.numerator_rest[i]);
  for (std::size_t i = 0; i < sampled.degree; ++i)
    round(term.denominator[i], sampled.denominator[i], sampled.denominator_rest[i]);
}

void check_range(const SampledTerm& sampled) {
  constexpr double largest = 1e60;
  const auto in_range = [](double c) { return std::abs(c) <= largest; };
  if (!std::all_of(sampled.numerator, sampled.numerator + sampled.degree + 1, in_range) ||
      !std::all_of(sampled.denominator, sampled.denominator + sampled.degree, in_range)) {
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::response_out_of_range});
  }
}

double cancellation(const SampledPlant& plant, double angle) {
  std::complex<double> sum = 0.0;
  double size = 0.0;
  for (const SampledTerm& term : plant.terms) {
    const std::complex<double> value = response(term, angle);
    sum += value;
    size += std::abs(value);
  }
  return size / std::abs(sum);
}

double worst_cancellation(const SampledPlant& plant) {
  return std::max(cancellation(plant, std::numbers::pi / 3.0), cancellation(plant, 2.0 * std::numbers::pi / 3.0));
}

double cancellation_at_poles(const SampledPlant& plant) {
  double worst = 1.0;
  for (const SampledTerm& term : plant.terms) {
    const double distance = std::pow(std::abs(term.denominator[0]), 1.0 / static_cast<double>(term.degree));
    if (!(distance > 0.0)) continue;
    const double here = cancellation(plant, 2.0 * std::asin(std::min(0.5 * distance, 1.0)));
    if (std::isfinite(here)) worst = std::max(worst, here);
  }
  return worst;
}

double cancellation_at_nyquist(const SampledPlant& plant) {
  double sum = 0.0;
  double size = 0.0;
  for (const SampledTerm& term : plant.terms) {
    double numerator = 0.0;
    double numerator_size = 0.0;
    double denominator = 1.0;
    for (std::size_t i = term.degree + 1; i-- > 0;) {
      numerator = -2.0 * numerator + term.numerator[i];
      numerator_size = 2.0 * numerator_size + std::abs(term.numerator[i]);
      if (i < term.degree) denominator = -2.0 * denominator + term.denominator[i];
    }
    sum += numerator / denominator;
    size += std::abs(numerator_size / denominator);
  }
  return size / std::abs(sum);
}

void add_up(const std::vector<ExtendedTerm>& terms, bool keeps_rests, SampledPlant& plant) {
  for (const Extended& c : extended_common_numerator(terms)) {
    plant.numerator.push_back(leading(c));
    if (keeps_rests) plant.numerator_rest.push_back(leading(c - Extended(plant.numerator.back())));
  }
}

void fill_in(const std::vector<ExtendedTerm>& terms, SampledPlant& plant) {
  for (std::size_t i = 0; i < terms.size(); ++i) {
    round_into(terms[i], plant.terms[i]);
    check_range(plant.terms[i]);
  }
  const bool sum_cancels = terms.size() > 1 && (cancellation_at_poles(plant) > carried_cancellation ||
                                                worst_cancellation(plant) > tolerable_cancellation);
  if (sum_cancels) add_up(terms, true, plant);
  if (sum_cancels || cancellation_at_nyquist(plant) > tolerable_cancellation_at_nyquist) {
    plant.at_nyquist = response_at_nyquist(terms, plant.delay_samples);
  }
}

}  // namespace zwidth::internal
