"""Random two-mass devices: the common input of the comparison."""

import math
import random
from dataclasses import dataclass

SAMPLING_PERIOD = 1e-3


@dataclass(frozen=True)
class TwoMass:
    """Motor and body joined by a cable; SI units, names of the paper's Table I."""

    motor_mass: float
    body_mass: float
    motor_damping: float
    body_damping: float
    cable_stiffness: float
    cable_damping: float

    def transfer_function(self):
        """Numerator and denominator, descending powers of s, motor force to motor position (eqs. 5 and 7)."""
        mm, md, bm, bd = self.motor_mass, self.body_mass, self.motor_damping, self.body_damping
        kc, bc = self.cable_stiffness, self.cable_damping
        numerator = [md, bd + bc, kc]
        denominator = [
            mm * md,
            mm * (bd + bc) + md * (bm + bc),
            (mm + md) * kc + bm * bd + (bm + bd) * bc,
            (bm + bd) * kc,
            0.0,
        ]
        return numerator, denominator

    def toml(self):
        return f"""name = "random two-mass device"
motion = "linear"
[[body]]
name = "motor"
mass = {self.motor_mass!r}
damping = {self.motor_damping!r}
[[body]]
name = "handle"
mass = {self.body_mass!r}
damping = {self.body_damping!r}
[[link]]
between = ["motor", "handle"]
stiffness = {self.cable_stiffness!r}
damping = {self.cable_damping!r}
[loop]
sampling_period = {SAMPLING_PERIOD!r}
"""


def random_devices(count, seed):
    """Vibration mode at 15-450 Hz with a damping ratio of 0.001-0.2, uniform; masses and dampings log-uniform."""
    source = random.Random(seed)

    def log_uniform(low, high):
        return math.exp(source.uniform(math.log(low), math.log(high)))

    devices = []
    for _ in range(count):
        motor_mass = log_uniform(0.05, 2.0)
        body_mass = log_uniform(0.1, 10.0)
        mode = 2 * math.pi * source.uniform(15.0, 450.0)
        damping_ratio = source.uniform(0.001, 0.2)
        reduced_mass = motor_mass * body_mass / (motor_mass + body_mass)
        devices.append(
            TwoMass(
                motor_mass=motor_mass,
                body_mass=body_mass,
                motor_damping=log_uniform(0.02, 1.0),
                body_damping=log_uniform(0.1, 10.0),
                cable_stiffness=reduced_mass * mode**2,
                cable_damping=2 * damping_ratio * mode * reduced_mass,
            )
        )
    return devices
