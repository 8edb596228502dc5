#!/usr/bin/python3
"""zwidth's map of stable walls (K, B) and batched eigenvalues (NumPy, LAPACK) of the same two-mass loop, in the same run."""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # one core each

import numpy as np
from scipy import signal

from two_mass import SAMPLING_PERIOD, TwoMass

DEVICE = TwoMass(0.3, 5.1, 0.1, 3.4, 79.5e3, 15.0)  # the paper's Table I
STIFFNESS, DAMPING = 207e3, 613.0  # the region and a tenth beyond


def closed_loops(count):
    """The matrices of all closed loops: four states of the device and the last position."""
    mm, md, bm, bd = DEVICE.motor_mass, DEVICE.body_mass, DEVICE.motor_damping, DEVICE.body_damping
    kc, bc = DEVICE.cable_stiffness, DEVICE.cable_damping
    a = np.array(
        [[0, 0, 1, 0], [0, 0, 0, 1], [-kc / mm, kc / mm, -(bm + bc) / mm, bc / mm], [kc / md, -kc / md, bc / md, -(bd + bc) / md]]
    )
    b = np.array([[0], [0], [1 / mm], [0]])
    c = np.array([[1, 0, 0, 0]])
    f, g, _, _, _ = signal.cont2discrete((a, b, c, [[0]]), SAMPLING_PERIOD)
    middles = (np.arange(count) + 0.5) / count
    damping, stiffness = np.meshgrid(DAMPING * middles, STIFFNESS * middles, indexing="ij")
    loops = np.zeros((count, count, 5, 5))
    loops[..., :4, :4] = f - (stiffness + damping / SAMPLING_PERIOD)[..., None, None] * (g @ c)
    loops[..., :4, 4] = (damping / SAMPLING_PERIOD)[..., None] * g[:, 0]
    loops[..., 4, 0] = 1.0
    return loops


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--zwidth", required=True, help="the built zwidth_region")
    parser.add_argument("--count", type=int, default=100, help="walls along each axis (default 100)")
    parser.add_argument("--repetitions", type=int, default=9, help="of each side, alternating (default 9)")
    arguments = parser.parse_args()
    if arguments.count < 1 or arguments.repetitions < 1:
        parser.error("--count and --repetitions must be at least 1")

    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as name:
        device, written = Path(name) / "device.toml", Path(name) / "map"
        device.write_text(DEVICE.toml())
        for _ in range(arguments.repetitions):
            command = [arguments.zwidth, device, str(STIFFNESS), str(DAMPING), str(arguments.count), "5", written]
            output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
            ours.append(statistics.median(float(line) for line in output.split()))
            start = time.perf_counter()
            stable = np.abs(np.linalg.eigvals(closed_loops(arguments.count))).max(axis=-1) < 1.0
            theirs.append(time.perf_counter() - start)
        mapped = np.fromfile(written, dtype=np.uint8).reshape(stable.shape) != 0

    zwidth, numpy = statistics.median(ours), statistics.median(theirs)
    print(f"{arguments.count} x {arguments.count} walls of a two-mass loop, one core; medians of {arguments.repetitions}")
    print(f"zwidth, from the device  {zwidth * 1e3:.3f} ms")
    print(f"NumPy eigvals            {numpy * 1e3:.3f} ms, ratio {numpy / zwidth:.0f}")
    print(f"{stable.sum()} stable; the two differ on {(stable != mapped).sum()}")
    if (stable != mapped).any():
        sys.exit("the maps differ")


if __name__ == "__main__":
    main()
