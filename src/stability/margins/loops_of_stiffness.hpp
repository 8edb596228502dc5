#pragma once

#include "stability/limit/gain_crossings.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// The loops of one damper and any stiffness > 0: what loop_margins() says of each, without finding again what does not
// depend on the stiffness.
class LoopsOfStiffness {
 public:
  // The plant must outlive this.
  LoopsOfStiffness(const FilteredPlant& plant, VirtualDamper damper);

  [[nodiscard]] const GainCrossings& crossings() const { return by_stiffness_; }

  // How far the loop is from falling short of a gain margin (of the whole force, factor >= 1) and a phase margin
  // (rad >= 0): the margin over the one required, less 1, of the phase where that falls short, else the lesser one.
  // -1 where the loop is unstable.
  [[nodiscard]] double slack(double stiffness, double gain_margin, double phase_margin) const;

 private:
  const FilteredPlant& plant_;
  VirtualDamper damper_;
  GainCrossings by_stiffness_;
};

}  // namespace zwidth::internal
