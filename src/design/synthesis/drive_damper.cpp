#include "design/synthesis/drive_damper.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "design/synthesis/wall_limits.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "stability/users/absolute_stability_search.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/two_rate_users.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/critical_damping.hpp"
#include "zwidth/stability/force_per_count.hpp"

namespace zwidth {

std::optional<Device> with_damper_on_drive(const Device& device) {
  DeviceParameters parameters = device.parameters();
  Loop& loop = parameters.loop;
  const double parts = std::round(usual_drive_rate * loop.sampling_period);
  if (has_damper_loop(loop) || !parameters.wall.filters.empty() || parts < 2.0) return std::nullopt;
  const double period = loop.sampling_period / parts;
  constexpr double rounding = 1e-9;  // periods
  const double periods = loop.delay / period;
  const double beyond = std::max(0.0, periods - std::floor(periods + rounding));
  LoopDamper damper;
  damper.sampling_period = period;
  damper.delay = (1.0 + beyond) * period;
  loop.damper = damper;
  if (find_problem(parameters)) return std::nullopt;
  return Device(std::move(parameters));
}

namespace internal {
namespace {

constexpr int samples_of_damping = 16;          // evenly in log B
constexpr double least_share_of_damper = 1e-3;  // of the largest
constexpr double most_share_of_damper = 1.0 - 1e-6;
constexpr int bits_of_damping = 10;  // of log B: the limit is flat there
constexpr std::uintmax_t most_refinements_of_damping = 16;

}  // namespace

BestDamping best_damping(const Device& device, const std::function<double(double)>& value, const Progress& progress) {
  require_no_coordinates(device);
  BestDamping best{0.0, value(0.0)};
  const Device alone = with_loop_of_damper(device);
  const double largest =
      device.has_bodies() ? absolute_stability_damping(alone, progress).damping : critical_damping(alone).damping;
  if (!(largest > 0.0) || !std::isfinite(largest) || std::isinf(best.value)) return best;
  const double begin = std::log(least_share_of_damper * largest);
  const double end = std::log(most_share_of_damper * largest);
  std::vector<BestDamping> found;
  const auto negative_value = [&](double log_damping) {
    tell(progress, 0.0);
    const double damping = std::exp(log_damping);
    found.push_back({damping, value(damping)});
    return -found.back().value;
  };
  for (int i = 0; i < samples_of_damping; ++i)
    negative_value(std::lerp(begin, end, double(i) / (samples_of_damping - 1)));
  const auto top = std::ranges::max_element(found, {}, &BestDamping::value);
  const double left = top == found.begin() ? begin : std::log(std::prev(top)->damping);
  const double right = std::next(top) == found.end() ? end : std::log(std::next(top)->damping);
  if (top->value > 0.0 && std::isfinite(top->value)) {
    std::uintmax_t steps = most_refinements_of_damping;
    boost::math::tools::brent_find_minima(negative_value, left, right, bits_of_damping, steps);
  }
  const BestDamping most = *std::ranges::max_element(found, {}, &BestDamping::value);
  return most.value > best.value ? most : best;
}

std::optional<DriveDamper> drive_damper(const Device& device, bool any_user, const Progress& progress) {
  const std::optional<Device> on_drive = with_damper_on_drive(device);
  if (!on_drive) return std::nullopt;
  const bool is_held = can_be_held(device);
  const double filter = device.parameters().wall.velocity_filter_hz;
  const auto with = [filter](const Device& each, double damping) { return with_wall(each, 0.0, {damping, filter}); };
  // The limit asked for at the best B; 0 where there is none.
  const auto limit_with = [&](const Device& each, const BestDamping& best) {
    const Device damped = with(each, best.damping);
    const CriticalStiffness critical = critical_stiffness(damped);
    if (critical.trust.refused() || !(critical.stiffness > 0.0)) return 0.0;
    return any_user && is_held ? known_any_user_limit(damped, progress).lower_bound() : critical.stiffness;
  };
  try {
    std::optional<TwoRateUsers> two_rates;
    std::optional<AbsoluteStabilitySearch> one_rate;
    if (is_held) {
      two_rates.emplace(*on_drive);
      one_rate.emplace(device, progress);
    }
    const BestDamping apart = best_damping(
        *on_drive,
        [&](double damping) {
          const double nobody = unguarded_stiffness(with(*on_drive, damping)).stiffness;
          return is_held && damping > 0.0 ? std::min(nobody, two_rates->limit_on_grid({damping, filter})) : nobody;
        },
        progress);
    const BestDamping together = best_damping(
        device,
        [&](double damping) {
          return is_held ? one_rate->limit({damping, filter}, progress).lower_bound()
                         : unguarded_stiffness(with(device, damping)).stiffness;
        },
        progress);
    DriveDamper found;
    found.damping = apart.damping;
    found.velocity_filter_hz = apart.damping > 0.0 ? filter : 0.0;
    found.stiffness = limit_with(*on_drive, apart);
    if (is_held) {
      found.absolute_stability_limit = known_any_user_limit(with(*on_drive, apart.damping), progress).lower_bound();
    }
    found.one_rate_damping = together.damping;
    found.one_rate_stiffness = limit_with(device, together);
    complete(found, *on_drive);
    if (!(found.stiffness > 0.0) || !(found.gain > 0.0) || !std::isfinite(found.gain)) return std::nullopt;
    return found;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    return std::nullopt;
  }
}

void complete(DriveDamper& found, const Device& on_drive) {
  const auto [period, delay] = damper_timing(on_drive.loop());
  found.sampling_period = period;
  found.delay = delay;
  found.gain = found.stiffness / found.one_rate_stiffness;
  const Units units = units_of(on_drive.parameters().motion);
  found.why = {.code = FindingCode::damper_on_drive,
               .evidence = {{"sampling_period", period, "s"},
                            {"rate_hz", 1.0 / period, "Hz"},
                            {"delay", delay, "s"},
                            {"damping", found.damping, units.damping},
                            {"stiffness", found.stiffness, units.stiffness},
                            {"one_rate_damping", found.one_rate_damping, units.damping},
                            {"one_rate_stiffness", found.one_rate_stiffness, units.stiffness},
                            {"gain", found.gain}},
               .key = "loop.damper.sampling_period"};
  std::vector<Evidence>& evidence = found.why.evidence;
  const Device walled = with_wall(on_drive, found.stiffness, {found.damping, found.velocity_filter_hz});
  if (const auto per_count = force_per_count(walled))
    evidence.push_back({"force_per_count", per_count->largest, units.force});
  if (found.velocity_filter_hz > 0.0) evidence.push_back({"velocity_filter_hz", found.velocity_filter_hz, "Hz"});
  if (found.absolute_stability_limit) {
    evidence.push_back({"any_user_stiffness", *found.absolute_stability_limit, units.stiffness});
  }
}

}  // namespace internal
}  // namespace zwidth
