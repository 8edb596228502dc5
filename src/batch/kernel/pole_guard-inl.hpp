// The second route: Routh's count of the closed loop's poles at a given stiffness, from the matrix exponential of the
// device's state space. Shares nothing with the modal terms. One device per lane; included once per instruction set.
#if defined(ZWIDTH_BATCH_POLE_GUARD_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ZWIDTH_BATCH_POLE_GUARD_INL_HPP
#undef ZWIDTH_BATCH_POLE_GUARD_INL_HPP
#else
#define ZWIDTH_BATCH_POLE_GUARD_INL_HPP
#endif

#include "batch/kernel/kernel_terms-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace zwidth::internal::HWY_NAMESPACE {

inline constexpr std::size_t most_degree = 22;  // of the closed loop

template <std::size_t n>
struct Matrix {
  V at[n][n];
};

template <std::size_t n>
HWY_INLINE Matrix<n> times(const Matrix<n>& a, const Matrix<n>& b) {
  Matrix<n> c;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      V sum = a.at[i][0] * b.at[0][j];
      for (std::size_t k = 1; k < n; ++k) sum = hn::MulAdd(a.at[i][k], b.at[k][j], sum);
      c.at[i][j] = sum;
    }
  }
  return c;
}

// x' = A x + B u: B is zero but for one entry.
template <std::size_t n>
struct StateSpace {
  Matrix<n> a;
  std::size_t force = 0;  // the row of B that is not zero
  V gain;                 // and what it is
  std::size_t output = 0;
};

// Positions, velocities over `scale`, and the lagged force.
template <std::size_t n>
HWY_INLINE StateSpace<n> state_space_of(const KernelGroup& group, const V* in) {
  const V zero = number(0.0);
  const V one = number(1.0);
  const auto input = [in](KernelInput which) HWY_ATTR { return in[static_cast<std::size_t>(which)]; };
  StateSpace<n> system;
  for (auto& row : system.a.at) {
    for (V& entry : row) entry = zero;
  }
  const V m1 = input(KernelInput::actuated_mass);
  const V g1 = input(KernelInput::actuated_damping);
  const std::size_t bodies = group.two_bodies ? 2 : 1;
  V scale = one / input(KernelInput::period);
  if constexpr (n >= 4) {  // two bodies have two positions and two velocities
    if (group.two_bodies) {
      const V m2 = input(KernelInput::other_mass);
      const V g2 = input(KernelInput::other_damping);
      const V k = input(KernelInput::link_stiffness);
      const V b = input(KernelInput::link_damping);
      scale = hn::Sqrt(k * (m1 + m2) / (m1 * m2));
      system.a.at[2][0] = hn::Neg(k / (m1 * scale));
      system.a.at[2][1] = k / (m1 * scale);
      system.a.at[3][0] = k / (m2 * scale);
      system.a.at[3][1] = hn::Neg(k / (m2 * scale));
      system.a.at[2][2] = hn::Neg((g1 + b) / m1);
      system.a.at[2][3] = b / m1;
      system.a.at[3][2] = b / m2;
      system.a.at[3][3] = hn::Neg((g2 + b) / m2);
      system.output = group.collocated ? 0 : 1;
    }
  }
  if (!group.two_bodies) {
    system.a.at[1][0] = hn::Neg(input(KernelInput::actuated_stiffness) / (m1 * scale));
    system.a.at[1][1] = hn::Neg(g1 / m1);
  }
  for (std::size_t i = 0; i < bodies; ++i) system.a.at[i][bodies + i] = scale;
  system.force = bodies;
  system.gain = one / (m1 * scale);
  if (group.lag) {
    const V rate = one / input(KernelInput::lag);
    system.a.at[bodies][n - 1] = rate;
    system.a.at[n - 1][n - 1] = hn::Neg(rate);
    system.force = n - 1;
  }
  return system;
}

template <std::size_t n>
HWY_INLINE V norm_of(const Matrix<n>& m) {
  V norm = number(0.0);
  for (std::size_t i = 0; i < n; ++i) {
    V row = number(0.0);
    for (std::size_t j = 0; j < n; ++j) row = row + hn::Abs(m.at[i][j]);
    norm = hn::Max(norm, row);
  }
  return norm;
}

template <std::size_t n>
struct Exponential {
  Matrix<n> e;  // e^{A t} - I
  V gamma[n];   // integral of e^{A s} B over 0..t
};

// By Taylor's series of A t / 2^s and E <- 2 E + E².
template <std::size_t n>
HWY_INLINE Exponential<n> exponential_of(const StateSpace<n>& system, V t) {
  const Tag tag;
  constexpr double largest = 0.25;  // norm of what the series sums
  constexpr int most_halvings = 16;
  V norm = norm_of(system.a) * t;
  V factor = t;
  V halvings = number(0.0);
  for (int i = 0; i < most_halvings; ++i) {
    const M large = norm > number(largest);
    if (hn::AllFalse(tag, large)) break;
    norm = choose(large, number(0.5) * norm, norm);
    factor = choose(large, number(0.5) * factor, factor);
    halvings = halvings + hn::IfThenElseZero(large, number(1.0));
  }
  Matrix<n> x;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) x.at[i][j] = factor * system.a.at[i][j];
  }
  // sum of X^k / (k + 1)!, k <= 11: four blocks of three powers
  const Matrix<n> x2 = times(x, x);
  const Matrix<n> x3 = times(x2, x);
  double inverse[12];
  double factorial = 1.0;
  for (int k = 0; k < 12; ++k) inverse[k] = 1.0 / (factorial *= k + 1.0);
  Matrix<n> sum;
  for (std::size_t block = 4; block-- > 0;) {
    if (block < 3) sum = times(x3, sum);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        V entry = hn::MulAdd(number(inverse[3 * block + 2]), x2.at[i][j], number(inverse[3 * block + 1]) * x.at[i][j]);
        if (i == j) entry = entry + number(inverse[3 * block]);
        sum.at[i][j] = block < 3 ? sum.at[i][j] + entry : entry;
      }
    }
  }
  Exponential<n> result;
  result.e = times(x, sum);
  for (std::size_t i = 0; i < n; ++i) result.gamma[i] = factor * system.gain * sum.at[i][system.force];
  for (int step = 0; step < most_halvings; ++step) {
    const M left = halvings > number(step);
    if (hn::AllFalse(tag, left)) break;
    const Matrix<n> squared = times(result.e, result.e);
    V turned[n];
    for (std::size_t i = 0; i < n; ++i) {
      turned[i] = result.gamma[i] + result.gamma[i];
      for (std::size_t j = 0; j < n; ++j) turned[i] = hn::MulAdd(result.e.at[i][j], result.gamma[j], turned[i]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      result.gamma[i] = choose(left, turned[i], result.gamma[i]);
      for (std::size_t j = 0; j < n; ++j) {
        const V entry = result.e.at[i][j];
        result.e.at[i][j] = choose(left, entry + entry + squared.at[i][j], entry);
      }
    }
  }
  return result;
}

// Coefficients by rising powers, with bounds of their rounding in units of `unit`.
struct BoundedPolynomial {
  std::size_t count = 0;
  V value[most_degree + 1];
  V size[most_degree + 1];
};

HWY_INLINE void multiply_by(BoundedPolynomial& p, V constant, V linear) {
  p.value[p.count] = p.size[p.count] = number(0.0);
  for (std::size_t i = p.count + 1; i-- > 0;) {
    const V lower = i > 0 ? p.value[i - 1] : number(0.0);
    const V lower_size = i > 0 ? p.size[i - 1] : number(0.0);
    p.value[i] = hn::MulAdd(p.value[i], constant, lower * linear);
    p.size[i] = hn::MulAdd(p.size[i], hn::Abs(constant), lower_size * hn::Abs(linear));
  }
  ++p.count;
}

// sum p_k (2 w)^k (1 - w)^(n-k)
HWY_INLINE BoundedPolynomial mapped(const V* p, const V* size, std::size_t count) {
  BoundedPolynomial sum;
  sum.count = 1;
  sum.value[0] = p[count - 1];
  sum.size[0] = size[count - 1];
  BoundedPolynomial powers;
  powers.count = 1;
  powers.value[0] = powers.size[0] = number(1.0);
  for (std::size_t i = count - 1; i-- > 0;) {
    multiply_by(powers, number(1.0), number(-1.0));
    multiply_by(sum, number(0.0), number(2.0));
    for (std::size_t j = 0; j < sum.count; ++j) {
      sum.value[j] = hn::MulAdd(powers.value[j], p[i], sum.value[j]);
      sum.size[j] = hn::MulAdd(powers.size[j], size[i], sum.size[j]);
    }
  }
  return sum;
}

// The closed loop's characteristic polynomial in w = (z - 1)/(z + 1): open + K stiffness.
struct LoopPolynomial {
  BoundedPolynomial open;  // the damper's part included
  BoundedPolynomial stiffness;
  V unit;  // rounding of both, relative to the sizes
};

template <std::size_t n>
HWY_INLINE LoopPolynomial loop_polynomial(const KernelGroup& group, const V* in) {
  const V zero = number(0.0);
  const V one = number(1.0);
  const auto input = [in](KernelInput which) HWY_ATTR { return in[static_cast<std::size_t>(which)]; };
  const StateSpace<n> system = state_space_of<n>(group, in);
  const V period = input(KernelInput::period);
  const Exponential<n> whole = exponential_of(system, period);
  V recent[n];
  V old[n];
  for (std::size_t i = 0; i < n; ++i) recent[i] = whole.gamma[i], old[i] = zero;
  if (group.fractional) {
    const Exponential<n> first = exponential_of(system, input(KernelInput::with_new));
    for (std::size_t i = 0; i < n; ++i) recent[i] = first.gamma[i], old[i] = whole.gamma[i] - first.gamma[i];
  }
  // Faddeev's recursion: det(delta I - Phi) and C adj(delta I - Phi) Gamma
  const V norm = norm_of(whole.e);
  V denominator[n + 1];
  V d_size[n + 1];
  V with_new[n];
  V with_old[n];
  V n_size[n];
  denominator[n] = d_size[n] = one;
  Matrix<n> m;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) m.at[i][j] = i == j ? one : zero;
  }
  V power = one;  // of the norm
  for (std::size_t k = 1; k <= n; ++k) {
    V of_new = zero;
    V of_old = zero;
    V of_size = zero;
    for (std::size_t j = 0; j < n; ++j) {
      of_new = hn::MulAdd(m.at[system.output][j], recent[j], of_new);
      of_old = hn::MulAdd(m.at[system.output][j], old[j], of_old);
      of_size = hn::MulAdd(power, hn::Abs(recent[j]) + hn::Abs(old[j]), of_size);
    }
    with_new[n - k] = of_new;
    with_old[n - k] = of_old;
    n_size[n - k] = of_size;
    power = power * norm;
    m = k == 1 ? whole.e : times(whole.e, m);
    V trace = zero;
    for (std::size_t i = 0; i < n; ++i) trace = trace + m.at[i][i];
    denominator[n - k] = trace * number(-1.0 / static_cast<double>(k));
    d_size[n - k] = power;
    for (std::size_t i = 0; i < n; ++i) m.at[i][i] = m.at[i][i] + denominator[n - k];
  }
  LoopPolynomial loop{mapped(denominator, d_size, n + 1), mapped(with_new, n_size, n),
                      number(4e-15) * (number(4.0) + norm_of(system.a) * period)};
  if (group.fractional) {
    multiply_by(loop.stiffness, one, one);
    BoundedPolynomial late = mapped(with_old, n_size, n);
    multiply_by(late, one, hn::Neg(one));
    for (std::size_t i = 0; i < late.count; ++i) {
      loop.stiffness.value[i] = loop.stiffness.value[i] + late.value[i];
      loop.stiffness.size[i] = loop.stiffness.size[i] + late.size[i];
    }
  }
  for (std::size_t i = 0; i < group.delay_samples; ++i) multiply_by(loop.open, one, one);
  while (loop.stiffness.count < loop.open.count) multiply_by(loop.stiffness, one, hn::Neg(one));
  if (group.damper) {
    V c = one;
    if (group.filter) {
      c = one - hn::Exp(Tag(), number(-2.0 * 3.14159265358979323846) * input(KernelInput::velocity_filter_hz) * period);
    }
    BoundedPolynomial damping = loop.stiffness;
    multiply_by(damping, zero, number(2.0) * c / period * input(KernelInput::damper));
    multiply_by(loop.open, c, number(2.0) - c);
    multiply_by(loop.stiffness, c, number(2.0) - c);
    for (std::size_t i = 0; i < damping.count; ++i) {
      loop.open.value[i] = loop.open.value[i] + damping.value[i];
      loop.open.size[i] = loop.open.size[i] + damping.size[i];
    }
  }
  return loop;
}

// Whether Routh's first column is surely positive (the loop stable), or surely changes its sign.
struct RouthSigns {
  M stable, unstable;
};

HWY_INLINE RouthSigns routh_signs(const LoopPolynomial& loop, V stiffness) {
  const V rounding = number(2.3e-16);
  V upper[most_degree + 1];
  V lower[most_degree + 1];
  V upper_error[most_degree + 1];
  V lower_error[most_degree + 1];
  const std::size_t count = loop.open.count;
  std::size_t n_upper = 0;
  std::size_t n_lower = 0;
  for (std::size_t i = count; i-- > 0;) {
    const V value = hn::MulAdd(stiffness, loop.stiffness.value[i], loop.open.value[i]);
    const V error = loop.unit * hn::MulAdd(stiffness, loop.stiffness.size[i], loop.open.size[i]);
    if ((count - 1 - i) % 2 == 0) {
      upper[n_upper] = value;
      upper_error[n_upper++] = error;
    } else {
      lower[n_lower] = value;
      lower_error[n_lower++] = error;
    }
  }
  M positive = upper[0] > upper_error[0];  // so far, all of the first column
  M turned = hn::And(upper[0]<hn::Neg(upper_error[0]), lower[0]> lower_error[0]);
  while (n_lower > 0) {
    turned = hn::Or(turned, hn::And(positive, lower[0] < hn::Neg(lower_error[0])));
    positive = hn::And(positive, lower[0] > lower_error[0]);
    const V inverse = number(1.0) / lower[0];
    const V ratio = upper[0] * inverse;
    const V ratio_size = hn::Abs(ratio);
    const V ratio_error =
        (upper_error[0] + ratio_size * lower_error[0]) / (hn::Abs(lower[0]) - lower_error[0]) + rounding * ratio_size;
    for (std::size_t i = 1; i < n_upper; ++i) {
      V value = upper[i];
      V error = upper_error[i];
      if (i < n_lower) {
        const V moved = ratio * lower[i];
        error = error + ratio_size * lower_error[i] + ratio_error * (hn::Abs(lower[i]) + lower_error[i]) +
                rounding * (hn::Abs(value) + hn::Abs(moved));
        value = value - moved;
      }
      upper[i - 1] = lower[i - 1];
      upper_error[i - 1] = lower_error[i - 1];
      lower[i - 1] = value;
      lower_error[i - 1] = error;
    }
    if (n_upper == n_lower) {
      upper[n_lower - 1] = lower[n_lower - 1];
      upper_error[n_lower - 1] = lower_error[n_lower - 1];
    }
    const std::size_t next = n_upper - 1;
    n_upper = n_lower;
    n_lower = next;
  }
  return {positive, turned};
}

// Stable at half and just below, unstable just above.
template <std::size_t n>
HWY_INLINE M poles_confirm(const KernelGroup& group, const V* in, V stiffness) {
  constexpr double closeness = 1e-6;  // as in guarded_stiffness.cpp
  const LoopPolynomial loop = loop_polynomial<n>(group, in);
  const M half = routh_signs(loop, stiffness * number(0.5)).stable;
  const M below = routh_signs(loop, stiffness * number(1.0 - closeness)).stable;
  const M above = routh_signs(loop, stiffness * number(1.0 + closeness)).unstable;
  return hn::And(half, hn::And(below, above));
}

}  // namespace zwidth::internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
