#include "zwidth/stability/stiffness_interval.hpp"

#include <algorithm>
#include <vector>

#include "stability/device_draws.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

CriticalStiffness critical_stiffness_of(const Device& device) {
  return critical_stiffness(filtered_plant(device), virtual_damper(device));
}

bool same_mechanism(const CriticalStiffness& a, const CriticalStiffness& b) {
  if (a.limit.has_value() != b.limit.has_value()) return false;
  if (!a.limit) return a.status == b.status;
  return a.limit->limited_by.kind == b.limit->limited_by.kind && a.limit->limited_by.mode == b.limit->limited_by.mode;
}

}  // namespace

bool is_open(const StiffnessInterval& interval) {
  constexpr double widest = 2.0;  // times the lower end
  return interval.upper > widest * interval.lower;
}

StiffnessInterval stiffness_interval(const Device& device, std::size_t draws, std::uint64_t seed,
                                     const Progress& progress) {
  const std::optional<Uncertainty>& uncertainty = device.parameters().uncertainty;
  if (!uncertainty || uncertainty->parameters.empty())
    throw Error(ErrorCode::invalid_argument, "the device has no uncertainty");
  if (draws == 0) throw Error(ErrorCode::invalid_argument, "draws is 0; must be at least 1");
  const CriticalStiffness own = critical_stiffness_of(device);
  internal::DeviceDraws drawn(device, seed);
  std::vector<double> stiffness;
  stiffness.reserve(draws);
  std::size_t others = 0;
  for (std::size_t draw = 0; draw < draws; ++draw) {
    const CriticalStiffness critical = critical_stiffness_of(drawn.next());
    stiffness.push_back(critical.stiffness);
    if (!same_mechanism(own, critical)) ++others;
    internal::tell(progress, static_cast<double>(draw + 1) / static_cast<double>(draws));
  }
  std::ranges::sort(stiffness);
  const auto tail = static_cast<std::size_t>(0.025 * static_cast<double>(draws));
  // A parameter at its bound is drawn to one side of it only: the device itself is within, all the same.
  return {std::min(stiffness[tail], own.stiffness), std::max(stiffness[draws - 1 - tail], own.stiffness),
          static_cast<double>(others) / static_cast<double>(draws), draws};
}

}  // namespace zwidth
