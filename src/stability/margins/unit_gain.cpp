#include "stability/margins/unit_gain.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "stability/limit/gain_locus.hpp"
#include "stability/loop/plant_fraction.hpp"
#include "stability/loop/response_bound.hpp"
#include "stability/roots/root_isolation.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;

// |C_num S|² - |(delta + c) D|², zero where |C P| = 1; C = K + B (c/T) delta / (delta + c). Without a spring the
// damper's delta cancels one of the plant's integrators: both sides are divided by |delta|² then.
class UnitGain {
 public:
  UnitGain(const FilteredPlant& plant, const Wall& wall, double rate, double c)
      : plant_(plant),
        stiffness_(*wall.stiffness),
        rate_(rate),
        c_(c),
        loop_(plant, GainLocus::Gain::wall, stiffness_, {wall.damping, wall.velocity_filter_hz}) {
    if (stiffness_ > 0.0) return;
    for (const SampledTerm& term : plant.terms) integrators_ += term.integrators;
  }

  [[nodiscard]] double value(double angle) const { return evaluate(circle_point(angle)); }
  template <typename Scalar>
  [[nodiscard]] BoundedJet<Scalar> model(double begin, double end) const {
    return evaluate(circle_interval<Scalar>(begin, end));
  }

  // |C P|² - 1 from the sum of terms, and where to ask for it: products of many terms may be nothing but rounding.
  [[nodiscard]] GainLocus::TermSum by_terms(double angle) const {
    const GainLocus::TermSum loop = loop_.by_terms(angle);
    const double square = loop.size * loop.size;
    return {square - 1.0, loop.noise * (2.0 * loop.size + loop.noise), square + 1.0};
  }
  [[nodiscard]] std::vector<double> pole_angles() const { return loop_.pole_angles(); }

 private:
  template <typename Real>
  Real evaluate(const CirclePoint<Real>& point) const {
    const Real& x = point.chord_squared;
    OnCircle<Real> kept{Real(1.0), Real(0.0)};  // delta^(integrators - 1)
    for (int i = 1; i < integrators_; ++i) kept = multiply(kept, {-0.5 * x, Real(1.0)}, point);
    const bool cancel = integrators_ > 0;
    const PlantFraction<Real> plant = plant_fraction(plant_, point, cancel ? &kept : nullptr);
    const Real filter = (1.0 - c_) * x + c_ * c_;  // |delta + c|²
    // |(K + B c/T) delta + K c|² = (K + r)² x + (K c)² - (K + r) K c x
    const double lead = stiffness_ + rate_;
    const double constant = stiffness_ * c_;
    const Real wall = cancel ? Real(rate_ * rate_) : (lead * (lead - constant)) * x + constant * constant;
    return wall * squared_magnitude(plant.numerator, point) - filter * squared_magnitude(plant.denominator, point);
  }

  const FilteredPlant& plant_;
  double stiffness_;
  double rate_;  // B c / T
  double c_;
  GainLocus loop_;       // of C P
  int integrators_ = 0;  // of the plant, where one cancels
};

// Where |C P| < 1 for certain there is no crossover.
class SmallLoopGain {
 public:
  SmallLoopGain(const FilteredPlant& plant, double stiffness, double rate, double c)
      : bound_(plant), stiffness_(stiffness), rate_(rate), c_(c) {}

  [[nodiscard]] bool leaves_out(double begin, double end) const {
    constexpr double certainly_less = 1.0 - 1e-9;
    // |C| <= K + B |v|, |v| = (c/T) |delta/(delta + c)| rises with x.
    const double controller = stiffness_ + rate_ * std::sqrt(end / (c_ * c_ + (1.0 - c_) * end));
    return controller * bound_.greatest(begin, end) < certainly_less;
  }

 private:
  ResponseBound bound_;
  double stiffness_;
  double rate_;  // B c / T
  double c_;
};

}  // namespace

std::complex<double> loop_gain(const FilteredPlant& plant, const Wall& wall, double angle) {
  const double c = velocity_filter_gain(wall.velocity_filter_hz, plant.period);
  const double half = std::sin(angle / 2.0);
  const std::complex<double> delta(-2.0 * half * half, std::sin(angle));
  const double rate = wall.damping * c / plant.period;
  return (*wall.stiffness + rate * delta / (delta + c)) * response(plant, angle / plant.period);
}

std::vector<UnitGainPoint> unit_gain_points(const FilteredPlant& plant, const Wall& wall) {
  const double stiffness = *wall.stiffness;
  const double c = velocity_filter_gain(wall.velocity_filter_hz, plant.period);
  const double rate = wall.damping * c / plant.period;
  std::vector<UnitGainPoint> points;
  if (stiffness == 0.0 && rate == 0.0) return points;
  for (const CircleRoot& root :
       roots_on_circle(UnitGain(plant, wall, rate, c), 1, SmallLoopGain(plant, stiffness, rate, c))) {
    points.push_back({root.angle, std::arg(-loop_gain(plant, wall, root.angle))});
  }
  return points;
}

double lag_to_instability(const UnitGainPoint& point) {
  return point.phase >= 0.0 ? point.phase : point.phase + 2.0 * pi;
}

}  // namespace zwidth::internal
