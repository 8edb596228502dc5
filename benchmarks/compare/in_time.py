#!/usr/bin/python3
"""zwidth and SciPy's solve_ivp with events on the same sampled loop in the same run."""

import argparse
import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

PERIOD = 1e-3  # s
START = 3e-3  # m
STIFFNESS = 5000.0  # N/m
MASS = (0.3, 5.1)  # kg: the LHIfAM of Diaz & Gil, Table I
DAMPING = (0.1, 3.4)  # N s/m
LINK = (79.5e3, 15.0)  # N/m, N s/m
TOLERANCE = 1e-6  # relative, between the two answers
# Friction on both bodies and the encoder's step, or neither.
LOOPS = {"linear": ((0.0, 0.0), 0.0), "friction, encoder": ((0.2, 0.4), 3.14e-6)}


def device_file(coulomb, resolution):
    bodies = "".join(
        f'[[body]]\nname = "{name}"\nmass = {MASS[i]}\ndamping = {DAMPING[i]}\ncoulomb = {coulomb[i]}\n'
        for i, name in enumerate(("motor", "handle"))
    )
    return (
        f'{bodies}[[link]]\nbetween = ["motor", "handle"]\nstiffness = {LINK[0]}\ndamping = {LINK[1]}\n'
        f'[loop]\nactuated = "motor"\nsensed = "motor"\nheld = "handle"\nsampling_period = {PERIOD}\n'
        f"[sensor]\nresolution = {resolution}\n[wall]\nstiffness = {STIFFNESS}\n"
    )


class SampledLoop:
    """One period at a time; within it, one solve_ivp from each stick-slip instant to the next."""

    def __init__(self, coulomb, resolution):
        self.coulomb = coulomb
        self.resolution = resolution
        self.state = np.array([START, START, 0.0, 0.0])
        self.directions = [0, 0]
        self.force = 0.0

    def others(self, x, body):
        """All forces on a body but its Coulomb friction."""
        sign = 1.0 if body == 0 else -1.0
        link = LINK[0] * (x[0] - x[1]) + LINK[1] * (x[2] - x[3])
        return (self.force if body == 0 else 0.0) - sign * link - DAMPING[body] * x[2 + body]

    def sticks(self, body):
        return self.coulomb[body] > 0.0 and self.directions[body] == 0

    def derivative(self, _, x):
        acceleration = [
            0.0 if self.sticks(i) else (self.others(x, i) - self.directions[i] * self.coulomb[i]) / MASS[i] for i in (0, 1)
        ]
        return [x[2], x[3], *acceleration]

    def settle(self, body):
        """At velocity 0: stick, or slide with the other forces."""
        self.state[2 + body] = 0.0
        others = self.others(self.state, body)
        self.directions[body] = 0 if abs(others) <= self.coulomb[body] else math.copysign(1, others)

    def events(self):
        def event_of(body):
            def until_break_away(_, x):
                return self.coulomb[body] - abs(self.others(x, body))

            def until_rest(_, x):
                return self.directions[body] * x[2 + body]

            event = until_break_away if self.sticks(body) else until_rest
            event.terminal = True
            event.direction = -1
            return event

        return [event_of(body) for body in (0, 1) if self.coulomb[body] > 0.0]

    def step(self):
        measured = self.state[0]
        if self.resolution > 0.0:
            measured = self.resolution * math.floor(measured / self.resolution + 0.5)
        self.force = -STIFFNESS * measured
        for body in (0, 1):
            if self.coulomb[body] > 0.0 and self.state[2 + body] == 0.0:
                self.settle(body)
        now = 0.0
        while now < PERIOD:
            with_friction = [body for body in (0, 1) if self.coulomb[body] > 0.0]
            run = solve_ivp(
                self.derivative, (now, PERIOD), self.state, method="DOP853", rtol=1e-9, atol=1e-14, events=self.events()
            )
            self.state = run.y[:, -1].copy()
            now = run.t[-1]
            if run.status != 1:
                return
            for body, times in zip(with_friction, run.t_events):
                if times.size == 0:
                    continue
                if self.sticks(body):
                    self.directions[body] = math.copysign(1, self.others(self.state, body))
                else:
                    self.settle(body)


def run_scipy(coulomb, resolution, samples):
    loop = SampledLoop(coulomb, resolution)
    start = time.perf_counter()
    for _ in range(samples):
        loop.step()
    return (time.perf_counter() - start) / samples, loop.state[:2]


def run_zwidth(program, folder, coulomb, resolution, samples):
    file = Path(folder) / "device.toml"
    file.write_text(device_file(coulomb, resolution))
    output = subprocess.run([program, file, repr(START), str(samples)], check=True, capture_output=True, text=True).stdout
    numbers = [float(word) for word in output.split()]
    return numbers[0], np.array(numbers[1:])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--zwidth", required=True, help="the built zwidth_in_time")
    parser.add_argument("--samples", type=int, default=300, help="sampling periods to simulate (default 300)")
    arguments = parser.parse_args()
    if arguments.samples < 1:
        parser.error("--samples must be at least 1")

    print(f"{arguments.samples} samples of 1 ms, two masses, wall of 5 kN/m, per sample:")
    print(f"{'':<20}{'zwidth':>12}{'solve_ivp':>14}{'ratio':>9}{'largest difference':>22}")
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        for name, (coulomb, resolution) in LOOPS.items():
            ours, our_end = run_zwidth(arguments.zwidth, folder, coulomb, resolution, arguments.samples)
            theirs, their_end = run_scipy(coulomb, resolution, arguments.samples)
            difference = np.max(np.abs(our_end - their_end)) / START
            print(f"{name:<20}{ours * 1e9:>9.1f} ns{theirs * 1e6:>11.1f} us{theirs / ours:>9.0f}{difference:>22.1e}")
            if not difference <= TOLERANCE:
                wrong.append(name)
    print("largest difference: of the bodies' positions at the end, relative to the start")
    if wrong:
        sys.exit(f"the two differ by more than {TOLERANCE:g}: {', '.join(wrong)}")


if __name__ == "__main__":
    main()
