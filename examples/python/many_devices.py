"""How the critical stiffness scatters over devices as they are built: 10 % in the cable, 5 % in the mass.

usage: many_devices.py DEVICE.toml [COUNT]
"""

import sys

import numpy as np
import zwidth


def main(path: str, count: int) -> None:
    device = zwidth.Device.from_toml(path)
    nominal = device.numbers
    stiffness, mass = nominal["link.0.stiffness"], nominal["body.motor.mass"]
    if stiffness is None or mass is None:
        raise SystemExit("the device has no such numbers")
    generator = np.random.default_rng(1)
    many = zwidth.critical_stiffness_many(
        device,
        {
            "link.0.stiffness": stiffness * generator.lognormal(sigma=0.10, size=count),
            "body.motor.mass": mass * generator.lognormal(sigma=0.05, size=count),
        },
    )
    low, median, high = np.nanquantile(many.critical_stiffness, [0.025, 0.5, 0.975])
    print(f"{len(many)} devices: 95 % between {low:.1f} and {high:.1f}, median {median:.1f} N/m")
    print(f"{len(many.reasons)} without an answer, or with a doubtful one")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 1000)
