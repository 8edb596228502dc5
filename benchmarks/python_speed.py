#!/usr/bin/python3
"""What Python costs beside the library: the call, two threads against one, many devices on two cores against one.

usage: PYTHONPATH=build/release/python benchmarks/python_speed.py [DEVICE]

Of each ratio the best of many short rounds: on a machine that others use, the one that they disturbed least.
tests/python/test_speed.py prints the same of few rounds.
"""

import os
import statistics
import subprocess
import sys
import threading
import time

import numpy as np
import zwidth

ROUNDS = 40
CALLS = 400  # a round: some milliseconds
DEVICES = (30_000, 300_000)


def seconds(work):
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def call_overhead(device, repeats=5001):
    python = statistics.median(seconds(lambda: zwidth.critical_stiffness(device)) for _ in range(repeats))
    library = zwidth._core.seconds_of_critical_stiffness(device, repeats)
    print(f"critical_stiffness(device): {1e6 * python:.2f} us, {1e6 * (python - library):.2f} us above the library (medians of {repeats})")


def two_threads(device, rounds=ROUNDS):
    def work():
        for _ in range(CALLS):
            zwidth.critical_stiffness(device)

    def pair():
        threads = [threading.Thread(target=work) for _ in range(2)]
        for each in threads:
            each.start()
        for each in threads:
            each.join()

    one, two = (min(seconds(call) for _ in range(rounds)) for call in (work, pair))
    print(f"two threads do {2 * one / two:.2f} times the work of one")


def many(device, devices, rounds=ROUNDS):
    """critical_stiffness_many() on the cores that this process may use: the least seconds."""
    changes = {"loop.delay": np.linspace(0.0, 4e-3, devices)}
    return min(seconds(lambda: zwidth.critical_stiffness_many(device, changes)) for _ in range(rounds))


def many_on(cores, path, devices):
    """Each in a process of its own: the library asks once how many there are."""
    call = [sys.executable, __file__, path, "--cores", str(cores), str(devices)]
    return float(subprocess.run(call, check=True, capture_output=True, text=True).stdout)


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "devices/lhifam.toml"
    device = zwidth.Device.from_toml(path)
    if len(sys.argv) > 3:
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: int(sys.argv[3])])
        print(many(device, int(sys.argv[4])))
        return
    call_overhead(device)
    two_threads(device)
    for devices in DEVICES:
        one, two = many_on(1, path, devices), many_on(2, path, devices)
        print(
            f"critical_stiffness_many of {devices} devices: {1e6 * one / devices:.2f} us each on one core, "
            f"{1e6 * two / devices:.2f} us on two: {one / two:.2f} times"
        )


if __name__ == "__main__":
    main()
