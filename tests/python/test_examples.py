"""The examples run, and are typed; every snippet of docs/python.md runs; figures are drawn."""

import os
import re
import subprocess
import sys

import matplotlib.pyplot as plt
import pytest
import zwidth
from conftest import ROOT


def test_examples_run(tmp_path):
    for words in (
        ["analyse_a_device.py", "devices/lhifam.toml"],
        ["identify_and_simulate.py", "devices/lhifam.toml", "recordings/locked_chirp.csv", str(tmp_path)],
        ["many_devices.py", "devices/lhifam.toml", "200"],
    ):
        done = subprocess.run([sys.executable, f"examples/python/{words[0]}", *words[1:]], capture_output=True, text=True)
        assert done.returncode == 0 and done.stdout, done.stderr
    assert (tmp_path / "fit.svg").stat().st_size > 1000 and (tmp_path / "simulation.svg").stat().st_size > 1000


def test_examples_and_package_are_typed(tmp_path):
    package = os.path.dirname(zwidth.__file__)
    for target in ("examples/python", package):
        done = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", f"--cache-dir={tmp_path}", target],
            capture_output=True, text=True, env=dict(os.environ, MYPYPATH=os.path.dirname(package)),
        )  # fmt: skip
        assert done.returncode == 0, done.stdout + done.stderr


def test_the_stub_names_what_the_module_has():
    core = zwidth._core
    stub = open(os.path.join(os.path.dirname(zwidth.__file__), "_core.pyi")).read()
    for name in dir(core):
        if not name.startswith("__"):
            assert re.search(rf"(def|class) {name}\b", stub), name
    for kind in (core.Device, core.CriticalStiffness, core.AnyUserLimit, core.Answer):
        body = stub.split(f"class {kind.__name__}:")[1].split("\nclass ")[0]
        for name in vars(kind):
            if not name.startswith("_"):
                assert f"def {name}(" in body, f"{kind.__name__}.{name}"


def test_every_snippet_of_the_documents(tmp_path, monkeypatch):
    for name in ("devices", "recordings"):
        (tmp_path / name).symlink_to(ROOT / name)
    text = (ROOT / "docs" / "python.md").read_text()
    snippets = re.findall(r"^```python\n(.*?)^```$", text, re.M | re.S)
    assert len(snippets) > 5
    monkeypatch.chdir(tmp_path)
    names = {}
    for snippet in snippets:
        exec(compile(snippet, "docs/python.md", "exec"), names)
    plt.close("all")
    readme = re.findall(r"^```python\n(.*?)^```$", (ROOT / "README.md").read_text(), re.M | re.S)
    assert readme
    for snippet in readme:
        exec(compile(snippet, "README.md", "exec"), {})


@pytest.mark.filterwarnings("ignore::zwidth.ResultWarning")
def test_figures(lhifam, tmp_path):
    columns = {"force": "force", "position": "position"}
    recording = "recordings/locked_chirp.csv"
    figures = [
        zwidth.plot.bode(lhifam, points=50),
        zwidth.plot.region(lhifam),
        zwidth.plot.frf(zwidth.frequency_response(recording, points=True, **columns)),
        zwidth.plot.sweep(zwidth.sweep(lhifam, "loop.delay=0:4e-3:9", any_user=True)),
        zwidth.plot.sweep(zwidth.sweep(lhifam, ["loop.delay=0:4e-3:5", "link.damping=5:50:4"])),
        zwidth.plot.simulation(lhifam.with_(wall__stiffness=5000), duration=0.5),
        zwidth.plot.simulation(zwidth.simulate(zwidth.Device.from_toml("devices/emps.toml").with_(wall__stiffness=500), duration=0.1, points=True)),
    ]
    for number, figure in enumerate(figures):
        figure.savefig(tmp_path / f"{number}.png", dpi=60)
        assert (tmp_path / f"{number}.png").stat().st_size > 5000
    plt.close("all")
    doubtful = zwidth.Device.from_toml(lhifam.to_toml() + '\n[uncertainty]\nwarning = "misfit"\n')
    assert "DOUBTFUL" in zwidth.plot.bode(doubtful)._suptitle.get_text()
    plt.close("all")
    with pytest.raises(zwidth.InputError, match="points=True"):
        zwidth.plot.simulation(zwidth.simulate(lhifam.with_(wall__stiffness=5000), duration=0.1))
