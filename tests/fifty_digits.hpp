#pragma once

// Responses of devices in 50-digit arithmetic, by textbook routes that share nothing with the library: Gaussian
// elimination of M s² + D s + K, matrix exponential by Taylor series.

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_complex.hpp>
#include <complex>
#include <cstddef>
#include <utility>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::test {

using Real50 = boost::multiprecision::cpp_bin_float_50;
using Complex50 = boost::multiprecision::cpp_complex_50;

template <typename Scalar>
using Matrix50 = std::vector<std::vector<Scalar>>;

template <typename Scalar>
Matrix50<Scalar> zeros(std::size_t rows, std::size_t columns) {
  return Matrix50<Scalar>(rows, std::vector<Scalar>(columns, Scalar(0)));
}

// Gaussian elimination with row pivoting.
template <typename Scalar>
std::vector<Scalar> solve(Matrix50<Scalar> matrix, std::vector<Scalar> right) {
  const std::size_t n = right.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i) {
      if (abs(matrix[i][k]) > abs(matrix[pivot][k])) pivot = i;
    }
    std::swap(matrix[k], matrix[pivot]);
    std::swap(right[k], right[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const Scalar factor = matrix[i][k] / matrix[k][k];
      if (factor == Scalar(0)) continue;
      for (std::size_t j = k; j < n; ++j) matrix[i][j] -= factor * matrix[k][j];
      right[i] -= factor * right[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) right[k] -= matrix[k][j] * right[j];
    right[k] /= matrix[k][k];
  }
  return right;
}

struct Matrices50 {
  Matrix50<Real50> damping;
  Matrix50<Real50> stiffness;
  std::vector<Real50> mass;
};

inline Matrices50 matrices_of(const Device& device) {
  const std::size_t n = device.bodies().size();
  Matrices50 m{zeros<Real50>(n, n), zeros<Real50>(n, n), std::vector<Real50>(n)};
  const auto to_ground = [&m](std::size_t i, double mass, double damping, double stiffness) {
    m.mass[i] += mass;
    m.damping[i][i] += damping;
    m.stiffness[i][i] += stiffness;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Body& body = device.bodies()[i];
    to_ground(i, body.mass, body.damping, body.stiffness);
  }
  const User& user = device.parameters().user;
  to_ground(device.loop().held, user.mass, user.damping, user.stiffness);
  for (const Link& link : device.links()) {
    for (const auto& [matrix, value] : {std::pair(&m.damping, link.damping), std::pair(&m.stiffness, link.stiffness)}) {
      (*matrix)[link.first][link.first] += value;
      (*matrix)[link.second][link.second] += value;
      (*matrix)[link.first][link.second] -= value;
      (*matrix)[link.second][link.first] -= value;
    }
  }
  return m;
}

// From the actuated body's force to the sensed body's position at s = jw, actuator lag included.
inline Complex50 exact_response(const Device& device, double frequency) {
  const Matrices50 m = matrices_of(device);
  const std::size_t n = m.mass.size();
  const Complex50 s(Real50(0), Real50(frequency));
  auto dynamic = zeros<Complex50>(n, n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) dynamic[i][j] = Complex50(m.stiffness[i][j]) + s * Complex50(m.damping[i][j]);
    dynamic[i][i] += Complex50(m.mass[i]) * s * s;
  }
  std::vector<Complex50> force(n, Complex50(0));
  force[device.loop().actuated] = Complex50(1);
  const Complex50 lag = Complex50(1) + s * Complex50(device.parameters().actuator.time_constant);
  return solve(dynamic, force)[device.loop().sensed] / lag;
}

// x' = A x + B u, y = C x of bodies: positions, velocities, lagged force.
struct StateSpace50 {
  Matrix50<Real50> A;
  std::vector<Real50> B;
  std::vector<Real50> C;
};

inline StateSpace50 exact_state_space(const Device& device) {
  const Matrices50 m = matrices_of(device);
  const std::size_t n = m.mass.size();
  const double lag = device.parameters().actuator.time_constant;
  const std::size_t order = 2 * n + (lag > 0.0 ? 1 : 0);
  StateSpace50 system{zeros<Real50>(order, order), std::vector<Real50>(order), std::vector<Real50>(order)};
  for (std::size_t i = 0; i < n; ++i) {
    system.A[i][n + i] = 1;
    for (std::size_t j = 0; j < n; ++j) {
      system.A[n + i][j] = -m.stiffness[i][j] / m.mass[i];
      system.A[n + i][n + j] = -m.damping[i][j] / m.mass[i];
    }
  }
  const std::size_t actuated = device.loop().actuated;
  const Real50 per_force = 1 / m.mass[actuated];
  if (lag > 0.0) {
    system.A[n + actuated][2 * n] = per_force;
    system.A[2 * n][2 * n] = -1 / Real50(lag);
    system.B[2 * n] = 1 / Real50(lag);
  } else {
    system.B[n + actuated] = per_force;
  }
  system.C[device.loop().sensed] = 1;
  return system;
}

inline Matrix50<Real50> multiply(const Matrix50<Real50>& a, const Matrix50<Real50>& b) {
  const std::size_t n = a.size();
  auto c = zeros<Real50>(n, n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t j = 0; j < n; ++j) c[i][j] += a[i][k] * b[k][j];
  return c;
}

// e^{M t} by Taylor series of M t / 2^k and k squarings.
inline Matrix50<Real50> exponential(Matrix50<Real50> matrix, const Real50& time) {
  const std::size_t n = matrix.size();
  Real50 norm = 0;
  for (auto& row : matrix) {
    Real50 sum = 0;
    for (auto& entry : row) entry *= time, sum += abs(entry);
    if (sum > norm) norm = sum;
  }
  int squarings = 0;
  for (; norm > 0.25; norm /= 2) ++squarings;
  for (auto& row : matrix)
    for (auto& entry : row) entry = ldexp(entry, -squarings);
  auto sum = zeros<Real50>(n, n);
  for (std::size_t i = 0; i < n; ++i) sum[i][i] = 1;
  auto power = sum;
  for (int k = 1; k <= 34; ++k) {  // 0.25^34 / 34! < 1e-58
    power = multiply(power, matrix);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        power[i][j] /= k;
        sum[i][j] += power[i][j];
      }
    }
  }
  for (int i = 0; i < squarings; ++i) sum = multiply(sum, sum);
  return sum;
}

// Z[H G e^{-t_d s}], from the definition: the hold's force is u[k-l-1] for the first f T of a period, then u[k-l].
class ExactSampledDevice {
 public:
  ExactSampledDevice(const StateSpace50& system, Sampling sampling) : period_(sampling.period), output_(system.C) {
    const std::size_t n = system.B.size();
    const Real50 samples = Real50(sampling.delay) / period_;
    // as documented: within rounding of a whole number of samples is that number
    Real50 whole = floor(samples + Real50(1e-15) * samples);
    Real50 fraction = samples - whole;
    if (abs(fraction) <= Real50(1e-15) * samples) fraction = 0;
    delay_samples_ = static_cast<int>(whole);
    auto generator = zeros<Real50>(n + 1, n + 1);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) generator[i][j] = system.A[i][j];
      generator[i][n] = system.B[i];
    }
    const auto full = exponential(generator, period_);
    const auto late = exponential(generator, (1 - fraction) * period_);
    transition_ = zeros<Real50>(n, n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) transition_[i][j] = full[i][j];
      with_new_.push_back(late[i][n]);
      with_old_.push_back(full[i][n] - late[i][n]);
    }
  }

  [[nodiscard]] Complex50 response(double frequency) const {
    const Real50 angle = Real50(frequency) * period_;
    const Complex50 z(cos(angle), sin(angle));
    const std::size_t n = with_new_.size();
    auto matrix = zeros<Complex50>(n, n);
    std::vector<Complex50> input(n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) matrix[i][j] = Complex50(-transition_[i][j]);
      matrix[i][i] += z;
      input[i] = Complex50(with_new_[i]) + Complex50(with_old_[i]) / z;
    }
    const auto state = solve(matrix, input);
    Complex50 y(0);
    for (std::size_t i = 0; i < n; ++i) y += Complex50(output_[i]) * state[i];
    const Real50 turn = -delay_samples_ * angle;
    return y * Complex50(cos(turn), sin(turn));
  }

 private:
  Real50 period_;
  int delay_samples_ = 0;
  std::vector<Real50> output_;
  Matrix50<Real50> transition_;
  std::vector<Real50> with_new_;
  std::vector<Real50> with_old_;
};

// |ours - exact| / |exact|.
inline double relative_error(std::complex<double> ours, const Complex50& exact) {
  return static_cast<double>(abs(Complex50(Real50(ours.real()), Real50(ours.imag())) - exact) / abs(exact));
}

// Relative error of the angle to the negative real axis, whose zeros are the phase crossovers. atan2(-im, -re).
inline double phase_distance_error(std::complex<double> ours, const Complex50& exact) {
  const Real50 distance = atan2(-exact.imag(), -exact.real());
  const Real50 our_distance = atan2(Real50(-ours.imag()), Real50(-ours.real()));
  return static_cast<double>(abs((our_distance - distance) / distance));
}

}  // namespace zwidth::test
