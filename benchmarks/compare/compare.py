#!/usr/bin/python3
"""zwidth, GNU Octave's margin, a NumPy/SciPy gain margin and, where it is installed, python-control's on the same random
devices in the same run."""

import argparse
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from dataclasses import dataclass
from pathlib import Path

import scipy_margin
import truth
from two_mass import SAMPLING_PERIOD, random_devices

HERE = Path(__file__).resolve().parent
WRONG = 1e-3  # relative error that makes an answer wrong; unsafe where it is too high


@dataclass(frozen=True)
class Peer:
    name: str
    stiffness: list
    seconds: list


def run_zwidth(program, devices, folder):
    files = []
    for i, device in enumerate(devices):
        file = folder / f"{i}.toml"
        file.write_text(device.toml())
        files.append(file)
    output = subprocess.run([program, *files], check=True, capture_output=True, text=True).stdout
    rows = [line.split() for line in output.splitlines()]
    return [Peer("zwidth analyze()", [float(row[0]) for row in rows], [float(row[1]) for row in rows])]


def run_octave(devices, folder):
    rows = (" ".join(repr(c) for side in device.transfer_function() for c in side) for device in devices)
    (folder / "devices.txt").write_text("\n".join(rows) + "\n")
    environment = dict(
        os.environ,
        ZWIDTH_INPUT=str(folder / "devices.txt"),
        ZWIDTH_OUTPUT=str(folder / "margins.txt"),
        ZWIDTH_PERIOD=repr(SAMPLING_PERIOD),
    )
    octave = subprocess.run(
        ["octave-cli", "--norc", "--quiet", str(HERE / "octave_margin.m")], env=environment, capture_output=True, text=True
    )
    if octave.returncode != 0:
        sys.exit(f"octave-cli failed: {octave.stderr.strip()}")
    table = [[float(x) for x in line.split()] for line in (folder / "margins.txt").read_text().splitlines()]
    stiffness = [row[0] for row in table]
    return [
        Peer("Octave c2d + margin", stiffness, [row[1] for row in table]),
        Peer("Octave margin alone", stiffness, [row[2] for row in table]),
    ]


def timed(gain_margin, devices):
    """Answers of gain_margin(numerator, denominator), and the median seconds of each, of the processor as of all peers."""
    stiffness, seconds = [], []
    for device in devices:
        numerator, denominator = device.transfer_function()
        times = []
        for _ in range(5):
            start = time.thread_time()
            answer = gain_margin(numerator, denominator)
            times.append(time.thread_time() - start)
        stiffness.append(float(answer))
        seconds.append(statistics.median(times))
    return stiffness, seconds


def run_scipy(devices):
    margin = lambda numerator, denominator: scipy_margin.gain_margin(numerator, denominator, SAMPLING_PERIOD)
    return [Peer("NumPy/SciPy", *timed(margin, devices))]


def run_python_control(devices):
    """Its defaults, as a user has them; `margin` is the least of its gain margins."""
    try:
        import control
    except ImportError:
        print("python-control is not installed: without it")
        return []
    margin = lambda *fraction: control.margin(control.c2d(control.tf(*fraction), SAMPLING_PERIOD, "zoh"))[0]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # where it falls back from polynomials to interpolation
        return [Peer(f"python-control {control.__version__}", *timed(margin, devices))]


def print_table(peers, true_stiffness):
    count = len(true_stiffness)
    fastest = statistics.median(peers[0].seconds)
    print(f"{'':<30}{'median CPU':>12}{'ratio':>9}{'wrong':>12}{'unsafe':>12}")
    for peer in peers:
        errors = [(answer - true) / true for answer, true in zip(peer.stiffness, true_stiffness)]
        wrong = sum(not abs(error) <= WRONG for error in errors)
        unsafe = sum(error > WRONG for error in errors)
        median = statistics.median(peer.seconds)
        print(
            f"{peer.name:<30}{median * 1e6:>9.1f} us{median / fastest:>9.1f}"
            f"{f'{wrong} of {count}':>12}{f'{unsafe} of {count}':>12}"
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--zwidth", required=True, help="the built zwidth_many")
    parser.add_argument("--devices", type=int, default=200, help="how many random devices (default 200)")
    parser.add_argument("--seed", type=int, default=1, help="of the random devices (default 1)")
    arguments = parser.parse_args()
    if arguments.devices < 1:
        parser.error("--devices must be at least 1")

    devices = random_devices(arguments.devices, arguments.seed)
    print(f"{len(devices)} random two-mass devices, seed {arguments.seed}: mode 15-450 Hz, damping ratio 0.001-0.2, T = 1 ms")
    true_stiffness = [truth.critical_stiffness(device) for device in devices]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        peers = run_zwidth(arguments.zwidth, devices, folder) + run_octave(devices, folder) + run_scipy(devices) + run_python_control(devices)
    print_table(peers, true_stiffness)
    print(f"wrong: off by more than {WRONG:.1%} from the 80-digit answer; unsafe: too high by more than that")

    ours = peers[0]
    missed = [i for i, (answer, true) in enumerate(zip(ours.stiffness, true_stiffness)) if not math.isclose(answer, true, rel_tol=WRONG)]
    if missed:
        sys.exit(f"zwidth is wrong on devices {missed}")


if __name__ == "__main__":
    main()
