#include "stability/users/grasp_search.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "stability/users/disc_stiffness.hpp"

namespace zwidth::internal {
namespace {

constexpr double beside_filter[] = {0.5, 0.8, 0.9, 0.95, 0.98, 1.0, 1.02, 1.05, 1.1, 1.25, 2.0};  // times its frequency
constexpr double at_low_end = 1.001;         // times the scan's lowest frequency
constexpr double worth_a_closer_look = 1.3;  // times the least of the scan
constexpr int closer_bits = 26;
constexpr std::uintmax_t most_closer_looks = 60;

}  // namespace

GraspSearch::GraspSearch(const Device& device)
    : users_(device), period_(device.loop().sampling_period), frequencies_(users_.frequencies_of_grasp()) {
  if (users_.is_undamped()) return;
  const double lowest = frequencies_.front();
  for (const WallFilter& filter : device.parameters().wall.filters) {
    for (const double factor : beside_filter) {
      const double at = 2.0 * std::numbers::pi * filter.frequency_hz * factor;
      if (at > lowest && at < frequencies_.back()) frequencies_.push_back(at);
    }
    std::ranges::sort(frequencies_);
  }
  discs_.reserve(frequencies_.size());
  for (const double frequency : frequencies_) discs_.push_back(users_.at(frequency));
}

WallResponse GraspSearch::wall_at(FreeGain gain, VirtualDamper damper, double frequency) const {
  const std::complex<double> velocity = damper_response(damper, period_, frequency);
  return gain == FreeGain::damping ? WallResponse{velocity, 0.0} : WallResponse{1.0, velocity};
}

AbsoluteStabilityLimit GraspSearch::limit(FreeGain gain, VirtualDamper damper, const CriticalStiffness& free) const {
  AbsoluteStabilityLimit limit;
  if (free.status == StiffnessStatus::none_stable || users_.is_undamped()) return limit;
  std::vector<double> gains;
  for (std::size_t i = 0; i < frequencies_.size(); ++i) {
    gains.push_back(least_gain(discs_[i], wall_at(gain, damper, frequencies_[i])));
  }
  const auto lowest = std::ranges::min_element(gains);
  double least = *lowest;
  double at = frequencies_[static_cast<std::size_t>(lowest - gains.begin())];
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, gains.size() - 1);
    const bool is_low =
        gains[i] <= gains[before] && gains[i] <= gains[after] && gains[i] <= worth_a_closer_look * *lowest;
    if (!is_low || !(*lowest > 0.0) || !std::isfinite(*lowest)) continue;
    std::uintmax_t most = most_closer_looks;
    const auto found = boost::math::tools::brent_find_minima(
        [&](double frequency) {
          const double value = least_gain(users_.at(frequency), wall_at(gain, damper, frequency));
          return std::isfinite(value) ? value : std::numeric_limits<double>::max();
        },
        frequencies_[before], frequencies_[after], closer_bits, most);
    if (found.second < least) least = found.second, at = found.first;
  }
  limit.needs_no_user = free.limit && free.stiffness <= least;
  limit.stiffness = limit.needs_no_user ? free.stiffness : least;
  if (!(limit.stiffness > 0.0) || !std::isfinite(limit.stiffness)) return limit;
  if (limit.needs_no_user) {
    limit.frequency = free.limit->frequency;
  } else if (at > at_low_end * frequencies_.front()) {
    limit.frequency = at;
  }
  return limit;
}

}  // namespace zwidth::internal
