#pragma once

#include <optional>

#include "stability/users/two_rate_users.hpp"
#include "stability/users/user_discs.hpp"
#include "zwidth/design/wall_number.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// Whether the limit over all passive users of the device with its wall can be computed.
[[nodiscard]] bool knows_users_of(const Device& device);

// What passive users do to the loop of a device and its wall at one frequency.
class UsersAtFrequency {
 public:
  // `device`: which knows_users_of().
  UsersAtFrequency(const Device& device, WallNumber number, const Progress& progress = {});

  // rad/s
  [[nodiscard]] double nyquist() const;

  // The least K, or B of a damper alone, with which some user destabilises it; infinite where there is none.
  // 0 < frequency <= nyquist().
  [[nodiscard]] double least_gain_at(double frequency) const;

 private:
  Device device_;  // in one loop, where it has one
  WallNumber number_;
  std::optional<UserDiscs> discs_;
  std::optional<TwoRateUsers> of_two_loops_;
};

}  // namespace zwidth::internal
