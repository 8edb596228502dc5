#pragma once

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

// The plant that the outer part of the wall sees with the inner part closed. The inner period is the outer one's N-th part,
// N >= 1. The device sampled at the inner period is P_outer with the outer part's delay and P_inner with the inner one's;
// c = 1 - a:
//
//     P_cl = P_outer / (1 + (K + (B c/T) delta / (delta + c)) P_inner)
//
// The outer force holds for N samples of it, and every N-th of its positions is read. Source: theory, section 8.
// Throws Error (invalid_argument) for a period or delay outside its domain, (did_not_converge) as modal_form() does.
[[nodiscard]] SampledPlant sample_behind(const ModalForm& form, const Sampling& outer, const InnerLoop& inner);

}  // namespace zwidth::internal
