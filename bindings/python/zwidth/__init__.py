"""The stiffest virtual wall that a haptic device renders stably::

    import zwidth
    device = zwidth.Device.from_toml("devices/lhifam.toml")
    zwidth.analyze(device).critical_stiffness

Options are keywords named as the command line's (`zwidth.options("analyze")` lists them). SI units and radians.
Bad input raises InputError; what is doubtful or refused warns with DoubtfulResult.
"""

import importlib
from typing import TYPE_CHECKING, Any

from . import _core

if not _core.is_main_interpreter():
    raise ImportError("zwidth works in the main interpreter alone, not in a subinterpreter")

from ._commands import (
    CriticalStiffnessMany,
    Recording,
    analyze,
    bode,
    compare,
    critical_stiffness_many,
    design,
    design_notch,
    design_targets,
    diagnose,
    excite,
    export,
    frequency_response,
    identify,
    model,
    options,
    recommend_wall,
    region,
    relay,
    simulate,
    study,
    sweep,
    workspace,
)
from ._core import (
    AnyUserDamping,
    AnyUserLimit,
    CriticalDamping,
    CriticalStiffness,
    Device,
    Mechanism,
    MechanismAtPose,
    MechanismJoint,
    ReachedPose,
    __version__,
    any_user_damping,
    any_user_limit,
    critical_damping,
    critical_stiffness,
    device_keys,
)
from ._errors import DoubtfulResult, Error, InputError, Place, Problem, ResultWarning, WorkFailed
from ._record import Record, Result
from ._documents import Crossover, Finding, HolderLimit, HoldingLimits, LimitedBy, Mode, Remark, StableFor, Trust, WallMargins
from ._results import (
    Analysis,
    Bode,
    Comparison,
    Design,
    DesignTargets,
    Diagnosis,
    Excitation,
    FrequencyResponse,
    Identification,
    Model,
    Notch,
    Region,
    Relay,
    RigidBodyIdentification,
    Simulation,
    Study,
    Sweep,
    WallRecommendation,
    Workspace,
)

if TYPE_CHECKING:
    from . import control as control, plot as plot


def __getattr__(name: str) -> Any:
    """zwidth.plot and zwidth.control are imported where they are first used: they bring matplotlib, python-control."""
    if name in ("control", "plot"):
        return importlib.import_module(f"zwidth.{name}")
    raise AttributeError(f"module 'zwidth' has no attribute {name!r}")


__all__ = [
    "Analysis",
    "AnyUserDamping",
    "AnyUserLimit",
    "Bode",
    "Comparison",
    "CriticalDamping",
    "CriticalStiffness",
    "CriticalStiffnessMany",
    "Crossover",
    "Design",
    "DesignTargets",
    "Device",
    "Diagnosis",
    "DoubtfulResult",
    "Error",
    "Excitation",
    "Finding",
    "FrequencyResponse",
    "HolderLimit",
    "HoldingLimits",
    "Identification",
    "InputError",
    "LimitedBy",
    "Mechanism",
    "MechanismAtPose",
    "MechanismJoint",
    "Mode",
    "Model",
    "Notch",
    "Place",
    "Problem",
    "Record",
    "ReachedPose",
    "Recording",
    "Region",
    "Relay",
    "Remark",
    "Result",
    "ResultWarning",
    "RigidBodyIdentification",
    "Simulation",
    "StableFor",
    "Study",
    "Sweep",
    "Trust",
    "WallMargins",
    "WallRecommendation",
    "WorkFailed",
    "Workspace",
    "__version__",
    "analyze",
    "any_user_damping",
    "any_user_limit",
    "bode",
    "compare",
    "critical_damping",
    "critical_stiffness",
    "critical_stiffness_many",
    "design",
    "design_notch",
    "design_targets",
    "device_keys",
    "diagnose",
    "excite",
    "export",
    "frequency_response",
    "identify",
    "model",
    "options",
    "recommend_wall",
    "region",
    "relay",
    "simulate",
    "study",
    "sweep",
    "workspace",
]
