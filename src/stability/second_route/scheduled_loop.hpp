#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

#include "sampling/inner_loop.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"

namespace zwidth::internal {

// The loop of a spring and a damper of different periods, one a whole multiple of the other, as it runs: state by state from
// one event to the next, by the continuous state space and its exponential. Its poles are the eigenvalues of what the longer
// period does to the state: the device's, and the forces on their way. It shares nothing with the plant that a spring sees.
class ScheduledLoop {
 public:
  ScheduledLoop(const ContinuousStateSpace& device, const Sampling& spring, const InnerLoop& damper);

  // The longer of the two periods, s.
  [[nodiscard]] double period() const { return static_cast<double>(ticks_) * tick_; }
  // Of the loop over that period.
  [[nodiscard]] std::size_t states() const { return states_; }

  // z - 1 of every pole, z of the longer period.
  [[nodiscard]] std::vector<std::complex<double>> poles_minus_one(double stiffness) const;
  // The same with another damper.
  [[nodiscard]] std::vector<std::complex<double>> poles_minus_one(double stiffness, double damping) const;

  // Poles outside the unit circle; nothing where one is too near it to tell.
  [[nodiscard]] std::optional<int> unstable_poles(double stiffness) const;

  // The frequency in rad/s, up to the Nyquist frequency of the shorter period, at which the position moves in the motion of
  // this pole with an imaginary part >= 0: of all that look alike once a longer period, the one that is seen most between.
  [[nodiscard]] double frequency_of(std::complex<double> pole_minus_one, double stiffness) const;

  // What the spring's force does to the position, the damper closed, which is as fast: the spring's samples, without a delay of
  // its own; what of the forces is on its way stands among the states.
  [[nodiscard]] DiscreteStateSpace seen_by_spring() const;

  static constexpr std::size_t most_states = 200;  // beyond, eigenvalues would take longer than all the rest

 private:
  // A force that is held from one sample of its path to the next.
  struct PathSchedule {
    std::size_t every = 1;  // ticks
    std::size_t whole = 0;  // ticks from sample to force
    Eigen::VectorXd with_new;
    Eigen::VectorXd with_old;  // empty where the force arrives with a tick
    std::size_t kept = 0;      // samples of earlier periods that are still on their way

    [[nodiscard]] std::size_t first_late() const { return whole + (with_old.size() > 0 ? 1U : 0U); }
  };
  struct Period {
    Eigen::MatrixXd change;     // of the state
    Eigen::MatrixXd positions;  // at each tick, by the state at the period's beginning
  };

  [[nodiscard]] PathSchedule path(const ContinuousStateSpace& device, std::size_t every, double delay);
  // Of a spring of that stiffness; nothing: its force is the last state, which the next period has not.
  [[nodiscard]] Period over_period(std::optional<double> stiffness, double damping) const;

  double tick_ = 0.0;
  std::size_t ticks_ = 1;
  Eigen::MatrixXd phi_;  // of a tick, less I
  Eigen::RowVectorXd output_;
  PathSchedule spring_;
  PathSchedule damper_;
  double damping_ = 0.0;
  double damper_period_ = 0.0;
  double pole_ = 0.0;  // of the velocity's low-pass
  std::size_t states_ = 0;
};

}  // namespace zwidth::internal
