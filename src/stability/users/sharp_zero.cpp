#include "stability/users/sharp_zero.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "stability/users/sharp_zero_taylor.hpp"

namespace zwidth::internal {
namespace {

constexpr double most_cancelled = 100.0;  // terms of a Taylor polynomial, of its value

/// A polynomial in s at s = j w0 (1 + e), its first `zeros` powers of e taken off, over its largest coefficient.
struct ScaledTaylor {
  SharpZero::Taylor coefficients;
  ManyDigits scale;
};

struct EvenAndOdd {
  DigitPolynomial even;
  DigitPolynomial odd;
  std::size_t zeros = 0;
};

EvenAndOdd on_axis_at(const DigitPolynomial& p, const ManyDigits& w0) {
  EvenAndOdd parts{DigitPolynomial(p.size(), ManyDigits(0.0)), DigitPolynomial(p.size(), ManyDigits(0.0))};
  for (std::size_t k = 0; k < p.size(); ++k) {
    (k % 2 == 0 ? parts.even : parts.odd)[k] = k / 2 % 2 == 0 ? p[k] : ManyDigits(-p[k]);
  }
  parts.even = taylor(std::move(parts.even), w0);
  parts.odd = taylor(std::move(parts.odd), w0);
  // A part that is 0 throughout has no multiplicity of its own.
  DigitPolynomial sizes(p.size());
  for (std::size_t k = 0; k < p.size(); ++k) sizes[k] = abs(parts.even[k]) + abs(parts.odd[k]);
  parts.zeros = multiplicity(sizes);
  return parts;
}

ScaledTaylor scaled_taylor(const EvenAndOdd& parts, std::size_t zeros) {
  ScaledTaylor result{{}, ManyDigits(0.0)};
  for (std::size_t k = zeros; k < parts.even.size(); ++k) {
    result.scale = std::max<ManyDigits>(result.scale, abs(parts.even[k]) + abs(parts.odd[k]));
  }
  for (std::size_t k = zeros; k < parts.even.size(); ++k) {
    result.coefficients.emplace_back(ManyDigits(parts.even[k] / result.scale).convert_to<double>(),
                                     ManyDigits(parts.odd[k] / result.scale).convert_to<double>());
  }
  return result;
}

}  // namespace

SharpZero sharp_zero(const MotionsInDigits& of, const ManyDigits& w0, const ManyDigits& depth, const DrivePath& drive) {
  SharpZero zero;
  zero.frequency = w0.convert_to<double>();
  zero.depth = depth.convert_to<double>();
  const bool is_exact = depth.is_zero();
  const EvenAndOdd sensed = on_axis_at(of.sensed, w0);
  const EvenAndOdd actuated = on_axis_at(of.actuated, w0);
  const EvenAndOdd determinant = on_axis_at(of.determinant, w0);
  DigitPolynomial even(2 * of.dissipation.size() - 1, ManyDigits(0.0));
  for (std::size_t k = 0; k < of.dissipation.size(); ++k) even[2 * k] = of.dissipation[k];
  EvenAndOdd dissipation{taylor(std::move(even), w0), {}, 0};
  DigitPolynomial& r = dissipation.even;
  if (is_exact) {
    dissipation.zeros = multiplicity(r);
  } else {  // over e² + d², from the top
    const ManyDigits square = depth * depth;
    for (std::size_t k = r.size() - 1; k >= 2; --k) r[k - 2] -= square * r[k];
    dissipation.zeros = 2;
  }
  dissipation.odd.assign(r.size(), ManyDigits(0.0));
  const std::size_t of_sensed = is_exact ? sensed.zeros : 0;
  const std::size_t of_actuated = is_exact ? actuated.zeros : 0;
  // A mode that nothing moves: it is in all of them.
  const std::size_t of_determinant = determinant.zeros;
  zero.order = static_cast<int>(dissipation.zeros) - static_cast<int>(of_sensed + of_actuated);
  zero.power = static_cast<int>(dissipation.zeros) - static_cast<int>(2 * of_determinant);
  const ScaledTaylor s = scaled_taylor(sensed, of_sensed);
  const ScaledTaylor a = scaled_taylor(actuated, of_actuated);
  const ScaledTaylor d = scaled_taylor(determinant, of_determinant);
  const ScaledTaylor q = scaled_taylor(dissipation, dissipation.zeros);
  zero.sensed = s.coefficients;
  zero.actuated = a.coefficients;
  zero.determinant = d.coefficients;
  zero.dissipation = q.coefficients;
  zero.of_density = ManyDigits(s.scale * a.scale / (2.0 * w0 * w0 * q.scale)).convert_to<double>();
  zero.of_dissipation = ManyDigits(w0 * w0 * q.scale / (d.scale * d.scale)).convert_to<double>();
  zero.drive = {drive.lag * zero.frequency, drive.tracking / zero.frequency};
  return zero;
}

double SharpZero::measure(double e) const {
  if (depth > 0.0) return e * e + depth * depth;
  return order > 0 ? std::pow(std::abs(e), order) : 1.0;
}

double SharpZero::of_conductance(double e) const {
  return depth > 0.0 ? e * e + depth * depth : std::pow(std::abs(e), power);
}

SharpZero::Density SharpZero::density(double e) const {
  bool keeps_digits = true;
  const auto at = [&](const Taylor& p, bool may_vanish) {
    std::complex<double> value = 0.0;
    double size = 0.0;
    for (std::size_t k = p.size(); k-- > 0;) {
      value = value * e + p[k];
      size = size * std::abs(e) + std::abs(p[k].real()) + std::abs(p[k].imag());
    }
    double kept = std::abs(value);
    if (may_vanish) kept = std::max(kept, std::abs(p[0]) + (p.size() > 1 ? std::abs(p[1] * e) : 0.0));
    keeps_digits = keeps_digits && size <= most_cancelled * kept;
    return value;
  };
  const std::complex<double> d = at(determinant, false);
  const double r = at(dissipation, false).real();
  std::complex<double> value =
      of_density * at(sensed, true) * at(actuated, true) * (std::conj(d) / d) / ((1.0 + e) * (1.0 + e) * r);
  value *= drive.response(1.0 + e);
  if (depth == 0.0) {
    if (order > 0 && order % 2 != 0 && e < 0.0) value = -value;
    if (order < 0) value *= std::pow(e, -order);
  }
  return {value, of_dissipation * (1.0 + e) * (1.0 + e) * r / std::norm(d),
          keeps_digits && std::isfinite(std::abs(value))};
}

}  // namespace zwidth::internal
