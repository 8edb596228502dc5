"""Figures with matplotlib, in the colours and the manner of `--output FIGURE`. Each returns its Figure."""

from __future__ import annotations

from typing import Any, Callable, Optional, Sequence, Tuple, TypeVar, Union

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes  # type: ignore[import]
from matplotlib.figure import Figure  # type: ignore[import]

from . import _commands, _documents, _results
from ._core import Device
from ._errors import InputError
from ._record import Result

BLUE, ORANGE, GREEN, PURPLE, INK, GREY = "#0b4f9e", "#c2410c", "#15803d", "#7e22ce", "#1a1a1a", "#777777"
RED, REGION, ANY_USER, INTERVAL = "#b91c1c", "#dbe7f6", "#bfe3c8", "#bcd3ef"

R = TypeVar("R", bound=Result)


def _result_of(source: Union[Device, R], call: Callable[..., R], options: Any) -> R:
    if isinstance(source, Device):
        return call(source, **options)
    if options:
        raise InputError("options", "are given with a result", "options with a device")
    if not isinstance(source, Result):
        raise InputError("source", f"is of type {type(source).__name__}", "a device, or a result")
    return source


def _figure(figure: Optional[Figure], rows: int, title: str, trust: Optional[_documents.Trust]) -> Tuple[Figure, Sequence[Axes]]:
    if figure is None:
        import matplotlib.pyplot as plt  # type: ignore[import]

        figure = plt.figure(figsize=(9.0, 3.2 + 2.0 * rows), layout="constrained")
    axes = figure.subplots(rows, 1, sharex=rows > 1, squeeze=False)[:, 0]
    # A doubtful answer says so on the picture.
    mark = "" if trust is None or trust.verdict == "sound" else f" ({trust.verdict.upper()})"
    figure.suptitle(title + mark, color=INK, fontsize="medium")
    for each in axes:
        each.grid(True, which="major", color="#e2e2e2", linewidth=0.6)
        each.set_axisbelow(True)
        for side in ("top", "right"):
            each.spines[side].set_visible(False)
    return figure, axes


def bode(source: Union[Device, _results.Bode], *, figure: Optional[Figure] = None, **options: Any) -> Figure:
    """Frequency responses of a device, its crossovers marked; options as those of zwidth.bode()."""
    result = _result_of(source, _commands.bode, options)
    figure, (gain, phase) = _figure(figure, 2, result.device, result.trust)
    for curve, colour, style, name in (
        (result.sampled, BLUE, "-", "sampled, what the wall sees"),
        (result.continuous, ORANGE, "--", "continuous"),
    ):
        gain.semilogx(curve.frequency_rad_s, curve.magnitude_db, style, color=colour, label=name)
        phase.semilogx(curve.frequency_rad_s, curve.phase_deg, style, color=colour)
    for crossover in result.crossovers:
        if crossover.frequency_rad_s > 0.0:
            for each in (gain, phase):
                each.axvline(crossover.frequency_rad_s, color=GREY, linewidth=0.8, linestyle=":")
            gain.plot(crossover.frequency_rad_s, -crossover.stiffness_db, "o", color=RED, markersize=4)
    gain.set_ylabel("magnitude, dB")
    phase.set_ylabel("phase, degrees")
    phase.set_xlabel("frequency, rad/s")
    gain.legend(frameon=False)
    return figure


def _outline(component: Any) -> npt.NDArray[np.float64]:
    points = [(point.damping, point.stiffness) for piece in component.outline for point in piece.points]
    return np.array(points, dtype=np.float64).reshape(-1, 2)


def _clip(shown: Any, outlines: Any, axes: Any) -> None:
    """Shows of a patch what lies in these outlines alone."""
    from matplotlib.path import Path  # type: ignore[import]

    closed = [np.vstack([outline, outline[:1]]) for outline in outlines]
    if closed:
        shown.set_clip_path(Path.make_compound_path(*(Path(each) for each in closed)), axes.transData)
    else:
        shown.set_visible(False)


def region(source: Union[Device, _results.Region], *, figure: Optional[Figure] = None, **options: Any) -> Figure:
    """Every stable wall in the plane of B and K, and those that no passive user destabilises."""
    result = _result_of(source, _commands.region, options)
    held = result.nobody is not None
    holder = "nobody holding and with the file's user" if held else "nobody holding"
    figure, (axes,) = _figure(figure, 1, f"Stable walls of {result.device}, {holder}", result.trust)
    outlines = [_outline(component) for component in result.components]
    nobodys = [_outline(component) for component in result.nobody.components] if result.nobody is not None else []
    for number, outline in enumerate(outlines):
        (shown,) = axes.fill(outline[:, 0], outline[:, 1], facecolor=REGION, linewidth=0,
                             label="stable alone only" if number == 0 else None)  # fmt: skip
        if held:
            _clip(shown, nobodys, axes)
    if result.any_user is not None:
        for number, limit in enumerate(result.any_user.limits):
            damping = [point.damping for point in limit]
            stiffness = [point.stiffness for point in limit]
            axes.fill_between(damping, stiffness, color=ANY_USER, alpha=0.8)
            axes.plot(damping, stiffness, color=GREEN, label="stable for anyone" if number == 0 else None)
    for outlines_of, name, style in ((outlines, "the file's user" if held else None, "--" if held else "-"), (nobodys, "nobody holding", "-")):
        for number, outline in enumerate(outlines_of):
            axes.plot(outline[:, 0], outline[:, 1], color=BLUE, linewidth=1.6, linestyle=style,
                      label=name if number == 0 else None)  # fmt: skip
    axes.set_xlabel(f"B, {result.units.damping}")
    axes.set_ylabel(f"K, {result.units.stiffness}")
    if result.components:
        axes.legend(frameon=False)
    return figure


def frf(source: _results.FrequencyResponse, *, figure: Optional[Figure] = None) -> Figure:
    """A measured response with its 95 % intervals; of frequency_response(..., points=True)."""
    _needs_points(source, "frequency_hz")
    figure, (gain, phase) = _figure(figure, 2, source.recording, source.trust)
    frequency = source.frequency_hz
    gain.fill_between(frequency, source.magnitude_lower, source.magnitude_upper, color=INTERVAL, linewidth=0)
    gain.loglog(frequency, source.magnitude, color=BLUE)
    phase.fill_between(
        frequency, np.degrees(source.phase_lower_rad), np.degrees(source.phase_upper_rad), color=INTERVAL, linewidth=0
    )
    phase.semilogx(frequency, np.degrees(source.phase_rad), color=BLUE)
    phase.axhline(-180.0, color=GREY, linewidth=1.0, linestyle="--")
    if source.critical_frequency_hz is not None:
        for each in (gain, phase):
            each.axvline(source.critical_frequency_hz, color=RED, linewidth=1.2)
    gain.set_ylabel(f"{source.units.position} per {source.units.force}")
    phase.set_ylabel("phase, degrees")
    phase.set_xlabel("frequency, Hz")
    return figure


def fit(source: _results.Identification, *, figure: Optional[Figure] = None) -> Figure:
    """Measured and fitted response, and what is left; of identify(..., points=True)."""
    _needs_points(source, "points")
    points = source.points
    figure, (gain, phase) = _figure(figure, 2, f"{source.device} from {source.source}", source.trust)
    residual = np.abs(points.measured - points.fitted)
    gain.loglog(points.frequency_hz, np.abs(points.measured), ".", color=BLUE, label="measured")
    gain.loglog(points.frequency_hz, np.abs(points.fitted), color=ORANGE, label="fitted")
    gain.loglog(points.frequency_hz, residual, ".", color=GREY, markersize=3, label="residual")
    for values, style, colour in ((points.measured, ".", BLUE), (points.fitted, "-", ORANGE)):
        phase.semilogx(points.frequency_hz, np.degrees(np.unwrap(np.angle(values))), style, color=colour)
    gain.set_ylabel("magnitude")
    phase.set_ylabel("phase, degrees")
    phase.set_xlabel("frequency, Hz")
    gain.legend(frameon=False)
    return figure


def _numbers(values: Sequence[Optional[float]]) -> npt.NDArray[np.float64]:
    return np.array([np.nan if value is None else value for value in values], dtype=np.float64)


def sweep(source: _results.Sweep, *, figure: Optional[Figure] = None) -> Figure:
    """The limit along one number, or as a map of two."""
    figure, (axes,) = _figure(figure, 1, source.device, source.trust)
    limit = _numbers([point.critical_stiffness for point in source.points])
    unit = source.units.stiffness
    first = source.axes[0]
    if len(source.axes) == 1:
        axes.plot(first.values, limit, color=BLUE, linewidth=2.0, label="critical stiffness")
        any_user = _numbers([point.any_user_stiffness for point in source.points])
        if not np.all(np.isnan(any_user)):
            axes.plot(first.values, any_user, color=GREEN, linestyle="--", label="with any passive user")
        axes.set_xlabel(f"{first.parameter}, {first.unit}")
        axes.set_ylabel(f"K, {unit}")
        axes.legend(frameon=False)
        return figure
    second = source.axes[1]
    mesh = axes.pcolormesh(
        first.values, second.values, limit.reshape(len(first.values), -1).T, cmap="viridis", shading="nearest"
    )
    figure.colorbar(mesh, label=f"critical stiffness, {unit}")
    axes.set_xlabel(f"{first.parameter}, {first.unit}")
    axes.set_ylabel(f"{second.parameter}, {second.unit}")
    return figure


def simulation(source: Union[Device, _results.Simulation], *, figure: Optional[Figure] = None, **options: Any) -> Figure:
    """Motion and force of a run; a result must be of simulate(..., points=True)."""
    result = _result_of(source, lambda device, **more: _commands.simulate(device, points=True, **more), options)
    _needs_points(result, "points")
    motion = result.points
    figure, (position, force) = _figure(figure, 2, f"{result.device}: {result.verdict}", result.trust)
    colours = (BLUE, ORANGE, GREEN, PURPLE, INK)
    for number, body in enumerate(motion.bodies):
        position.plot(motion.time_s, body.position, color=colours[number % len(colours)], label=body.body)
    if not motion.bodies:
        position.plot(motion.time_s, motion.measured, color=BLUE, label="measured")
    force.plot(motion.time_s, motion.command, color=INK, label="wall")
    if np.any(motion.user_force):
        force.plot(motion.time_s, motion.user_force, color=PURPLE, linestyle="--", label="user")
    position.set_ylabel(f"position, {result.units.length}")
    force.set_ylabel(f"force, {result.units.force}")
    force.set_xlabel("time, s")
    for each in (position, force):
        each.legend(frameon=False)
    return figure


def _needs_points(result: Result, key: str) -> None:
    if key not in result._values:
        raise InputError("result", "has no points to draw", "points=True where it was computed")
