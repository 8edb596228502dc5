"""The exact discrete model: its closed loop has a pole on the unit circle at the critical stiffness."""

import importlib.util
import sys
import types

import numpy as np
import pytest
import zwidth


@pytest.mark.parametrize("delay", [0.0, 0.25e-3, 1e-3, 2.75e-3])
def test_the_loop_closed_at_the_critical_stiffness(lhifam, delay):
    device = lhifam.with_(loop__delay=delay)
    model = zwidth.control.state_space(device)
    limit = zwidth.critical_stiffness(device).critical_stiffness
    radius = [np.abs(np.linalg.eigvals(model.A - k * limit * model.B @ model.C)).max() for k in (0.99, 1.0, 1.01)]
    assert radius[0] < 1.0 < radius[2] and radius[1] == pytest.approx(1.0, abs=1e-7)
    assert model.dt == device.sampling_period and model.D.shape == (1, 1)


@pytest.mark.skipif(importlib.util.find_spec("control") is not None, reason="python-control is installed")
def test_without_python_control_it_says_so(lhifam):
    with pytest.raises(zwidth.Error, match="python-control is not installed"):
        zwidth.control.to_control(lhifam)


def test_exchange(lhifam):
    control = pytest.importorskip("control", reason="python-control is not installed")
    system = zwidth.control.to_control(lhifam)
    assert system.dt == lhifam.sampling_period
    device = zwidth.control.from_control(control.tf([1.0], [5.4, 3.5, 0.0]), sampling_period=1e-3)
    rigid = zwidth.Device.from_toml("devices/lhifam_rigid.toml")
    assert zwidth.critical_stiffness(device).critical_stiffness == pytest.approx(
        zwidth.critical_stiffness(rigid).critical_stiffness, rel=1e-9
    )
    with pytest.raises(zwidth.InputError):
        zwidth.control.from_control(system, sampling_period=1e-3)


def test_what_is_handed_to_python_control(lhifam, monkeypatch):
    """In the place of python-control, which Debian 12 has not, a module that keeps what it is given."""
    stand_in = types.ModuleType("control")
    stand_in.ss = lambda *given: given
    stand_in.tf = lambda system: system
    monkeypatch.setitem(sys.modules, "control", stand_in)
    A, B, C, D, dt = zwidth.control.to_control(lhifam)
    assert A.shape[0] == A.shape[1] == B.shape[0] == C.shape[1] and dt == 1e-3

    def system(continuous=True, inputs=1):
        return types.SimpleNamespace(ninputs=inputs, noutputs=1, isctime=lambda: continuous,
                                     num=[[np.array([1.0])]], den=[[np.array([5.4, 3.5, 0.0])]])  # fmt: skip

    device = zwidth.control.from_control(system(), sampling_period=1e-3, delay=0.5e-3)
    assert device.delay == 0.5e-3 and zwidth.critical_stiffness(device).status == "finite"
    for bad in (system(continuous=False), system(inputs=2)):
        with pytest.raises(zwidth.InputError):
            zwidth.control.from_control(bad, sampling_period=1e-3)
