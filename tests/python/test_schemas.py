"""docs/schemas holds for what the program prints, names every key, and notices one that is missing, new or mistyped.

ZWIDTH_WRITE_SCHEMAS=1 writes docs/schemas anew, from the documents of this test: read the difference before it is kept.
"""

import json
import os
import re
from collections import defaultdict

import jsonschema
import pytest
import zwidth
from command_line import answers
from conftest import ROOT
from schema_of_documents import published
from test_same_answer import CALLS, words_of

SCHEMAS = ROOT / "docs/schemas"
COLUMNS = ["--force", "force", "--position", "position"]
CHIRP, MOTION, LHIFAM = "recordings/locked_chirp.csv", "recordings/free_motion.csv", "devices/lhifam.toml"
ARM = "devices/mechanisms/planar_arm.toml"
STUDY = ["--study", "devices/studies/lhifam.toml", "--samples", "300"]
OTHERS = [
    ["frf", CHIRP, *COLUMNS, "--points"],
    ["frf", MOTION, *COLUMNS],
    ["frf", CHIRP, "--list"],
    ["frf", CHIRP, *COLUMNS, "--aperiodic", "--lines", "1,2.5,7"],
    ["identify", CHIRP, *COLUMNS, "--structure", LHIFAM, "--free", "link.stiffness,link.damping", "--locked", "handle", "--points"],
    ["identify", CHIRP, *COLUMNS, "--structure", LHIFAM, "--free", "link.stiffness,link.damping", "--locked", "handle"],
    ["identify", MOTION, *COLUMNS, "--structure", "rigid"],
    ["identify", MOTION, *COLUMNS, "--method", "inverse-dynamics"],
    ["identify", MOTION, *COLUMNS, "--method", "frequency-response", "--structure", "rigid"],
    ["identify", "--structure", LHIFAM, "--free", "body.handle.damping", "--limit", "K=8000,B=0,hz=6"],
    ["relay", LHIFAM, "--recording", CHIRP, *COLUMNS],
    ["diagnose", LHIFAM, "--recording", CHIRP, "--position", "position"],
    ["simulate", LHIFAM, "--user-force", CHIRP, "--user-force-column", "force", "--duration", "0.5", "--wall-position", "0"],
    ["analyze", LHIFAM, "--set", "wall.stiffness=3000", "--set", "wall.damping=10", "--set", "sensor.resolution=1e-6"],
    ["analyze", LHIFAM, "--set", "body.motor.coulomb=1", "--set", "sensor.resolution=1e-6", "--set", "wall.stiffness=90000"],
    ["analyze", LHIFAM, "--users", "mass=0:2,damping=0:20,stiffness=0:2000"],
    ["design", LHIFAM, "--target", "6000", "--any-user"],
    ["study", LHIFAM, *STUDY],
    ["study", LHIFAM, *STUDY, "--rare-samples", "300"],
    ["study", LHIFAM, "--study", "devices/studies/lhifam.toml", "--samples", "400", "--region-units", "400"],
    ["study", "devices/lhifam_reduced_pretension.toml", *STUDY],
    ["rig", "check", LHIFAM, "--duration", "0.2"],
    ["rig", "check", LHIFAM, "--set", "loop.sampling_period=0.02", "--real-time", "--duration", "0.2"],
    ["rig", "measure", LHIFAM, "--duration", "1"],
    ["rig", "wall", LHIFAM, "--set", "wall.stiffness=3000", "--duration", "1"],
    ["rig", "limit", LHIFAM],
    ["rig", "relay", LHIFAM],
    ["rig", "relay", "devices/lhifam_rigid.toml"],
    ["rig", "identify", LHIFAM, "--duration", "4"],
    *[["simulate", LHIFAM, "--duration", "0.2", "--user-force", force] for force in ("step:5@0.1", "ramp:5@0.1", "sine:1,5@0")],
    *[["rig", action, LHIFAM, "--velocity-limit", "1e-9"] for action in ("measure", "identify", "relay", "limit")],
    ["rig", "limit", LHIFAM, "--ceiling", "100", "--from", "90"],
    ["excite", "--amplitude", "1"],
    ["workspace", ARM, "--poses", "shoulder=0,elbow=0:2:3", "--stiffness", "300"],
    ["workspace", ARM, "--points", "0.3,0.2,0;2,0,0", "--normals", "1,0,0;0,1,0", "--all-directions"],
    ["workspace", ARM, "--points", "2,0,0"],
    ["workspace", "devices/mechanisms/pantograph.toml", "--poses", "theta1=30:60:2deg,theta5=120:150:2deg"],
]
LOOP = "[loop]\nsampling_period = 1e-3\n"
BODY = '[[body]]\nname = "a"\nmass = 1\ndamping = 1\n'
FILTERS = """[[wall.filter]]
type = "low_pass"
frequency_hz = 300
order = 2
[[wall.filter]]
type = "notch"
frequency_hz = 60
[[wall.filter]]
type = "lead_lag"
frequency_hz = 30
ratio = 1.5
[[wall.filter]]
type = "biquad"
frequency_hz = 20
numerator = [1e-8, 1e-4, 1]
denominator = [1e-8, 2e-4, 1]
[[wall.filter]]
type = "digital"
numerator = [1]
denominator = [1, 0.1]
"""
# with a warning of its own; with nobody to hold it; that no wall leaves stable; ...
DEVICES = {
    "all_keys": BODY.replace("name", "stiffness = 1\ncoulomb = 0.1\nname") + LOOP + "delay = 1e-4\n"
    "[actuator]\ntime_constant = 1e-4\nforce_limit = 10\n[sensor]\nresolution = 1e-6\n[operator]\nmass = 1\ndamping = 2\nstiffness = 3\n"
    "[driver]\ntravel = 0.01\ngear = 2\nsign = -1\ntorque_constant = 0.1\ntorque_per_volt = 0.2\nid = 1\ncommand = 'M'\nbaud = 115200\n"
    "[wall]\nstiffness = 100\ndamping = 1\nvelocity_filter_hz = 50\n"
    "[uncertainty]\nparameters = ['body.a.mass']\ncovariance = [[1e-4]]\nverdict = 'doubtful'\nwarning = 'guessed'\nreasons = ['one']\nassumed = ['loop.delay']\n",
    "filters": BODY + LOOP + "[wall]\nstiffness = 10\n" + FILTERS,
    "low_pass": BODY + LOOP + FILTERS.split("[[wall.filter]]\ntype = \"notch")[0].replace("order = 2", "order = 1"),
    "uncertain": BODY + LOOP + "[uncertainty]\nparameters = ['body.a.mass']\ncovariance = [[1e-4]]\n",
    "refused": (ROOT / LHIFAM).read_text() + "[wall]\nstiffness = 10\n[uncertainty]\nverdict = 'refused'\n",
    "lag": "[transfer_function]\nnumerator = [1e-9]\ndenominator = [1, 1000]\n" + LOOP,
    "nine_bodies": "".join(f'[[body]]\nname = "b{i}"\nmass = 0.1\ndamping = 0.1\n' for i in range(9))
    + "".join(f'[[link]]\nbetween = ["b{i}", "b{i + 1}"]\nstiffness = 2e4\ndamping = 1\n' for i in range(8)) + LOOP,
    "doubtful": '[[body]]\nname = "a"\nmass = 1\ndamping = 1\n[loop]\nsampling_period = 1e-3\n[uncertainty]\nwarning = "misfit"\n',
    "transfer_function": "[transfer_function]\nnumerator = [1]\ndenominator = [1, 2, 0]\n[loop]\nsampling_period = 1e-3\n",
    "undamped": '[[body]]\nname = "a"\nmass = 1\n[loop]\nsampling_period = 1e-3\n',
}


@pytest.fixture(scope="module")
def documents(random_devices, device_files, tmp_path_factory):
    """What every command prints, by its schema."""
    folder = tmp_path_factory.mktemp("others")
    for name, text in DEVICES.items():
        (folder / f"{name}.toml").write_text(text)
    files = [*sorted(folder.glob("*.toml")), *device_files, *random_devices[:30]]
    (folder / "study.toml").write_text("[[parameter]]\nkey = 'link.stiffness'\ndistribution = 'uniform'\nrelative_tolerance = 0.1\n")
    devices = [zwidth.Device.from_toml(file) for file in files]
    asked = [words_of(call, *each) for call in CALLS for each in list(zip(devices, files))[:21]]
    asked += [["study", folder / "refused.toml", *STUDY[2:], "--study", folder / "study.toml", "--json"]]
    asked += [["rig", action, folder / f"{name}.toml", "--set", "wall.stiffness=10", "--duration", "0.2", "--json"] for action in ("check", "wall") for name in ("filters", "nine_bodies")]
    asked += [["rig", "limit", folder / f"{name}.toml", "--duration", "0.2", "--json"] for name in ("lag", "nine_bodies")]
    asked += [["design", folder / "refused.toml", *rest, "--json"] for rest in (["--notch"], ["--compare", "loop.delay=0,0.01", "--operator", "1,2,3"])]
    asked += [[*words, "--json"] for words in OTHERS]
    found = defaultdict(list)
    for words, (text, status) in zip(asked, answers(asked, tmp_path_factory.mktemp("documents"))):
        if text:
            document = json.loads(text)
            found[document["schema"]].append(document)
        else:
            assert words[:-1] not in OTHERS, f"{words}: exit status {status}"
    if os.environ.get("ZWIDTH_WRITE_SCHEMAS"):
        SCHEMAS.mkdir(exist_ok=True)
        for name, each in found.items():
            file_of(name).write_text(json.dumps(published(name, each), indent=1) + "\n")
    return found


def file_of(name):
    return SCHEMAS / f"{name.replace('/', '.')}.json"


def validator(name):
    schema = json.loads(file_of(name).read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def test_every_document_keeps_its_schema(documents):
    for name, each in documents.items():
        judge = validator(name)
        for document in each:
            wrong = [f"{name}{error.json_path[1:]}: {error.message[:300]}" for error in judge.iter_errors(document)]
            assert not wrong, wrong
    print(", ".join(f"{len(each)} {name}" for name, each in sorted(documents.items())))


def test_every_schema_is_tried_and_every_document_has_one(documents):
    published_names = {path.name.removesuffix(".1.json") + "/1" for path in SCHEMAS.glob("*.json")}
    assert published_names == set(documents)
    source = "".join(path.read_text() for path in (ROOT / "apps/results").glob("*.cpp"))
    assert set(re.findall(r'"(zwidth\.\w+/1)"', source)) - {"zwidth.text/1"} <= published_names
    told = (ROOT / "docs/schemas.md").read_text()
    for name in published_names:
        assert f"schemas/{file_of(name).name}" in told, name


def test_what_is_missing_new_or_mistyped_is_noticed(documents):
    for name, each in documents.items():
        judge = validator(name)
        document = each[0]
        assert not judge.is_valid({**document, "critical_stifness": 1})
        for key, value in document.items():
            if key in json.loads(file_of(name).read_text())["required"]:
                assert not judge.is_valid({k: v for k, v in document.items() if k != key}), f"{name}: {key} missing"
            if value is not None:
                assert not judge.is_valid({**document, key: 7 if isinstance(value, str) else "seven"}), f"{name}: {key} mistyped"
