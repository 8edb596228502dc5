"""A device from a recording, with its uncertainty; then the loop in time, and figures of both.

usage: identify_and_simulate.py STRUCTURE.toml RECORDING.csv FOLDER
"""

import sys
from pathlib import Path

import zwidth


def main(structure: str, recording: str, folder: Path) -> None:
    found = zwidth.identify(
        recording,
        structure=zwidth.Device.from_toml(structure),
        free="link.stiffness,link.damping",
        locked="handle",
        force="force",
        position="position",
        points=True,
    )
    for each in found.parameters:
        print(f"{each.key}: {each.value:.6g} {each.unit}, 95 % interval {each.interval}")
    zwidth.plot.fit(found).savefig(folder / "fit.svg")
    device: zwidth.Device = found.to_device()
    limit = zwidth.critical_stiffness(device).critical_stiffness
    if limit is None:
        raise SystemExit("the device is not known well enough")
    run = zwidth.simulate(device.with_(wall__stiffness=0.5 * limit), duration=1.0, points=True)
    print(f"half of {limit:.1f} {run.units.stiffness}: the run {run.verdict}")
    zwidth.plot.simulation(run).savefig(folder / "simulation.svg")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], Path(sys.argv[3]))
