"""The examples run, and are typed; every Python snippet of the documents runs, and both notebooks; figures are drawn."""

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
    for kind in (core.Device, core.CriticalStiffness, core.AnyUserLimit, core.Answer,
                 core.Mechanism, core.MechanismAtPose, core.MechanismJoint, core.ReachedPose):
        body = stub.split(f"class {kind.__name__}:")[1].split("\nclass ")[0]
        for name in vars(kind):
            if not name.startswith("_"):
                assert f"def {name}(" in body, f"{kind.__name__}.{name}"


def snippets(path, language):
    return re.findall(rf"^```{language}\n(.*?)^```$", path.read_text(), re.M | re.S)


DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


@pytest.mark.parametrize("path", [p for p in DOCUMENTS if snippets(p, "python")], ids=lambda path: path.stem)
def test_every_snippet_of_the_documents(path, tmp_path, monkeypatch):
    """Those of one document run one after the other: what one names the next may use."""
    for name in ("devices", "recordings"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)
    names = {}
    for snippet in snippets(path, "python"):
        exec(compile(snippet, str(path), "exec"), names)
    plt.close("all")


def test_octave_of_the_comparison():
    """docs/comparison.md says what Octave answers, and that it is 3.8 times too high."""
    (code,) = snippets(ROOT / "docs" / "comparison.md", "octave")
    done = subprocess.run(["octave", "--quiet", "--eval", code], capture_output=True, text=True)
    assert done.stdout.strip() == "33895.5", done.stdout + done.stderr


@pytest.mark.parametrize("path", sorted((ROOT / "examples/notebooks").glob("*.ipynb")), ids=lambda path: path.stem)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_notebooks_run_and_are_without_output(path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    notebook = nbformat.read(path, as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert len(code) > 2
    assert all(cell.execution_count is None and not cell.outputs for cell in code), "has output"
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(ROOT)}}).execute()
    assert any(cell.outputs for cell in code)


def test_firmware(tmp_path):
    """The file of `export --format c` in the loop of examples/firmware."""
    exported = subprocess.run(
        [os.environ["ZWIDTH_PROGRAM"], "export", "devices/lhifam.toml", "--format", "c", "--safety-factor", "0.5",
         "--output", str(tmp_path / "wall.c")], capture_output=True, text=True,
    )  # fmt: skip
    assert exported.returncode == 0, exported.stderr
    program = tmp_path / "firmware"
    built = subprocess.run(
        ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-I", str(tmp_path), "examples/firmware/main.c", "-o", str(program), "-lm"],
        capture_output=True, text=True,
    )  # fmt: skip
    assert built.returncode == 0, built.stderr
    done = subprocess.run([str(program)], capture_output=True, text=True, check=True)
    limit = zwidth.any_user_limit(zwidth.Device.from_toml("devices/lhifam.toml")).critical_stiffness
    force = float(re.search(r"inside: (\S+) N", done.stdout)[1])
    assert force == pytest.approx(-0.5e-3 * limit, abs=1e-6)


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
