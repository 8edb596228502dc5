#include "zwidth/stability/any_user.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "stability/damper_response.hpp"
#include "stability/disc_stiffness.hpp"
#include "stability/user_discs.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double lowest_angle = 1e-7;  // rad per sample
// A limit at w = 0 is extrapolated from the first of these that fits closer to 0 too; rounding asks for large ones.
constexpr double zero_angles[] = {3e-5, 3e-6, 3e-7};
constexpr double closer = 1.0 / 30.0;
constexpr double rounding_unit = 2e-15;  // relative error of the root at w T = 1; it grows as 1/(w T)
constexpr int even_samples = 64;
constexpr double samples_per_delay = 16.0;  // more of them for each sample of delay: e^{-j w t_d} turns that often
constexpr int low_samples_per_decade = 24;
constexpr double narrowest_band = 1e-5;  // relative, around a crossover of the free device
constexpr int refining_bits = 30;
constexpr std::uintmax_t max_refinements = 60;
constexpr double worth_refining = 1.05;  // of the least sample

/// The limit of an even function at 0 from its values at 1, 2 and 3 steps; nothing where those at 4 steps and much
/// closer to 0 do not fit.
std::optional<double> limit_at_zero(const std::function<double(double)>& even, double step, double close) {
  const double y1 = even(step);
  const double y2 = even(2.0 * step);
  const double y3 = even(3.0 * step);
  const double y4 = even(4.0 * step);
  if (!(std::abs(even_parabola(y1, y2, y3, 4.0) - y4) <= smooth_enough * y4)) return std::nullopt;
  const double at_zero = even_parabola(y1, y2, y3, 0.0);
  if (!(std::abs(even(close) - at_zero) <= smooth_enough * at_zero)) return std::nullopt;
  return at_zero;
}

class LimitAt {
 public:
  LimitAt(const UserDiscs& discs, const Device& device, VirtualDamper damper)
      : discs_(discs), period_(device.loop().sampling_period), damper_(damper) {}

  double operator()(double frequency) const {
    return least_stiffness(discs_.at(frequency), damper_response(damper_, period_, frequency));
  }

 private:
  const UserDiscs& discs_;
  double period_;
  VirtualDamper damper_;
};

/// Where the condition may be tightest: evenly, towards zero, and around every mode of the held device and its alias.
std::vector<double> frequencies_to_scan(const UserDiscs& discs, const CriticalStiffness& free, double period,
                                        double delay, const std::vector<WallFilter>& filters) {
  const double nyquist = pi / period;
  std::vector<double> scan{nyquist};
  const int even = even_samples + static_cast<int>(samples_per_delay * delay / period);
  for (int i = 1; i < even; ++i) scan.push_back(nyquist * i / even);
  for (double angle = pi / even_samples; angle > lowest_angle; angle *= std::pow(10.0, -1.0 / low_samples_per_decade)) {
    scan.push_back(angle / period);
  }
  // The free device's own crossovers lie on the discs: the limit is never above them.
  for (const Crossover& each : free.crossovers) {
    // The band where K is finite may be narrow: closer and closer around.
    for (double share = 0.0; share < 0.5; share = share == 0.0 ? narrowest_band : 4.0 * share) {
      for (const double at : {each.frequency * (1.0 - share), each.frequency * (1.0 + share)}) {
        if (at > lowest_angle / period && at < nyquist) scan.push_back(at);
      }
    }
  }
  std::vector<Mode> modes = discs.held_form().modes;
  if (discs.held_form().suspended_rigid_body) modes.push_back(*discs.held_form().suspended_rigid_body);
  // A filter bends the condition as a mode does.
  for (const WallFilter& filter : filters) {
    if (filter.frequency_hz > 0.0) modes.push_back({2.0 * pi * filter.frequency_hz, filter.damping_ratio});
  }
  for (const Mode& mode : modes) {
    const double centre = std::abs(std::remainder(mode.frequency, 2.0 * nyquist));
    const double width = std::min(mode.damping_ratio, 1.0) * mode.frequency;
    for (const double widths : {0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 64.0}) {
      for (const double side : {-1.0, 1.0}) {
        const double at = centre + side * widths * width;
        if (at > lowest_angle / period && at < nyquist) scan.push_back(at);
      }
    }
  }
  std::sort(scan.begin(), scan.end());
  scan.erase(std::unique(scan.begin(), scan.end()), scan.end());
  return scan;
}

}  // namespace

AnyUserLimit any_user_limit(const Device& device, VirtualDamper damper) {
  const UserDiscs discs(device);
  AnyUserLimit limit;
  limit.truncation = discs.truncation();
  const CriticalStiffness free = critical_stiffness(discs.free_plant(), damper);
  if (free.status == StiffnessStatus::none_stable || discs.is_undamped()) return limit;
  const double period = device.loop().sampling_period;
  const LimitAt limit_at(discs, device, damper);
  const std::vector<double> scan =
      frequencies_to_scan(discs, free, period, device.loop().delay, device.parameters().wall.filters);
  std::vector<double> sampled;
  limit.stiffness = infinity;
  const auto consider = [&](double frequency, double stiffness) {
    const double angle = frequency > 0.0 ? frequency * period : zero_angles[0];
    if (stiffness * (1.0 + rounding_unit / angle) >= limit.stiffness) return;
    limit.stiffness = stiffness;
    limit.frequency = frequency;
  };
  for (const double angle : zero_angles) {
    const std::optional<double> at_zero = limit_at_zero(limit_at, angle / period, closer * angle / period);
    if (!at_zero) continue;
    consider(0.0, std::max(*at_zero, 0.0));
    break;
  }
  for (const double frequency : scan) {
    sampled.push_back(limit_at(frequency));
    consider(frequency, sampled.back());
  }
  const double least = limit.stiffness;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double left = i > 0 ? sampled[i - 1] : infinity;
    const double right = i + 1 < scan.size() ? sampled[i + 1] : infinity;
    if (sampled[i] > left || sampled[i] > right || !(sampled[i] <= worth_refining * least)) continue;
    std::uintmax_t iterations = max_refinements;
    // 1/K, which stays finite where no K violates the condition
    const auto [frequency, compliance] =
        boost::math::tools::brent_find_minima([&](double at) { return -1.0 / limit_at(at); }, scan[i > 0 ? i - 1 : 0],
                                              scan[std::min(i + 1, scan.size() - 1)], refining_bits, iterations);
    consider(frequency, -1.0 / compliance);
  }
  // Nobody is a passive user too. Where users hardly reach the wall's loop their discs are too small for rounding.
  if (free.limit && free.stiffness <= limit.stiffness) {
    limit.stiffness = free.stiffness;
    limit.frequency = free.limit->frequency;
    limit.needs_no_user = true;
  }
  if (limit.stiffness == 0.0 || !std::isfinite(limit.stiffness)) limit.frequency = 0.0;
  return limit;
}

}  // namespace zwidth
