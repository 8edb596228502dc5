#pragma once

#include <pybind11/pybind11.h>

#include "constructed.hpp"

namespace zwidth::python {

/// Device, critical_stiffness, absolute_stability_limit, critical_damping, absolute_stability_damping, critical_stiffness_many.
void bind_device(pybind11::module_& module);
void bind_limits(pybind11::module_& module);

/// Mechanism, MechanismAtPose, MechanismJoint, ReachedPose.
void bind_mechanism(pybind11::module_& module);

/// Answer, run(command, ...) and options(command).
void bind_commands(pybind11::module_& module);

}  // namespace zwidth::python
