#include "design/synthesis/wall_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "infinity.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/device_user.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;

constexpr std::array shares_of_damping{0.0, 0.001, 0.003, 0.01, 0.02, 0.05, 0.1, 0.2,
                                       0.3, 0.4,   0.5,   0.6,  0.7,  0.8,  0.9, 0.97};
constexpr double worth_a_damper = 1e-3;  // relative, of the goal
constexpr int refinements = 12;          // golden sections around the best of them
constexpr double golden = 0.61803398874989485;
constexpr double damper_over_spring = 10.0;  // B w over K at the crossover, where the damper alone is never critical
constexpr std::size_t filters_tried = 7;
constexpr double fastest_filter = 0.4;  // of the sampling rate
constexpr double slowest_filter = 2.0;  // times the frequency at which the device oscillates
constexpr double slow_filter = 0.01;    // of the sampling rate: as slow a one is tried in any case
constexpr double between_filters = 1.8;
constexpr int filter_refinements = 4;
constexpr int contact_bisections = 14;
constexpr double before_meeting = 1e-4;  // relative, of the stiffness at which poles meet as a grid shows it
constexpr double critical_contact_ratio = 1.0 - 1e-6;

/// The softest crossover of the device without a damper.
std::optional<Crossover> softest_crossover(const FilteredPlant& plant) {
  const CriticalStiffness critical = critical_stiffness(plant);
  std::optional<Crossover> softest = critical.limit;
  for (const Crossover& each : critical.crossovers) {
    if (!critical.limit && (!softest || each.stiffness < softest->stiffness)) softest = each;
  }
  return softest;
}

/// The loop that is searched: what damps a user damps the wall too, so that nobody holding is the harder case as a rule. What
/// is proposed keeps its margins with both (WallLimits).
Device searched(const WallLimits& limits) {
  return device_has_user(limits.device()) ? device_without_user(limits.device()) : limits.device();
}

}  // namespace

WallSearch::WallSearch(const WallLimits& limits, const RecommendationOptions& options)
    : WallSearch(limits, options,
                 std::make_shared<const LoopGrid>(searched(limits), limits.has_users(), options.progress), {}) {
  factor_.assign(grid_->size(), 1.0);
}

WallSearch::WallSearch(const WallSearch& without, const WallLimits& limits, const WallFilter& filter)
    : WallSearch(limits, without.options_, without.grid_, without.grid_->filter(filter)) {}

WallSearch::WallSearch(const WallLimits& limits, const RecommendationOptions& options,
                       std::shared_ptr<const LoopGrid> grid, LoopGrid::Response factor)
    : limits_(limits),
      options_(options),
      period_(limits.device().loop().sampling_period),
      plant_(filtered_plant(searched(limits))),
      grid_(std::move(grid)),
      factor_(std::move(factor)) {
  if (const auto softest = softest_crossover(plant_)) {
    critical_frequency_ = softest->frequency;
    critical_stiffness_ = softest->stiffness;
  }
}

double WallSearch::value_of(WallGoal goal, double stiffness, double damping) {
  return goal == WallGoal::width ? stiffness * damping : stiffness;
}

std::vector<double> WallSearch::velocity_filters() const {
  const double fastest = fastest_filter / period_;
  const double slowest = std::min(
      slow_filter / period_, critical_frequency_ > 0.0 ? slowest_filter * critical_frequency_ / (2.0 * pi) : infinity);
  std::vector<double> filters{0.0};
  for (std::size_t i = 0; i < filters_tried && slowest < fastest; ++i) {
    filters.push_back(fastest * std::pow(slowest / fastest, static_cast<double>(i) / (filters_tried - 1)));
  }
  return filters;
}

double WallSearch::most_damping(const Filtered& filtered) const {
  const double critical = grid_->largest_damping(factor_, filtered.unit_damper) / options_.gain_margin;
  if (std::isfinite(critical)) return critical;
  return critical_frequency_ > 0.0 ? damper_over_spring * critical_stiffness_ / critical_frequency_ : 0.0;
}

/// The goal at this B; some value not above `enough` as soon as it is seen to be that.
double WallSearch::value(const Filtered& filtered, double damping, WallGoal goal, double enough) const {
  tell(options_.progress, 0.0);
  LoopGrid::Response damper = filtered.unit_damper;
  for (std::complex<double>& each : damper) each *= damping;
  const double gain = options_.gain_margin;
  double stiffness = infinity;
  if (options_.quantisation_force && filtered.rates.per_stiffness > 0.0) {
    stiffness = (*options_.quantisation_force - damping * filtered.rates.per_damping) / filtered.rates.per_stiffness;
  }
  if (!(value_of(goal, stiffness, damping) > enough)) return 0.0;
  stiffness = std::min(stiffness, grid_->stiffest(factor_, damper, {gain, 0.0, limits_.has_users()}, 0.0));
  if (damping > 0.0 && limits_.has_users()) {
    for (const double factor : {std::sqrt(gain), gain}) {
      if (!(value_of(goal, stiffness, damping) > enough)) return 0.0;
      stiffness = std::min(stiffness, grid_->any_user(factor_, damper, factor) / factor);
    }
  }
  if (!(value_of(goal, stiffness, damping) > enough)) return 0.0;
  stiffness = grid_->stiffest_in_phase(factor_, damper, {.at_most = stiffness}, options_.phase_margin);
  if (goal == WallGoal::critical_damping && std::isfinite(stiffness) && stiffness > enough) {
    stiffness = damped_contact(stiffness, filtered, damping, enough);
  }
  return std::max(0.0, value_of(goal, stiffness, damping));
}

double WallSearch::damped_contact(double at_most, const Filtered& filtered, double damping, double enough) const {
  const VirtualDamper damper{damping, filtered.cutoff_hz};
  if (const std::optional<double> meeting =
          filtered.real_poles ? filtered.real_poles->meeting(damping) : std::nullopt) {
    if (*meeting <= enough) return 0.0;
    const double softer = std::min(at_most, *meeting * (1.0 - before_meeting));
    if (limits_.contact_damping(softer, damper) >= critical_contact_ratio) return softer;
  }
  if (limits_.contact_damping(at_most, damper) >= critical_contact_ratio) return at_most;
  double low = std::max(enough, 1e-9 * at_most);
  double high = at_most;
  if (limits_.contact_damping(low, damper) < critical_contact_ratio) return 0.0;
  for (int i = 0; i < contact_bisections; ++i) {
    const double middle = std::sqrt(low * high);
    (limits_.contact_damping(middle, damper) < critical_contact_ratio ? high : low) = middle;
  }
  return low;
}

WallSearch::Found WallSearch::best_near(const Found& start, WallGoal goal) const {
  Found found = start;
  double low = std::log(start.damper.velocity_filter_hz / between_filters);
  double high = std::log(std::min(start.damper.velocity_filter_hz * between_filters, fastest_filter / period_));
  for (int i = 0; i < filter_refinements; ++i) {
    const Found left = best(std::exp(high - golden * (high - low)), goal);
    const Found right = best(std::exp(low + golden * (high - low)), goal);
    for (const Found& each : {left, right}) {
      if (each.value > found.value) found = each;
    }
    (left.value < right.value ? low : high) =
        std::log((left.value < right.value ? left : right).damper.velocity_filter_hz);
  }
  return found;
}

WallSearch::Filtered WallSearch::filtered(double velocity_filter_hz, WallGoal goal) const {
  Filtered filtered{velocity_filter_hz, grid_->damper({1.0, velocity_filter_hz}), {}, {}};
  if (goal == WallGoal::critical_damping) filtered.real_poles.emplace(plant_, velocity_filter_hz);
  if (const double resolution = limits_.device().parameters().sensor.resolution; resolution > 0.0) {
    Wall wall = limits_.device().parameters().wall;
    wall.velocity_filter_hz = velocity_filter_hz;
    filtered.rates = force_per_count_rates(wall, period_, resolution);
  }
  return filtered;
}

double WallSearch::stiffest(VirtualDamper damper, WallGoal goal) const {
  const WallGoal of_stiffness = goal == WallGoal::width ? WallGoal::stiffness : goal;
  const Filtered filtered = this->filtered(damper.velocity_filter_hz, goal);
  if (damper.damping > 0.0 && damper.damping >= most_damping(filtered)) return 0.0;
  return value(filtered, damper.damping, of_stiffness, 0.0);
}

WallSearch::Found WallSearch::best(double velocity_filter_hz, WallGoal goal) const {
  const Filtered filtered = this->filtered(velocity_filter_hz, goal);
  const double most = most_damping(filtered);
  Found found{{0.0, velocity_filter_hz}, 0.0};
  std::size_t at = 0;
  for (std::size_t i = 0; i < shares_of_damping.size() && (i == 0 || most > 0.0); ++i) {
    const double damping = shares_of_damping[i] * most;
    const double value = this->value(filtered, damping, goal, found.value);
    if (value > found.value * (i == 1 ? 1.0 + worth_a_damper : 1.0)) {
      found = {{damping, velocity_filter_hz}, value};
      at = i;
    }
  }
  if (!(most > 0.0) || !(found.value > 0.0) || !std::isfinite(found.value)) return found;
  // By golden sections: an interval of B around the best share.
  double low = most * shares_of_damping[at > 0 ? at - 1 : 0];
  double high = most * shares_of_damping[std::min(at + 1, shares_of_damping.size() - 1)];
  for (int i = 0; i < refinements; ++i) {
    const double left = high - golden * (high - low);
    const double right = low + golden * (high - low);
    const double at_left = value(filtered, left, goal, 0.0);
    const double at_right = value(filtered, right, goal, 0.0);
    for (const auto& [damping, reached] : {std::pair{left, at_left}, std::pair{right, at_right}}) {
      if (reached > found.value) found = {{damping, velocity_filter_hz}, reached};
    }
    (at_left < at_right ? low : high) = at_left < at_right ? left : right;
  }
  return found;
}

}  // namespace zwidth::internal
