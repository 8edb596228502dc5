#include "zwidth/stability/stiffness_interval.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "batch/kernel/kernel_columns.hpp"
#include "model/uncertainty_problem.hpp"
#include "stability/device_draws.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
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
  const CriticalStiffness critical = internal::unguarded_stiffness(device);
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

/// Quantiles of the draws, and how many belong to another mechanism than the device's own.
struct Quantiles {
  double lower = 0.0;
  double upper = 0.0;
  std::size_t others = 0;
};

Quantiles quantiles(const Device& device, const Limit& own, std::size_t draws, std::uint64_t seed,
                    const Progress& progress) {
  DrawnLimits drawn(device, seed);
  std::vector<double> stiffness;
  stiffness.reserve(draws);
  Quantiles result;
  while (stiffness.size() < draws) {
    for (const Limit& each : drawn.next(std::min(block, draws - stiffness.size()))) {
      stiffness.push_back(each.stiffness);
      if (each.mode != own.mode || (!each.mode && each.stiffness != own.stiffness)) ++result.others;
    }
    internal::tell(progress, static_cast<double>(stiffness.size()) / static_cast<double>(draws));
  }
  std::ranges::sort(stiffness);
  const auto tail = static_cast<std::size_t>(0.025 * static_cast<double>(draws));
  result.lower = stiffness[tail];
  result.upper = stiffness[draws - 1 - tail];
  return result;
}

constexpr double infinite = std::numeric_limits<double>::infinity();

bool is_at_bound(const Device& device) {
  return internal::least_known(device.parameters(), infinite).share == infinite;
}

/// The device of which one more number is taken as known: one at its bound, else the least known. Nothing where that
/// leaves none.
std::optional<Device> with_one_more_known(const Device& device) {
  DeviceParameters parameters = device.parameters();
  const internal::LeastKnown least = internal::least_known(parameters, infinite);
  if (parameters.uncertainty->parameters.size() < 2 || least.share == 0.0) return std::nullopt;
  parameters.uncertainty = internal::given(*std::move(parameters.uncertainty), least.i);
  return Device(std::move(parameters));
}

}  // namespace

bool is_inconclusive(const StiffnessInterval& interval) {
  constexpr double widest = 2.0;  // times the lower end
  return interval.upper > widest * interval.lower;
}

StiffnessInterval stiffness_interval(const Device& device, std::size_t draws, std::uint64_t seed,
                                     const Progress& progress) {
  const std::optional<Uncertainty>& uncertainty = device.parameters().uncertainty;
  if (!uncertainty || uncertainty->parameters.empty())
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::no_uncertainty});
  if (draws == 0)
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::none_asked, .subjects = {{"name", "draws"}}});
  const Limit own = limit_of(device);
  internal::StagedProgress stages(progress);
  constexpr double main_stage = 0.8;
  stages.next(main_stage);
  const Quantiles all = quantiles(device, own, draws, seed, stages.stage());
  StiffnessInterval interval{std::min(all.lower, own.stiffness), std::max(all.upper, own.stiffness),
                             static_cast<double>(all.others) / static_cast<double>(draws), draws};
  // Draws that go to one side only, of numbers at their bound or where K_CR is least, crowd the other tail: what is
  // known of K_CR where those numbers stay as they are counts too.
  std::optional<Device> better = device;
  while (own.mode && (is_at_bound(*better) || interval.lower >= own.stiffness)) {
    better = with_one_more_known(*better);
    if (!better) break;
    stages.next(1.0);
    const Quantiles near = quantiles(*better, own, draws, seed, stages.stage());
    interval.lower = std::min(interval.lower, near.lower);
    interval.upper = std::max(interval.upper, near.upper);
  }
  stages.done();
  return interval;
}

}  // namespace zwidth
