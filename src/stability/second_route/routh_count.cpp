#include "stability/second_route/routh_count.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "model/balance.hpp"
#include "model/extended_precision.hpp"
#include "stability/second_route/characteristic_polynomial.hpp"

namespace zwidth::internal {
namespace {

// Faddeev's recursion costs the fourth power of these.
constexpr Eigen::Index most_plant_states = 6;
// The circles are this far from the unit circle, over the size of Phi: rounding of Phi moves poles by less.
constexpr double beside = 1e-12;
constexpr double least_beside = 1e-13;
constexpr double most_beside = 1e-9;

constexpr double roundoff = 0x1p-99;  // of QD's operations, with room for that of the bounds below

// A double-double number and a bound of its rounding.
struct Bounded {
  Extended value{0.0};
  double error = 0.0;

  Bounded() = default;
  explicit Bounded(double exact) : value(exact) {}
  Bounded(const Extended& rounded, double bound) : value(rounded), error(bound) {}

  [[nodiscard]] double size() const { return std::abs(value.x[0]); }

  friend Bounded operator+(const Bounded& a, const Bounded& b) {
    return {a.value + b.value, a.error + b.error + roundoff * (a.size() + b.size())};
  }
  friend Bounded operator-(const Bounded& a, const Bounded& b) {
    return {a.value - b.value, a.error + b.error + roundoff * (a.size() + b.size())};
  }
  friend Bounded operator*(const Bounded& a, const Bounded& b) {
    const double rounding = roundoff * a.size() * b.size();
    return {a.value * b.value, a.size() * b.error + a.error * (b.size() + b.error) + rounding};
  }
  friend Bounded operator*(const Bounded& a, double b) {
    return {a.value * b, (a.error + roundoff * a.size()) * std::abs(b)};
  }
  // |b| > its error
  friend Bounded operator/(const Bounded& a, const Bounded& b) {
    const Extended ratio = a.value / b.value;
    const double size = std::abs(ratio.x[0]);
    return {ratio, (a.error + size * b.error) / (b.size() - b.error) + roundoff * size};
  }
  Bounded& operator+=(const Bounded& b) { return *this = *this + b; }
};

int sure_sign(const Polynomial<Bounded>& row) {
  if (!(row[0].size() > row[0].error)) return 0;
  return row[0].value.x[0] < 0.0 ? -1 : 1;
}

// Phi over powers of two that make its rows and columns alike.
struct Balanced {
  std::vector<double> phi;
  std::vector<double> gamma1;
  std::vector<double> gamma2;
  std::vector<double> output;
  double size = 0.0;  // of Phi: greatest sum over a row

  explicit Balanced(const DiscreteStateSpace& plant) {
    const Eigen::VectorXd scales = balancing_scales(plant.Phi);
    for (Eigen::Index i = 0; i < plant.Phi.rows(); ++i) {
      double row = 0.0;
      for (Eigen::Index j = 0; j < plant.Phi.rows(); ++j) {
        phi.push_back(plant.Phi(i, j) / scales(i) * scales(j));
        row += std::abs(phi.back());
      }
      size = std::max(size, row);
      gamma1.push_back(plant.Gamma1(i) / scales(i));
      gamma2.push_back(plant.Gamma2(i) / scales(i));
      output.push_back(plant.C(i) * scales(i));
    }
  }
};

}  // namespace

struct RouthCount::Circles {
  CirclePolynomials<Bounded> inner;
  CirclePolynomials<Bounded> outer;
};

RouthCount::RouthCount(const DiscreteStateSpace& plant, const Wall& wall) {
  const Balanced balanced(plant);
  const PlantPolynomials<Bounded> polynomials =
      plant_polynomials<Bounded>(balanced.phi, balanced.gamma1, balanced.gamma2, balanced.output);
  const WallPolynomials<Bounded> rounded = rounded_wall<Bounded>(wall, plant.period);
  const double apart = std::clamp(beside * balanced.size, least_beside, most_beside);
  const auto circle = [&](double g) {
    return CirclePolynomials<Bounded>(polynomials, plant.delay_samples, !plant.Gamma2.isZero(0.0), rounded,
                                      plant.period, Bounded(g));
  };
  circles_ = std::make_shared<const Circles>(Circles{circle(-apart), circle(apart)});
}

bool RouthCount::suits(const DiscreteStateSpace& plant) {
  return plant.Phi.rows() <= most_plant_states && plant.Phi.allFinite() && plant.Gamma1.allFinite() &&
         plant.Gamma2.allFinite();
}

bool RouthCount::surely(bool stable, double stiffness, double damping) const {
  const std::optional<int> outside =
      (stable ? circles_->inner : circles_->outer).outside(stiffness, damping, sure_sign);
  return outside && (*outside == 0) == stable;
}

}  // namespace zwidth::internal
