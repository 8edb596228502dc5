#include "stability/users/user_discs.hpp"

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <limits>

#include "stability/users/any_grasp.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/tip_motion.hpp"

namespace zwidth::internal {

UserDiscs::UserDiscs(const Device& device, const Progress& progress) : period_(device.loop().sampling_period) {
  if (!is_grasped_in_many_directions(device)) {
    held_.emplace(device, progress);
    return;
  }
  tell(progress, 0.0);
  plant_ = filtered_plant(device);
  grasped_.emplace(tip_motion_of(device).value(), device.parameters(), wall_normal(device));
}

TerminationDiscs::Disc UserDiscs::at(double frequency) const {
  if (held_) return held_->at(frequency);
  const auto [centre, radius] = grasped_->at(frequency);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!std::isfinite(radius)) return {centre, infinity, -infinity, 1.0};
  const std::complex<double> filters = filter_response(*plant_, frequency * period_);
  const double size = std::abs(filters);
  const double power = (std::abs(centre) - radius) * (std::abs(centre) + radius);
  return {filters * centre, size * radius, size * size * power, 1.0};
}

bool UserDiscs::is_undamped() const { return held_ ? held_->is_undamped() : grasped_->is_undamped(); }

}  // namespace zwidth::internal
