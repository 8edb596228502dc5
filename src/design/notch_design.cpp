#include "zwidth/design/notch_design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "zwidth/error.hpp"
#include "zwidth/stability/any_user.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr std::size_t drifts_verified = 41;
constexpr int rounds = 4;                   // of search and verification
constexpr std::size_t most_crossovers = 4;  // whose frequencies are starts of the search
constexpr double worth_having = 1e-6;       // relative gain below which there is no notch

// Ranges of the search.
constexpr double highest_centre = 0.95;  // of Nyquist
constexpr double narrowest = 0.02;       // damping ratio of the notch's poles
constexpr double widest = 2.0;
constexpr double deepest = 3e-3;
constexpr double shallowest = 0.99;
// Far below a crossover a wide and shallow notch leads there.
constexpr std::array centres_on_grid{0.03, 0.06, 0.12, 0.25, 0.4,  0.5, 0.65, 0.8, 0.9,
                                     0.95, 1.0,  1.05, 1.1,  1.25, 1.5, 1.9,  2.5};
constexpr std::array widths_on_grid{0.03, 0.08, 0.2, 0.5, 1.0, 1.7};
constexpr std::array depths_on_grid{0.01, 0.05, 0.15, 0.4, 0.7, 0.9, 0.97};

constexpr int levels_per_decade = 8;  // of stiffnesses asked for their phase margin
constexpr int most_decades = 9;
constexpr int bisections = 30;
constexpr int bits_of_drift = 24;
constexpr double shaved = 1e-6;  // off the least over the drift: what lies between its refined samples
constexpr double step_down = 0.98;
constexpr int most_steps_down = 400;

// One device of the drift and its plant, sampled once.
struct Scenario {
  Device device;
  FilteredPlant plant;  // through the filters that the wall has
};

Scenario scenario_of(const Device& device) { return {device, filtered_plant(device)}; }

VirtualDamper damper_of(const Device& device) {
  return {device.parameters().wall.damping, device.parameters().wall.velocity_filter_hz};
}

bool has_phase_margin(const FilteredPlant& plant, Wall wall, double stiffness, double phase_margin) {
  wall.stiffness = stiffness;
  const LoopMargins margins = loop_margins(plant, wall);
  return margins.stable && margins.phase_margin.value_or(pi) >= phase_margin;
}

// The stiffest found going down from `top`; 0 once it is below `enough`.
double with_phase_margin(const FilteredPlant& plant, const Wall& wall, double top, double phase_margin, double enough) {
  double above = top;
  for (int i = 0; i <= levels_per_decade * most_decades; ++i) {
    double low = top * std::pow(10.0, -static_cast<double>(i) / levels_per_decade);
    if (above < enough) return 0.0;
    if (!has_phase_margin(plant, wall, low, phase_margin)) {
      above = low;
      continue;
    }
    for (int step = 0; i > 0 && step < bisections; ++step) {
      const double middle = 0.5 * (low + above);
      (has_phase_margin(plant, wall, middle, phase_margin) ? low : above) = middle;
    }
    return low;
  }
  return 0.0;
}

// Some value below `enough` as soon as it is seen to be that.
double stiffest_wall(const Scenario& scenario, const NotchOptions& options, double enough = 0.0) {
  const VirtualDamper damper = damper_of(scenario.device);
  double goal = critical_stiffness(scenario.plant, damper).stiffness;
  if (options.goal == StiffnessGoal::any_user_limit && goal > enough * options.gain_margin) {
    goal = std::min(goal, any_user_limit(scenario.device, damper).stiffness);
  }
  const double top = goal / options.gain_margin;
  if (options.phase_margin == 0.0 || top <= enough || !std::isfinite(top)) return top;
  const Wall& wall = scenario.device.parameters().wall;
  // A search is content with walls that have the margin down to `enough`.
  if (enough > 0.0 && !has_phase_margin(scenario.plant, wall, enough, options.phase_margin)) return 0.0;
  return with_phase_margin(scenario.plant, wall, top, options.phase_margin, enough);
}

Scenario with_notch(const Scenario& scenario, const WallFilter& notch, StiffnessGoal goal) {
  Scenario result = scenario;
  result.plant.filters.push_back(filter_section(notch, scenario.plant.period));
  if (goal == StiffnessGoal::any_user_limit) {
    DeviceParameters parameters = scenario.device.parameters();
    parameters.wall.filters.push_back(notch);
    result.device = Device(std::move(parameters));
  }
  return result;
}

// Centre (rad/s), damping ratio and depth of a notch, as logarithms.
using Point = std::array<double, 3>;

class NotchSearch {
 public:
  NotchSearch(const NotchOptions& options, double period) : options_(options), nyquist_(pi / period) {}

  std::vector<Scenario> scenarios;

  [[nodiscard]] static WallFilter notch_at(const Point& at) {
    WallFilter notch;
    notch.kind = WallFilter::Kind::notch;
    notch.frequency_hz = std::exp(at[0]) / (2.0 * pi);
    notch.damping_ratio = std::exp(at[1]);
    notch.depth = std::exp(at[2]);
    return notch;
  }

  // The least over the scenarios; some value below `enough` as soon as it is seen to be that.
  [[nodiscard]] double least(const Point& at, double enough) const {
    const WallFilter notch = notch_at(at);
    double result = infinity;
    for (const Scenario& scenario : scenarios) {
      result = std::min(result, stiffest_wall(with_notch(scenario, notch, options_.goal), options_, enough));
      if (result <= enough) break;
    }
    return result;
  }

  // The best of a grid around each of the frequencies.
  template <typename OnStep>
  [[nodiscard]] std::vector<Point> grid(const std::vector<double>& frequencies, OnStep&& on_step) const {
    std::vector<Point> points;
    std::size_t step = 0;
    for (const double frequency : frequencies) {
      std::optional<Point> best;
      double most = 0.0;
      for (const double factor : centres_on_grid) {
        on_step(static_cast<double>(step++) / static_cast<double>(frequencies.size() * centres_on_grid.size()));
        if (factor * frequency > highest_centre * nyquist_) continue;
        for (const double width : widths_on_grid) {
          for (const double depth : depths_on_grid) {
            const Point at{std::log(factor * frequency), std::log(width), std::log(depth)};
            const double value = least(at, most);
            if (value > most) most = value, best = at;
          }
        }
      }
      if (best) points.push_back(*best);
    }
    return points;
  }

  // Pattern search: the best of the 26 neighbours of a cube, halved where none is better.
  [[nodiscard]] std::pair<double, Point> refine(Point at) const {
    constexpr double coarsest = 0.08;
    constexpr double finest = 1e-4;
    constexpr std::array weight{1.0, 4.0, 4.0};  // width and depth matter less than the centre
    constexpr int most_moves = 200;
    double value = least(at, 0.0);
    int moves = 0;
    for (double step = coarsest; step > finest && moves < most_moves;) {
      Point best = at;
      double best_value = value;
      for (int i = 0; i < 27; ++i) {
        const Point neighbour =
            inside({at[0] + step * weight[0] * (i % 3 - 1), at[1] + step * weight[1] * (i / 3 % 3 - 1),
                    at[2] + step * weight[2] * (i / 9 - 1)});
        if (neighbour == at) continue;
        const double there = least(neighbour, best_value);
        if (there > best_value) best_value = there, best = neighbour;
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

 private:
  [[nodiscard]] Point inside(const Point& at) const {
    return {std::clamp(at[0], std::log(1e-4 * nyquist_), std::log(highest_centre * nyquist_)),
            std::clamp(at[1], std::log(narrowest), std::log(widest)),
            std::clamp(at[2], std::log(deepest), std::log(shallowest))};
  }

  const NotchOptions& options_;
  double nyquist_;
};

void check(const NotchOptions& options) {
  const auto require = [](bool holds, const std::string& what, double value, const char* allowed) {
    if (!holds) throw Error(ErrorCode::invalid_argument, what + " is " + fmt::format("{}", value) + "; " + allowed);
  };
  require(options.drift >= 0.0 && options.drift <= 0.9, "the drift", options.drift, "must be from 0 to 0.9");
  require(options.gain_margin >= 1.0 && std::isfinite(options.gain_margin), "the gain margin", options.gain_margin,
          "must be a factor >= 1");
  require(options.phase_margin >= 0.0 && options.phase_margin <= pi / 2.0, "the phase margin", options.phase_margin,
          "must be from 0 to pi/2 rad");
}

// Where the wall sees the modes: themselves, or their aliases below Nyquist.
std::vector<double> seen_modes(const Device& device) {
  const double spacing = 2.0 * pi / device.loop().sampling_period;
  std::vector<double> frequencies;
  for (const Mode& mode : modal_form(device).modes) {
    if (mode.damping_ratio >= 1.0) continue;
    const double seen = std::abs(std::remainder(mode.frequency, spacing));
    if (seen > 1e-3 * spacing) frequencies.push_back(seen);
  }
  if (frequencies.empty()) {
    throw Error(ErrorCode::invalid_argument, "the device has no vibration mode that a notch could be tuned to");
  }
  return frequencies;
}

// The modes, and the softest crossovers or where the worst user destabilises the wall.
std::vector<double> starting_frequencies(const Device& device, StiffnessGoal goal) {
  std::vector<double> frequencies = seen_modes(device);
  if (goal == StiffnessGoal::any_user_limit) {
    const double worst = any_user_limit(device, damper_of(device)).frequency;
    if (worst > 0.0) frequencies.push_back(worst);
    return frequencies;
  }
  std::vector<Crossover> crossovers = critical_stiffness(filtered_plant(device), damper_of(device)).crossovers;
  std::sort(crossovers.begin(), crossovers.end(),
            [](const Crossover& a, const Crossover& b) { return a.stiffness < b.stiffness; });
  for (std::size_t i = 0; i < crossovers.size() && i < most_crossovers; ++i) {
    if (crossovers[i].frequency > 0.0) frequencies.push_back(crossovers[i].frequency);
  }
  return frequencies;
}

double drift_at(const NotchOptions& options, std::size_t i) {
  const double share = 2.0 * static_cast<double>(i) / static_cast<double>(drifts_verified - 1) - 1.0;
  return share * options.drift;
}

// What holds over the whole drift, between its samples too.
class Over {
 public:
  Over(const Device& device, const NotchOptions& options) : device_(device), options_(options) {}

  struct Least {
    double stiffness = 0.0;
    double drift = 0.0;
  };
  // The least of that member, refined around every local minimum of the samples and shaved; `notch` is null for the
  // walls without.
  [[nodiscard]] Least least(const std::vector<NotchAtDrift>& samples, double NotchAtDrift::*member,
                            const WallFilter* notch) const {
    Least result{samples.front().*member, samples.front().drift};
    const auto consider = [&](double drift, double stiffness) {
      if (stiffness < result.stiffness) result = {stiffness, drift};
    };
    const auto at = [&](double drift) {
      const Scenario plain = scenario_of(zwidth::drifted(device_, drift));
      return stiffest_wall(notch != nullptr ? with_notch(plain, *notch, options_.goal) : plain, options_);
    };
    const std::size_t last = samples.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      const double here = samples[i].*member;
      consider(samples[i].drift, here);
      const NotchAtDrift& left = samples[i > 0 ? i - 1 : 0];
      const NotchAtDrift& right = samples[std::min(i + 1, last)];
      if (last == 0 || !std::isfinite(here) || here > left.*member || here > right.*member) continue;
      std::uintmax_t steps = max_refinements;
      const auto [drift, stiffness] =
          boost::math::tools::brent_find_minima(at, left.drift, right.drift, bits_of_drift, steps);
      consider(drift, stiffness);
    }
    if (last > 0) result.stiffness *= 1.0 - shaved;
    return result;
  }

  // The phase margin may fail below the stiffest wall that has it: down to a stiffness that has it at every drift.
  [[nodiscard]] double with_margin_everywhere(const std::vector<Scenario>& scenarios, const WallFilter& notch,
                                              double stiffness) const {
    const double needed = options_.phase_margin * (1.0 - shaved);
    for (int step = 0; step < most_steps_down; ++step, stiffness *= step_down) {
      const bool holds = std::all_of(scenarios.begin(), scenarios.end(), [&](const Scenario& scenario) {
        return has_phase_margin(with_notch(scenario, notch, options_.goal).plant, scenario.device.parameters().wall,
                                stiffness, needed);
      });
      if (holds) return stiffness;
    }
    return 0.0;
  }

 private:
  static constexpr std::uintmax_t max_refinements = 40;

  const Device& device_;
  const NotchOptions& options_;
};

}  // namespace

Device drifted(const Device& device, double drift) {
  if (!(drift > -1.0 && drift <= 10.0)) {
    throw Error(ErrorCode::invalid_argument,
                "the drift is " + fmt::format("{}", drift) + "; must be above -1, up to 10");
  }
  if (drift == 0.0) return device;
  if (device.links().empty()) throw Error(ErrorCode::invalid_argument, "a drift of the modes needs a [[link]]");
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty.reset();
  for (Link& link : parameters.links) {
    link.stiffness *= (1.0 + drift) * (1.0 + drift);
    link.damping *= 1.0 + drift;
  }
  return Device(std::move(parameters));
}

double stiffest_wall(const Device& device, const NotchOptions& options) {
  check(options);
  return stiffest_wall(scenario_of(device), options);
}

NotchDesign design_notch(const Device& device, const NotchOptions& options) {
  check(options);
  const std::vector<double> starts = starting_frequencies(device, options.goal);
  double reported = 0.0;
  const auto report = [&](double fraction) {
    reported = std::max(reported, fraction);
    if (options.progress) options.progress(reported);
  };

  NotchDesign design;
  std::vector<Scenario> verified;
  const std::size_t count = options.drift > 0.0 ? drifts_verified : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double drift = count == 1 ? 0.0 : drift_at(options, i);
    verified.push_back(scenario_of(drifted(device, drift)));
    const double without = stiffest_wall(verified.back(), options);
    design.over_drift.push_back({drift, without, without});
  }
  const Over over{device, options};
  design.without = design.with = over.least(design.over_drift, &NotchAtDrift::without, nullptr).stiffness;
  report(0.1);
  if (!std::isfinite(design.without)) return design;

  NotchSearch search(options, device.loop().sampling_period);
  if (count == 1) {
    search.scenarios = verified;
  } else {
    search.scenarios = {verified.front(), verified[count / 2], verified.back()};
  }
  std::vector<Point> candidates = search.grid(starts, [&](double done) { report(0.1 + 0.4 * done); });
  for (int round = 0; round < rounds && !candidates.empty(); ++round) {
    std::pair<double, Point> best{-1.0, {}};
    for (const Point& start : candidates) best = std::max(best, search.refine(start));
    const WallFilter notch = NotchSearch::notch_at(best.second);
    std::vector<NotchAtDrift> over_drift = design.over_drift;
    for (std::size_t i = 0; i < count; ++i) {
      over_drift[i].with = stiffest_wall(with_notch(verified[i], notch, options.goal), options);
    }
    const Over::Least worst = over.least(over_drift, &NotchAtDrift::with, &notch);
    double with = worst.stiffness;
    if (options.phase_margin > 0.0) with = over.with_margin_everywhere(verified, notch, with);
    if (with > design.with * (1.0 + worth_having)) {
      design.notch = notch;
      design.with = with;
      design.over_drift = std::move(over_drift);
      design.low_frequency_delay = 2.0 * notch.damping_ratio * (1.0 - notch.depth) / (2.0 * pi * notch.frequency_hz);
    }
    report(0.5 + 0.5 * (round + 1) / rounds);
    if (worst.stiffness >= best.first * (1.0 - 3.0 * shaved)) break;
    search.scenarios.push_back(scenario_of(drifted(device, worst.drift)));
    candidates = {best.second};
  }
  report(1.0);
  return design;
}

}  // namespace zwidth
