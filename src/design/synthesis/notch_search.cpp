#include "design/synthesis/notch_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "infinity.hpp"
#include "staged_progress.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;

constexpr double highest_centre = 0.95;  // of Nyquist
constexpr double lowest_centre = 1e-4;
constexpr double nearest_factor = 2.0;  // from a mode, unless asked for
constexpr double narrowest = 0.02;      // damping ratio of the notch's poles
constexpr double widest = 1.0;
constexpr double deepest = 3e-3;
constexpr double shallowest = 0.99;
constexpr std::array centres_on_grid{0.5, 0.65, 0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.25, 1.5, 1.9};
constexpr std::array far_centres_on_grid{0.03, 0.06, 0.12, 0.25, 0.4, 2.5};
constexpr std::array widths_on_grid{0.03, 0.08, 0.2, 0.5, 0.9};
constexpr std::array depths_on_grid{0.01, 0.05, 0.15, 0.4, 0.7, 0.9, 0.97};
constexpr double on_grid_at_most = 1.02;  // a grid may miss a dip, but not invent one
constexpr double same_on_grid = 2e-3;     // relative, of two absolute stability limits on a grid of frequencies

// Pattern search.
constexpr double coarsest = 0.08;
constexpr double finest = 1e-3;
constexpr double coarsest_exact = 0.02;
constexpr std::array weight{1.0, 4.0, 4.0};  // width and depth matter less than the centre
constexpr int most_moves = 100;
constexpr double worth_a_move = 1e-6;  // relative, of an exact value where nothing is gained: there is a plateau

// Indices, of the least value first: where a search ends soonest.
std::vector<std::size_t> by_value(const std::vector<double>& values) {
  std::vector<std::size_t> indices(values.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  std::ranges::sort(indices, {}, [&values](std::size_t i) { return values[i]; });
  return indices;
}

}  // namespace

RequiredMargins required(const NotchOptions& options) {
  return {options.gain_margin, options.phase_margin, options.goal == StiffnessGoal::absolute_stability_limit};
}

std::optional<OptionProblem> find_modal_frequency_uncertainty_problem(double uncertainty, const Device& device) {
  const auto problem = [uncertainty](ProblemCode code) {
    return option_problem("modal_frequency_uncertainty",
                          {.code = code, .evidence = {{"percent", 100.0 * uncertainty}}});
  };
  if (!(uncertainty >= 0.0 && uncertainty <= 0.9)) return problem(ProblemCode::drift_out_of_range);
  if (uncertainty == 0.0 || !device.links().empty()) return std::nullopt;
  return problem(ProblemCode::no_modes_to_drift);
}

std::vector<double> seen_modes(const Device& device) {
  const double spacing = 2.0 * pi / device.loop().sampling_period;
  std::vector<double> frequencies;
  for (const Mode& mode : modal_form(device).modes) {
    if (mode.damping_ratio >= 1.0) continue;
    const double seen = std::abs(std::remainder(mode.frequency, spacing));
    if (seen > 1e-3 * spacing) frequencies.push_back(seen);
  }
  return frequencies;
}

WallFilter NotchSearch::notch_at(const Point& at) {
  WallFilter notch;
  notch.kind = WallFilter::Kind::notch;
  notch.frequency_hz = std::exp(at[0]) / (2.0 * pi);
  notch.damping_ratio = std::exp(at[1]);
  notch.depth = std::exp(at[2]);
  return notch;
}

NotchSearch::NotchSearch(const NotchOptions& options, std::vector<double> modes, double period,
                         bool keep_absolute_stability_limit)
    : options_(options),
      margins_(required(options)),
      modes_(std::move(modes)),
      nyquist_(pi / period),
      keep_absolute_stability_limit_(keep_absolute_stability_limit) {}

void NotchSearch::add(const Device& device) {
  add(device, LoopGrid(device, keep_absolute_stability_limit_ || margins_.any_user, options_.progress));
}

void NotchSearch::add(const Device& device, const LoopGrid& of_device) {
  LoopGrid grid = of_device.with_damper(virtual_damper(device));
  const LoopGrid::Response none(grid.size(), 1.0);
  const double any_user = keep_absolute_stability_limit_ ? grid.any_user(none) * (1.0 - same_on_grid) : 0.0;
  scenarios_.push_back({filtered_plant(device), virtual_damper(device), std::move(grid), any_user});
}

// Over the scenarios; some value not above `enough` as soon as it is seen to be that. The crossovers between the grid's
// points are looked at last: they matter to the few that would become the best.
double NotchSearch::least_on_grid(const WallFilter& notch, double enough, Route route,
                                  std::vector<double>& of_scenarios, std::vector<LoopGrid::Response>& factors) const {
  double result = infinity;
  for (const Scenario& scenario : scenarios_) {
    const LoopGrid::Response& factor = factors.emplace_back(scenario.grid.filter(notch));
    of_scenarios.push_back(scenario.grid.stiffest(factor, margins_, enough));
    result = std::min(result, of_scenarios.back());
    if (result <= enough) return result;
    if (scenario.any_user > 0.0 && scenario.grid.any_user(factor) < scenario.any_user) return 0.0;
  }
  if (route == Route::on_points) return result;
  for (std::size_t i = 0; i < scenarios_.size() && result > enough; ++i) {
    result = scenarios_[i].grid.stiffest_in_phase(factors[i], {enough, result}, margins_.phase);
  }
  return result;
}

// The same; exactly but for the users, who are seen on the grid alone: their exact limit takes longer than all the rest.
double NotchSearch::least(const Point& at, double enough, Route route) const {
  tell(options_.progress, 0.0);
  const WallFilter notch = notch_at(at);
  std::vector<double> of_scenarios;
  std::vector<LoopGrid::Response> factors;
  const double on_grid = least_on_grid(notch, enough, route, of_scenarios, factors);
  if (route != Route::exact || on_grid <= enough) return on_grid;
  double result = margins_.any_user ? on_grid : on_grid_at_most * on_grid;
  for (const std::size_t i : by_value(of_scenarios)) {
    const Scenario& scenario = scenarios_[i];
    const FilteredPlant plant = filtered_plant(scenario.plant, {notch});
    const SeenCrossings seen = scenario.grid.seen(plant, scenario.damper, factors[i]);
    result = std::min(result, stiffest_wall(plant, scenario.damper, margins_, {.at_least = enough, .at_most = result},
                                            options_.progress, &seen));
    if (result <= enough) return result;
  }
  return result;
}

std::vector<NotchSearch::Point> NotchSearch::candidates(const Progress& progress) const {
  std::vector<double> factors(centres_on_grid.begin(), centres_on_grid.end());
  if (options_.far_from_modes) factors.insert(factors.end(), far_centres_on_grid.begin(), far_centres_on_grid.end());
  // Without the look between the frequencies the climb may start in a better place.
  std::vector<Route> routes{Route::on_grid};
  if (margins_.phase > 0.0) routes.push_back(Route::on_points);
  const auto steps = static_cast<double>(routes.size() * modes_.size() * factors.size());
  std::vector<Point> points;
  std::size_t step = 0;
  for (const Route route : routes) {
    for (const double mode : modes_) {
      std::optional<Point> best;
      double most = 0.0;
      for (const double factor : factors) {
        tell(progress, static_cast<double>(step++) / steps);
        if (factor * mode > highest_centre * nyquist_) continue;
        for (const double width : widths_on_grid) {
          for (const double depth : depths_on_grid) {
            const Point at{std::log(factor * mode), std::log(width), std::log(depth)};
            const double value = least(at, most, route);
            if (value > most) most = value, best = at;
          }
        }
      }
      if (best && std::ranges::find(points, *best) == points.end()) points.push_back(*best);
    }
  }
  return points;
}

std::pair<double, NotchSearch::Point> NotchSearch::climb(Point at, double first_step, double last_step,
                                                         Route route) const {
  const auto offset = [](int third) { return static_cast<double>(third - 1); };
  double value = least(at, 0.0, route);
  int moves = 0;
  for (double step = first_step; step > last_step && moves < most_moves;) {
    Point best = at;
    double best_value = value;
    const double worth = route == Route::exact && value <= nothing_gained_ ? 1.0 + worth_a_move : 1.0;
    for (int i = 0; i < 27; ++i) {
      const Point neighbour =
          inside({at[0] + step * weight[0] * offset(i % 3), at[1] + step * weight[1] * offset(i / 3 % 3),
                  at[2] + step * weight[2] * offset(i / 9)});
      if (neighbour == at || !is_near(neighbour)) continue;
      const double there = least(neighbour, worth * best_value, route);
      if (there > worth * best_value) best_value = there, best = neighbour;
    }
    if (best_value > value) {
      value = best_value, at = best;
      ++moves;
    } else {
      step *= 0.5;
    }
  }
  return {value, at};
}

std::vector<std::pair<double, NotchSearch::Point>> NotchSearch::refine(const std::vector<Point>& candidates,
                                                                       double nothing_gained) {
  nothing_gained_ = nothing_gained;
  std::vector<Point> starts;
  const auto add = [&starts](const Point& start) {
    if (std::ranges::find(starts, start) == starts.end()) starts.push_back(start);
  };
  for (const Point& at : candidates) {
    add(refine_on_grid(at).second);
    if (margins_.phase > 0.0) add(climb(at, coarsest, finest, Route::on_points).second);
  }
  std::vector<std::pair<double, Point>> found;
  found.reserve(starts.size());
  for (const Point& start : starts) found.push_back(climb(start, coarsest_exact, finest, Route::exact));
  return found;
}

std::pair<double, NotchSearch::Point> NotchSearch::refine_on_grid(Point at) const {
  return climb(at, coarsest, finest, Route::on_grid);
}

bool NotchSearch::is_near(const Point& at) const {
  return options_.far_from_modes || std::ranges::any_of(modes_, [&](double mode) {
           return std::abs(at[0] - std::log(mode)) <= std::log(nearest_factor);
         });
}

NotchSearch::Point NotchSearch::inside(const Point& at) const {
  return {std::clamp(at[0], std::log(lowest_centre * nyquist_), std::log(highest_centre * nyquist_)),
          std::clamp(at[1], std::log(narrowest), std::log(widest)),
          std::clamp(at[2], std::log(deepest), std::log(shallowest))};
}

}  // namespace zwidth::internal
