#!/usr/bin/python3
"""zwidth's Welch estimate and SciPy's csd and welch on the same record, segments, window and overlap, in the same run."""

import argparse
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from scipy import signal

PERIOD = 1e-3
SEGMENT = 4096


def record(samples):
    """A mode at 80 Hz under white force, with white noise on the position."""
    generator = np.random.default_rng(1)
    force = generator.standard_normal(samples)
    numerator, denominator, _ = signal.cont2discrete(([1.0], [1.0, 2 * 0.05 * 503.0, 503.0**2]), PERIOD)
    position = signal.lfilter(numerator[0], denominator, force)
    return force, position + 0.01 * position.std() * generator.standard_normal(samples)


def scipy_estimate(force, position):
    """H1 and coherence, as csd and welch give them; what zwidth returns besides (noise, bias) is not computed."""
    shape = dict(fs=1 / PERIOD, window="hann", nperseg=SEGMENT, noverlap=SEGMENT // 2, detrend="linear")
    frequencies, ff = signal.welch(force, **shape)
    _, xx = signal.welch(position, **shape)
    _, fx = signal.csd(force, position, **shape)
    return frequencies, fx / ff, np.abs(fx) ** 2 / (ff * xx)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--zwidth", required=True, help="the built zwidth_welch")
    parser.add_argument("--samples", type=int, default=6_000_000, help="of the record (default 6 million)")
    parser.add_argument("--repetitions", type=int, default=5, help="of each side, alternating (default 5)")
    arguments = parser.parse_args()
    if arguments.samples < SEGMENT or arguments.repetitions < 1:
        parser.error(f"--samples must be at least {SEGMENT}, --repetitions at least 1")

    force, position = record(arguments.samples)
    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as name:
        signals, lines = Path(name) / "signals", Path(name) / "lines"
        np.concatenate([force, position]).tofile(signals)
        for _ in range(arguments.repetitions):
            command = [arguments.zwidth, signals, str(arguments.samples), str(SEGMENT), "1", lines]
            ours.append(float(subprocess.run(command, check=True, capture_output=True, text=True).stdout))
            start = time.perf_counter()
            frequencies, response, _ = scipy_estimate(force, position)
            theirs.append(time.perf_counter() - start)
        measured = np.loadtxt(lines)

    index = np.rint(measured[:, 0] * SEGMENT * PERIOD).astype(int)
    band = (measured[:, 0] > 1) & (measured[:, 0] < 400)
    difference = np.abs(measured[band, 1] + 1j * measured[band, 2] - response[index[band]]) / np.abs(response[index[band]])
    zwidth, scipy = statistics.median(ours), statistics.median(theirs)
    print(f"{arguments.samples} samples, segments of {SEGMENT}, Hann, half overlapping; medians of {arguments.repetitions}")
    print(f"zwidth  {zwidth:.3f} s")
    print(f"SciPy   {scipy:.3f} s, ratio {scipy / zwidth:.2f}")
    print(f"responses differ by {np.median(difference):.2e} (median), {difference.max():.2e} (most), 1 to 400 Hz")
    if scipy < zwidth:
        sys.exit("zwidth is slower than SciPy")


if __name__ == "__main__":
    main()
