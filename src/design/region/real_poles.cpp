#include "design/region/real_poles.hpp"

#include <cmath>
#include <cstddef>

namespace zwidth::internal {
namespace {

constexpr int poles_per_decade = 40;
constexpr double slowest_pole = 1e-8;  // -ln z
constexpr double fastest_pole = 20.0;

// c[0] + c[1] delta + ... + leading delta^count
double real_polynomial(const double* c, std::size_t count, double leading, double delta) {
  double value = leading;
  for (std::size_t i = count; i-- > 0;) value = value * delta + c[i];
  return value;
}

double real_response(const FilteredPlant& plant, double log_z) {
  const double delta = std::expm1(log_z);
  double sum = 0.0;
  for (const SampledTerm& term : plant.terms) {
    sum += real_polynomial(term.numerator, term.degree, term.numerator[term.degree], delta) /
           real_polynomial(term.denominator, term.degree, 1.0, delta);
  }
  for (const FilterSection& section : plant.filters) {
    const std::size_t degree = section.degree - section.nyquist_zeros;
    sum *= real_polynomial(section.numerator.data(), degree, section.numerator[degree], delta) /
           real_polynomial(section.denominator.data(), section.degree, 1.0, delta);
    for (std::size_t i = 0; i < section.nyquist_zeros; ++i) sum *= delta + 2.0;
  }
  return sum * std::exp(-log_z * static_cast<double>(plant.delay_samples));
}

}  // namespace

RealPoles::RealPoles(const FilteredPlant& plant, double velocity_filter_hz) {
  const double c = 1.0 - velocity_filter_pole(velocity_filter_hz, plant.period);
  const int count = static_cast<int>(std::ceil(poles_per_decade * std::log10(fastest_pole / slowest_pole)));
  for (int i = 0; i <= count; ++i) {
    const double log_z = -slowest_pole * std::pow(fastest_pole / slowest_pole, static_cast<double>(i) / count);
    const double delta = std::expm1(log_z);
    points_.push_back({-1.0 / real_response(plant, log_z), c / plant.period * delta / (delta + c)});
  }
}

std::optional<double> RealPoles::meeting(double damping) const {
  const auto stiffness = [&](std::size_t i) { return points_[i].spring - damping * points_[i].velocity; };
  for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
    const double here = stiffness(i);
    const double before = stiffness(i - 1);
    const double after = stiffness(i + 1);
    if (!(here > 0.0) || !(here >= before) || !(here > after) || !std::isfinite(before - after)) continue;
    // The parabola through the three.
    const double slope = 0.5 * (after - before);
    return here - 0.5 * slope * slope / (before - 2.0 * here + after);
  }
  return std::nullopt;
}

}  // namespace zwidth::internal
