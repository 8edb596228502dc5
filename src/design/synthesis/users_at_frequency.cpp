#include "design/synthesis/users_at_frequency.hpp"

#include <numbers>

#include "design/sensitivities/loops_of_wall.hpp"
#include "design/sensitivities/number_limit.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/disc_stiffness.hpp"

namespace zwidth::internal {

bool knows_users_of(const Device& device) {
  return can_be_held(device) && (!has_two_loops(device) || knows_all_users(device));
}

UsersAtFrequency::UsersAtFrequency(const Device& device, WallNumber number, const Progress& progress)
    : device_(in_one_loop(device)), number_(number) {
  if (has_two_loops(device_)) {
    of_two_loops_.emplace(device_);
  } else {
    discs_.emplace(device_, progress);
  }
}

double UsersAtFrequency::nyquist() const { return std::numbers::pi / device_.loop().sampling_period; }

double UsersAtFrequency::least_gain_at(double frequency) const {
  if (discs_) return least_gain(discs_->at(frequency), response_of(device_, number_, frequency));
  const Wall& wall = device_.parameters().wall;
  return of_two_loops_->limit_at(frequency, {wall.damping, wall.velocity_filter_hz});
}

}  // namespace zwidth::internal
