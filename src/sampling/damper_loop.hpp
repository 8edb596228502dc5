#pragma once

#include <cstddef>

#include "zwidth/model/modal_form.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// A damper in a loop of its own: -B v is there `delay` after every period, v = (1 - a)(y - y_last)/T + a v_last.
struct DamperLoop {
  Sampling sampling;
  double damping = 0.0;             // B >= 0
  double velocity_filter_hz = 0.0;  // a = exp(-2 pi f T); 0: none
};

// How often the damper runs while the spring runs once, >= 1; 0 where it is not as often or oftener.
[[nodiscard]] std::size_t damper_steps(const Sampling& spring, const Sampling& damper);

// The plant as a spring sees it behind which the damper is closed, damper_steps() >= 1: with the device's P_v = z^-l N/D at
// the damper's period and 1 - a = c
//
//     P_cl = P_p / (1 + (B c/T) delta / (delta + c) P_v)      at the damper's period, P_p with the spring's delay
//
// and of that every damper_steps()-th sample behind a force that changes as often. Source: theory, section 8.
// Throws Error (invalid_argument) for a period or delay outside its domain, (did_not_converge) as modal_form() does.
[[nodiscard]] SampledPlant sample_behind_damper(const ModalForm& form, const Sampling& spring,
                                                const DamperLoop& damper);

}  // namespace zwidth::internal
