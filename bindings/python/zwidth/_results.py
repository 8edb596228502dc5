"""The class of each document: its keys are those of its schema (_documents.py), what it can do besides stands here."""

from __future__ import annotations

from typing import Any, Callable, Dict, Optional, Type

from . import _core, _documents
from ._errors import Error, InputError
from ._record import Array, Result


def _device_of(result: Result, none: str) -> _core.Device:
    found = result._answer.device
    if found is None:
        raise Error(none)
    return _core.Device.from_toml(found)


class Analysis(_documents.Analysis):
    """What a device renders stably: docs/analysis_json.md. str() of it is what the command prints."""

    _tell: Optional[Callable[[], str]] = None
    _told: Optional[str] = None

    def __str__(self) -> str:
        if self._tell is None:
            return repr(self)
        if self._told is None:  # more is computed for it: the walls with a damper
            self._told = self._tell()
        return self._told


class Bode(_documents.Bode):
    """Frequency responses of a device: docs/bode_json.md."""


class Region(_documents.Region):
    """Every stable wall (K, B): docs/region.md."""


class Design(_documents.Design):
    """What each number of a device does to the limit: docs/design.md."""


class Sweep(_documents.DesignSweep):
    """The limit along one number or two: docs/design.md."""


class Comparison(_documents.DesignComparison):
    """Several values of one key side by side: docs/design.md."""


class Notch(_documents.Notch):
    """A notch for the wall: docs/design.md."""


class DesignTargets(_documents.DesignTarget):
    """What each number alone must be for the limit to reach a target: docs/design.md."""


class WallRecommendation(_documents.WallRecommendation):
    """The wall to render: docs/recommendation.md."""


class Diagnosis(_documents.Diagnosis):
    """What an oscillation is, and what moves it: docs/diagnosis.md."""


class Study(_documents.Study):
    """How the limit varies over many units of one design: docs/study.md."""

    def worst_device(self) -> _core.Device:
        """The worst unit as a device, as study --output-device writes it."""
        return _device_of(self, "no unit has a limit: there is no worst one")


class Identification(_documents.Identification):
    """A device from a recording: docs/identification.md."""

    def to_device(self) -> _core.Device:
        """The device with what was found and how sure it is, as identify --output-device writes it."""
        return _device_of(self, "no device was found")


class RigidBodyIdentification(_documents.InverseDynamics):
    """Mass and friction of a rigid body from its motion: docs/inverse_dynamics.md."""

    def to_device(self) -> _core.Device:
        """The rigid device with what was found, as identify --output-device writes it."""
        return _device_of(self, "no device was found")


class FrequencyResponse(_documents.Frf):
    """A measured response and the critical stiffness that it shows: docs/frf_json.md."""


class Simulation(_documents.Simulation):
    """The sampled loop in time: docs/simulation.md."""


class Relay(_documents.Relay):
    """The relay experiment: docs/relay.md."""

    def force(self, trial: int = 0) -> Array:
        """The relay's force in a trial (from 0), every sample: N or N m."""
        return self._series(f"force_{trial + 1}")

    def position(self, trial: int = 0) -> Array:
        """The position in that trial, m or rad."""
        return self._series(f"position_{trial + 1}")


class Excitation(_documents.Excitation):
    """A signal to excite a device with: docs/excitation.md."""

    def force(self) -> Array:
        """Every sample of the signal, N or N m."""
        return self._series("samples")


class Workspace(_documents.Workspace):
    """The stiffest wall at every pose and in every direction of a mechanism: docs/mechanisms.md."""

    def _table(self, name: str, *more: int) -> Array:
        poses, directions = (int(each) for each in self._series("shape"))
        return self._series(name).reshape(poses, directions, *more)

    @property
    def limits(self) -> Array:
        """K_CR with nobody holding, N/m, poses x directions: inf where unbounded, 0 where none is stable, NaN where there is none."""
        return self._table("nobody")

    @property
    def any_user_limits(self) -> Array:
        """The same with any passive user; NaN where it is not known or not asked for."""
        return self._table("any_user")

    @property
    def normals(self) -> Array:
        """Of the wall, poses x directions x 3, of length 1 in the world's frame; NaN where a pose has fewer directions."""
        return self._table("normals", 3)

    def worst_device(self) -> _core.Device:
        """The device at the worst pose and normal, as workspace --worst-to writes it."""
        return _device_of(self, "no pose has a limit: there is no worst one")


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
    "zwidth.workspace/1": Workspace,
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
