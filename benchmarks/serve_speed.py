#!/usr/bin/python3
"""What HTTP costs beside the library: analyze over one connection of `zwidth serve` against zwidth.analyze, medians.

usage: PYTHONPATH=build/release/python benchmarks/serve_speed.py [PROGRAM [DEVICE]]
"""

import http.client
import json
import statistics
import subprocess
import sys
import time
import urllib.parse
from pathlib import Path

import zwidth

CALLS = 1000


def median_ms(work):
    times = []
    for _ in range(CALLS):
        begun = time.perf_counter()
        work()
        times.append(1e3 * (time.perf_counter() - begun))
    return statistics.median(times)


def main(program="build/release/bin/zwidth", file="devices/lhifam.toml"):
    device = zwidth.Device.from_toml(file)
    stiffness = zwidth.analyze(device).critical_stiffness
    body = json.dumps({"device_toml": Path(file).read_text(encoding="utf-8")})
    server = subprocess.Popen([program, "serve", "--port", "0"], stdout=subprocess.PIPE, text=True)
    try:
        address = urllib.parse.urlsplit(server.stdout.readline().strip())
        connection = http.client.HTTPConnection(address.hostname, address.port)

        def ask():
            connection.request("POST", "/api/v1/analyze", body, {"Content-Type": "application/json"})
            return json.load(connection.getresponse())

        if ask()["critical_stiffness"] != stiffness:
            raise SystemExit("the server's answer is not the library's")
        served = median_ms(ask)
        library = median_ms(lambda: zwidth.analyze(device))
        print(f"analyze: {library:.3f} ms in Python, {served:.3f} ms over HTTP (medians of {CALLS})")
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
