#include "zwidth/sampling/filter_section.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "require_argument.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;

constexpr double vanishes = 1e-14;  // a digital numerator at z = -1, relative to its terms: a zero there

// Coefficients of s^0, s^1, s^2.
struct InS {
  std::array<double, 3> numerator{};
  std::array<double, 3> denominator{};
  std::size_t degree = 1;
};

std::array<double, 3> ascending(const std::vector<double>& descending) {
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < descending.size(); ++i) result[i] = descending[descending.size() - 1 - i];
  return result;
}

InS continuous(const WallFilter& filter) {
  using enum WallFilter::Kind;
  const double w = 2.0 * pi * filter.frequency_hz;
  const double twice = 2.0 * filter.damping_ratio / w;
  switch (filter.kind) {
    case low_pass:
      if (filter.order == 1) return {{1.0}, {1.0, 1.0 / w}, 1};
      return {{1.0}, {1.0, twice, 1.0 / (w * w)}, 2};
    case notch:
      return {{1.0, filter.depth * twice, 1.0 / (w * w)}, {1.0, twice, 1.0 / (w * w)}, 2};
    case lead_lag:
      return {{1.0, std::sqrt(filter.ratio) / w}, {1.0, 1.0 / (w * std::sqrt(filter.ratio))}, 1};
    case biquad:
    case digital:
      break;
  }
  return {ascending(filter.numerator), ascending(filter.denominator), filter.denominator.size() - 1};
}

// sum c[i] (g delta)^i (delta + 2)^(degree - i), for the least such degree
std::array<double, 3> by_tustin(const std::array<double, 3>& c, std::size_t degree, double g) {
  if (degree == 0) return {c[0]};
  if (degree == 1) return {2.0 * c[0], c[0] + g * c[1]};
  return {4.0 * c[0], 4.0 * c[0] + 2.0 * g * c[1], c[0] + g * (c[1] + g * c[2])};
}

// Divides by the leading coefficient of the denominator.
FilterSection normalised(const std::array<double, 3>& numerator, const std::array<double, 3>& denominator,
                         std::size_t degree, std::size_t nyquist_zeros) {
  FilterSection section{degree, nyquist_zeros, {}, {}};
  const double leading = denominator[degree];
  for (std::size_t i = 0; i < degree; ++i) section.denominator[i] = denominator[i] / leading;
  for (std::size_t i = 0; i + nyquist_zeros <= degree; ++i) section.numerator[i] = numerator[i] / leading;
  return section;
}

// z = 1 + delta
std::array<double, 3> delta_from_z(const std::vector<double>& descending) {
  const std::array<double, 3> c = ascending(descending);
  return {c[0] + c[1] + c[2], c[1] + 2.0 * c[2], c[2]};
}

FilterSection digital_section(const WallFilter& filter) {
  const std::size_t degree = filter.denominator.size() - 1;
  std::array<double, 3> numerator = delta_from_z(filter.numerator);
  std::size_t zeros = 0;
  for (; zeros < degree; ++zeros) {
    const double at_minus_one = numerator[0] - 2.0 * numerator[1] + 4.0 * numerator[2];
    const double size = std::abs(numerator[0]) + 2.0 * std::abs(numerator[1]) + 4.0 * std::abs(numerator[2]);
    if (std::abs(at_minus_one) > vanishes * size) break;
    numerator = {numerator[1] - 2.0 * numerator[2], numerator[2]};  // over delta + 2
  }
  return normalised(numerator, delta_from_z(filter.denominator), degree, zeros);
}

}  // namespace

FilterSection filter_section(const WallFilter& filter, double period) {
  internal::require_positive({"sampling period", period, "s"});
  if (const auto problem = find_problem(filter, period)) {
    throw Error(ErrorCode::invalid_argument,
                "wall.filter." + std::string(problem->member) + " " + problem->what + "; " + problem->allowed);
  }
  if (filter.kind == WallFilter::Kind::digital) return digital_section(filter);
  const InS f = continuous(filter);
  const double w = 2.0 * pi * filter.frequency_hz;
  const double g = w > 0.0 ? w / std::tan(0.5 * w * period) : 2.0 / period;
  std::size_t numerator_degree = f.degree;
  while (numerator_degree > 0 && f.numerator[numerator_degree] == 0.0) --numerator_degree;
  return normalised(by_tustin(f.numerator, numerator_degree, g), by_tustin(f.denominator, f.degree, g), f.degree,
                    f.degree - numerator_degree);
}

std::complex<double> response(const FilterSection& section, double angle) {
  if (angle >= pi && section.nyquist_zeros > 0) return 0.0;
  const double half = std::sin(0.5 * angle);
  const std::complex<double> delta(-2.0 * half * half, std::sin(angle));
  const auto& n = section.numerator;
  const auto& d = section.denominator;
  const std::complex<double> denominator = section.degree == 1 ? delta + d[0] : (delta + d[1]) * delta + d[0];
  std::complex<double> value = ((n[2] * delta + n[1]) * delta + n[0]) / denominator;
  for (std::size_t i = 0; i < section.nyquist_zeros; ++i) value *= delta + 2.0;
  return value;
}

double static_gain(const FilterSection& section) {
  return std::exp2(static_cast<double>(section.nyquist_zeros)) * section.numerator[0] / section.denominator[0];
}

std::array<double, 3> whole_numerator(const FilterSection& section) {
  std::array<double, 3> n = section.numerator;
  for (std::size_t i = 0; i < section.nyquist_zeros; ++i) n = {2.0 * n[0], n[0] + 2.0 * n[1], n[1] + 2.0 * n[2]};
  return n;
}

FilterCoefficients in_delta(const FilterSection& section) {
  const std::array<double, 3> n = whole_numerator(section);
  const auto degree = static_cast<std::ptrdiff_t>(section.degree);
  FilterCoefficients result{{n.begin(), n.begin() + degree + 1},
                            {section.denominator.begin(), section.denominator.begin() + degree}};
  result.denominator.push_back(1.0);
  return result;
}

FilterCoefficients in_z(const FilterSection& section) {
  // c0 + c1 (z - 1) + c2 (z - 1)²
  const auto expanded = [](const std::vector<double>& c) {
    if (c.size() == 2) return std::vector{c[1], c[0] - c[1]};
    return std::vector{c[2], c[1] - 2.0 * c[2], c[0] - c[1] + c[2]};
  };
  const FilterCoefficients delta = in_delta(section);
  return {expanded(delta.numerator), expanded(delta.denominator)};
}

double velocity_filter_pole(double cutoff_hz, double sampling_period) {
  return cutoff_hz > 0.0 ? std::exp(-2.0 * pi * cutoff_hz * sampling_period) : 0.0;
}

double velocity_filter_gain(double cutoff_hz, double sampling_period) {
  return cutoff_hz > 0.0 ? -std::expm1(-2.0 * pi * cutoff_hz * sampling_period) : 1.0;
}

}  // namespace zwidth
