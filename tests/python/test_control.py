"""The exact discrete model: its closed loop has a pole on the unit circle at the critical stiffness."""

import importlib.util
import sys
import types
import warnings

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


def without_wall(file):
    keys = zwidth.Device.from_toml(file).to_dict()
    del keys["wall"]
    return zwidth.Device(**keys)


def by_numpy(device):
    model = zwidth.control.state_space(device)
    identity = np.eye(len(model.A))
    return lambda z: np.array([(model.C @ np.linalg.solve(each * identity - model.A, model.B))[0, 0] for each in z])


@pytest.mark.parametrize("system_of", [by_numpy, zwidth.control.to_control], ids=["numpy", "python-control"])
def test_responses_are_those_of_the_device(system_of, random_devices):
    """Up to Nyquist itself, for any delay; as closely as a lightly damped mode can be solved for in double precision."""
    if system_of is not by_numpy:
        pytest.importorskip("control", reason="python-control is not installed: its responses are not tried")
    for file in random_devices[:63]:
        for delay in (0.0, 0.25, 1.0, 2.75, 7.0, 7.5):
            device = without_wall(file)
            device = device.with_(loop__delay=delay * device.sampling_period)
            exact = zwidth.bode(device, points=40).sampled
            expected = 10 ** (exact.magnitude_db / 20) * np.exp(1j * np.radians(exact.phase_deg))
            found = system_of(device)(np.exp(1j * exact.frequency_rad_s * device.sampling_period))
            assert np.max(np.abs(found / expected - 1)) < 1e-7, f"{file.name}, {delay} samples of delay"


@pytest.mark.skipif(importlib.util.find_spec("control") is not None, reason="python-control is installed")
def test_without_python_control_it_says_so(lhifam):
    with pytest.raises(zwidth.Error, match="python-control is not installed"):
        zwidth.control.to_control(lhifam)


@pytest.fixture
def control():
    """The real one, where it is installed: Debian 12 has no package of it."""
    return pytest.importorskip("control", reason="python-control is not installed: its exchange is not tried, but for a stand-in")


def continuous(control, device):
    model = zwidth.model(device).continuous.to_dict()
    return control.ss(model["A"], model["B"], model["C"], 0)


def test_a_state_space_keeps_its_rigid_body(control, random_devices):
    """Through control.tf() the pole at s = 0 moves, and of most of these devices no wall would be stable."""
    compared = 0
    for file in random_devices:
        device = without_wall(file)
        expected = zwidth.critical_stiffness(device)
        system = continuous(control, device)
        if expected.status != "finite" or system.nstates > 8:
            continue
        back = zwidth.control.from_control(system, sampling_period=device.sampling_period, delay=device.delay)
        assert zwidth.critical_stiffness(back).critical_stiffness == pytest.approx(expected.critical_stiffness, rel=1e-9), file
        compared += 1
    print(f"{compared} state spaces of python-control {control.__version__} and back")
    assert compared > 150


def test_rounding_of_its_own_conversion_is_doubted(control, lhifam):
    """What tf() makes of a state space: where the limit is another one, it is doubtful."""
    wrong = 0
    for stiffness in np.geomspace(2e4, 2e6, 40):
        device = lhifam.with_(link__stiffness=stiffness)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            fraction = control.tf(continuous(control, device))
            found = zwidth.critical_stiffness(zwidth.control.from_control(fraction, sampling_period=1e-3))
        limit = zwidth.critical_stiffness(device).critical_stiffness
        if found.critical_stiffness != pytest.approx(limit, rel=1e-6):
            assert found.trust["verdict"] == "doubtful" and "belongs at s = 0" in found.trust["reasons"][0]
            wrong += 1
    print(f"{wrong} of 40 limits of control.tf(state space) are wrong, and doubted")


def test_exchange(control, lhifam):
    system = zwidth.control.to_control(lhifam)
    assert system.dt == lhifam.sampling_period
    fraction = control.tf([1.0], [5.4, 3.5, 0.0])
    device = zwidth.control.from_control(fraction, sampling_period=1e-3)
    rigid = zwidth.Device.from_toml("devices/lhifam_rigid.toml")
    assert zwidth.critical_stiffness(device).critical_stiffness == pytest.approx(
        zwidth.critical_stiffness(rigid).critical_stiffness, rel=1e-9
    )
    two = control.ss(np.eye(2), np.eye(2), np.eye(2), 0)
    direct = control.ss([[-1.0]], [[1.0]], [[1.0]], [[1.0]])
    improper = control.tf([1.0, 1.0], [1.0, 2.0])
    for bad in (system, two, direct, improper, control.frd([1.0], [1.0]), 3, None, control.ss([[np.nan]], [[1]], [[1]], 0)):
        with pytest.raises(zwidth.InputError):
            zwidth.control.from_control(bad, sampling_period=1e-3)
    with pytest.raises(zwidth.InputError, match="too many samples"):
        zwidth.control.to_control(lhifam.with_(loop__delay=9.0))


def test_what_is_handed_to_python_control(lhifam, monkeypatch):
    """In the place of python-control, which Debian 12 has not, a module that keeps what it is given."""

    class Fraction(types.SimpleNamespace):
        ninputs = noutputs = 1
        num, den = [[np.array([1.0])]], [[np.array([5.4, 3.5, 0.0])]]
        continuous = True

        def isctime(self):
            return self.continuous

    class States(Fraction):
        A, B, C = (np.array(each) for each in ([[0.0, 1.0], [0.0, -3.5 / 5.4]], [[0.0], [1 / 5.4]], [[1.0, 0.0]]))
        D = np.zeros((1, 1))

    stand_in = types.ModuleType("control")
    stand_in.ss = lambda *given: given
    stand_in.TransferFunction, stand_in.StateSpace = Fraction, States
    monkeypatch.setitem(sys.modules, "control", stand_in)
    A, B, C, D, dt = zwidth.control.to_control(lhifam)
    assert A.shape[0] == A.shape[1] == B.shape[0] == C.shape[1] and dt == 1e-3

    limit = zwidth.critical_stiffness(zwidth.Device.from_toml("devices/lhifam_rigid.toml").with_(loop__delay=0.5e-3))
    for system in (Fraction(), States()):
        device = zwidth.control.from_control(system, sampling_period=1e-3, delay=0.5e-3)
        assert device.delay == 0.5e-3
        assert zwidth.critical_stiffness(device).critical_stiffness == pytest.approx(limit.critical_stiffness, rel=1e-9)
    unseen = np.zeros((3, 3))
    unseen[:2, :2] = States.A
    for B, C in (([[0.0], [1 / 5.4], [1.0]], [[1.0, 0.0, 0.0]]), ([[0.0], [1 / 5.4], [0.0]], [[1.0, 0.0, 1.0]])):
        with pytest.raises(zwidth.InputError, match="may drift unseen"):
            zwidth.control.from_control(States(A=unseen, B=np.array(B), C=np.array(C)), sampling_period=1e-3)
    shapes = (np.zeros(2), np.zeros((2, 3)), np.zeros((0, 0)), np.full((2, 2), np.inf), np.full((2, 2), "x"), [[1j, 0], [0, 0]])
    for bad in (Fraction(continuous=False), Fraction(ninputs=2), States(D=np.ones((1, 1))), object(), *(States(A=A) for A in shapes)):
        with pytest.raises((zwidth.InputError, TypeError, ValueError)):
            zwidth.control.from_control(bad, sampling_period=1e-3)
