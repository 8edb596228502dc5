#include "stability/second_route/spectral_radius.hpp"

#include <cmath>
#include <complex>
#include <optional>

#include "stability/second_route/winding_number.hpp"

namespace zwidth::internal {
namespace {

// The characteristic polynomial, over positive numbers, and over z^L; over z - 1 too where nothing holds the position.
class Characteristic {
 public:
  using Complex = std::complex<double>;

  Characteristic(const FilteredPlant& plant, const Wall& wall) : plant_(plant) {
    c_ = velocity_filter_gain(wall.velocity_filter_hz, plant.period);
    stiffness_ = *wall.stiffness;
    rate_ = wall.damping * c_ / plant.period;
    order_ = plant.delay_samples + 1;
    for (const SampledTerm& term : plant.terms) {
      order_ += term.degree;
      is_free_ = is_free_ || (stiffness_ == 0.0 && term.integrators > 0);
    }
    if (is_free_) --order_;
    for (const FilterSection& section : plant.filters) order_ += section.degree;
  }

  [[nodiscard]] std::size_t order() const { return order_; }

  // p(z) / z^L at z = radius e^{j angle}: D (delta + c) + z^-L (K (delta + c) + rate delta) S; with K = 0 and D over delta
  // the damper's delta goes too.
  [[nodiscard]] Complex operator()(double radius, double angle) const {
    const Complex delta = std::polar(radius, angle) - 1.0;
    Complex s = plant_.numerator.empty() ? 0.0 : evaluate(plant_.numerator.data(), plant_.numerator.size(), delta);
    Complex d = 1.0;
    Complex rest = 1.0;  // d over delta, once an integrator has come
    bool is_held = !is_free_;
    for (const SampledTerm& term : plant_.terms) {
      Complex d_k = evaluate(term.denominator, term.degree, delta) + std::pow(delta, static_cast<int>(term.degree));
      Complex n_k = evaluate(term.numerator, term.degree + 1, delta);
      const double scale = 1.0 / std::max(std::abs(d_k), 1e-300);
      s = plant_.numerator.empty() ? (s * d_k + n_k * d) * scale : s * scale;
      if (!is_held && term.integrators > 0) {
        is_held = true;
        rest = (evaluate(term.denominator + 1, term.degree - 1, delta) +
                std::pow(delta, static_cast<int>(term.degree) - 1)) *
               d * scale;
      } else {
        rest *= d_k * scale;
      }
      d *= d_k * scale;
    }
    for (const FilterSection& section : plant_.filters) {
      Complex n = evaluate(section.numerator.data(), section.numerator.size(), delta);
      for (std::size_t i = 0; i < section.nyquist_zeros; ++i) n *= delta + 2.0;
      const Complex d_k = evaluate(section.denominator.data(), section.degree, delta) +
                          std::pow(delta, static_cast<int>(section.degree));
      const double scale = 1.0 / std::max(std::abs(d_k), 1e-300);
      s *= n * scale;
      rest *= d_k * scale;
    }
    const auto delay = static_cast<double>(plant_.delay_samples);
    const Complex shift = std::polar(std::exp(-delay * std::log(radius)), -delay * angle);
    return rest * (delta + c_) + shift * (is_free_ ? rate_ : stiffness_ * (delta + c_) + rate_ * delta) * s;
  }

 private:
  static Complex evaluate(const double* c, std::size_t count, Complex delta) {
    Complex value = 0.0;
    for (std::size_t i = count; i-- > 0;) value = value * delta + c[i];
    return value;
  }

  const FilteredPlant& plant_;
  double c_;
  double stiffness_;
  double rate_;
  bool is_free_ = false;
  std::size_t order_ = 0;
};

bool holds_all_poles(const Characteristic& p, double radius, std::size_t delay_samples) {
  const auto f = [&](double angle) { return p(radius, angle); };
  const std::optional<double> turns = winding_number(f, 8 * p.order());
  // Half the circle turns p by pi per zero inside; p / z^L by L less.
  return turns && std::lround(*turns + static_cast<double>(delay_samples)) >= static_cast<long>(p.order());
}

}  // namespace

double spectral_radius_by_winding(const FilteredPlant& plant, const Wall& wall) {
  constexpr int max_steps = 60;
  const Characteristic p(plant, wall);
  double low = 0.0;
  double high = 2.0;
  while (high < 1e12 && !holds_all_poles(p, high, plant.delay_samples)) {
    low = high;
    high *= 4.0;
  }
  for (int i = 0; i < max_steps && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (holds_all_poles(p, middle, plant.delay_samples) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace zwidth::internal
