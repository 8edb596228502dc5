"""A device, the stiffest wall it renders stably, what limits it, and the wall to render.

usage: analyse_a_device.py DEVICE.toml
"""

import sys

import zwidth


def main(path: str) -> None:
    device = zwidth.Device.from_toml(path)
    analysis = zwidth.analyze(device)
    print(f"{device.name}: status {analysis.status}, trust {analysis.trust.verdict}")
    if analysis.critical_stiffness is not None and analysis.limited_by is not None:
        print(f"  K_CR {analysis.critical_stiffness:.1f} {analysis.units.stiffness}, limited by {analysis.limited_by.kind}")
    if analysis.any_user is not None and analysis.any_user.critical_stiffness is not None:
        print(f"  for any passive user {analysis.any_user.critical_stiffness:.1f} {analysis.units.stiffness}")
    recommended = zwidth.recommend_wall(device, gain_margin_db=6, phase_margin_deg=30)
    if recommended.wall is not None:
        print(f"  render K = {recommended.wall.stiffness:.1f}, B = {recommended.wall.damping:.2f}")
    for delay in ("0 ms", "1 ms", "2 ms"):
        print(f"  with a delay of {delay}: {zwidth.critical_stiffness(device.with_(loop__delay=delay)).critical_stiffness}")


if __name__ == "__main__":
    main(sys.argv[1])
