#include "design/region/seen_crossings.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "infinity.hpp"
#include "sampling/term_on_circle.hpp"
#include "stability/loop/damper_response.hpp"

namespace zwidth::internal {
namespace {

constexpr double unit = 16.0 * std::numeric_limits<double>::epsilon();
constexpr double extended_unit = 1e-29;
constexpr double clear = 1e-10;  // relative rounding of P, and of a function whose sign is told
constexpr std::uintmax_t most_evaluations = 60;

// The sum of the magnitudes of a polynomial's terms, its leading coefficient too.
double size_of(const double* coefficients, std::size_t degree, double leading, double radius) {
  double size = std::abs(leading);
  for (std::size_t i = degree; i-- > 0;) size = size * radius + std::abs(coefficients[i]);
  return size;
}

double magnitude(const OnCircle<double>& value, double angle) {
  return std::hypot(value.even, value.odd * std::sin(angle));
}

}  // namespace

bool SeenCrossings::is_clear_of_rounding(const FilteredPlant& plant, double angle) {
  const CirclePoint<double> point = circle_point(angle);
  const double radius = std::sqrt(point.chord_squared);
  std::complex<double> sum = 0.0;
  double of_sum = 0.0;
  double of_factors = 0.0;
  for (const SampledTerm& term : plant.terms) {
    const double lost =
        unit * size_of(term.denominator, term.degree, 1.0, radius) / magnitude(denominator_of(term, 0, point), angle);
    of_factors += lost;
    if (!plant.numerator.empty()) continue;
    const std::complex<double> value = response(term, angle);
    sum += value;
    of_sum += std::abs(value) * (unit + lost);
  }
  if (plant.numerator.empty()) return of_sum <= clear * std::abs(sum);
  const std::size_t degree = plant.numerator.size() - 1;
  const double size = size_of(plant.numerator.data(), degree, plant.numerator[degree], radius);
  const double of_numerator = (plant.numerator_rest.empty() ? unit : extended_unit) * size;
  return of_numerator / magnitude(sum_of_numerators(plant, point), angle) + of_factors <= clear;
}

SeenCrossings::SeenCrossings(const FilteredPlant& plant, VirtualDamper damper, std::vector<Point> points)
    : plant_(plant), damper_(damper), points_(std::move(points)) {}

SeenCrossings::Point SeenCrossings::at(double angle) const {
  const double frequency = angle / plant_.period;
  return {angle, response(plant_, frequency), damper_response(damper_, plant_.period, frequency), true};
}

// `condition` gives a value, whose sign is certain where it is not small beside 1.
template <typename Condition, typename Found>
void SeenCrossings::for_each_crossing(const Condition& condition, const Found& found) const {
  double last = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double here = points_[i].is_clear ? condition(points_[i]) : 0.0;
    const bool is_certain = std::abs(here) > clear;
    if (is_certain && last != 0.0 && (here > 0.0) != (last > 0.0)) {
      std::uintmax_t evaluations = most_evaluations;
      const auto [low, high] = boost::math::tools::toms748_solve(
          [&](double angle) { return condition(at(angle)); }, points_[i - 1].angle, points_[i].angle, last, here,
          boost::math::tools::eps_tolerance<double>(50), evaluations);
      const Point crossing = at(low);
      if (is_clear_of_rounding(plant_, crossing.angle)) found(crossing);
    }
    last = is_certain ? here : 0.0;
  }
}

double SeenCrossings::limit() const {
  double least = infinity;
  const auto take = [&least](const Point& at) {
    const double stiffness = (-1.0 / at.plant - at.damper).real();
    if (stiffness > 0.0 && std::isfinite(stiffness)) least = std::min(least, stiffness);
  };
  // 1/P + B v is real.
  for_each_crossing(
      [](const Point& at) {
        const std::complex<double> minus_stiffness = 1.0 / at.plant + at.damper;
        return minus_stiffness.imag() / (std::abs(1.0 / at.plant) + std::abs(at.damper));
      },
      take);
  if (points_.back().is_clear) take(points_.back());
  return least;
}

double SeenCrossings::slack(double stiffness, double gain_margin, double phase_margin) const {
  double slack = infinity;
  if (phase_margin > 0.0) {
    for_each_crossing([&](const Point& at) { return std::abs((stiffness + at.damper) * at.plant) - 1.0; },
                      [&](const Point& at) {
                        const double phase = std::arg(-(stiffness + at.damper) * at.plant);
                        slack = std::min(slack, std::abs(phase) / phase_margin - 1.0);
                      });
    if (slack < 0.0) return slack;
  }
  const auto take = [&](const Point& at) {
    const double factor = -1.0 / ((stiffness + at.damper) * at.plant).real();
    if (factor > 1.0) slack = std::min(slack, factor / gain_margin - 1.0);
  };
  for_each_crossing(
      [&](const Point& at) {
        const std::complex<double> loop = (stiffness + at.damper) * at.plant;
        return loop.imag() / std::abs(loop);
      },
      take);
  if (points_.back().is_clear) take(points_.back());
  return slack;
}

}  // namespace zwidth::internal
