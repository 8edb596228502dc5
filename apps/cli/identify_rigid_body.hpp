#pragma once

#include <CLI/App.hpp>
#include <string>

#include "cli/recording_arguments.hpp"
#include "cli/structure_arguments.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"

namespace zwidth::cli {

/// Declares the options of `identify --method inverse-dynamics`; `options` must outlive the parsing.
void add_inverse_dynamics_options(CLI::App& command, InverseDynamicsOptions& options);

/// Throws BadInput for options on the command line that only the other method has.
void check_inverse_dynamics_options(const CLI::App& command);

/// Throws BadInput for options on the command line that only inverse dynamics has.
void refuse_inverse_dynamics_options(const CLI::App& command);

/// Reads force and position and fits the rigid body. Throws BadInput: a file or a record that is refused.
[[nodiscard]] RigidBodyIdentification fitted_rigid_body(const RecordingArguments& recording,
                                                        const StructureArguments& structure,
                                                        const InverseDynamicsOptions& options);

}  // namespace zwidth::cli
