#!/usr/bin/python3
"""Whole studies of two-mass devices, HDF5 included, with 1 and 2 threads and 1 and 2 processes, beside batched NumPy on one
core in the same run. Medians; the ratio of processor times is what a busy machine hardly changes, that of wall times is what
a second core gains. Every run must write the same bytes."""

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"

import numpy as np

import compare_batch

DEVICE = {"mm": 0.3, "md": 5.1, "bm": 0.1, "bd": 3.4, "kc": 79.5e3, "bc": 15.0}  # Table I of Diaz & Gil
KEYS = ("body.motor.mass", "body.handle.mass", "body.motor.damping", "body.handle.damping", "link.stiffness", "link.damping")
NUMPY_DEVICES = 20000


def files(folder):
    value = DEVICE
    (folder / "device.toml").write_text(
        f'[[body]]\nname = "motor"\nmass = {value["mm"]}\ndamping = {value["bm"]}\n'
        f'[[body]]\nname = "handle"\nmass = {value["md"]}\ndamping = {value["bd"]}\n'
        f'[[link]]\nbetween = ["motor", "handle"]\nstiffness = {value["kc"]}\ndamping = {value["bc"]}\n'
        "[loop]\nsampling_period = 1e-3\n"
    )
    tables = (f'[[parameter]]\nkey = "{key}"\ndistribution = "uniform"\nrelative_tolerance = 0.2\n' for key in KEYS)
    (folder / "study.toml").write_text("".join(tables))


def measured(command, folder):
    """Wall and processor seconds, and the bytes of the result."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.monotonic()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, cwd=folder)
    wall = time.monotonic() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    result = folder / "units.h5"
    contents = result.read_bytes()
    result.unlink()
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, contents


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True, type=Path, help="the built zwidth; zwidth-study beside it is used too")
    parser.add_argument("--units", type=int, default=1000000, help="default 1000000")
    parser.add_argument("--repetitions", type=int, default=3, help="default 3")
    arguments = parser.parse_args()
    if arguments.units < 1 or arguments.repetitions < 1:
        parser.error("--units and --repetitions must be at least 1")
    program = arguments.program.resolve()
    words = ["device.toml", "--study", "study.toml", "--index-samples", "0", "--output", "units.h5", "--samples"]
    words.append(str(arguments.units))
    runs = {f"{threads} thread{'s'[: threads - 1]}": [program, "study", *words, "--threads", str(threads)] for threads in (1, 2)}
    in_processes = program.with_name("zwidth-study")
    if in_processes.exists() and shutil.which("mpirun"):
        for ranks in (1, 2):
            mpi = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)]
            runs[f"{ranks} process{'es' * (ranks - 1)}"] = [*mpi, in_processes, *words, "--threads", "1"]
    share = np.random.default_rng(1).uniform(0.8, 1.2, (6, NUMPY_DEVICES))
    columns = [value * column for value, column in zip(DEVICE.values(), share)]
    numpy = compare_batch.timed(lambda: compare_batch.numpy_batched(columns))[1] / NUMPY_DEVICES
    print(f"{arguments.units} units, HDF5 included   wall s   units/s   gain   processor us/unit   NumPy, batched / this")
    first = None
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files(folder)
        for what, command in runs.items():
            times = [measured(command, folder) for _ in range(arguments.repetitions)]
            wall = float(np.median([each[0] for each in times]))
            processor = float(np.median([each[1] for each in times])) / arguments.units
            first = first or (wall, times[0][2])
            if any(each[2] != first[1] for each in times):
                sys.exit(f"{what}: the result differs from that of one thread")
            print(
                f"{what:28} {wall:9.2f} {arguments.units / wall:9.0f} {first[0] / wall:6.2f} "
                f"{1e6 * processor:19.3f} {numpy / processor:23.1f}"
            )
    print(f"NumPy, batched: {1e6 * numpy:.1f} us of the processor per device, the critical stiffness alone")


if __name__ == "__main__":
    main()
