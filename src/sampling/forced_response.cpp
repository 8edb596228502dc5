#include "zwidth/sampling/forced_response.hpp"

#include <utility>

namespace zwidth {

ForcedMotion::ForcedMotion(DiscreteStateSpace system)
    : system_(std::move(system)),
      state_(Eigen::VectorXd::Zero(system_.Phi.rows())),
      change_(system_.Phi.rows()),
      past_forces_(system_.delay_samples + 1, 0.0) {}

double ForcedMotion::step(double force) {
  const double position = system_.C.dot(state_);
  // The ring holds u[k-l-1] .. u[k-1], oldest first; u[k-l] is the next, or the new force itself when l = 0.
  const double before = std::exchange(past_forces_[oldest_], force);
  oldest_ = (oldest_ + 1) % past_forces_.size();
  const double now = past_forces_[oldest_];
  change_.noalias() = system_.Phi * state_;
  state_ += change_ + system_.Gamma1 * now + system_.Gamma2 * before;
  return position;
}

std::vector<double> forced_response(const DiscreteStateSpace& system, std::span<const double> force) {
  ForcedMotion motion(system);
  std::vector<double> positions;
  positions.reserve(force.size());
  for (const double each : force) positions.push_back(motion.step(each));
  return positions;
}

}  // namespace zwidth
