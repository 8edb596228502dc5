#include "results/trajectory_envelope.hpp"

#include <algorithm>
#include <vector>

namespace zwidth::results {
namespace {

using Signal = std::vector<double>;

Signal at(const Signal& all, const std::vector<std::size_t>& places) {
  Signal kept;
  kept.reserve(places.size());
  for (const std::size_t place : places) kept.push_back(all[place]);
  return kept;
}

std::vector<Signal> at(const std::vector<Signal>& all, const std::vector<std::size_t>& places) {
  std::vector<Signal> kept;
  for (const Signal& each : all) kept.push_back(at(each, places));
  return kept;
}

}  // namespace

Trajectory envelope_of(const Trajectory& motion, std::size_t most) {
  const std::size_t count = motion.time.size();
  if (count <= most) return motion;
  std::vector<const Signal*> drawn = {&motion.measured, &motion.command};
  for (const Signal& each : motion.position) drawn.push_back(&each);
  const std::size_t windows = std::max<std::size_t>(1, (most - 1) / (1 + 2 * drawn.size()));
  std::vector<std::size_t> places;
  for (std::size_t window = 0; window < windows; ++window) {
    const std::size_t begin = window * count / windows;
    const auto length = static_cast<std::ptrdiff_t>((window + 1) * count / windows - begin);
    std::vector<std::size_t> here = {begin};
    for (const Signal* signal : drawn) {
      const auto first = signal->begin() + static_cast<std::ptrdiff_t>(begin);
      const auto [least, largest] = std::minmax_element(first, first + length);
      for (const auto& each : {least, largest}) here.push_back(static_cast<std::size_t>(each - signal->begin()));
    }
    if (window + 1 == windows) here.push_back(count - 1);
    std::ranges::sort(here);
    places.insert(places.end(), here.begin(), std::ranges::unique(here).begin());
  }
  return {at(motion.time, places),       at(motion.measured, places), at(motion.command, places),
          at(motion.user_force, places), at(motion.position, places), at(motion.velocity, places)};
}

}  // namespace zwidth::results
