#include "zwidth/design/branch_switch.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "design/sensitivities/two_rate_sensitivity.hpp"
#include "stability/limit/gain_crossings.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/mechanism_key.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double followed_per_decade = 12.0;
constexpr double jump = 0.02;        // of log frequency: another crossover
constexpr double resolution = 1e-9;  // of p
constexpr int max_bisections = 60;
constexpr double first_share_of_way = 1e-3;  // of the way from 0
constexpr double farthest_beyond = 1e-3;     // of p
constexpr double may_grow = 4.0;             // K_CR, from one value to the next: beyond it all crossovers are sought

struct FollowedPoint {
  double value = 0.0;
  CriticalStiffness critical;
};

/// How far apart the limiting crossovers are: infinite where one is missing or at rest.
double distance(const FollowedPoint& a, const FollowedPoint& b) {
  if (!a.critical.limit || !b.critical.limit) return std::numeric_limits<double>::infinity();
  const double first = a.critical.limit->frequency;
  const double second = b.critical.limit->frequency;
  if (first == second) return 0.0;
  return std::abs(std::log(first / second));
}

/// The critical stiffness and the crossover that limits it; stiffer ones are not sought where that is at most `most`.
CriticalStiffness limit_of(const FilteredPlant& plant, VirtualDamper damper, double most) {
  if (most > 0.0 && std::isfinite(most)) {
    const GainCrossings softest = stiffness_crossings_up_to(plant, damper, most);
    if (!softest.crossings.empty()) return critical_stiffness_of(plant, softest);
  }
  return critical_stiffness(plant, damper);
}

class Way {
 public:
  Way(const Device& device, std::string key, SharedProgress& progress)
      : parameters_(device.parameters()), key_(std::move(key)), progress_(progress) {
    parameters_.uncertainty.reset();
  }

  /// Nothing where the value makes no device. `near`: K_CR at a value near by.
  [[nodiscard]] std::optional<FollowedPoint> at(double value, double near) const {
    progress_.go_on();
    DeviceParameters moved = parameters_;
    set_with_ratio(moved, key_, value);
    if (find_problem(moved)) return std::nullopt;
    if (has_damper_loop(moved.loop)) return at_two_rates(value, Device(std::move(moved)));
    const VirtualDamper damper{moved.wall.damping, moved.wall.velocity_filter_hz};
    return FollowedPoint{value, limit_of(filtered_plant(Device(std::move(moved))), damper, may_grow * near)};
  }

  /// Halves the way between two points towards the jump; nothing where it closes: one branch that moves fast.
  [[nodiscard]] std::optional<BranchSwitch> switch_between(FollowedPoint near, FollowedPoint far) const {
    for (int i = 0; i < max_bisections && std::abs(far.value - near.value) > resolution * std::abs(far.value); ++i) {
      const double stiffest = std::max(near.critical.stiffness, far.critical.limit ? far.critical.stiffness : 0.0);
      auto middle = at(0.5 * (near.value + far.value), stiffest);
      if (!middle) return std::nullopt;
      const double before = distance(near, *middle);
      const double beyond = distance(*middle, far);
      if (std::max(before, beyond) < jump) return std::nullopt;
      (before >= beyond ? far : near) = *std::move(middle);
    }
    if (distance(near, far) < jump) return std::nullopt;
    const std::optional<CriticalStiffness> after = beyond(far, far.value > near.value ? 1.0 : -1.0);
    if (!after) return std::nullopt;
    return BranchSwitch{key_, far.value, near.critical.stiffness, after->stiffness, *near.critical.limit, after->limit};
  }

  /// The first switch along rising step numbers.
  template <typename Values>
  [[nodiscard]] std::optional<BranchSwitch> first_switch(const CriticalStiffness& own, double value, int steps,
                                                         const Values& value_at) const {
    FollowedPoint last{value, own};
    for (int i = 1; i <= steps; ++i) {
      auto next = at(value_at(i), last.critical.stiffness);
      if (!next) return std::nullopt;
      if (distance(last, *next) >= jump) {
        if (auto found = switch_between(last, *next)) return found;
      }
      if (!next->critical.limit) return std::nullopt;
      last = *std::move(next);
    }
    return std::nullopt;
  }

 private:
  /// Nothing where its plant is beyond all digits.
  [[nodiscard]] static std::optional<FollowedPoint> at_two_rates(double value, const Device& device) {
    try {
      return FollowedPoint{value, unguarded_stiffness(device)};
    } catch (const Error& error) {
      if (error.code() != ErrorCode::did_not_converge) throw;
      return std::nullopt;
    }
  }

  /// What holds beyond a switch. Where no crossover limits there, rounding decides at its very edge between no wall and
  /// every wall: then the first answer on the way onward that the second route confirms. Nothing where there is none.
  [[nodiscard]] std::optional<CriticalStiffness> beyond(const FollowedPoint& far, double direction) const {
    if (far.critical.limit) return far.critical;
    for (double step = resolution; step <= farthest_beyond; step *= 10.0) {
      DeviceParameters moved = parameters_;
      set_with_ratio(moved, key_, far.value + direction * step * std::abs(far.value));
      if (find_problem(moved)) return std::nullopt;
      CriticalStiffness critical = critical_stiffness(Device(std::move(moved)));
      if (critical.trust.sound()) return critical;
    }
    return std::nullopt;
  }

  DeviceParameters parameters_;
  std::string key_;
  SharedProgress& progress_;
};

std::vector<BranchSwitch> switches_of(const Device& device, const CriticalStiffness& own, const Sensitivity& each,
                                      double factor, SharedProgress& progress) {
  std::vector<BranchSwitch> switches;
  if (is_key_of_pose(each.key)) return switches;  // no share of an angle is a step
  const Way way(device, each.key, progress);
  // From the device's own value, by equal factors from `start` to `end`.
  const auto follow = [&](double start, double end) {
    const int steps = static_cast<int>(std::ceil(followed_per_decade * std::abs(std::log10(end / start))));
    auto found = way.first_switch(own, each.value, steps, [&](int i) {
      return i == steps ? end : start * std::pow(end / start, static_cast<double>(i) / steps);
    });
    if (found) switches.push_back(*std::move(found));
  };
  if (each.value > 0.0) {
    follow(each.value, each.value / factor);
    follow(each.value, each.value * factor);
  } else if (each.slope != 0.0) {
    const double full = own.stiffness / std::abs(each.slope);
    follow(first_share_of_way * full, factor * full);
  }
  return switches;
}

}  // namespace

std::vector<BranchSwitch> branch_switches(const Device& device, BranchSwitchOptions options) {
  if (!(options.factor > 1.0) || !std::isfinite(options.factor)) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::not_finite_and_above,
                                              .evidence = {{"value", options.factor}, {"bound", 1.0}},
                                              .subjects = {{"name", "factor"}}});
  }
  const CriticalStiffness own = unguarded_stiffness(device);
  const std::vector<Sensitivity> sensitivities = stiffness_sensitivities(device, own);
  std::vector<std::vector<BranchSwitch>> found(sensitivities.size());
  SharedProgress progress(options.progress, sensitivities.size());
  tbb::parallel_for(std::size_t{0}, sensitivities.size(), [&](std::size_t i) {
    found[i] = switches_of(device, own, sensitivities[i], options.factor, progress);
    progress.add();
  });
  std::vector<BranchSwitch> switches;
  for (auto& each : found) std::ranges::move(each, std::back_inserter(switches));
  return switches;
}

}  // namespace zwidth
