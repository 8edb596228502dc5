#pragma once

#include <cstddef>
#include <memory>

#include "zwidth/model/modal_form.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// A part of the wall that runs in a loop of its own: -(K y + B v) is there `delay` after every period T,
// v = (1 - a)(y - y_last)/T + a v_last. A damper alone, or a spring alone.
struct InnerLoop {
  Sampling sampling;
  double damping = 0.0;             // B >= 0
  double velocity_filter_hz = 0.0;  // a = exp(-2 pi f T); 0: none
  double stiffness = 0.0;           // K >= 0
};

// How often the inner loop runs while the outer one runs once: rounded; 0 where it is the slower one.
[[nodiscard]] std::size_t steps_within(const Sampling& outer, const Sampling& inner);

// The plant as the outer part of the wall sees it, behind which the inner part is closed, steps_within() >= 1: with the
// device's P = z^-l N/D at the inner period, once with either delay, and 1 - a = c
//
//     P_cl = P_outer / (1 + (K + (B c/T) delta / (delta + c)) P_inner)
//
// and of that every steps_within()-th sample behind a force that changes as often. Source: docs/theory.md, "Two rates".
class PlantBehindLoop {
 public:
  // For inner loops of that period and delay. Throws Error (invalid_argument) for one outside its domain.
  PlantBehindLoop(const ModalForm& form, const Sampling& outer, const Sampling& inner);

  // Closed by this one. Throws Error (did_not_converge) as modal_form() does.
  [[nodiscard]] SampledPlant closed_by(const InnerLoop& inner) const;

 private:
  struct Responses;
  std::shared_ptr<const Responses> responses_;
};

// The same of one inner loop.
[[nodiscard]] SampledPlant sample_behind(const ModalForm& form, const Sampling& outer, const InnerLoop& inner);

}  // namespace zwidth::internal
