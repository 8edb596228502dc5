#pragma once

#include <string>

#include "report/analysed_device.hpp"
#include "results/json.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::report {

/// Everything about a device that another program needs to go on from.
struct ExportedModel {
  AnalysedDevice analysed;
  ContinuousStateSpace continuous;
  DiscreteStateSpace discrete;
  ModalForm modal;
  SampledPlant sampled;
};

[[nodiscard]] ExportedModel exported_model(AnalysedDevice analysed);

/// A script for GNU Octave with its control package, that runs as it is: `sysc`, `sysd`,
/// sampled_response(model, w), wall_controller(wall, T, K) and closed_loop_poles(sysd, wall, K).
[[nodiscard]] std::string export_octave(const ExportedModel& model);

/// A script for Python 3 with SciPy, that runs and imports as it is: `sysc`, `sysd`,
/// sampled_response(w), wall_controller(K) and closed_loop_poles(K).
[[nodiscard]] std::string export_python(const ExportedModel& model);

}  // namespace zwidth::report
