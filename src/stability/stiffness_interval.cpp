#include "zwidth/stability/stiffness_interval.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "batch/kernel/kernel_columns.hpp"
#include "stability/device_draws.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/model/parameter_values.hpp"

namespace zwidth {
namespace {

constexpr std::size_t block = 512;  // devices at once

/// K_CR, and the mode that limits it: 0 is the rigid body.
struct Limit {
  double stiffness = 0.0;
  std::optional<int> mode;  ///< nothing unless finite
};

Limit limit_of(const Device& device) {
  const CriticalStiffness critical = critical_stiffness(filtered_plant(device), virtual_damper(device));
  if (!critical.limit) return {critical.stiffness, std::nullopt};
  return {critical.stiffness, critical.limit->limited_by.mode};
}

/// Draws a block of devices at a time and solves them: by the kernel of many devices, and where that is not certain one by
/// one.
class DrawnLimits {
 public:
  DrawnLimits(const Device& device, std::uint64_t seed) : device_(device), drawn_(device, seed) {
    for (const std::string& key : device.parameters().uncertainty->parameters) columns_.push_back({key, {}});
  }

  [[nodiscard]] std::vector<Limit> next(std::size_t count) {
    std::vector<Device> devices;
    for (ParameterValues& each : columns_) each.values.clear();
    for (std::size_t i = 0; i < count; ++i) {
      devices.push_back(drawn_.next());
      for (ParameterValues& each : columns_) each.values.push_back(*parameter(devices[i].parameters(), each.key));
    }
    const internal::KernelColumns kernel(device_.parameters(), columns_);
    kernel.solve(0, count, answers_, scratch_);
    std::vector<Limit> limits;
    for (std::size_t i = 0; i < count; ++i) {
      const bool certain = answers_.certain[i] != 0;
      limits.push_back(certain ? Limit{answers_.stiffness[i], answers_.mode[i]} : limit_of(devices[i]));
    }
    return limits;
  }

 private:
  const Device& device_;
  internal::DeviceDraws drawn_;
  std::vector<ParameterValues> columns_;
  internal::KernelAnswers answers_;
  internal::BlockScratch scratch_;
};

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
  const Limit own = limit_of(device);
  DrawnLimits drawn(device, seed);
  std::vector<double> stiffness;
  stiffness.reserve(draws);
  std::size_t others = 0;
  while (stiffness.size() < draws) {
    for (const Limit& each : drawn.next(std::min(block, draws - stiffness.size()))) {
      stiffness.push_back(each.stiffness);
      if (each.mode != own.mode || (!each.mode && each.stiffness != own.stiffness)) ++others;
    }
    internal::tell(progress, static_cast<double>(stiffness.size()) / static_cast<double>(draws));
  }
  std::ranges::sort(stiffness);
  const auto tail = static_cast<std::size_t>(0.025 * static_cast<double>(draws));
  // A parameter at its bound is drawn to one side of it only: the device itself is within, all the same.
  return {std::min(stiffness[tail], own.stiffness), std::max(stiffness[draws - 1 - tail], own.stiffness),
          static_cast<double>(others) / static_cast<double>(draws), draws};
}

}  // namespace zwidth
