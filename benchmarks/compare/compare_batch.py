#!/usr/bin/python3
"""The batch kernel, the library one by one, batched NumPy and the method of python-control's margin on the same two-mass
devices, in the same run, on one core each: processor time, which a busy machine does not change."""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"

import numpy as np

import scipy_margin

PERIOD = 1e-3
WRONG = 1e-3  # relative error that makes an answer wrong
NUMPY_DEVICES, CONTROL_DEVICES = 20000, 200


def transfer_functions(mm, md, bm, bd, kc, bc):
    one = np.ones_like(mm)
    numerator = np.stack([md, bd + bc, kc], axis=-1)
    denominator = np.stack(
        [mm * md, mm * (bd + bc) + md * (bm + bc), kc * (mm + md) + bm * bd + bc * (bm + bd), kc * (bm + bd), 0 * one], axis=-1
    )
    return numerator, denominator


def sampled(mm, md, bm, bd, kc, bc):
    """num(z), den(z) of all devices: exponential by scaling and squaring, polynomials by Faddeev and Leverrier."""
    n = len(mm)
    m = np.zeros((n, 5, 5))
    m[:, 0, 2] = m[:, 1, 3] = 1
    m[:, 2, 0], m[:, 2, 1], m[:, 2, 2], m[:, 2, 3] = -kc / mm, kc / mm, -(bm + bc) / mm, bc / mm
    m[:, 3, 0], m[:, 3, 1], m[:, 3, 2], m[:, 3, 3] = kc / md, -kc / md, bc / md, -(bd + bc) / md
    m[:, 2, 4] = 1 / mm
    halvings = max(0, int(np.ceil(np.log2(np.abs(m).sum(axis=-1).max() * PERIOD))) + 1)
    x = m * PERIOD / 2**halvings
    e = np.eye(5) + x / 14
    for k in range(13, 0, -1):
        e = np.eye(5) + x @ e / k
    for _ in range(halvings):
        e = e @ e
    f, g = e[:, :4, :4], e[:, :4, 4:]
    den, num, adjugate = [np.ones(n)], [], np.broadcast_to(np.eye(4), (n, 4, 4))
    for k in range(1, 5):
        num.append((adjugate @ g)[:, 0, 0])
        product = f @ adjugate
        den.append(-np.trace(product, axis1=1, axis2=2) / k)
        adjugate = product + den[-1][:, None, None] * np.eye(4)
    return np.stack(num, axis=-1), np.stack(den, axis=-1)


def convolve(a, b):
    c = np.zeros((len(a), a.shape[1] + b.shape[1] - 1))
    for i in range(a.shape[1]):
        c[:, i : i + b.shape[1]] += a[:, i : i + 1] * b
    return c


def numpy_batched(columns):
    """As scipy_margin, for all devices at once: eigenvalues of companion matrices."""
    num, den = sampled(*columns)
    p = convolve(np.pad(num, ((0, 0), (1, 0))), den[:, ::-1]) - convolve(np.pad(num, ((0, 0), (1, 0)))[:, ::-1], den)
    companion = np.zeros((len(p), p.shape[1] - 1, p.shape[1] - 1))
    companion[:, 0] = -p[:, 1:] / p[:, :1]
    companion[:, np.arange(1, p.shape[1] - 1), np.arange(p.shape[1] - 2)] = 1
    z = np.linalg.eigvals(companion)
    near = (np.abs(np.abs(z) - 1) < np.finfo(float).eps ** (1 / p.shape[1])) & (np.angle(z) / PERIOD >= 1e-8)
    value = lambda c: sum(c[:, i : i + 1] * z ** (c.shape[1] - 1 - i) for i in range(c.shape[1]))
    with np.errstate(all="ignore"):
        response = value(num) / value(den)
        gains = np.where(near & (response.real < 0), 1 / np.abs(response), np.inf)
    return gains.min(axis=1)


def timed(work):
    start = time.process_time()
    answer = work()
    return answer, time.process_time() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--zwidth", required=True, help="the built zwidth_batch")
    parser.add_argument("--devices", type=int, default=100000, help="default 100000")
    arguments = parser.parse_args()
    if arguments.devices < CONTROL_DEVICES:
        parser.error(f"--devices must be at least {CONTROL_DEVICES}")
    with tempfile.TemporaryDirectory() as folder:
        command = [arguments.zwidth, str(arguments.devices), folder]
        output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        table = np.fromfile(Path(folder) / "devices").reshape(7, arguments.devices)
    mm, md, bm, bd, kc, bc, stiffness = table
    columns = (mm, md, bm, bd, kc, bc)
    print("critical stiffnesses on one core        us per device   per second   one by one / kernel   left to the library")
    for line in output.splitlines():
        name, kernel, alone, share = line.split()
        kernel, alone = float(kernel), float(alone)
        print(f"{name:36} {1e6 * kernel:16.3f} {1 / kernel:12.0f} {alone / kernel:21.1f} {float(share):21.4f}")
        if name == "two_mass":
            ours = kernel
    few = [column[:NUMPY_DEVICES] for column in columns]
    found, seconds = timed(lambda: numpy_batched(few))
    wrong = int((np.abs(found / stiffness[: len(found)] - 1) > WRONG).sum())
    numpy = seconds / len(found)
    print(f"NumPy, batched: {1e6 * numpy:.1f} us per device, ratio {numpy / ours:.0f}, {wrong} of {len(found)} wrong")
    numerators, denominators = transfer_functions(*(column[:CONTROL_DEVICES] for column in columns))
    found, seconds = timed(
        lambda: np.array([scipy_margin.gain_margin(n, d, PERIOD) for n, d in zip(numerators, denominators)])
    )
    wrong = int((np.abs(found / stiffness[: len(found)] - 1) > WRONG).sum())
    control = seconds / len(found)
    print(f"python-control's method: {1e6 * control:.0f} us per device, ratio {control / ours:.0f}, {wrong} of {len(found)} wrong")


if __name__ == "__main__":
    sys.exit(main())
