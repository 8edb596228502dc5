#pragma once

#include <array>

#include "property/random_devices.hpp"
#include "zwidth/design/notch_design.hpp"

namespace zwidth::test {

/// What is asked of a notch, drawn: the modal shifts, margins and goals of its tests and its benchmark.
inline NotchOptions random_notch_options(RandomDevices& random) {
  NotchOptions options;
  if (random.chance(0.7)) options.modal_frequency_uncertainty = std::array{0.02, 0.05, 0.1, 0.2}[random.index(4)];
  if (random.chance(0.3)) options.gain_margin = random.uniform(1.0, 4.0);
  if (random.chance(0.4)) options.phase_margin = random.chance(0.5) ? 0.0 : random.uniform(0.0, 1.0);
  if (random.chance(0.2)) options.goal = StiffnessGoal::absolute_stability_limit;
  options.far_from_modes = random.chance(0.2);
  options.lower_absolute_stability_limit = random.chance(0.1);
  return options;
}

}  // namespace zwidth::test
