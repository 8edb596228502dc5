#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "stability/second_route/routh_count.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"

namespace zwidth::internal {

// A pole of the closed loop on the unit circle, at e^{j angle}.
struct PoleOnCircle {
  double angle = 0.0;
  double stiffness = 0.0;  // of the wall, K
};

// How many poles of the closed loop lie outside the unit circle, at any stiffness of the device's wall: the routes that
// check critical_stiffness(). They share nothing with it: no modal form, no partial fractions, no frequency response
// and no root isolation, only the continuous state space and its exponential.
class PoleCount {
 public:
  explicit PoleCount(const Device& device);

  // Whether the loop is found stable (unstable): by Routh's count where that is quicker and sure, else by in_double().
  [[nodiscard]] bool confirms(double stiffness, bool stable) const;

  // In double precision: eigenvalues of the loop's state matrix, or for long delays the winding number of
  //     det((z - 1) I - Phi + (Gamma1 + Gamma2 z^-1) z^-l C(z) c)
  // on the unit circle. Nothing where a pole is too near the circle to tell.
  [[nodiscard]] std::optional<int> in_double(double stiffness) const;

  // In ball arithmetic of 332 to 2048 bits, as many as make every sign sure: the characteristic polynomial and Routh's
  // count of its roots. Slow, and only for loops of up to most_states_for_digits states, delays included; nothing beyond.
  [[nodiscard]] std::optional<int> in_digits(double stiffness) const;

  // Poles that were found on the circle at 0 < angle < pi, again in ball arithmetic of 332 bits: where the terms of the
  // response keep fewer digits than K needs, which may turn out to be negative. Those that do not settle beside where
  // they were stay, and all of larger loops.
  void polish_in_digits(std::vector<PoleOnCircle>& poles) const;

  static constexpr std::size_t most_states_for_digits = 40;

 private:
  [[nodiscard]] std::optional<int> by_eigenvalues(double stiffness) const;
  [[nodiscard]] std::optional<int> by_winding(double stiffness) const;

  const Device& device_;
  DiscreteStateSpace plant_;
  std::size_t states_ = 0;  // of the loop
  std::optional<RouthCount> routh_;
};

// The same two without the class.
[[nodiscard]] std::optional<int> unstable_poles_in_digits(const Device& device, double stiffness);
void polish_poles_in_digits(const Device& device, std::vector<PoleOnCircle>& poles);

}  // namespace zwidth::internal
