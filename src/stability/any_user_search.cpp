#include "stability/any_user_search.hpp"

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

namespace zwidth::internal {
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
constexpr double far_above = 10.0;       // times the least K: a disc there would hold the origin or nearly so
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

/// Where the condition may be tightest whatever the damper: evenly, towards zero, and around every mode of the held
/// device and its alias.
std::vector<double> frequencies_to_scan(const UserDiscs& discs, double period, double delay,
                                        const std::vector<WallFilter>& filters) {
  const double nyquist = pi / period;
  std::vector<double> scan{nyquist};
  const int even = even_samples + static_cast<int>(samples_per_delay * delay / period);
  for (int i = 1; i < even; ++i) scan.push_back(nyquist * i / even);
  for (double angle = pi / even_samples; angle > lowest_angle; angle *= std::pow(10.0, -1.0 / low_samples_per_decade)) {
    scan.push_back(angle / period);
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

AnyUserSearch::AnyUserSearch(const Device& device) : discs_(device), period_(device.loop().sampling_period) {
  if (discs_.is_undamped()) return;
  frequencies_ = frequencies_to_scan(discs_, period_, device.loop().delay, device.parameters().wall.filters);
  discs_at_.reserve(frequencies_.size());
  for (const double frequency : frequencies_) discs_at_.push_back(discs_.at(frequency));
}

double AnyUserSearch::limit_at(VirtualDamper damper, double frequency) const {
  return least_stiffness(discs_.at(frequency), damper_response(damper, period_, frequency));
}

/// By rising frequency. The free device's own crossovers lie on the discs: the limit is never above them, and the band
/// around one where K is finite may be narrow, so closer and closer around. A band that is narrow is so because the
/// disc is small beside its centre, and K there is hardly below the crossover's: those far above the least K need no
/// closer look.
std::vector<AnyUserSearch::Sample> AnyUserSearch::scan(VirtualDamper damper, const CriticalStiffness& free) const {
  std::vector<Sample> samples;
  samples.reserve(frequencies_.size());
  double least = infinity;
  for (std::size_t i = 0; i < frequencies_.size(); ++i) {
    const double frequency = frequencies_[i];
    samples.push_back({frequency, least_stiffness(discs_at_[i], damper_response(damper, period_, frequency))});
    least = std::min(least, samples.back().stiffness);
  }
  const auto known = static_cast<std::ptrdiff_t>(samples.size());
  for (const Crossover& each : free.crossovers) {
    if (each.stiffness > far_above * least) continue;
    for (double share = 0.0; share < 0.5; share = share == 0.0 ? narrowest_band : 4.0 * share) {
      for (const double at : {each.frequency * (1.0 - share), each.frequency * (1.0 + share)}) {
        if (at > lowest_angle / period_ && at < pi / period_) samples.push_back({at, limit_at(damper, at)});
      }
    }
  }
  const auto by_frequency = [](const Sample& a, const Sample& b) { return a.frequency < b.frequency; };
  std::sort(samples.begin() + known, samples.end(), by_frequency);
  std::inplace_merge(samples.begin(), samples.begin() + known, samples.end(), by_frequency);
  return samples;
}

AnyUserLimit AnyUserSearch::limit(VirtualDamper damper) const {
  AnyUserLimit limit;
  limit.truncation = discs_.truncation();
  const CriticalStiffness free = critical_stiffness(discs_.free_plant(), damper);
  if (free.status == StiffnessStatus::none_stable || discs_.is_undamped()) return limit;
  limit.stiffness = infinity;
  const auto consider = [&](double frequency, double stiffness) {
    const double angle = frequency > 0.0 ? frequency * period_ : zero_angles[0];
    if (stiffness * (1.0 + rounding_unit / angle) >= limit.stiffness) return;
    limit.stiffness = stiffness;
    limit.frequency = frequency;
  };
  const auto at = [&](double frequency) { return limit_at(damper, frequency); };
  for (const double angle : zero_angles) {
    const std::optional<double> at_zero = limit_at_zero(at, angle / period_, closer * angle / period_);
    if (!at_zero) continue;
    consider(0.0, std::max(*at_zero, 0.0));
    break;
  }
  const std::vector<Sample> samples = scan(damper, free);
  for (const Sample& each : samples) consider(each.frequency, each.stiffness);
  const double least = limit.stiffness;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& here = samples[i];
    const double left = i > 0 ? samples[i - 1].stiffness : infinity;
    const double right = i + 1 < samples.size() ? samples[i + 1].stiffness : infinity;
    if (here.stiffness > left || here.stiffness > right) continue;
    // Between the samples it may fall as far again as from the higher neighbour to here.
    const double may_reach = here.stiffness - (std::max(left, right) - here.stiffness);
    if (!(std::isfinite(here.stiffness) && may_reach <= worth_refining * least)) continue;
    std::uintmax_t iterations = max_refinements;
    // 1/K, which stays finite where no K violates the condition
    const auto [frequency, compliance] = boost::math::tools::brent_find_minima(
        [&](double x) { return -1.0 / at(x); }, samples[i > 0 ? i - 1 : 0].frequency,
        samples[std::min(i + 1, samples.size() - 1)].frequency, refining_bits, iterations);
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

}  // namespace zwidth::internal
