#pragma once

#include <optional>
#include <utility>

#include "zwidth/design/user_family.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/any_user.hpp"
#include "zwidth/stability/worst_user.hpp"

namespace zwidth::report {

/// What a family of users makes of a device.
struct UserFamilyAnswer {
  UserFamily family;
  WorstOfFamily worst;
  CriticalStiffness free;  ///< of the device that nobody holds
};

/// A device with its answer, the input of every report (text, JSON, HTML).
struct AnalysedDevice {
  Device device;
  Analysis analysis;
  std::optional<AnyUserLimit> any_user =
      std::nullopt;  ///< absent for a transfer function, and above most_bodies_for_any_user
  std::optional<WorstUser> worst_user = std::nullopt;          ///< absent unless asked for, and where there is no limit
  std::optional<UserFamilyAnswer> user_family = std::nullopt;  ///< absent unless asked for
};

/// Each body costs a modal form: beyond, the limit over all users would take longer than the rest by far.
inline constexpr std::size_t most_bodies_for_any_user = 20;

/// Analyses the device; throws as analyze() and any_user_limit() do.
[[nodiscard]] inline AnalysedDevice analysed_device(Device device) {
  Analysis analysis = analyze(device);
  std::optional<AnyUserLimit> any_user = std::nullopt;
  if (device.has_bodies() && device.bodies().size() <= most_bodies_for_any_user) {
    const Wall& wall = device.parameters().wall;
    any_user = any_user_limit(device, {wall.damping, wall.velocity_filter_hz});
  }
  return {std::move(device), std::move(analysis), std::move(any_user)};
}

/// Throws as worst_user() does; `any_user` must be there.
inline void find_worst_user(AnalysedDevice& analysed) {
  const Wall& wall = analysed.device.parameters().wall;
  analysed.worst_user = worst_user(analysed.device, *analysed.any_user, {wall.damping, wall.velocity_filter_hz});
}

/// Throws as worst_of_family() does.
inline void search_user_family(AnalysedDevice& analysed, const UserFamily& family, const Progress& progress) {
  const VirtualDamper damper{analysed.device.parameters().wall.damping,
                             analysed.device.parameters().wall.velocity_filter_hz};
  DeviceParameters free = analysed.device.parameters();
  free.uncertainty.reset();
  free.user = {};
  analysed.user_family = UserFamilyAnswer{family, worst_of_family(analysed.device, family, damper, progress),
                                          critical_stiffness(filtered_plant(Device(std::move(free))), damper)};
}

}  // namespace zwidth::report
