#pragma once

// The closed loop's characteristic polynomial, and Routh's count of its roots outside a circle: in any arithmetic with
// + - * / that is made from double.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth::internal {

template <typename Number>
using Polynomial = std::vector<Number>;  // ascending powers

template <typename Number>
Polynomial<Number> operator*(const Polynomial<Number>& a, const Polynomial<Number>& b) {
  Polynomial<Number> product(a.size() + b.size() - 1, Number(0.0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  }
  return product;
}

// p times (c0 + c1 w)
template <typename Number>
void multiply(Polynomial<Number>& p, const Number& c0, const Number& c1) {
  p.push_back(p.back() * c1);
  for (std::size_t i = p.size() - 2; i > 0; --i) p[i] = p[i] * c0 + p[i - 1] * c1;
  p[0] = p[0] * c0;
}

// p times (1 - w)
template <typename Number>
void multiply_down(Polynomial<Number>& p) {
  p.push_back(Number(0.0) - p.back());
  for (std::size_t i = p.size() - 2; i > 0; --i) p[i] = p[i] - p[i - 1];
}

// det(delta I - Phi) and c adj(delta I - Phi) Gamma of both inputs.
template <typename Number>
struct PlantPolynomials {
  Polynomial<Number> denominator;
  Polynomial<Number> with_new;
  Polynomial<Number> with_old;
};

// By Faddeev's and Leverrier's recursion:
//   M_1 = I, d_{n-k} = -tr(Phi M_k)/k, M_{k+1} = Phi M_k + d_{n-k} I, adj = sum M_k delta^{n-k}
// Entry: of Phi (row by row), gamma1, gamma2 and output; Number, or double where these are rounded anyway.
template <typename Number, typename Entry>
PlantPolynomials<Number> plant_polynomials(const std::vector<Entry>& phi, const std::vector<Entry>& gamma1,
                                           const std::vector<Entry>& gamma2, const std::vector<Entry>& output) {
  const std::size_t n = output.size();
  const Number zero(0.0);
  const Entry none(0.0);
  PlantPolynomials<Number> plant{Polynomial<Number>(n, zero), Polynomial<Number>(n, zero), Polynomial<Number>(n, zero)};
  plant.denominator.push_back(Number(1.0));
  std::vector<Number> m(n * n, zero);
  std::vector<Number> product(n * n, zero);
  for (std::size_t i = 0; i < n; ++i) m[i * n + i] = Number(1.0);
  for (std::size_t k = 1; k <= n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      if (output[i] == none) continue;
      for (std::size_t j = 0; j < n; ++j) {
        const Number each = m[i * n + j] * output[i];
        plant.with_new[n - k] += each * gamma1[j];
        if (!(gamma2[j] == none)) plant.with_old[n - k] += each * gamma2[j];
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        if (k == n && i != j) continue;  // of the last product the trace matters alone
        Number& entry = product[i * n + j];
        entry = zero;
        if (k == 1) {
          entry = Number(phi[i * n + j]);
        } else {
          for (std::size_t l = 0; l < n; ++l) entry += m[l * n + j] * phi[i * n + l];
        }
      }
    }
    std::swap(m, product);
    Number trace = zero;
    for (std::size_t i = 0; i < n; ++i) trace += m[i * n + i];
    const Number coefficient = trace / Number(-static_cast<double>(k));
    plant.denominator[n - k] = coefficient;
    for (std::size_t i = 0; i < n; ++i) m[i * n + i] += coefficient;
  }
  return plant;
}

// The wall beside its gains: each filter as polynomials of delta, and 1 - a of the velocity's low-pass.
template <typename Number>
struct WallPolynomials {
  struct Filter {
    Polynomial<Number> numerator;
    Polynomial<Number> denominator;
  };
  std::vector<Filter> filters;
  bool has_damper = false;
  Number low_pass = Number(1.0);  // 1 - a
};

// As the wall runs: from the coefficients that filter_section() rounds.
template <typename Number>
WallPolynomials<Number> rounded_wall(const Wall& wall, double period) {
  WallPolynomials<Number> result;
  for (const WallFilter& filter : wall.filters) {
    const FilterCoefficients delta = in_delta(filter_section(filter, period));
    auto& section = result.filters.emplace_back();
    for (const double c : delta.numerator) section.numerator.emplace_back(c);
    for (const double c : delta.denominator) section.denominator.emplace_back(c);
  }
  result.has_damper = wall.damping > 0.0;
  if (wall.velocity_filter_hz > 0.0) {
    result.low_pass = Number(velocity_filter_gain(wall.velocity_filter_hz, period));
  }
  return result;
}

// The characteristic polynomial is open + K stiffness + B damping, here of w, which maps the outside of a circle to the
// right half plane:  z/radius = (1 + w)/(1 - w); with g = radius - 1,  delta = (g + (g + 2) w)/(1 - w). Of delta it is
//     D (delta + 1 - a) z^l d_F + (K (delta + 1 - a) + B (1 - a)/T delta) n_F (N1 z + N2) z^-1
template <typename Number>
class CirclePolynomials {
 public:
  // `samples`: of delay, whole. A wall without damping leaves the damper out.
  CirclePolynomials(const PlantPolynomials<Number>& plant, std::size_t samples, bool fractional,
                    const WallPolynomials<Number>& wall, double period, const Number& g)
      : up_{g, g + Number(2.0)} {
    const std::array<Number, 2> z{Number(1.0) + up_[0], up_[1] - Number(1.0)};  // times 1 - w
    open_ = mapped(plant.denominator);
    Polynomial<Number> input = mapped(plant.with_new);
    if (fractional) {
      multiply(input, z[0], z[1]);
      Polynomial<Number> old = mapped(plant.with_old);
      multiply_down(old);
      for (std::size_t i = 0; i < input.size(); ++i) input[i] += old[i];
    }
    for (std::size_t i = 0; i < samples + (fractional ? 1 : 0); ++i) multiply(open_, z[0], z[1]);
    for (const auto& filter : wall.filters) {
      input = input * mapped(filter.numerator);
      open_ = open_ * mapped(filter.denominator);
    }
    while (input.size() < open_.size()) multiply_down(input);
    if (wall.has_damper) {
      const Number rate = wall.low_pass / Number(period);
      damping_ = input;
      multiply(damping_, up_[0] * rate, up_[1] * rate);
      const std::array<Number, 2> low_pass{wall.low_pass + up_[0], up_[1] - wall.low_pass};
      multiply(open_, low_pass[0], low_pass[1]);
      multiply(input, low_pass[0], low_pass[1]);
    }
    stiffness_ = std::move(input);
  }

  // Poles outside the circle; nothing where a sign is unsure. sure_sign(row): of the first element of a row of Routh's
  // array, 0 where rounding may have made it.
  template <typename SureSign>
  [[nodiscard]] std::optional<int> outside(double stiffness, double damping, SureSign sure_sign) const {
    Polynomial<Number> closed = without_spring(damping);
    for (std::size_t i = 0; i < stiffness_.size(); ++i) closed[i] += stiffness_[i] * Number(stiffness);
    return roots_on_the_right(closed, sure_sign);
  }

  // The polynomial of w at K = 0, and what each unit of K adds to it.
  [[nodiscard]] Polynomial<Number> without_spring(double damping) const {
    Polynomial<Number> closed = open_;
    for (std::size_t i = 0; i < damping_.size(); ++i) closed[i] += damping_[i] * Number(damping);
    return closed;
  }
  [[nodiscard]] const Polynomial<Number>& of_stiffness() const { return stiffness_; }

 private:
  // Of n + 1 coefficients in delta, times (1 - w)^n. Horner: sum_k p_k up^k down^(n-k)
  [[nodiscard]] Polynomial<Number> mapped(const Polynomial<Number>& p) const {
    Polynomial<Number> sum{p.back()};
    Polynomial<Number> powers{Number(1.0)};
    sum.reserve(p.size());
    powers.reserve(p.size());
    for (std::size_t i = p.size() - 1; i-- > 0;) {
      multiply_down(powers);
      multiply(sum, up_[0], up_[1]);
      for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += powers[j] * p[i];
    }
    return sum;
  }

  // Roots of positive real part, by Routh's array.
  template <typename SureSign>
  static std::optional<int> roots_on_the_right(const Polynomial<Number>& p, SureSign sure_sign) {
    Polynomial<Number> upper;
    Polynomial<Number> lower;
    for (std::size_t i = p.size(); i-- > 0;) ((p.size() - 1 - i) % 2 == 0 ? upper : lower).push_back(p[i]);
    int changes = 0;
    int above = sure_sign(upper);
    while (!lower.empty()) {
      const int below = sure_sign(lower);
      if (above == 0 || below == 0) return std::nullopt;
      if (above != below) ++changes;
      const Number ratio = upper[0] / lower[0];
      for (std::size_t i = 1; i < upper.size(); ++i) {
        upper[i - 1] = i < lower.size() ? upper[i] - ratio * lower[i] : upper[i];
      }
      upper.pop_back();
      std::swap(upper, lower);
      above = below;
    }
    return changes;
  }

  std::array<Number, 2> up_;  // delta times 1 - w
  Polynomial<Number> open_;
  Polynomial<Number> stiffness_;
  Polynomial<Number> damping_;  // empty without a damper
};

}  // namespace zwidth::internal
