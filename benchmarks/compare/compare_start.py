#!/usr/bin/python3
"""Processor time of a whole process, from its start to its answer: zwidth, and Python that has but loaded SciPy.

usage: compare_start.py --program ZWIDTH [--runs N]      from the root of the sources
"""

import argparse
import os
import statistics
import sys


def processor_time(command):
    """ms of user and system of one run."""
    quiet = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
    _, status, usage = os.wait4(os.posix_spawn(command[0], command, os.environ, file_actions=quiet), 0)
    if status != 0:
        sys.exit(f"{' '.join(command)}: failed")
    return 1e3 * (usage.ru_utime + usage.ru_stime)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--runs", type=int, default=20)
    arguments = parser.parse_args()
    commands = {
        "zwidth --version": [arguments.program, "--version"],
        "zwidth analyze": [arguments.program, "analyze", "devices/lhifam.toml", "--json"],
        "import scipy.signal": [sys.executable, "-c", "import scipy.signal"],
    }
    times = {name: [] for name in commands}
    for _ in range(arguments.runs):  # in turn: they meet the same noise
        for name, command in commands.items():
            times[name].append(processor_time(command))
    peer = statistics.median(times["import scipy.signal"])
    print(f"{'start to answer':24}{'ms, median':>12}{'of SciPy':>10}")
    for name, each in times.items():
        median = statistics.median(each)
        print(f"{name:24}{median:12.1f}{median / peer:10.3f}")


if __name__ == "__main__":
    main()
