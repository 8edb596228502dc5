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
#include "stability/users/two_rate_users.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/critical_damping.hpp"

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

constexpr int looks_at_damping = 16;            // evenly in log B
constexpr double least_share_of_damper = 1e-3;  // of the largest
constexpr double most_share_of_damper = 1.0 - 1e-6;
constexpr int bits_of_damping = 10;  // of log B: the limit is flat there
constexpr std::uintmax_t most_refinements_of_damping = 16;

}  // namespace

BestDamping best_damping(const Device& device, const std::function<double(double)>& value, const Progress& progress) {
  BestDamping best{0.0, value(0.0)};
  const Device alone = with_loop_of_damper(device);
  const double largest =
      device.has_bodies() ? absolute_stability_damping(alone, progress).damping : critical_damping(alone).damping;
  if (!(largest > 0.0) || !std::isfinite(largest) || std::isinf(best.value)) return best;
  const double begin = std::log(least_share_of_damper * largest);
  const double end = std::log(most_share_of_damper * largest);
  std::vector<BestDamping> found;
  const auto look = [&](double log_damping) {
    tell(progress, 0.0);
    const double damping = std::exp(log_damping);
    found.push_back({damping, value(damping)});
    return -found.back().value;
  };
  for (int i = 0; i < looks_at_damping; ++i) look(std::lerp(begin, end, double(i) / (looks_at_damping - 1)));
  const auto top = std::ranges::max_element(found, {}, &BestDamping::value);
  const double left = top == found.begin() ? begin : std::log(std::prev(top)->damping);
  const double right = std::next(top) == found.end() ? end : std::log(std::next(top)->damping);
  if (top->value > 0.0 && std::isfinite(top->value)) {
    std::uintmax_t steps = most_refinements_of_damping;
    boost::math::tools::brent_find_minima(look, left, right, bits_of_damping, steps);
  }
  const BestDamping most = *std::ranges::max_element(found, {}, &BestDamping::value);
  return most.value > best.value ? most : best;
}

std::optional<DriveDamper> drive_damper(const Device& device, bool any_user, double limit_now,
                                        const Progress& progress) {
  const std::optional<Device> on_drive = with_damper_on_drive(device);
  if (!on_drive || !(limit_now > 0.0) || !std::isfinite(limit_now)) return std::nullopt;
  const bool is_held = can_be_held(*on_drive);
  const double filter = device.parameters().wall.velocity_filter_hz;
  const auto with = [&](double damping) { return with_wall(*on_drive, 0.0, {damping, filter}); };
  try {
    const BestDamping best = best_damping(
        *on_drive,
        [&](double damping) {
          return is_held ? any_user_limit(with(damping), progress)->stiffness
                         : unguarded_stiffness(with(damping)).stiffness;
        },
        progress);
    const CriticalStiffness critical = critical_stiffness(with(best.damping));
    if (!(best.value > 0.0) || critical.trust.refused()) return std::nullopt;
    const auto [period, delay] = damper_timing(on_drive->loop());
    DriveDamper found{period, delay, best.damping, any_user ? best.value : critical.stiffness, {}, 1.0, {}};
    if (is_held) found.absolute_stability_limit = best.value;
    found.gain = found.stiffness / limit_now;
    found.why = finding_of(found, device.parameters().motion);
    return found;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    return std::nullopt;
  }
}

Finding finding_of(const DriveDamper& on_drive, Motion motion) {
  const Units units = units_of(motion);
  Finding why{.code = FindingCode::damper_on_drive,
              .evidence = {{"sampling_period", on_drive.sampling_period, "s"},
                           {"rate_hz", 1.0 / on_drive.sampling_period, "Hz"},
                           {"delay", on_drive.delay, "s"},
                           {"damping", on_drive.damping, units.damping},
                           {"stiffness", on_drive.stiffness, units.stiffness},
                           {"gain", on_drive.gain}},
              .key = "loop.damper.sampling_period"};
  if (on_drive.absolute_stability_limit) {
    why.evidence.push_back({"any_user_stiffness", *on_drive.absolute_stability_limit, units.stiffness});
  }
  return why;
}

}  // namespace internal
}  // namespace zwidth
