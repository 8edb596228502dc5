"""The exact discrete model as matrices, and exchange with python-control where that is installed."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from . import _commands, _core
from ._core import Device
from ._errors import Error, InputError
from ._record import Array


class StateSpace(NamedTuple):
    """x[k+1] = A x[k] + B u[k], y[k] = C x[k] + D u[k]: force in, sensed position out (N and m, N m and rad)."""

    A: Array
    B: Array
    C: Array
    D: Array
    dt: float
    """The sampling period, s."""


def state_space(device: Device) -> StateSpace:
    """The device with zero-order hold and delay, exact for any delay: the delay's whole samples are states.

    Raises InputError where a delay has too many samples for states of its own.
    """
    model = _commands.model(device)
    document = model._answer
    if model._values.get("with_delay_states") is None:
        raise InputError("device.loop.delay", "has too many samples for states", "a shorter delay")
    path = "/with_delay_states"
    A, B, C = (document.array(f"{path}/{name}") for name in ("F", "Gamma", "C"))
    return StateSpace(A, B, C, np.zeros((1, 1)), device.sampling_period)


def _module() -> Any:
    try:
        import control  # type: ignore[import]
    except ImportError:
        raise Error("python-control is not installed; zwidth.control.state_space() gives the matrices") from None
    return control


def to_control(device: Device) -> Any:
    """state_space() as a control.StateSpace of that sampling period."""
    made = state_space(device)
    return _module().ss(made.A, made.B, made.C, made.D, made.dt)


def from_control(system: Any, *, sampling_period: float, **loop: Any) -> Device:
    """A device from a continuous control.TransferFunction or control.StateSpace of one force and one position.

    `loop`: further keys of [loop]. A state space is converted without rounding: a conversion in double precision moves a
    rigid body's pole away from s = 0, where it grows. Coefficients of a transfer function are taken as they are.
    Raises InputError for other systems, other numbers of inputs or outputs, force that passes straight to the position,
    a state space with an integrator that force or position does not reach, and a discrete system: the hold is zwidth's.
    """
    control = _module()
    if not isinstance(system, (control.TransferFunction, control.StateSpace)):
        raise InputError("system", f"is of type {type(system).__name__}", "a control.TransferFunction or control.StateSpace")
    if system.ninputs != 1 or system.noutputs != 1:
        raise InputError("system", f"has {system.ninputs} inputs, {system.noutputs} outputs", "one of each")
    if not system.isctime():
        raise InputError("system", "is discrete", "a continuous one: the hold is exact here")
    if isinstance(system, control.StateSpace):
        if np.any(system.D):
            raise InputError("system", "passes force straight to the position", "D = 0")
        fraction = _core.transfer_function_of(system.A, system.B, system.C)
        if fraction["numerator"][-1] == 0.0 and fraction["denominator"][-1] == 0.0:
            what = "has an integrator that the force does not move or the position does not show: it may drift unseen"
            raise InputError("system", what, "the system without that state")
    else:
        fraction = {"numerator": system.num[0][0], "denominator": system.den[0][0]}
    return Device(transfer_function=fraction, loop={"sampling_period": sampling_period, **loop})
