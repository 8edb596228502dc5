#include "stability/dissipation_zeros.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "stability/motion_polynomials.hpp"
#include "stability/polynomial_roots.hpp"

namespace zwidth::internal {
namespace {

using DigitPolynomial = Polynomial<ManyDigits>;

constexpr double sharp_depth = 0.02;       // of the zero's frequency or of Nyquist
constexpr double maybe_sharp = 0.06;       // the same, of roots in long double
constexpr double same_place = 0.03;        // relative: roots that may be one of higher multiplicity
constexpr double much_less_damped = 1e-4;  // a body, of the most damped one per mass
constexpr double most_cancelled = 100.0;   // terms of a Taylor polynomial, of its value

/// |N(jw)|² as a polynomial in X = w²: N(jw) = E(X) + jw O(X).
DigitPolynomial squared_size(const DigitPolynomial& numerator) {
  DigitPolynomial even{ManyDigits(0.0)};
  DigitPolynomial odd{ManyDigits(0.0)};
  for (std::size_t k = 0; k < numerator.size(); ++k) {
    DigitPolynomial& part = k % 2 == 0 ? even : odd;
    if (k >= 2) part.emplace_back(0.0);
    part.back() = k / 2 % 2 == 0 ? numerator[k] : ManyDigits(-numerator[k]);
  }
  DigitPolynomial square = even * even;
  const DigitPolynomial of_odd = odd * odd;
  square.resize(std::max(square.size(), of_odd.size() + 1), ManyDigits(0.0));
  for (std::size_t k = 0; k < of_odd.size(); ++k) square[k + 1] += of_odd[k];
  return square;
}

void add_scaled(DigitPolynomial& sum, const DigitPolynomial& p, double factor) {
  sum.resize(std::max(sum.size(), p.size()), ManyDigits(0.0));
  for (std::size_t k = 0; k < p.size(); ++k) sum[k] += factor * p[k];
}

void drop_leading_zeros(DigitPolynomial& p) {
  while (p.size() > 1 && p.back().is_zero()) p.pop_back();
}

bool is_zero(const DigitPolynomial& p) {
  return std::all_of(p.begin(), p.end(), [](const ManyDigits& each) { return each.is_zero(); });
}

/// q^H Dmp q |det|² as a polynomial in X = w².
DigitPolynomial dissipation_of(const Device& device, const MotionPolynomials& motions) {
  DigitPolynomial sum{ManyDigits(0.0)};
  for (std::size_t i = 0; i < device.bodies().size(); ++i) {
    const double damping = device.bodies()[i].damping;
    if (damping > 0.0) add_scaled(sum, squared_size(motions.numerators[i]), damping);
  }
  for (const Link& link : device.links()) {
    if (!(link.damping > 0.0)) continue;
    DigitPolynomial length = motions.numerators[link.first];
    add_scaled(length, motions.numerators[link.second], -1.0);
    // A rigid body moves as one: what is left of its motion is rounding.
    const DigitPolynomial& first = motions.numerators[link.first];
    const DigitPolynomial& second = motions.numerators[link.second];
    for (std::size_t k = 0; k < length.size(); ++k) {
      ManyDigits size = 0.0;
      if (k < first.size()) size += abs(first[k]);
      if (k < second.size()) size += abs(second[k]);
      if (abs(length[k]) <= zero_in_digits * size) length[k] = 0.0;
    }
    drop_leading_zeros(length);
    add_scaled(sum, squared_size(length), link.damping);
  }
  drop_leading_zeros(sum);
  return sum;
}

/// p(1 + e) by rising powers of e.
void shift_by_one(DigitPolynomial& p) {
  for (std::size_t first = 0; first + 1 < p.size(); ++first) {
    for (std::size_t k = p.size() - 1; k-- > first;) p[k] += p[k + 1];
  }
}

/// p(x (1 + e)) by rising powers of e.
DigitPolynomial taylor(DigitPolynomial p, const ManyDigits& x) {
  ManyDigits power = 1.0;
  for (ManyDigits& each : p) {
    each *= power;
    power *= x;
  }
  shift_by_one(p);
  return p;
}

/// How many of the first coefficients vanish: the multiplicity of the root.
std::size_t multiplicity(const DigitPolynomial& p) {
  ManyDigits largest = 0.0;
  for (const ManyDigits& each : p) largest = std::max<ManyDigits>(largest, abs(each));
  std::size_t count = 0;
  while (count + 1 < p.size() && abs(p[count]) <= zero_in_digits * largest) ++count;
  return count;
}

/// X² + u X + v
struct Quadratic {
  ManyDigits u;
  ManyDigits v;
};

/// Bairstow's method: quadratic convergence to the factor, also where its two roots are one.
std::optional<Quadratic> quadratic_factor(const DigitPolynomial& a, Quadratic q) {
  constexpr int most_steps = 40;
  constexpr double settled = 1e-70;  // relative
  const std::size_t n = a.size() - 1;
  if (n == 2) return Quadratic{a[1] / a[2], a[0] / a[2]};
  for (int step = 0; step < most_steps; ++step) {
    DigitPolynomial b(n + 1, ManyDigits(0.0));
    DigitPolynomial f(n + 1, ManyDigits(0.0));
    for (std::size_t i = n - 1; i-- > 0;) {
      b[i] = a[i + 2] - q.u * b[i + 1] - q.v * b[i + 2];
      f[i] = b[i + 2] - q.u * f[i + 1] - q.v * f[i + 2];
    }
    const ManyDigits c = a[1] - q.u * b[0] - q.v * b[1];
    const ManyDigits d = a[0] - q.v * b[0];
    const ManyDigits g = b[1] - q.u * f[0] - q.v * f[1];
    const ManyDigits h = b[0] - q.v * f[0];
    const ManyDigits determinant = q.v * g * g + h * (h - q.u * g);
    if (determinant.is_zero()) return std::nullopt;
    const ManyDigits by_u = (g * d - h * c) / determinant;
    const ManyDigits by_v = ((g * q.u - h) * d - g * q.v * c) / determinant;
    q.u -= by_u;
    q.v -= by_v;
    if (abs(by_u) <= settled * abs(q.u) && abs(by_v) <= settled * abs(q.v)) return q;
  }
  return std::nullopt;
}

/// The root of multiplicity m beside `start`: that of the (m - 1)th derivative, if it is one of all lower ones.
std::optional<ManyDigits> multiple_root(const DigitPolynomial& p, std::size_t m, ManyDigits start) {
  constexpr int most_steps = 40;
  constexpr double settled = 1e-80;
  for (int step = 0; step < most_steps; ++step) {
    const DigitPolynomial at = taylor(p, start);
    if (at.size() <= m || at[m].is_zero()) return std::nullopt;
    const ManyDigits change = at[m - 1] / (static_cast<double>(m) * at[m]);
    if (!(abs(change) < 0.5)) return std::nullopt;
    start -= change * start;
    if (abs(change) <= settled) {
      if (multiplicity(taylor(p, start)) != m) return std::nullopt;
      return start;
    }
  }
  return std::nullopt;
}

/// The polynomials of a device, and what is made of them at each zero.
struct Polynomials {
  DigitPolynomial sensed;
  DigitPolynomial actuated;
  DigitPolynomial determinant;
  DigitPolynomial dissipation;  // in X = w²
};

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

SharpZero sharp_zero(const Polynomials& of, const ManyDigits& w0, const ManyDigits& depth, double lag) {
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
  zero.lag = lag * zero.frequency;
  return zero;
}

/// Beyond a hundred digits: without dips where all bodies are damped alike to within a factor.
bool is_damped_alike(const Device& device) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const Body& body : device.bodies()) {
    least = std::min(least, body.damping / body.mass);
    most = std::max(most, body.damping / body.mass);
  }
  for (const Link& link : device.links()) {
    const double mass = std::min(device.bodies()[link.first].mass, device.bodies()[link.second].mass);
    most = std::max(most, link.damping / mass);
  }
  return least > much_less_damped * most;
}

}  // namespace

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
  std::complex<double> value = of_density * at(sensed, true) * at(actuated, true) * (std::conj(d) / d) /
                               ((1.0 + e) * (1.0 + e) * r);
  if (lag > 0.0) value /= std::complex<double>(1.0, lag * (1.0 + e));
  if (depth == 0.0) {
    if (order > 0 && order % 2 != 0 && e < 0.0) value = -value;
    if (order < 0) value *= std::pow(e, -order);
  }
  return {value, of_dissipation * (1.0 + e) * (1.0 + e) * r / std::norm(d), keeps_digits && std::isfinite(std::abs(value))};
}

DissipationZeros::DissipationZeros(const Device& device, double nyquist) {
  if (device.bodies().size() > most_bodies_for_polynomials) {
    is_unknown = !is_damped_alike(device);
    return;
  }
  are_complete = true;
  const Loop& loop = device.loop();
  MotionPolynomials motions = motion_polynomials(device, loop.held);
  Polynomials of{motions.numerators[loop.sensed], motions.numerators[loop.actuated], motions.determinant,
                 dissipation_of(device, motions)};
  if (is_zero(of.dissipation) || is_zero(of.sensed) || is_zero(of.actuated)) return;
  const double lag = device.parameters().actuator.time_constant;
  const auto degree = [](const DigitPolynomial& p) { return static_cast<int>(p.size()) - 1; };
  discs_diverge = degree(of.sensed) + degree(of.actuated) - 2 - 2 * degree(of.dissipation) - (lag > 0.0 ? 1 : 0) >= -1;
  // In units of the geometric mean of its roots.
  DigitPolynomial p = of.dissipation;
  p.erase(p.begin(), std::find_if(p.begin(), p.end(), [](const ManyDigits& each) { return !each.is_zero(); }));
  if (p.size() < 3) {
    for (std::size_t i = 1; i < p.size(); ++i) {  // a lone root is negative
      others.push_back({0.0, std::sqrt(std::abs(ManyDigits(p[0] / p[1]).convert_to<double>()))});
    }
    return;
  }
  const auto n = static_cast<long double>(p.size() - 1);
  const long double mean = std::pow(ManyDigits(abs(p.front() / p.back())).convert_to<long double>(), 1.0L / n);
  const ManyDigits unit = mean;
  ManyDigits power = ManyDigits(1.0) / abs(p.front());
  std::vector<long double> coefficients;
  for (ManyDigits& each : p) {
    each *= power;
    power *= unit;
    coefficients.push_back(each.convert_to<long double>());
  }
  const std::vector<std::complex<long double>> roots = polynomial_roots(coefficients);
  // Their product is that of the coefficients, unless one was not found or another twice.
  std::complex<long double> product = coefficients.back();
  for (const std::complex<long double>& each : roots) product *= -each;
  is_unknown = !(std::abs(product - coefficients.front()) <= same_place * std::abs(coefficients.front()));
  std::vector<bool> is_used(roots.size(), false);
  const auto in_radians = [&](std::complex<long double> root) {  // rad/s
    const std::complex<long double> w = std::sqrt(root * mean);
    return std::complex<double>(static_cast<double>(w.real()), static_cast<double>(std::abs(w.imag())));
  };
  const auto add = [&](const ManyDigits& u, const ManyDigits& v) {  // X² + u X + v, in p's unit
    const ManyDigits middle = -0.5 * u;
    const ManyDigits square = std::max<ManyDigits>(v - middle * middle, ManyDigits(0.0));
    const bool is_exact = square <= zero_in_digits * v || middle <= 0.0;
    if (middle <= 0.0) return false;
    // sqrt(middle + j root) = w0 (1 + j depth)
    const ManyDigits size = sqrt(is_exact ? ManyDigits(middle * middle) : v);
    const ManyDigits w0 = sqrt(unit * (is_exact ? middle : ManyDigits(0.5 * (size + middle))));
    const ManyDigits depth = is_exact ? ManyDigits(0.0) : ManyDigits(0.5 * unit * sqrt(square) / (w0 * w0));
    const auto frequency = w0.convert_to<double>();
    const double away = depth.convert_to<double>() * frequency;
    if (away > sharp_depth * std::min(frequency, nyquist)) {
      others.push_back({frequency, away});
    } else {
      sharp.push_back(sharp_zero(of, w0, depth, lag));
    }
    return true;
  };
  for (std::size_t i = 0; i < roots.size(); ++i) {
    if (is_used[i]) continue;
    const std::complex<double> w = in_radians(roots[i]);
    if (!(w.imag() <= maybe_sharp * std::min(w.real(), nyquist))) {
      if (roots[i].imag() >= 0.0L) others.push_back({w.real(), w.imag()});
      continue;
    }
    std::vector<std::size_t> near;
    for (std::size_t j = 0; j < roots.size(); ++j) {
      if (!is_used[j] && std::abs(roots[j] - roots[i]) <= same_place * std::abs(roots[i])) near.push_back(j);
    }
    if (near.size() > 2) {
      std::complex<long double> sum = 0.0L;
      for (const std::size_t j : near) sum += roots[j];
      const ManyDigits middle = sum.real() / static_cast<long double>(near.size());
      if (const auto root = multiple_root(p, near.size(), middle)) {
        add(-2.0 * *root, *root * *root);
        for (const std::size_t j : near) is_used[j] = true;
        continue;
      }
    }
    std::size_t partner = i;
    for (std::size_t j = 0; j < roots.size(); ++j) {
      if (j == i || is_used[j]) continue;
      if (partner == i || std::abs(roots[j] - std::conj(roots[i])) < std::abs(roots[partner] - std::conj(roots[i]))) {
        partner = j;
      }
    }
    const auto factor = quadratic_factor(p, {ManyDigits(-(roots[i] + roots[partner]).real()),
                                             ManyDigits((roots[i] * roots[partner]).real())});
    is_used[i] = is_used[partner] = true;
    const bool is_there = factor && abs(factor->u + (roots[i] + roots[partner]).real()) <= same_place * abs(factor->u);
    if (partner == i || !is_there || !add(factor->u, factor->v)) is_unknown = true;
  }
  std::sort(sharp.begin(), sharp.end(),
            [](const SharpZero& a, const SharpZero& b) { return a.frequency < b.frequency; });
  for (std::size_t i = 1; i < sharp.size(); ++i) {
    if (sharp[i].frequency == sharp[i - 1].frequency) is_unknown = true;  // one pair found twice
  }
  are_complete = !is_unknown;
}

}  // namespace zwidth::internal
