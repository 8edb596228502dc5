"""One job, one call. Each runs the program's command of the same name: the same declarations parse the options."""

from __future__ import annotations

import copy
import functools
import os
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _core, _device, _mechanism, _results
from ._core import Device
from ._errors import InputError, warn_of_document

Option = Union[bool, int, float, str, None, Sequence[Any]]
"""Of a command: True for a flag, a number (SI) or a text with a unit, a list for what repeats; None leaves it out."""

DeviceOrFile = Union[Device, str, "os.PathLike[str]"]
"""A Device, or what Device.from_toml() takes: a device file's path, or its text."""

Progress = Optional[Callable[[float], object]]
"""Called with the fraction done, 0 to 1; what it raises ends the work."""


def _real_numbers(where: str, values: npt.ArrayLike, allowed: str) -> npt.NDArray[np.float64]:
    """One column; what is masked is missing. A cast to float alone would drop imaginary parts, masks and units."""
    if np.iscomplexobj(values):
        raise InputError(where, "is complex", allowed)
    if any(getattr(values, name, None) is not None for name in ("unit", "units")) or _device.is_time(values):
        raise InputError(where, "has a unit of its own", f"{allowed} without one; of times, seconds")
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(where, f"is no column of numbers: {error}", allowed) from None
    if array.ndim != 1:
        raise InputError(where, f"has {array.ndim} dimensions", "one")
    if isinstance(values, np.ma.MaskedArray):
        array[np.broadcast_to(values.mask, array.shape)] = np.nan
    return array


class Recording:
    """Signals that were recorded together: columns of equal length in memory.

    `columns`: arrays by name (a pandas DataFrame is such a mapping). The time axis is `sampling_period` (s), or a column
    whose name says time, or what the command's options say (rate, time). NaN where a sample is missing.
    """

    def __init__(
        self, columns: Mapping[str, npt.ArrayLike], *, sampling_period: Optional[float] = None, name: str = "recording"
    ) -> None:
        if not isinstance(name, str) or not name or name.startswith("-"):
            raise InputError("recording", f"{name!r} is no name", "a text that begins with no '-'")
        _device.text_of("recording", name)
        if not hasattr(columns, "keys"):
            raise InputError(name, f"is of type {type(columns).__name__}", "arrays by name")
        held: List[Tuple[str, npt.NDArray[np.float64]]] = []
        for key in columns:
            text = _device.text_of(f"{name}: {key!r}", str(key))
            held.append((text, _real_numbers(f"{name}: {key}", columns[key], "numbers in SI units")))
        if not held:
            raise InputError(name, "has no columns", "arrays by name")
        self.name = name
        self.columns = tuple(key for key, _ in held)
        period = None if sampling_period is None else _device.number_of(f"{name}: sampling_period", sampling_period)
        self._held = _core.RecordedColumns(name, held, period)

    def __repr__(self) -> str:
        return f"<zwidth.Recording {self.name!r}: {', '.join(self.columns)}>"


Recorded = Union[str, "os.PathLike[str]", Recording, Mapping[str, npt.ArrayLike]]
"""A recording: a file's path (CSV, MAT, UFF), a Recording, or columns by name (a pandas DataFrame)."""


def _held(recorded: Recorded, number: int) -> Tuple[str, Any]:
    if isinstance(recorded, Recording):
        return recorded.name, recorded._held
    if isinstance(recorded, (str, os.PathLike)):
        path = os.fspath(recorded)
        if not isinstance(path, str):
            raise InputError("recording", "is a path of bytes", "a path of text")
        if path == "-":
            raise InputError("recording", "is standard input", "a file, or columns")
        _device.text_of("recording", path)
        return path if not path.startswith("-") else f"./{path}", Path(path)
    if hasattr(recorded, "keys"):
        made = Recording(recorded, name="recording" if number == 0 else f"recording {number + 1}")
        return made.name, made._held
    raise InputError("recording", f"is of type {type(recorded).__name__}", "a path, a Recording, or columns by name")


def _value(name: str, value: Any) -> str:
    if isinstance(value, np.generic) and not _device.is_time(value):
        value = value.item()
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        if not value or "\0" in value:
            raise InputError(f"options.{name}", "is empty or has a character of code 0", "a text")
        return _device.text_of(f"options.{name}", value)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"options.{name}", f"is of type {type(value).__name__}", "a number or a text")
    try:
        return repr(value)
    except ValueError:  # Python writes no integer of so many digits
        raise InputError(f"options.{name}", "is an integer beyond every double", "a finite number") from None


def _options(options: Mapping[str, Any]) -> List[Tuple[str, List[str]]]:
    given: List[Tuple[str, List[str]]] = []
    for key, value in options.items():
        name = _device.text_of("options", key).rstrip("_").replace("_", "-")
        if isinstance(value, np.bool_):
            value = bool(value)
        if value is None or value is False:
            continue
        if value is True:
            given.append((name, []))
        elif isinstance(value, (list, tuple, np.ndarray)):
            if np.ndim(value) != 1:
                raise InputError(f"options.{key}", f"has {np.ndim(value)} dimensions", "a list")
            if len(value) > 0:
                given.append((name, [_value(key, each) for each in value]))
        else:
            given.append((name, [_value(key, value)]))
    return given


def _opened(device: DeviceOrFile) -> Device:
    return device if isinstance(device, Device) else Device.from_toml(device)


def _run(
    command: str,
    device: Optional[DeviceOrFile],
    recordings: Sequence[Recorded],
    progress: Progress,
    options: Mapping[str, Any],
    study: Union[str, Path, None] = None,
) -> _core.Answer:
    held = [_held(each, number) for number, each in enumerate(recordings)]
    opened = None if device is None else _opened(device)
    return _core.run(command, _options(options), opened, held, progress, study, False)


def _result(
    command: str,
    device: Optional[DeviceOrFile],
    recordings: Sequence[Recorded],
    progress: Progress,
    options: Mapping[str, Any],
    study: Union[str, Path, None] = None,
) -> Any:
    if "list" in options:
        raise InputError("options.list", "asks for another document", "none; columns: of a zwidth.Recording")
    answer = _run(command, device, recordings, progress, options, study)
    result = _results.result_of(answer)
    warn_of_document(result._values)
    return result


def analyze(device: DeviceOrFile, *, progress: Progress = None, **options: Option) -> _results.Analysis:
    """Critical stiffness of a device, what limits it, and the margins of its wall. print() of it is the command's text."""
    opened = _opened(device)
    result: _results.Analysis = _result("analyze", opened, (), progress, options)
    given = _options(options)
    result._tell = lambda: _core.run("analyze", given, opened, [], None, None, True).printed
    return result


def bode(device: DeviceOrFile, *, progress: Progress = None, **options: Option) -> _results.Bode:
    """Frequency responses of a device with every crossover (`from_` is the option --from)."""
    result: _results.Bode = _result("bode", device, (), progress, options)
    return result


def region(device: DeviceOrFile, *, progress: Progress = None, **options: Option) -> _results.Region:
    """Every stable wall, stiff and damped: the region in the plane of K and B."""
    result: _results.Region = _result("region", device, (), progress, options)
    return result


def design(device: DeviceOrFile, *, progress: Progress = None, **options: Option) -> _results.Design:
    """What each number of the device does to the limits."""
    _refuse("design", options, "sweep", "compare", "notch", "target", "recommend")
    result: _results.Design = _result("design", device, (), progress, options)
    return result


def sweep(
    device: DeviceOrFile, axis: Union[str, Sequence[str]], *, progress: Progress = None, **options: Option
) -> _results.Sweep:
    """The limit along one number or two: `axis` is "KEY=FIRST:LAST:COUNT", or with ":log", or two of these."""
    result: _results.Sweep = _result("design", device, (), progress, {**_given("sweep", axis), **options})
    return result


def compare(device: DeviceOrFile, values: str, *, progress: Progress = None, **options: Option) -> _results.Comparison:
    """Several values of one key side by side: "KEY=VALUE,VALUE"."""
    result: _results.Comparison = _result("design", device, (), progress, {**_given("compare", values), **options})
    return result


def design_notch(device: DeviceOrFile, *, progress: Progress = None, **options: Option) -> _results.Notch:
    """A notch on the wall's force that lets the wall be stiffer."""
    result: _results.Notch = _result("design", device, (), progress, {"notch": True, **options})
    return result


def design_targets(
    device: DeviceOrFile, target: Union[float, str], *, progress: Progress = None, **options: Option
) -> _results.DesignTargets:
    """What each number alone must be for the limit to reach `target`: N/m or N m/rad, "2x", "200 %"; goal="damper": B."""
    result: _results.DesignTargets = _result("design", device, (), progress, {**_given("target", target), **options})
    return result


def recommend_wall(device: DeviceOrFile, *, progress: Progress = None, **options: Option) -> _results.WallRecommendation:
    """The wall to render: K, B, velocity filter and optional notch, stable for any passive user with margins."""
    result: _results.WallRecommendation = _result("recommend", device, (), progress, options)
    return result


def diagnose(
    device: DeviceOrFile, *, recording: Optional[Recorded] = None, progress: Progress = None, **options: Option
) -> _results.Diagnosis:
    """What an oscillation is, by its frequency (oscillates_hz) or a recording of it, and what moves it."""
    recordings = () if recording is None else (recording,)
    result: _results.Diagnosis = _result("diagnose", device, recordings, progress, options)
    return result


def simulate(
    device: DeviceOrFile, *, user_force: Union[str, Recorded, None] = None, progress: Progress = None, **options: Option
) -> _results.Simulation:
    """The sampled loop in time. `points=True` keeps the motion; `user_force`: "step:5@0.1" and the like, or a recording."""
    recordings: Tuple[Recorded, ...] = ()
    if isinstance(user_force, str) and user_force.partition(":")[0] in ("step", "ramp", "sine"):
        options["user_force"] = user_force
    elif user_force is not None:
        recordings = (user_force,)
    result: _results.Simulation = _result("simulate", device, recordings, progress, options)
    return result


def relay(
    device: Optional[DeviceOrFile] = None,
    *,
    recording: Optional[Recorded] = None,
    progress: Progress = None,
    **options: Option,
) -> _results.Relay:
    """The relay experiment, simulated or recorded: the stiffness it reads, beside what theory expects."""
    recordings = () if recording is None else (recording,)
    result: _results.Relay = _result("relay", device, recordings, progress, options)
    return result


def frequency_response(
    recording: Recorded, *more: Recorded, progress: Progress = None, **options: Option
) -> _results.FrequencyResponse:
    """The measured frequency response of recordings, and the critical stiffness it shows: the command frf."""
    result: _results.FrequencyResponse = _result("frf", None, (recording, *more), progress, options)
    return result


def identify(
    recording: Optional[Recorded] = None,
    *more: Recorded,
    structure: Union[DeviceOrFile, None] = None,
    progress: Progress = None,
    **options: Option,
) -> Any:
    """A device's parameters from recordings: an Identification, or with method="inverse-dynamics" a
    RigidBodyIdentification. `structure`: a Device or its file, or the name of a structure ("rigid", "two-body",
    "three-body").
    `limit="K=3, B=0, hz=40"`, or a list: walls at which the device was seen to oscillate, with or without a recording."""
    is_name = structure in ("rigid", "two-body", "three-body") if isinstance(structure, str) else False
    if is_name:
        options["structure"] = str(structure)
    device = None if is_name else structure
    recordings = more if recording is None else (recording, *more)
    return _result("identify", device, recordings, progress, options)


def excite(device: Optional[DeviceOrFile] = None, *, progress: Progress = None, **options: Option) -> _results.Excitation:
    """A signal to excite a device with, played through a model of it where one is given."""
    result: _results.Excitation = _result("excite", device, (), progress, options)
    return result


def study(
    device: DeviceOrFile,
    study: Union[str, "os.PathLike[str]", Mapping[str, Any]],
    *,
    progress: Progress = None,
    **options: Option,
) -> _results.Study:
    """How the limit varies over many units: yield, quantiles, the worst unit, which tolerance to tighten.

    `study`: a study file's path, its text (more than one line), or its keys as a dict (docs/study.md).
    """
    held: Union[str, Path]
    if isinstance(study, Mapping):
        held = _core.study_toml(_device.json_of(study, "study"))
    elif isinstance(study, str) and "\n" in study:
        held = _device.text_of("study", study)
    elif isinstance(study, (str, os.PathLike)) and isinstance(os.fspath(study), str):
        if not os.fspath(study) or "\0" in os.fspath(study):
            raise InputError("study", "is empty or has a character of code 0", "a path")
        if os.fspath(study) == "-":
            raise InputError("study", "is standard input", "a file, a text, or a dict")
        held = Path(_device.text_of("study", os.fspath(study)))
    else:
        raise InputError("study", f"is of type {type(study).__name__}", "a path, a text, or a dict")
    result: _results.Study = _result("study", device, (), progress, options, held)
    return result


def workspace(
    device: DeviceOrFile,
    *,
    poses: Union[str, Sequence[str], npt.ArrayLike, Mapping[str, npt.ArrayLike], None] = None,
    points: Union[str, npt.ArrayLike, None] = None,
    normals: Union[str, npt.ArrayLike, None] = None,
    directions: Optional[int] = None,
    stiffness: Union[float, str, None] = None,
    progress: Progress = None,
    **options: Option,
) -> _results.Workspace:
    """The stiffest wall at every pose and in every direction of a mechanism.

    `poses`: an array of a row a pose with the columns of Mechanism.pose_joints, arrays by joint, or the text of a grid,
    "shoulder=0:90:19 deg"; or `points`, rows of x, y, z (m), to which the tip is brought. `normals`: rows of three, or so
    many `directions` at each pose. `stiffness`: the share of poses and directions that reaches it.
    """
    if directions is not None and normals is not None:
        raise InputError("options.directions", "are given beside normals", "one of the two")
    device = _opened(device)
    if poses is not None:
        options["poses"] = _mechanism.poses_text(device, poses)
    if points is not None:
        options["points"] = _mechanism.vectors_text("points", points)
    if normals is not None:
        options["normals"] = _mechanism.vectors_text("normals", normals)
    if directions is not None:
        options["normals"] = str(_mechanism.count_of("directions", directions))
    result: _results.Workspace = _result("workspace", device, (), progress, {"stiffness": stiffness, **options})
    return result


def model(device: DeviceOrFile) -> _results.Model:
    """The continuous and the exact discrete model of a device, and its wall: `export --format json`."""
    result: _results.Model = _result("export", device, (), None, {"format": "json"})
    return result


def export(device: DeviceOrFile, format: str, **options: Option) -> str:
    """The model or the wall as the text of a program: "octave", "python", "json", "c" or "chai3d"."""
    text = _run("export", device, (), None, {"format": format, **options}).printed
    # The text says what is doubtful; so does the document of the same device.
    described = _run("export", device, (), None, {"format": "json", "set": options.get("set")})
    warn_of_document(described.value(""))
    return text


def _given(name: str, value: Any) -> Dict[str, Any]:
    """The option that asks for this answer; left out, another answer would come."""
    if value is None or isinstance(value, (bool, np.bool_)) or np.size(value) == 0:
        raise InputError(f"options.{name}", f"is {value!r}", "a value")
    return {name: value}


def _refuse(command: str, options: Mapping[str, Any], *names: str) -> None:
    own = {"sweep": "sweep", "compare": "compare", "notch": "design_notch", "target": "design_targets"}
    for name in names:
        if name in options:
            call = own.get(name, "recommend_wall")
            raise InputError(f"options.{name}", f"has a function of its own", f"zwidth.{call}()")


class CriticalStiffnessMany:
    """The critical stiffness of many devices, an array element each."""

    def __init__(self, columns: Dict[str, Any]) -> None:
        self.critical_stiffness: npt.NDArray[np.float64] = columns["critical_stiffness"]
        """K_CR, N/m or N m/rad: 0 where none is stable, inf where unbounded, NaN where refused or failed."""
        self.critical_frequency_rad_s: npt.NDArray[np.float64] = columns["critical_frequency_rad_s"]
        """rad/s; NaN unless finite."""
        self.reasons: Dict[int, List[str]] = columns["reasons"]
        """By index: why an element is refused, doubtful or failed."""
        self.scalar_count: int = columns["scalar_count"]
        """Devices that critical_stiffness() answered one by one, not the kernel of many (docs/batch.md)."""
        self._columns = columns

    @functools.cached_property
    def status(self) -> List[str]:
        """As of Analysis."""
        names = self._columns["statuses"]
        return [names[code] for code in self._columns["status"].tolist()]

    @functools.cached_property
    def limited_by(self) -> List[Optional[Dict[str, Any]]]:
        """{"kind": ...}; None unless finite."""
        mechanisms = self._columns["mechanisms"]
        return [copy.copy(mechanisms[mode]) for mode in self._columns["limited_by"].tolist()]

    def __len__(self) -> int:
        return len(self.critical_stiffness)

    def __repr__(self) -> str:
        return f"<zwidth.CriticalStiffnessMany of {len(self)}, {len(self.reasons)} with reasons>"


def critical_stiffness_many(
    device: DeviceOrFile, changes: Mapping[str, npt.ArrayLike], *, progress: Progress = None
) -> CriticalStiffnessMany:
    """critical_stiffness() of the device with the i-th value of every key set, for every i, on all cores.

    `changes`: arrays of numbers in SI units by key ({"link.stiffness": ...}), all of one length.
    """
    if not hasattr(changes, "items"):
        raise InputError("changes", f"is of type {type(changes).__name__}", "arrays by key")
    arrays = {str(key): _real_numbers(f"device.{key}", values, "numbers in SI units") for key, values in changes.items()}
    return CriticalStiffnessMany(_core.critical_stiffness_many(_opened(device), arrays, progress))


_COMMANDS = {
    "analyze": analyze, "bode": bode, "region": region, "design": design, "diagnose": diagnose, "simulate": simulate,
    "relay": relay, "frf": frequency_response, "identify": identify, "excite": excite, "export": export,
    "study": study,
}  # fmt: skip


def options(command: str) -> Dict[str, str]:
    """What each option of a command says of itself, by keyword: the program's own declarations."""
    listed = _core.options(command) if command in _core.commands() else []
    if not listed:
        raise InputError("command", f"{command!r} is none", ", ".join(sorted(_core.commands())))
    return {
        name.replace("-", "_"): f"{text} ({value})" if value else f"{text} (True)" for name, value, text in listed
    }
