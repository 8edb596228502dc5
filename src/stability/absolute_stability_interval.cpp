#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <vector>

#include "stability/device_draws.hpp"
#include "stability/users/any_user_limits.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth {
namespace {

// 0 where it is not known, as of a damper that became slower than its spring.
double any_user_stiffness(const Device& device, VirtualDamper damper) {
  if (!has_damper_loop(device.loop())) return absolute_stability_limit(device, damper).lower_bound();
  if (!internal::bounds_all_users(device)) return 0.0;
  return internal::AnyUserLimits(device).limit(damper).lower_bound();
}

}  // namespace

StiffnessInterval absolute_stability_interval(const Device& device, VirtualDamper damper, std::size_t draws,
                                              std::uint64_t seed, const Progress& progress) {
  const auto& uncertainty = device.parameters().uncertainty;
  if (!uncertainty || uncertainty->parameters.empty())
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::no_uncertainty});
  if (draws == 0)
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::none_asked, .subjects = {{"name", "draws"}}});
  if (!internal::bounds_all_users(device)) require_one_rate(device);
  const double own = any_user_stiffness(device, damper);
  internal::DeviceDraws drawn(device, seed);
  std::vector<Device> devices;
  for (std::size_t i = 0; i < draws; ++i) devices.push_back(drawn.next());
  std::vector<double> limits(draws);
  internal::SharedProgress shared(progress, draws);
  tbb::parallel_for(std::size_t{0}, draws, [&](std::size_t i) {
    limits[i] = any_user_stiffness(devices[i], damper);
    shared.add();
  });
  const auto others =
      static_cast<double>(std::ranges::count_if(limits, [&](double k) { return (k > 0.0) != (own > 0.0); }));
  std::ranges::sort(limits);
  const auto tail = static_cast<std::size_t>(0.025 * static_cast<double>(draws));
  return {std::min(limits[tail], own), std::max(limits[draws - 1 - tail], own), others / static_cast<double>(draws),
          draws};
}

}  // namespace zwidth
