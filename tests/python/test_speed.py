"""The benchmark of what a call costs runs; scripts/bench shows its numbers."""

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
    python_speed.call_overhead(lhifam, repeats=21)


def test_two_threads(lhifam, python_speed):
    python_speed.two_threads(lhifam, rounds=1)


def test_many_devices(lhifam, python_speed):
    devices = 300
    print(f"critical_stiffness_many: {1e6 * python_speed.many(lhifam, devices, rounds=1) / devices:.2f} us per device on all cores")
