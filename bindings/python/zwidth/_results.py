"""The class of each document, by its schema."""

from __future__ import annotations

from typing import Any, Dict, Type

from . import _core
from ._device_results import (
    Analysis,
    Bode,
    Comparison,
    Design,
    DesignTargets,
    Diagnosis,
    Notch,
    Region,
    Study,
    Sweep,
    WallRecommendation,
)
from ._errors import InputError
from ._measured_results import (
    Excitation,
    FrequencyResponse,
    Identification,
    Relay,
    RigidBodyIdentification,
    Simulation,
)
from ._record import Result


class Model(Result):
    """The continuous and the exact discrete model, and the wall: `export --format json`."""


CLASSES: Dict[str, Type[Result]] = {
    "zwidth.analysis/1": Analysis,
    "zwidth.bode/1": Bode,
    "zwidth.region/1": Region,
    "zwidth.design/1": Design,
    "zwidth.design_sweep/1": Sweep,
    "zwidth.design_comparison/1": Comparison,
    "zwidth.notch/1": Notch,
    "zwidth.design_target/1": DesignTargets,
    "zwidth.wall_recommendation/1": WallRecommendation,
    "zwidth.diagnosis/1": Diagnosis,
    "zwidth.study/1": Study,
    "zwidth.identification/1": Identification,
    "zwidth.inverse_dynamics/1": RigidBodyIdentification,
    "zwidth.frf/1": FrequencyResponse,
    "zwidth.simulation/1": Simulation,
    "zwidth.relay/1": Relay,
    "zwidth.excitation/1": Excitation,
}


def result_of(answer: _core.Answer) -> Any:
    """The answer as the object of its schema."""
    if not answer.is_document:
        raise InputError("options", "ask for a text", "those that leave the answer a document")
    return CLASSES.get(answer.value("/schema"), Model)(answer)
