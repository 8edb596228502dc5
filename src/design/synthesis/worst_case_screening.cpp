#include "design/synthesis/worst_case_screening.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "stability/device_draws.hpp"
#include "staged_progress.hpp"
#include "zwidth/design/notch_design.hpp"

namespace zwidth::internal {
namespace {

constexpr std::uint64_t seed = 1;
constexpr int steps_of_damping = 10;
constexpr double softer = 0.97;
constexpr int most_softer = 40;

}  // namespace

std::vector<Device> drawn(const Device& device, const RecommendationOptions& options) {
  DeviceDraws draws(device, seed);
  std::vector<Device> devices;
  for (std::size_t i = 0; i < options.draws; ++i) {
    tell(options.progress, 0.0);
    devices.push_back(draws.next());
  }
  return devices;
}

std::vector<Device> with_modal_shifts(const Device& device, double uncertainty) {
  std::vector<Device> devices;
  for (std::size_t i = 0; i < modal_shifts_held; ++i) {
    const std::size_t pair = i / 2;
    const double inwards = 1.0 - 2.0 * static_cast<double>(pair) / (modal_shifts_held - 1);
    devices.push_back(with_modal_shift(device, (i % 2 == 0 ? -uncertainty : uncertainty) * inwards));
  }
  return devices;
}

WorstCaseScreening::WorstCaseScreening(const std::vector<Device>& devices, const std::optional<WallFilter>& notch,
                                       double may_fail, const RecommendationOptions& options)
    : options_(options),
      may_fail_(static_cast<std::size_t>(may_fail * static_cast<double>(devices.size()))),
      devices_(devices.size()) {
  if (options.progress) {
    options_.progress = [this, whole = options.progress](double fraction) {
      const std::lock_guard lock(told_);
      whole(fraction);
    };
  }
  tbb::parallel_for(std::size_t{0}, devices.size(), [&](std::size_t i) {
    devices_[i].limits = std::make_unique<WallLimits>(notch ? with_filter(devices[i], *notch) : devices[i], options_);
  });
}

template <typename Keeps>
bool WorstCaseScreening::enough_keep(const Keeps& keeps) {
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> failed = 0;
  tbb::parallel_for(std::size_t{0}, devices_.size(), [&](std::size_t /*any*/) {
    if (failed > may_fail_) return;
    const std::size_t i = next++;
    if (!keeps(i)) ++failed;
  });
  return failed <= may_fail_;
}

/// On the grids; 0 as soon as more devices than may fail are seen not to get above `enough`.
double WorstCaseScreening::lower_limit(VirtualDamper damper, WallGoal goal, double enough) {
  std::vector<double> stiffnesses(devices_.size());
  const bool is_higher = enough_keep([&](std::size_t i) {
    Each& each = devices_[i];
    if (!each.search) each.search = std::make_unique<WallSearch>(*each.limits, options_);
    stiffnesses[i] = each.search->stiffest(damper, goal);
    return stiffnesses[i] > enough;
  });
  if (!is_higher) return 0.0;
  const auto at = stiffnesses.begin() + static_cast<std::ptrdiff_t>(may_fail_);
  std::nth_element(stiffnesses.begin(), at, stiffnesses.end());
  return *at;
}

bool WorstCaseScreening::most_keep(double stiffness, VirtualDamper damper) {
  return enough_keep([&](std::size_t i) { return devices_[i].limits->keeps(stiffness, damper); });
}

bool WorstCaseScreening::has_no_lower_limit_than(const WorstCaseScreening& others, VirtualDamper damper) const {
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    if (is_lower(devices_[i].limits->limit(damper), others.devices_[i].limits->limit(damper))) return false;
  }
  return true;
}

WorstCaseScreening::Kept WorstCaseScreening::lowered(double stiffness, VirtualDamper damper, WallGoal goal) {
  if (most_keep(stiffness, damper)) return {stiffness, damper};
  Kept best;
  double value = 0.0;
  for (int i = steps_of_damping; i >= 0; --i) {
    const VirtualDamper less{damper.damping * i / steps_of_damping, damper.velocity_filter_hz};
    // What the goal needs to get above the best so far.
    const double per_stiffness = WallSearch::value_of(goal, 1.0, less.damping);
    const double enough = value > 0.0 ? value / per_stiffness : 0.0;
    if (!(stiffness > enough)) continue;
    const double limit = std::min(stiffness, lower_limit(less, goal, enough));
    if (WallSearch::value_of(goal, limit, less.damping) > value) {
      value = WallSearch::value_of(goal, limit, less.damping);
      best = {limit, less};
    }
  }
  for (int i = 0; i < most_softer && best.stiffness > 0.0; ++i, best.stiffness *= softer) {
    if (most_keep(best.stiffness, best.damper)) return best;
  }
  return {};
}

}  // namespace zwidth::internal
