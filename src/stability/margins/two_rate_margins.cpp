#include "stability/margins/two_rate_margins.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <optional>

#include "stability/limit/two_rate_stiffness.hpp"
#include "stability/second_route/pole_modulus.hpp"
#include "stability/second_route/scheduled_loop.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/state_space.hpp"

namespace zwidth::internal {
namespace {

// log |z| of the pole that is largest.
double largest_log_modulus(const ScheduledLoop& loop, double stiffness) {
  double largest = -1e3;
  for (const std::complex<double>& delta : loop.poles_minus_one(stiffness)) {
    largest = std::max(largest, log_modulus(delta));
  }
  return largest;
}

// The least delay added to either force or to both that takes a pole of the loop out of the circle.
class DelaySearch {
 public:
  DelaySearch(const Device& device, const TwoRateDevice& loop, double stiffness)
      : continuous_(state_space(device)), loop_(loop), stiffness_(stiffness) {}

  [[nodiscard]] std::optional<double> least(bool of_spring, bool of_damper) const {
    const double longer = std::max(loop_.spring().period, loop_.damper().sampling.period);
    const double step = longer / steps_per_period;
    const auto log_modulus_after = [&](double delay) {
      return log_modulus_delayed_by(of_spring ? delay : 0.0, of_damper ? delay : 0.0);
    };
    double before = log_modulus_after(0.0);
    for (double end = step; end <= most_periods * longer; end += step) {
      const double after = log_modulus_after(end);
      if (!std::isfinite(after)) return std::nullopt;
      if (after >= 0.0) {
        std::uintmax_t most_steps = 100;
        return boost::math::tools::toms748_solve(log_modulus_after, end - step, end, before, after,
                                                 boost::math::tools::eps_tolerance<double>(48), most_steps)
            .first;
      }
      before = after;
    }
    return std::nullopt;
  }

 private:
  static constexpr double steps_per_period = 16.0;  // of the longer one
  static constexpr double most_periods = 16.0;
  static constexpr std::size_t most_delay_states = 80;

  // Infinite where the loop would have too many states.
  [[nodiscard]] double log_modulus_delayed_by(double of_spring, double of_damper) const {
    Sampling spring = loop_.spring();
    InnerLoop damper = loop_.damper();
    spring.delay += of_spring;
    damper.sampling.delay += of_damper;
    const ScheduledLoop as_it_runs(continuous_, spring, damper);
    if (as_it_runs.states() > most_delay_states) return std::numeric_limits<double>::infinity();
    return largest_log_modulus(as_it_runs, stiffness_);
  }

  ContinuousStateSpace continuous_;
  const TwoRateDevice& loop_;
  double stiffness_;
};

// The least factor above 1 on K alone.
std::optional<double> factor_to_instability(const CriticalStiffness& critical, double stiffness) {
  std::optional<double> least;
  for (const Crossover& each : critical.crossovers) {
    const double factor = each.stiffness / stiffness;
    if (factor > 1.0) least = std::min(least.value_or(factor), factor);
  }
  return least;
}

}  // namespace

WallMargins two_rate_margins(const Device& device) {
  const Wall& wall = device.parameters().wall;
  if (wall.damping == 0.0) return wall_margins(with_one_rate(device));
  if (*wall.stiffness == 0.0) return wall_margins(with_loop_of_damper(device));
  const double stiffness = *wall.stiffness;
  const TwoRateDevice loop(device, wall.damping);
  Wall cut;
  cut.stiffness = loop.is_damper_inside() ? stiffness : 0.0;
  if (!loop.is_damper_inside()) {
    cut.damping = wall.damping;
    cut.velocity_filter_hz = wall.velocity_filter_hz;
  }
  const FilteredPlant plant = loop.is_damper_inside() ? loop.seen_by_spring() : loop.seen_by_damper(stiffness);
  WallMargins margins{loop_margins(plant, cut), stiffness, wall.damping, 0.0};
  const ScheduledLoop as_it_runs = loop.as_it_runs(device);
  margins.spectral_radius =
      std::exp(largest_log_modulus(as_it_runs, stiffness) * loop.spring().period / as_it_runs.period());
  margins.delay_margin.reset();
  // Those of the force that is cut, not of both together.
  margins.gain_margin.reset();
  margins.lower_gain_margin.reset();
  if (!margins.stable) return margins;
  margins.stiffness_margin = factor_to_instability(unguarded_stiffness(device), stiffness);
  const DelaySearch delays(device, loop, stiffness);
  margins.delay_margin = delays.least(true, true);
  margins.spring_delay_margin = delays.least(true, false);
  margins.damper_delay_margin = delays.least(false, true);
  return margins;
}

}  // namespace zwidth::internal
