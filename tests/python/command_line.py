"""The program's answers, many commands for one start (see tests/cli/started_once)."""

import os
import subprocess
from pathlib import Path

from conftest import PROGRAM


def answers(commands, folder):
    """For each list of arguments (without blanks inside) what is printed, and the exit status."""
    folder = Path(folder)
    lines = [f"{folder}/{i}.out {folder}/{i}.err {' '.join(map(str, words))}" for i, words in enumerate(commands)]
    environment = dict(os.environ, LD_PRELOAD=os.environ["ZWIDTH_STARTED_ONCE"])
    done = subprocess.run([PROGRAM], input="\n".join(lines) + "\n", env=environment, capture_output=True, text=True)
    statuses = [int(line) for line in done.stdout.split()]
    assert len(statuses) == len(commands), done.stderr
    return [((folder / f"{i}.out").read_text(), statuses[i]) for i in range(len(commands))]
