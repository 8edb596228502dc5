#include "zwidth/stability/disk_margin.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "stability/loop/delay_factor.hpp"
#include "stability/loop/plant_fraction.hpp"
#include "stability/margins/confirmed_margins.hpp"
#include "stability/margins/unit_gain.hpp"
#include "stability/roots/root_isolation.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;

// L = A/B, A = ((K + r) delta + K c) S, B = z^L (delta + c) D, r = B c/T: see gain_locus.hpp. Without a spring the damper's
// delta cancels one of the plant's integrators.
class LoopFraction {
 public:
  LoopFraction(const FilteredPlant& plant, const Wall& wall)
      : plant_(plant),
        stiffness_(*wall.stiffness),
        c_(velocity_filter_gain(wall.velocity_filter_hz, plant.period)),
        rate_(wall.damping * c_ / plant.period) {
    if (stiffness_ > 0.0) return;
    for (const SampledTerm& term : plant.terms) integrators_ += term.integrators;
  }

  template <typename Real>
  [[nodiscard]] PlantFraction<Real> at(const CirclePoint<Real>& point, const OnCircle<Real>& delay) const {
    const Real half = -0.5 * point.chord_squared;  // delta = half + j sin
    const double lead = stiffness_ + rate_;
    OnCircle<Real> kept{Real(1.0), Real(0.0)};  // delta^(integrators - 1)
    for (int i = 1; i < integrators_; ++i) kept = multiply(kept, {half, Real(1.0)}, point);
    const bool cancels = integrators_ > 0;
    const PlantFraction<Real> plant = plant_fraction(plant_, point, cancels ? &kept : nullptr);
    OnCircle<Real> wall{lead * half + stiffness_ * c_, Real(lead)};
    if (cancels) wall = {Real(lead), Real(0.0)};
    return {multiply(plant.numerator, wall, point),
            multiply(multiply(plant.denominator, {half + c_, Real(1.0)}, point), delay, point)};
  }

  [[nodiscard]] PlantFraction<double> at(double angle) const {
    return at(circle_point(angle), delay_factor(plant_.delay_samples, angle));
  }

  [[nodiscard]] const FilteredPlant& plant() const { return plant_; }

 private:
  const FilteredPlant& plant_;
  double stiffness_;
  double c_;
  double rate_;
  int integrators_ = 0;  // of the plant, where one cancels
};

// |A - B|² and |A + B|².
template <typename Real>
struct Distances {
  Real from_one;        // of L
  Real from_minus_one;  // of L
};

template <typename Real>
Distances<Real> distances(const PlantFraction<Real>& loop, const CirclePoint<Real>& point) {
  return {squared_magnitude(sum(loop.numerator, scaled(-1.0, loop.denominator)), point),
          squared_magnitude(sum(loop.numerator, loop.denominator), point)};
}

// |1 - L|/|1 + L|
double ratio(const LoopFraction& loop, double angle) {
  const auto [from_one, from_minus_one] = distances(loop.at(angle), circle_point(angle));
  return std::sqrt(from_one / from_minus_one);
}

// |A - B|² - level² |A + B|²: above zero where the ratio is above the level.
class AboveLevel {
 public:
  AboveLevel(const LoopFraction& loop, double level) : loop_(loop), level_squared_(level * level) {}

  [[nodiscard]] double value(double angle) const { return assemble(loop_.at(angle), circle_point(angle)); }
  template <typename Scalar>
  [[nodiscard]] BoundedJet<Scalar> model(double begin, double end) const {
    const auto point = circle_interval<Scalar>(begin, end);
    return assemble(loop_.at(point, delay_factor<Scalar>(loop_.plant().delay_samples, begin, end)), point);
  }

 private:
  template <typename Real>
  Real assemble(const PlantFraction<Real>& loop, const CirclePoint<Real>& point) const {
    const Distances<Real> distance = distances(loop, point);
    return distance.from_one - level_squared_ * distance.from_minus_one;
  }

  const LoopFraction& loop_;
  double level_squared_;
};

struct Peak {
  double angle = pi;
  double ratio = 0.0;
};

// Takes the angle for the peak where it is higher there.
void raise(const LoopFraction& loop, double angle, Peak& peak) {
  const double here = ratio(loop, angle);
  if (here > peak.ratio) peak = {angle, here};
}

// Where to begin: near each gain crossover, each mode, and evenly on a logarithmic axis.
Peak first_peak(const LoopFraction& loop, const Wall& wall) {
  constexpr int points = 40;
  constexpr double decades = 6.0;
  Peak peak;
  for (int i = 0; i <= points; ++i) raise(loop, pi * std::pow(10.0, -decades * i / points), peak);
  for (const UnitGainPoint& point : unit_gain_points(loop.plant(), wall)) raise(loop, point.angle, peak);
  return peak;
}

// The greatest ratio of the whole circle: raised over the intervals that lie above it until none does.
Peak greatest_ratio(const LoopFraction& loop, const Wall& wall) {
  constexpr double tolerance = 1e-9;
  constexpr int most_rounds = 60;
  constexpr int digits = 40;  // bits of a maximum's place in its interval: a peak may be far narrower than its angle
  Peak peak = first_peak(loop, wall);
  const std::size_t pieces = std::max<std::size_t>(1, loop.plant().delay_samples);
  for (int round = 0; round < most_rounds; ++round) {
    const AboveLevel above(loop, peak.ratio * (1.0 + tolerance));
    std::vector<double> ends{0.0};
    for (const CircleRoot& root : roots_on_circle(above, pieces)) ends.push_back(root.angle);
    ends.push_back(pi);
    const double before = peak.ratio;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      if (above.value(0.5 * (ends[i] + ends[i + 1])) <= 0.0) continue;
      std::uintmax_t steps = 200;
      const auto angle = [&](double share) { return std::lerp(ends[i], ends[i + 1], share); };
      const auto [share, lowest] = boost::math::tools::brent_find_minima(
          [&](double at) { return -ratio(loop, angle(at)); }, 0.0, 1.0, digits, steps);
      raise(loop, angle(share), peak);
      for (const double end : {ends[i], ends[i + 1]}) raise(loop, end, peak);
    }
    if (peak.ratio <= before * (1.0 + tolerance)) return peak;
  }
  throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::disk_peak_not_found});
}

}  // namespace

std::optional<DiskMargin> disk_margin(const FilteredPlant& plant, const Wall& wall) {
  if (!loop_margins(plant, wall).stable) return std::nullopt;
  return disk_margin_of_stable(plant, wall);
}

DiskMargin internal::disk_margin_of_stable(const FilteredPlant& plant, const Wall& wall) {
  const LoopFraction loop(plant, wall);
  const Peak peak = greatest_ratio(loop, wall);
  DiskMargin margin;
  margin.alpha = 2.0 / peak.ratio;
  if (margin.alpha < 2.0) {
    margin.gain_margin = (2.0 + margin.alpha) / (2.0 - margin.alpha);
    margin.lower_gain_margin = (2.0 - margin.alpha) / (2.0 + margin.alpha);
  }
  margin.phase_margin = 2.0 * std::atan(0.5 * margin.alpha);
  margin.frequency = peak.angle / plant.period;
  const PlantFraction<double> at_peak = loop.at(peak.angle);
  const auto value = [&](const OnCircle<double>& part) {
    return std::complex<double>(part.even, part.odd * std::sin(peak.angle));
  };
  const std::complex<double> numerator = value(at_peak.numerator);
  if (numerator != 0.0) margin.worst_factor = -value(at_peak.denominator) / numerator;
  return margin;
}

std::optional<DiskMargin> disk_margin(const Device& device) {
  return disk_margin(filtered_plant(device), device.parameters().wall);
}

}  // namespace zwidth
