// The closed loop's characteristic polynomial in ball arithmetic, Routh's count of its roots outside the unit circle and
// those on it: decides with proof where double precision cannot.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "model/device_matrices.hpp"
#include "sampling/sampling_instants.hpp"
#include "stability/roots/ball.hpp"
#include "stability/second_route/characteristic_polynomial.hpp"
#include "stability/second_route/pole_count.hpp"

namespace zwidth::internal {
namespace {

// Bits, by turns, until every sign is sure. Poles that coincide m times are known to the m-th root of what rounding leaves.
constexpr std::array<slong, 3> bits_of_count{332, 768, 2048};
// Beyond so many states the last would take seconds.
constexpr std::size_t most_states_for_all = 24;
constexpr slong bits_of_polish = 332;

int sure_sign(const Polynomial<Ball>& row) { return row[0].sure_sign(); }

// x' = A x + B u, y = c x, and the input as one more state that stays: the generator [[A, b], [0, 0]].
struct Continuous {
  explicit Continuous(std::size_t states)
      : generator((states + 1) * (states + 1)), output(states, Ball(0.0)), size(states + 1) {}
  Ball& operator()(std::size_t i, std::size_t j) { return generator[i * size + j]; }

  std::vector<Ball> generator;
  std::vector<Ball> output;
  std::size_t size;
};

// M^-1 [-K -D b]
void set_coupled(Continuous& system, const DeviceMatrices<Ball>& matrices, const Device& device) {
  const std::size_t n = matrices.mass.size();
  BallMatrix mass(n, n);
  BallMatrix forces(n, 2 * n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    system(i, n + i) = Ball(1.0);
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t entry = i * n + j;
      arb_set(mass(i, j), (i == j ? matrices.mass[i] : matrices.coupling[entry]).get());
      arb_neg(forces(i, j), matrices.stiffness[entry].get());
      arb_neg(forces(i, n + j), matrices.damping[entry].get());
    }
  }
  for (const auto& [i, weight] : weights_of(device, device.loop().actuated)) arb_set_d(forces(i, 2 * n), weight);
  BallMatrix solution(n, 2 * n + 1);
  arb_mat_spd_solve(solution, mass, forces, BallDigits::bits());
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= 2 * n; ++j) arb_set(system(n + i, j).get(), solution(i, j));
  }
  for (const auto& [i, weight] : weights_of(device, device.loop().sensed)) system.output[i] = Ball(weight);
}

Continuous of_bodies(const Device& device, std::size_t more) {
  const DeviceMatrices<Ball> matrices = device_matrices<Ball>(device);
  const std::size_t n = matrices.mass.size();
  Continuous system(2 * n + more);
  if (!matrices.coupling.empty()) {
    set_coupled(system, matrices, device);
    return system;
  }
  for (std::size_t i = 0; i < n; ++i) {
    system(i, n + i) = Ball(1.0);
    for (std::size_t j = 0; j < n; ++j) {
      system(n + i, j) = -matrices.stiffness[i * n + j] / matrices.mass[i];
      system(n + i, n + j) = -matrices.damping[i * n + j] / matrices.mass[i];
    }
  }
  const std::size_t actuated = device.loop().actuated;
  system(n + actuated, 2 * n) = Ball(1.0) / matrices.mass[actuated];  // of the lag, or of the input
  system.output[device.loop().sensed] = Ball(1.0);
  return system;
}

Continuous of_transfer_function(const TransferFunction& function, std::size_t more) {
  const std::size_t n = function.denominator.size() - 1;
  Continuous system(n + more);
  const Ball leading_coefficient(function.denominator[0]);
  for (std::size_t i = 0; i + 1 < n; ++i) system(i, i + 1) = Ball(1.0);
  for (std::size_t i = 0; i < n; ++i) {
    system(n - 1, i) = -Ball(function.denominator[n - i]) / leading_coefficient;
  }
  system(n - 1, n) = Ball(1.0);
  for (std::size_t i = 0; i < function.numerator.size() && i < n; ++i) {
    system.output[i] = Ball(function.numerator[function.numerator.size() - 1 - i]) / leading_coefficient;
  }
  return system;
}

Continuous continuous(const Device& device) {
  const double tau = device.parameters().actuator.time_constant;
  const double bandwidth = device.parameters().sensor.tracking_bandwidth;
  const std::size_t tracked = bandwidth > 0.0 ? 2 : 0;
  const std::size_t more = (tau > 0.0 ? 1 : 0) + tracked;
  Continuous system = device.is_mechanical() ? of_bodies(device, more)
                                             : of_transfer_function(*device.parameters().transfer_function, more);
  const std::size_t states = system.output.size();
  const std::size_t last = states - 1 - tracked;  // before those of the tracking
  if (tau > 0.0) {
    system(last, last) = Ball(-1.0) / Ball(tau);
    system(last, states) = Ball(1.0) / Ball(tau);
  } else if (tracked > 0) {  // the input stands behind the tracking
    for (std::size_t i = 0; i <= last; ++i) std::swap(system(i, last + 1), system(i, states));
  }
  if (tracked == 0) return system;
  // p' = w (2 (y - p) + q), q' = w (y - p); p is read.
  const std::size_t p = last + 1;
  const Ball w(bandwidth);
  for (std::size_t i = 0; i <= last; ++i) {
    system(p + 1, i) = w * system.output[i];
    system(p, i) = Ball(2.0) * system(p + 1, i);
    system.output[i] = Ball(0.0);
  }
  system(p, p) = Ball(-2.0) * w;
  system(p, p + 1) = w;
  system(p + 1, p) = -w;
  system.output[p] = Ball(1.0);
  return system;
}

// e^{generator time}
void exponential(BallMatrix& result, const Continuous& system, const Ball& time) {
  BallMatrix scaled(system.size, system.size);
  for (std::size_t i = 0; i < system.size; ++i) {
    for (std::size_t j = 0; j < system.size; ++j) {
      arb_mul(scaled(i, j), system.generator[i * system.size + j].get(), time.get(), BallDigits::bits());
    }
  }
  arb_mat_exp(result, scaled, BallDigits::bits());
}

PlantPolynomials<Ball> sampled(const Device& device, const SamplingInstants& instants) {
  const Continuous system = continuous(device);
  const std::size_t n = system.output.size();
  BallMatrix early(n + 1, n + 1);
  BallMatrix whole(n + 1, n + 1);
  exponential(early, system, Ball(instants.with_new));
  exponential(whole, system, Ball(instants.with_new) + Ball(instants.with_old));
  std::vector<Ball> phi(n * n);
  std::vector<Ball> gamma1(n);
  std::vector<Ball> gamma2(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) arb_set(phi[i * n + j].get(), whole(i, j));
    phi[i * n + i] -= Ball(1.0);
    arb_set(gamma1[i].get(), early(i, n));
    if (instants.with_old > 0.0) arb_sub(gamma2[i].get(), whole(i, n), early(i, n), BallDigits::bits());
  }
  return plant_polynomials<Ball>(phi, gamma1, gamma2, system.output);
}

Polynomial<Ball> ascending(const std::vector<double>& descending) {
  Polynomial<Ball> result;
  for (std::size_t i = descending.size(); i-- > 0;) result.emplace_back(descending[i]);
  return result;
}

Ball turns_per_second(double frequency_hz) {  // rad/s
  Ball result;
  arb_const_pi(result.get(), BallDigits::bits());
  return result * Ball(2.0 * frequency_hz);
}

// sum c_i s^i (delta + 2)^degree with s = g delta / (delta + 2)
Polynomial<Ball> by_tustin(Polynomial<Ball> c, std::size_t degree, const Ball& g) {
  c.resize(degree + 1, Ball(0.0));
  Polynomial<Ball> sum{c[degree]};
  Polynomial<Ball> powers{Ball(1.0)};  // of delta + 2
  for (std::size_t i = degree; i-- > 0;) {
    multiply(powers, Ball(2.0), Ball(1.0));
    multiply(sum, Ball(0.0), g);
    for (std::size_t j = 0; j < powers.size(); ++j) sum[j] += powers[j] * c[i];
  }
  return sum;
}

// Of s over the filter's own frequency, but of a biquad, whose coefficients are of s.
WallPolynomials<Ball>::Filter in_s(const WallFilter& filter) {
  using enum WallFilter::Kind;
  const Ball one(1.0);
  const Ball twice = Ball(2.0) * Ball(filter.damping_ratio);
  if (filter.kind == low_pass && filter.order == 1) return {{one}, {one, one}};
  if (filter.kind == low_pass) return {{one}, {one, twice, one}};
  if (filter.kind == notch) return {{one, Ball(filter.depth) * twice, one}, {one, twice, one}};
  if (filter.kind == lead_lag) {
    Ball root(filter.ratio);
    arb_sqrt(root.get(), root.get(), BallDigits::bits());
    return {{one, root}, {one, one / root}};
  }
  return {ascending(filter.numerator), ascending(filter.denominator)};
}

WallPolynomials<Ball>::Filter in_delta(const WallFilter& filter, double period) {
  WallPolynomials<Ball>::Filter in = in_s(filter);
  const std::size_t degree = in.denominator.size() - 1;
  if (filter.kind == WallFilter::Kind::digital) {  // z = delta + 1
    for (Polynomial<Ball>* p : {&in.numerator, &in.denominator}) {
      Polynomial<Ball> shifted{p->back()};
      for (std::size_t i = p->size() - 1; i-- > 0;) {
        multiply(shifted, Ball(1.0), Ball(1.0));
        shifted[0] += (*p)[i];
      }
      *p = shifted;
    }
    return in;
  }
  Ball g = Ball(2.0) / Ball(period);
  if (filter.frequency_hz > 0.0) {
    const Ball w = turns_per_second(filter.frequency_hz);
    arb_cot(g.get(), (w * Ball(0.5) * Ball(period)).get(), BallDigits::bits());
    if (filter.kind == WallFilter::Kind::biquad) g = g * w;
  }
  return {by_tustin(in.numerator, degree, g), by_tustin(in.denominator, degree, g)};
}

// As it is defined: nothing rounded.
WallPolynomials<Ball> exact_wall(const Wall& wall, double period) {
  WallPolynomials<Ball> result;
  for (const WallFilter& filter : wall.filters) result.filters.push_back(in_delta(filter, period));
  result.has_damper = wall.damping > 0.0;
  if (wall.velocity_filter_hz > 0.0) {
    const Ball decay = -turns_per_second(wall.velocity_filter_hz) * Ball(period);
    arb_expm1(result.low_pass.get(), decay.get(), BallDigits::bits());
    result.low_pass = -result.low_pass;
  }
  return result;
}

// The loop's polynomial on the circle of radius 1 + beside.
CirclePolynomials<Ball> loop_in_digits(const Device& device, const Ball& beside) {
  const double period = device.loop().sampling_period;
  const SamplingInstants instants = sampling_instants({period, device.loop().delay});
  return {sampled(device, instants),
          instants.whole_samples,
          instants.with_old > 0.0,
          exact_wall(device.parameters().wall, period),
          period,
          beside};
}

// p(jy) and d p(jy) / dy
struct OnAxis {
  Ball re{0.0};
  Ball im{0.0};
  Ball slope_re{0.0};
  Ball slope_im{0.0};
};

OnAxis on_axis(const Polynomial<Ball>& p, const Ball& y) {
  OnAxis at;  // Horner's rule for p and p' in w = jy
  for (std::size_t i = p.size(); i-- > 0;) {
    const Ball slope_re = at.re - y * at.slope_im;
    at.slope_im = at.im + y * at.slope_re;
    at.slope_re = slope_re;
    const Ball re = p[i] - y * at.im;
    at.im = y * at.re;
    at.re = re;
  }
  return {at.re, at.im, -at.slope_im, at.slope_re};
}

// A pole at z = 1 (w = 0) or z = -1 (w infinite), where the two coefficients decide.
std::optional<PoleOnCircle> settled_at_end(const Ball& open, const Ball& of_stiffness, double angle) {
  if (of_stiffness.sure_sign() == 0 || open.sure_sign() == 0) return std::nullopt;
  return PoleOnCircle{angle, (-open / of_stiffness).middle()};
}

// Newton's method for (y, K) in open(jy) + K of_stiffness(jy) = 0, with z = (1 + jy)/(1 - jy): y = tan(angle/2).
std::optional<PoleOnCircle> settled(const Polynomial<Ball>& open, const Polynomial<Ball>& of_stiffness,
                                    const PoleOnCircle& start) {
  constexpr int most_steps = 30;
  constexpr double close_enough = 1e-20;  // relative
  constexpr double beside = 1e-6;         // of the start's angle, relative
  constexpr double beside_pi = 1e-4;      // of its distance from pi, where filters in double lose as much
  constexpr double rounding = 2e-15;      // of the start's chord, |z - 1|^2
  if (start.angle == 0.0) return settled_at_end(open.front(), of_stiffness.front(), start.angle);
  if (start.angle >= std::numbers::pi) return settled_at_end(open.back(), of_stiffness.back(), start.angle);
  const double from_pi = std::numbers::pi - start.angle;
  const double reach = std::min(beside * start.angle, std::max(beside_pi * from_pi, rounding / from_pi)) + rounding;
  Ball y(std::tan(0.5 * start.angle));
  Ball stiffness(start.stiffness);
  for (int i = 0; i < most_steps; ++i) {
    const OnAxis a = on_axis(open, y);
    const OnAxis b = on_axis(of_stiffness, y);
    const Ball re = a.re + stiffness * b.re;
    const Ball im = a.im + stiffness * b.im;
    const Ball slope_re = a.slope_re + stiffness * b.slope_re;
    const Ball slope_im = a.slope_im + stiffness * b.slope_im;
    const Ball determinant = slope_re * b.im - slope_im * b.re;
    if (determinant.sure_sign() == 0) return std::nullopt;
    const Ball by_y = (re * b.im - im * b.re) / determinant;
    const Ball by_stiffness = (slope_re * im - slope_im * re) / determinant;
    y = (y - by_y).sharp();
    stiffness = (stiffness - by_stiffness).sharp();
    const double angle = 2.0 * std::atan(y.middle());
    if (!(std::abs(angle - start.angle) < reach)) return std::nullopt;
    if (std::abs(by_y.middle()) <= close_enough * y.middle() &&
        std::abs(by_stiffness.middle()) <= close_enough * std::abs(stiffness.middle())) {
      return PoleOnCircle{angle, stiffness.middle()};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<int> unstable_poles_in_digits(const Device& device, double stiffness) {
  // Just outside the circle, so that a mode that nothing damps and nothing moves lies inside.
  constexpr double beside = 0x1p-80;
  for (const slong bits : bits_of_count) {
    const BallDigits digits(bits);
    const CirclePolynomials<Ball> loop = loop_in_digits(device, Ball(beside));
    if (const auto count = loop.outside(stiffness, device.parameters().wall.damping, sure_sign)) return count;
    if (bits > bits_of_count.front() && loop.of_stiffness().size() > most_states_for_all) break;
  }
  return std::nullopt;
}

void polish_poles_in_digits(const Device& device, std::vector<PoleOnCircle>& poles) {
  const BallDigits digits(bits_of_polish);
  const CirclePolynomials<Ball> loop = loop_in_digits(device, Ball(0.0));
  const Polynomial<Ball> open = loop.without_spring(device.parameters().wall.damping);
  for (PoleOnCircle& pole : poles) pole = settled(open, loop.of_stiffness(), pole).value_or(pole);
}

}  // namespace zwidth::internal
