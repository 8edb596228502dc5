#pragma once

#include "sampling/inner_loop.hpp"
#include "stability/limit/guarded_stiffness.hpp"
#include "stability/second_route/scheduled_loop.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

// A device whose damper runs in a loop of its own (has_damper_loop()), as its spring and its damper see it. The slower of the
// two is outside: it sees a plant of one rate, behind which the other is closed.
class TwoRateDevice {
 public:
  // `damping`: B of the wall's damper.
  TwoRateDevice(const Device& device, double damping);

  // Whether the damper runs as often as the spring or oftener, or does nothing.
  [[nodiscard]] bool is_damper_inside() const { return is_damper_inside_; }
  [[nodiscard]] const ModalForm& form() const { return form_; }
  [[nodiscard]] const Sampling& spring() const { return spring_; }
  [[nodiscard]] const InnerLoop& damper() const { return damper_; }

  // The device alone, at the spring's period and delay: the terms of the modes.
  [[nodiscard]] SampledPlant spring_alone() const;
  // Behind the closed damper, which is_damper_inside().
  [[nodiscard]] FilteredPlant seen_by_spring() const;
  // Behind a closed spring of that stiffness, where the damper is the slower one.
  [[nodiscard]] FilteredPlant seen_by_damper(double stiffness) const;
  // As it runs.
  [[nodiscard]] ScheduledLoop as_it_runs(const Device& device) const;

  // The damper's gains where it is outside.
  [[nodiscard]] VirtualDamper gains() const { return {damper_.damping, damper_.velocity_filter_hz}; }

 private:
  ModalForm form_;
  Sampling spring_;
  InnerLoop damper_;
  bool is_damper_inside_ = true;
};

// Whether the route that two_rate_stiffness() does not take, too, finds the loop stable (unstable) at this stiffness.
[[nodiscard]] Agreement agreement(const TwoRateDevice& loop, const ScheduledLoop& as_it_runs, double stiffness,
                                  bool stable);

// critical_stiffness() of a device whose damper runs in a loop of its own. Damper inside: every crossing of K on the plant that
// the spring sees, and the poles of the loop as it runs count beside them. Damper outside: K stands inside its loop, so that
// the poles of the loop as it runs are followed over K, and the crossings of B behind the closed spring count beside them.
[[nodiscard]] CriticalStiffness two_rate_stiffness(const Device& device);

// critical_stiffness() of any device without the second count and the trust, for many devices.
[[nodiscard]] CriticalStiffness unguarded_stiffness(const Device& device);

// Of a device whose response or models are those that the spring sees.
[[nodiscard]] Remark damper_closed_at_own_rate(const Device& device);

}  // namespace zwidth::internal
