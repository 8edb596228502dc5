"""What a call costs beside the library's own work; printed, not judged: other programs run on this machine."""

import threading
import time

import numpy as np
import zwidth


def seconds(call, repeats):
    times = []
    for _ in range(repeats):
        begun = time.perf_counter()
        call()
        times.append(time.perf_counter() - begun)
    return sorted(times)[repeats // 2]


def test_call_overhead(lhifam):
    python = seconds(lambda: zwidth.critical_stiffness(lhifam), 2001)
    library = zwidth._core.seconds_of_critical_stiffness(lhifam, 2001)
    print(f"critical_stiffness(device): {1e6 * python:.1f} us, of the library {1e6 * library:.1f} us, "
          f"above it {1e6 * (python - library):.1f} us (medians of 2001)")  # fmt: skip


def test_two_threads(lhifam):
    def work():
        for _ in range(1500):
            zwidth.critical_stiffness(lhifam)

    def pair():
        threads = [threading.Thread(target=work) for _ in range(2)]
        for each in threads:
            each.start()
        for each in threads:
            each.join()

    one, two = seconds(work, 3), seconds(pair, 3)
    print(f"two threads do {2 * one / two:.2f} times the work of one")
    changes = {"loop.delay": np.linspace(0.0, 4e-3, 1500)}
    many = seconds(lambda: zwidth.critical_stiffness_many(lhifam, changes), 3)
    print(f"critical_stiffness_many: {1e6 * many / 1500:.1f} us per device on all cores")
