"""The program's answers, many commands for one start (see tests/cli/started_once), on all cores, each command once."""

import os
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from conftest import PROGRAM

_known = {}


def _ask(lines):
    """What is printed, and the exit status, for each line of arguments without blanks inside."""
    environment = dict(os.environ, LD_PRELOAD=os.environ["ZWIDTH_STARTED_ONCE"])
    done = subprocess.run([PROGRAM], input="\n".join(lines) + "\n", env=environment, capture_output=True, text=True)
    statuses = [int(line) for line in done.stdout.split()]
    assert len(statuses) == len(lines), done.stderr
    return statuses


def answers(commands, folder):
    """For each list of arguments (without blanks inside) what is printed, and the exit status."""
    folder = Path(folder)
    commands = [" ".join(map(str, words)) for words in commands]
    new = [words for words in dict.fromkeys(commands) if words not in _known]
    lines = [f"{folder}/{i}.out {folder}/{i}.err {words}" for i, words in enumerate(new)]
    shares = min(os.cpu_count() or 1, len(new))
    with ThreadPoolExecutor(max(1, shares)) as pool:
        told = list(pool.map(_ask, [lines[first::shares] for first in range(shares)]))
    for i, words in enumerate(new):
        _known[words] = ((folder / f"{i}.out").read_text(), told[i % shares][i // shares])
    return [_known[words] for words in commands]
