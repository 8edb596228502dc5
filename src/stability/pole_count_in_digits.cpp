// The closed loop's characteristic polynomial with a hundred digits, Routh's count of its roots outside the unit circle
// and those on it: decides where double precision cannot.

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "model/device_matrices.hpp"
#include "sampling/sampling_instants.hpp"
#include "stability/pole_count.hpp"
#include "stability/routh.hpp"

namespace zwidth::internal {
namespace {

namespace mp = boost::multiprecision;
using Digits = mp::number<mp::cpp_bin_float<100>, mp::et_off>;

// Of the first element of a row of Routh's array.
int sure_sign(const Polynomial<Digits>& row) {
  const Digits tiny = ldexp(Digits(1.0), -200);  // of 332 bits
  Digits size = 0.0;
  for (const Digits& each : row) size = std::max<Digits>(size, abs(each));
  if (!(abs(row[0]) > tiny * size)) return 0;
  return row[0] < 0.0 ? -1 : 1;
}

class Matrix {
 public:
  explicit Matrix(std::size_t n) : n_(n), values_(n * n) {}

  [[nodiscard]] std::size_t size() const { return n_; }
  Digits& operator()(std::size_t i, std::size_t j) { return values_[i * n_ + j]; }
  const Digits& operator()(std::size_t i, std::size_t j) const { return values_[i * n_ + j]; }

  Matrix& operator+=(const Matrix& other) {
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += other.values_[i];
    return *this;
  }
  Matrix& operator*=(const Digits& factor) {
    for (Digits& value : values_) value *= factor;
    return *this;
  }
  friend Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix product(a.n_);
    for (std::size_t i = 0; i < a.n_; ++i) {
      for (std::size_t k = 0; k < a.n_; ++k) {
        if (a(i, k).is_zero()) continue;
        for (std::size_t j = 0; j < a.n_; ++j) product(i, j) += a(i, k) * b(k, j);
      }
    }
    return product;
  }

 private:
  std::size_t n_;
  std::vector<Digits> values_;
};

// x' = A x + b u, y = c x, and the input as one more state that stays: the generator [[A, b], [0, 0]].
struct Continuous {
  Matrix generator;
  std::vector<Digits> output;
};

Continuous of_bodies(const Device& device, bool lag) {
  const DeviceMatrices<Digits> matrices = device_matrices<Digits>(device);
  const std::size_t n = matrices.mass.size();
  const std::size_t states = 2 * n + (lag ? 1 : 0);
  Continuous system{Matrix(states + 1), std::vector<Digits>(states)};
  for (std::size_t i = 0; i < n; ++i) {
    system.generator(i, n + i) = 1.0;
    for (std::size_t j = 0; j < n; ++j) {
      system.generator(n + i, j) = -matrices.stiffness[i * n + j] / matrices.mass[i];
      system.generator(n + i, n + j) = -matrices.damping[i * n + j] / matrices.mass[i];
    }
  }
  const std::size_t actuated = device.loop().actuated;
  system.generator(n + actuated, 2 * n) = Digits(1.0) / matrices.mass[actuated];  // of the lag, or of the input
  system.output[device.loop().sensed] = 1.0;
  return system;
}

Continuous of_transfer_function(const TransferFunction& function, bool lag) {
  const std::size_t n = function.denominator.size() - 1;
  const std::size_t states = n + (lag ? 1 : 0);
  Continuous system{Matrix(states + 1), std::vector<Digits>(states)};
  const Digits leading_coefficient = function.denominator[0];
  for (std::size_t i = 0; i + 1 < n; ++i) system.generator(i, i + 1) = 1.0;
  for (std::size_t i = 0; i < n; ++i) {
    system.generator(n - 1, i) = -Digits(function.denominator[n - i]) / leading_coefficient;
  }
  system.generator(n - 1, n) = 1.0;
  for (std::size_t i = 0; i < function.numerator.size() && i < n; ++i) {
    system.output[i] = Digits(function.numerator[function.numerator.size() - 1 - i]) / leading_coefficient;
  }
  return system;
}

Continuous continuous(const Device& device) {
  const double tau = device.parameters().actuator.time_constant;
  const bool lag = tau > 0.0;
  Continuous system =
      device.has_bodies() ? of_bodies(device, lag) : of_transfer_function(*device.parameters().transfer_function, lag);
  if (lag) {
    const std::size_t last = system.output.size() - 1;
    system.generator(last, last) = Digits(-1.0) / tau;
    system.generator(last, last + 1) = Digits(1.0) / tau;
  }
  return system;
}

// e^{M t} - I by Taylor's series of the scaled matrix and doubling.
Matrix exponential_minus_one(Matrix m, const Digits& time) {
  constexpr int terms = 40;  // 2^-8 each: below 1e-100
  constexpr double scaled_norm = 0x1p-8;
  m *= time;
  Digits norm = 0.0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    Digits row = 0.0;
    for (std::size_t j = 0; j < m.size(); ++j) row += abs(m(i, j));
    norm = std::max(norm, row);
  }
  const int halvings = norm > scaled_norm ? 1 + static_cast<int>(ilogb(Digits(norm / scaled_norm))) : 0;
  m *= ldexp(Digits(1.0), -halvings);
  Matrix sum = m;
  Matrix power = m;
  for (int k = 2; k <= terms; ++k) {
    power = power * m;
    power *= Digits(1.0) / k;
    sum += power;
  }
  for (int i = 0; i < halvings; ++i) {
    Matrix square = sum * sum;
    sum *= 2.0;
    sum += square;
  }
  return sum;
}

PlantPolynomials<Digits> sampled(const Device& device, const SamplingInstants& instants) {
  const Continuous system = continuous(device);
  const std::size_t n = system.output.size();
  const Matrix early = exponential_minus_one(system.generator, instants.with_new);
  const Matrix late = exponential_minus_one(system.generator, instants.with_old);
  // e^{A T} - I of both parts of the period; Gamma2 = e^{A (1-f) T} int_0^{fT} e^{As} b ds.
  Matrix product = early * late;
  product += early;
  product += late;
  std::vector<Digits> phi(n * n);
  std::vector<Digits> gamma1(n);
  std::vector<Digits> gamma2(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) phi[i * n + j] = product(i, j);
    gamma1[i] = early(i, n);
    gamma2[i] = late(i, n);
    for (std::size_t j = 0; j < n; ++j) gamma2[i] += early(i, j) * late(j, n);
  }
  return plant_polynomials<Digits>(phi, gamma1, gamma2, system.output);
}

// The loop's polynomial on the circle of radius 1 + beside.
CirclePolynomials<Digits> loop_in_digits(const Device& device, const Digits& beside) {
  const double period = device.loop().sampling_period;
  const SamplingInstants instants = sampling_instants({period, device.loop().delay});
  return {sampled(device, instants),
          instants.whole_samples,
          instants.with_old > 0.0,
          device.parameters().wall,
          period,
          beside};
}

// p(jy) and d p(jy) / dy
struct OnAxis {
  Digits re = 0.0;
  Digits im = 0.0;
  Digits slope_re = 0.0;
  Digits slope_im = 0.0;
};

OnAxis on_axis(const Polynomial<Digits>& p, const Digits& y) {
  OnAxis at;  // Horner's rule for p and p' in w = jy
  for (std::size_t i = p.size(); i-- > 0;) {
    const Digits slope_re = at.re - y * at.slope_im;
    at.slope_im = at.im + y * at.slope_re;
    at.slope_re = slope_re;
    const Digits re = p[i] - y * at.im;
    at.im = y * at.re;
    at.re = re;
  }
  return {at.re, at.im, -at.slope_im, at.slope_re};
}

// Newton's method for (y, K) in open(jy) + K of_stiffness(jy) = 0, with z = (1 + jy)/(1 - jy): y = tan(angle/2).
std::optional<PoleOnCircle> settled(const Polynomial<Digits>& open, const Polynomial<Digits>& of_stiffness,
                                    const PoleOnCircle& start) {
  constexpr int most_steps = 30;
  constexpr double close_enough = 1e-20;  // relative
  constexpr double beside = 1e-6;         // of the start's angle, relative
  const Digits first = tan(Digits(0.5 * start.angle));
  Digits y = first;
  Digits stiffness = start.stiffness;
  for (int i = 0; i < most_steps; ++i) {
    const OnAxis a = on_axis(open, y);
    const OnAxis b = on_axis(of_stiffness, y);
    const Digits re = a.re + stiffness * b.re;
    const Digits im = a.im + stiffness * b.im;
    const Digits slope_re = a.slope_re + stiffness * b.slope_re;
    const Digits slope_im = a.slope_im + stiffness * b.slope_im;
    const Digits determinant = slope_re * b.im - slope_im * b.re;
    if (determinant.is_zero()) return std::nullopt;
    const Digits by_y = (re * b.im - im * b.re) / determinant;
    const Digits by_stiffness = (slope_re * im - slope_im * re) / determinant;
    y -= by_y;
    stiffness -= by_stiffness;
    if (!(abs(y - first) < beside * first)) return std::nullopt;
    if (abs(by_y) <= close_enough * y && abs(by_stiffness) <= close_enough * abs(stiffness)) {
      return PoleOnCircle{Digits(2.0 * atan(y)).convert_to<double>(), stiffness.convert_to<double>()};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<int> unstable_poles_in_digits(const Device& device, double stiffness) {
  // Just outside the circle, so that a mode that nothing damps and nothing moves lies inside.
  const Digits beside = ldexp(Digits(1.0), -80);
  return loop_in_digits(device, beside).outside(stiffness, device.parameters().wall.damping, sure_sign);
}

void polish_poles_in_digits(const Device& device, std::vector<PoleOnCircle>& poles) {
  const CirclePolynomials<Digits> loop = loop_in_digits(device, Digits(0.0));
  const Polynomial<Digits> open = loop.without_spring(device.parameters().wall.damping);
  for (PoleOnCircle& pole : poles) pole = settled(open, loop.of_stiffness(), pole).value_or(pole);
}

}  // namespace zwidth::internal
