"""What a call costs beside the library's own work; printed, not judged: other programs run on this machine."""

import importlib.util
from pathlib import Path

import pytest


@pytest.fixture(scope="module")
def python_speed():
    path = Path(__file__).resolve().parents[2] / "benchmarks" / "python_speed.py"
    spec = importlib.util.spec_from_file_location("python_speed", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_call_overhead(lhifam, python_speed):
    python_speed.call_overhead(lhifam, repeats=2001)


def test_two_threads(lhifam, python_speed):
    python_speed.two_threads(lhifam, rounds=10)


def test_many_devices(lhifam, python_speed):
    devices = 30_000
    print(f"critical_stiffness_many: {1e6 * python_speed.many(lhifam, devices, rounds=5) / devices:.2f} us per device on all cores")
