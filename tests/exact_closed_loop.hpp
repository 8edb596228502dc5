#pragma once

// How many closed-loop poles lie outside the unit circle, in 200-digit arithmetic and by a route that shares nothing
// with the library: state matrix, matrix exponential by Taylor series, characteristic polynomial by Faddeev and
// LeVerrier, Schur and Cohn's count. No root is ever sought, so that multiple and crowded poles are no harder than
// others.

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstddef>
#include <utility>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::test {

using Real200 = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<200>, boost::multiprecision::et_off>;
using Matrix200 = std::vector<std::vector<Real200>>;
using Polynomial200 = std::vector<Real200>;  // ascending

inline Matrix200 square_matrix(std::size_t size) { return Matrix200(size, std::vector<Real200>(size, Real200(0))); }

inline Matrix200 operator*(const Matrix200& a, const Matrix200& b) {
  const std::size_t n = a.size();
  Matrix200 c = square_matrix(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      if (a[i][k] == 0) continue;
      for (std::size_t j = 0; j < n; ++j) {
        if (b[k][j] != 0) c[i][j] += a[i][k] * b[k][j];
      }
    }
  }
  return c;
}

// x' = A x + b u, y = c x, the actuator's lag included. Bodies: positions, then velocities; a transfer function: its
// companion form.
struct StateSpace200 {
  Matrix200 a;
  std::vector<Real200> b;
  std::vector<Real200> c;
};

inline StateSpace200 state_space_of(const Device& device) {
  StateSpace200 system;
  const double lag = device.parameters().actuator.time_constant;
  std::size_t plant_order = 0;
  std::vector<Real200> input;
  if (device.has_bodies()) {
    const std::size_t n = device.bodies().size();
    plant_order = 2 * n;
    system.a = square_matrix(plant_order + (lag > 0.0 ? 1 : 0));
    std::vector<Real200> mass(n);
    for (std::size_t i = 0; i < n; ++i) mass[i] = device.bodies()[i].mass;
    mass[device.loop().held] += device.parameters().user.mass;
    const auto to_ground = [&](std::size_t i, double stiffness, double damping) {
      system.a[n + i][i] -= stiffness / mass[i];
      system.a[n + i][n + i] -= damping / mass[i];
    };
    for (std::size_t i = 0; i < n; ++i) {
      system.a[i][n + i] = 1;
      to_ground(i, device.bodies()[i].stiffness, device.bodies()[i].damping);
    }
    to_ground(device.loop().held, device.parameters().user.stiffness, device.parameters().user.damping);
    for (const Link& link : device.links()) {
      for (const auto& [here, there] : {std::pair(link.first, link.second), std::pair(link.second, link.first)}) {
        to_ground(here, link.stiffness, link.damping);
        system.a[n + here][there] += link.stiffness / mass[here];
        system.a[n + here][n + there] += link.damping / mass[here];
      }
    }
    input.assign(plant_order, Real200(0));
    input[n + device.loop().actuated] = 1 / mass[device.loop().actuated];
    system.c.assign(system.a.size(), Real200(0));
    system.c[device.loop().sensed] = 1;
  } else {
    const TransferFunction& g = *device.parameters().transfer_function;
    plant_order = g.denominator.size() - 1;
    system.a = square_matrix(plant_order + (lag > 0.0 ? 1 : 0));
    const Real200 first = g.denominator.front();
    for (std::size_t i = 0; i + 1 < plant_order; ++i) system.a[i][i + 1] = 1;
    for (std::size_t i = 0; i < plant_order; ++i) {
      system.a[plant_order - 1][i] = -g.denominator[plant_order - i] / first;
    }
    input.assign(plant_order, Real200(0));
    input.back() = 1 / first;
    system.c.assign(system.a.size(), Real200(0));
    for (std::size_t i = 0; i < g.numerator.size(); ++i) system.c[i] = g.numerator[g.numerator.size() - 1 - i];
  }
  system.b.assign(system.a.size(), Real200(0));
  if (lag > 0.0) {
    for (std::size_t i = 0; i < plant_order; ++i) system.a[i][plant_order] = input[i];
    system.a[plant_order][plant_order] = -1 / Real200(lag);
    system.b[plant_order] = 1 / Real200(lag);
  } else {
    std::copy(input.begin(), input.end(), system.b.begin());
  }
  return system;
}

// e^{M t} by Taylor series of M t / 2^k and k squarings.
inline Matrix200 exponential(Matrix200 matrix, const Real200& time) {
  const std::size_t n = matrix.size();
  Real200 norm = 0;
  for (auto& row : matrix) {
    Real200 sum = 0;
    for (Real200& entry : row) {
      entry *= time;
      sum += abs(entry);
    }
    norm = std::max(norm, sum);
  }
  int squarings = 0;
  for (; norm > Real200(0.001); norm /= 2) ++squarings;
  for (auto& row : matrix)
    for (Real200& entry : row) entry = ldexp(entry, -squarings);
  Matrix200 sum = square_matrix(n);
  for (std::size_t i = 0; i < n; ++i) sum[i][i] = 1;
  Matrix200 power = sum;
  for (int k = 1; k <= 55; ++k) {  // 0.001^55 / 55! < 1e-230
    power = power * matrix;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        power[i][j] /= k;
        sum[i][j] += power[i][j];
      }
    }
  }
  for (int i = 0; i < squarings; ++i) sum = sum * sum;
  return sum;
}

// Roots outside the unit circle (M. Marden, Geometry of Polynomials, 1966, theorem 42.1).
inline int roots_outside(Polynomial200 p) {
  while (p.size() > 1 && p.back() == 0) p.pop_back();
  const int degree = static_cast<int>(p.size()) - 1;
  int inside = 0;
  bool negative = false;
  while (p.size() > 1) {
    const std::size_t n = p.size() - 1;
    Real200 largest = 0;
    Polynomial200 next(n);
    for (std::size_t j = 0; j < n; ++j) {
      next[j] = p[0] * p[j] - p[n] * p[n - j];
      largest = std::max(largest, Real200(abs(next[j])));
    }
    if (next[0] < 0) negative = !negative;
    if (negative) ++inside;
    if (largest > 0) {
      for (Real200& c : next) c /= largest;
    }
    p = std::move(next);
  }
  return degree - inside;
}

// The loop of a device: z^l D(z) d_F(z) + (K + B v(z)) N(z) n_F(z) = 0, F the wall's filters.
class ExactClosedLoop {
 public:
  explicit ExactClosedLoop(const Device& device) {
    const StateSpace200 system = state_space_of(device);
    const std::size_t n = system.b.size();
    const Real200 period = device.loop().sampling_period;
    const Real200 samples = Real200(device.loop().delay) / period;
    // As documented: within rounding of a whole number of samples is that number.
    Real200 whole = floor(samples + Real200(1e-15) * samples);
    Real200 fraction = samples - whole;
    if (abs(fraction) <= Real200(1e-15) * samples) fraction = 0;
    Matrix200 generator = square_matrix(n + 1);
    for (std::size_t i = 0; i < n; ++i) {
      std::copy(system.a[i].begin(), system.a[i].end(), generator[i].begin());
      generator[i][n] = system.b[i];
    }
    const Matrix200 full = exponential(generator, period);
    const Matrix200 late = fraction == 0 ? full : exponential(generator, (1 - fraction) * period);
    Matrix200 transition = square_matrix(n);
    for (std::size_t i = 0; i < n; ++i) std::copy_n(full[i].begin(), n, transition[i].begin());
    // adj(z I - F) = sum B_k z^k: c adj (G1 z + G2) over z^(l+1) det, or c adj G1 over z^l det without a fraction.
    Matrix200 b = square_matrix(n);
    for (std::size_t i = 0; i < n; ++i) b[i][i] = 1;
    denominator_.assign(n + 1, Real200(0));
    denominator_[n] = 1;
    numerator_.assign(n + 1, Real200(0));
    for (std::size_t k = 1; k <= n; ++k) {
      for (std::size_t j = 0; j < n; ++j) {
        Real200 row = 0;
        for (std::size_t i = 0; i < n; ++i) row += system.c[i] * b[i][j];
        numerator_[n - k + (fraction == 0 ? 0 : 1)] += row * late[j][n];
        if (fraction != 0) numerator_[n - k] += row * (full[j][n] - late[j][n]);
      }
      b = transition * b;
      Real200 trace = 0;
      for (std::size_t i = 0; i < n; ++i) trace += b[i][i];
      denominator_[n - k] = -trace / static_cast<int>(k);
      for (std::size_t i = 0; i < n; ++i) b[i][i] += denominator_[n - k];
    }
    const auto delay = static_cast<std::size_t>(whole) + (fraction == 0 ? 0 : 1);
    denominator_.insert(denominator_.begin(), delay, Real200(0));
    const Wall& wall = device.parameters().wall;
    for (const WallFilter& filter : wall.filters) {
      const auto [above, below] = filter_of(filter, period);
      numerator_ = times(numerator_, above);
      denominator_ = times(denominator_, below);
    }
    // v = (c/T)(z - 1)/(z - 1 + c)
    if (wall.damping > 0.0) {
      Real200 c = 1;
      if (wall.velocity_filter_hz > 0.0) {
        c = 1 - exp(-2 * boost::math::constants::pi<Real200>() * wall.velocity_filter_hz * period);
      }
      const Real200 rate = wall.damping * c / period;
      damper_ = times(numerator_, {-rate, rate});
      numerator_ = times(numerator_, {c - 1, Real200(1)});
      denominator_ = times(denominator_, {c - 1, Real200(1)});
    }
  }

  // Poles on the circle itself, of motions that nothing damps and that the wall neither moves nor sees, are inside.
  [[nodiscard]] int poles_outside(double stiffness) const {
    Polynomial200 p = denominator_;
    p.resize(std::max({p.size(), numerator_.size(), damper_.size()}), Real200(0));
    for (std::size_t i = 0; i < numerator_.size(); ++i) p[i] += stiffness * numerator_[i];
    for (std::size_t i = 0; i < damper_.size(); ++i) p[i] += damper_[i];
    const Real200 radius = 1 + Real200("1e-30");
    Real200 power = 1;
    for (Real200& c : p) {
      c *= power;
      power *= radius;
    }
    return roots_outside(p);
  }

 private:
  // Tustin's rule, exact at the filter's own frequency: s = g (z - 1)/(z + 1), g = w/tan(wT/2), or 2/T where none is given.
  static std::pair<Polynomial200, Polynomial200> filter_of(const WallFilter& filter, const Real200& period) {
    using enum WallFilter::Kind;
    const auto ascending = [](const std::vector<double>& c) { return Polynomial200(c.rbegin(), c.rend()); };
    if (filter.kind == digital) return {ascending(filter.numerator), ascending(filter.denominator)};
    const Real200 w = 2 * boost::math::constants::pi<Real200>() * filter.frequency_hz;
    const Real200 g = w > 0 ? Real200(w / tan(w * period / 2)) : Real200(2 / period);
    const Real200 twice = w > 0 ? Real200(2 * Real200(filter.damping_ratio) / w) : Real200(0);
    const Real200 root = sqrt(Real200(filter.ratio));
    Polynomial200 above{Real200(1)};
    Polynomial200 below{Real200(1), twice, 1 / (w * w)};
    if (filter.kind == low_pass && filter.order == 1) below = {Real200(1), 1 / w};
    if (filter.kind == notch) above = {Real200(1), Real200(filter.depth) * twice, 1 / (w * w)};
    if (filter.kind == lead_lag) above = {Real200(1), root / w}, below = {Real200(1), 1 / (w * root)};
    if (filter.kind == biquad) above = ascending(filter.numerator), below = ascending(filter.denominator);
    const std::size_t degree = below.size() - 1;
    const auto mapped = [&](const Polynomial200& c) {
      Polynomial200 sum(degree + 1, Real200(0));
      Real200 power = 1;
      for (std::size_t i = 0; i < c.size(); ++i, power *= g) {
        Polynomial200 term{Real200(c[i] * power)};
        for (std::size_t j = 0; j < degree; ++j) term = times(term, {Real200(j < i ? -1 : 1), Real200(1)});
        for (std::size_t j = 0; j <= degree; ++j) sum[j] += term[j];
      }
      return sum;
    };
    return {mapped(above), mapped(below)};
  }

  static Polynomial200 times(const Polynomial200& a, const Polynomial200& b) {
    Polynomial200 product(a.size() + b.size() - 1, Real200(0));
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
    return product;
  }

  Polynomial200 numerator_;
  Polynomial200 denominator_;
  Polynomial200 damper_;
};

}  // namespace zwidth::test
