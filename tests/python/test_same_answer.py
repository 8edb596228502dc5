"""Every command says the same from Python as on the command line, byte for byte."""

import json
import os
import warnings
from concurrent.futures import ThreadPoolExecutor

import pytest
import zwidth
from command_line import answers


def options_of(call, device):
    """The options of a call for this device, in its own time: arguments of the program, keywords of the function."""
    period = device.sampling_period
    if call == "sweep":
        axis = f"loop.delay=0:{2 * period!r}:3"
        return ["design", "--sweep", axis], lambda: zwidth.sweep(device, axis)
    if call == "compare":
        values = f"loop.delay=0,{period!r}"
        return ["design", "--compare", values], lambda: zwidth.compare(device, values)
    if call == "target":
        return ["design", "--target", "1000"], lambda: zwidth.design_targets(device, 1000)
    if call == "notch":
        return ["design", "--notch", "--drift-percent", "10"], lambda: zwidth.design_notch(device, drift_percent=10)
    if call == "recommend":
        return (
            ["design", "--recommend", "--phase-margin-deg", "0", "--ripple", "0.2"],
            lambda: zwidth.recommend_wall(device, phase_margin_deg=0, ripple=0.2),
        )
    if call == "diagnose":
        hz = 1 / (6 * period)
        return ["diagnose", "--oscillates-hz", repr(hz)], lambda: zwidth.diagnose(device, oscillates_hz=hz)
    if call == "simulate":
        duration = max(400 * period, 3 * device.delay)
        return (
            ["simulate", "--set", "wall.stiffness=30", "--duration", repr(duration), "--wall-position", "1e-3", "--points"],
            lambda: zwidth.simulate(
                device.with_(wall__stiffness=30), duration=duration, wall_position=1e-3, points=True
            ),
        )
    if call == "relay":
        duration = max(500 * period, 2 * device.delay)
        words = ["--amplitude", "0.5", "--duration", repr(duration), "--trials", "1", "--segment", "256"]
        return (
            ["relay", *words],
            lambda: zwidth.relay(device, amplitude=0.5, duration=duration, trials=1, segment=256),
        )
    if call == "excite":
        rate = 1 / period
        values = {"amplitude": 0.25, "duration": 1000 / rate, "lowest_hz": 0.02 * rate, "highest_hz": 0.2 * rate}
        words = [word for key, value in values.items() for word in (f"--{key.replace('_', '-')}", repr(value))]
        return ["excite", "--kind", "multisine", *words], lambda: zwidth.excite(device, kind="multisine", **values)
    if call == "export":
        return ["export", "--format", "json"], lambda: zwidth.model(device)
    if call == "bode":
        return ["bode", "--points", "50"], lambda: zwidth.bode(device, points=50)
    if call == "worst_user":
        return ["analyze", "--worst-user"], lambda: zwidth.analyze(device, worst_user=True)
    return [call], lambda: getattr(zwidth, call)(device)


# How many of the random devices each is asked about: one of each of the 21 kinds. ZWIDTH_CAMPAIGN_DEVICES=200 asks everything
# about all of them, which takes minutes.
KINDS = 21
CALLS = [
    "analyze", "bode", "sweep", "compare", "simulate", "excite", "export", "worst_user", "diagnose", "design", "relay",
    "region", "target", "recommend", "notch",
]  # fmt: skip
FEWER = {"notch": 6, "recommend": 6}  # half a second of processor and more for each, twice


def words_of(call, device, file):
    words, _ = options_of(call, device)
    place = ["--device", file] if call == "excite" else [file]
    return [words[0], *place, *words[1:], *([] if call == "export" else ["--json"])]


def python_answer(call, device):
    """The line, or None where the call raises."""
    _, ask = options_of(call, device)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            result = ask()
        except zwidth.Error:
            return None
    line = result.to_json()
    assert result.to_dict() == json.loads(line)
    return line


def compare_all(files, calls, folder):
    devices = [zwidth.Device.from_toml(file) for file in files]
    asked = [(call, device, file) for call in calls for device, file in zip(devices, files)]
    with ThreadPoolExecutor(1) as pool:
        printed = pool.submit(answers, [words_of(*each) for each in asked], folder)
        mine = [python_answer(call, device) for call, device, _ in asked]
        theirs = printed.result()
    same = 0
    for (call, _, file), line, (text, status) in zip(asked, mine, theirs):
        assert line == (text or None), f"{call} {file}: exit status {status}"
        same += line is not None
    return len(asked), same


def test_every_command_on_the_devices(device_files, tmp_path):
    asked, same = compare_all(device_files, CALLS, tmp_path)
    print(f"{asked} commands on devices/, {same} with an answer, all the same")
    assert same > asked / 2


@pytest.mark.parametrize("call", CALLS)
def test_random_devices(call, random_devices, tmp_path):
    count = int(os.environ.get("ZWIDTH_CAMPAIGN_DEVICES", FEWER.get(call, KINDS)))
    asked, same = compare_all(random_devices[:count], [call], tmp_path)
    print(f"{call}: {asked} devices, {same} with an answer, all the same")
    assert same > asked / 3


EXPORTS = {"octave": {}, "python": {}, "json": {}, "c": {"safety_factor": 0.5}, "chai3d": {"safety_factor": 0.5}}


def test_exported_texts(device_files, random_devices, tmp_path):
    files = [*device_files, *random_devices[: int(os.environ.get("ZWIDTH_CAMPAIGN_DEVICES", KINDS))]]
    asked = [(file, form, options) for form, options in EXPORTS.items() for file in files]
    words = [
        ["export", file, "--format", form, *(w for key, value in options.items() for w in (f"--{key.replace('_', '-')}", value))]
        for file, form, options in asked
    ]
    same = dict.fromkeys(EXPORTS, 0)
    for (file, form, options), (text, status) in zip(asked, answers(words, tmp_path)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                mine = zwidth.export(zwidth.Device.from_toml(file), form, **options)
            except zwidth.Error:
                mine = ""
        assert mine == text, f"{file} as {form}: exit status {status}"
        same[form] += text != ""
    print(f"{len(files)} devices, exported alike: {same}")
    assert all(count > len(files) / 3 for count in same.values())


STUDY = {
    "samples": 60,
    "sampling": "latin-hypercube",
    "specification": {"critical_stiffness": 300},
    "parameter": [{"key": "loop.sampling_period", "distribution": "uniform", "relative_tolerance": 0.2}],
}
STUDY_TEXT = """samples = 60
sampling = "latin-hypercube"
specification.critical_stiffness = 300
[[parameter]]
key = "loop.sampling_period"
distribution = "uniform"
relative_tolerance = 0.2
"""


def test_studies(device_files, random_devices, tmp_path):
    """A study as a path, as a text and as a dict."""
    path = tmp_path / "study.toml"
    path.write_text(STUDY_TEXT)
    files = [*device_files, *random_devices[:3]]
    words = [["study", file, "--study", path, "--index-samples", "16", "--seed", "3", "--json"] for file in files]
    same = 0
    for file, (text, status) in zip(files, answers(words, tmp_path)):
        device = zwidth.Device.from_toml(file)
        for study in (path, STUDY_TEXT, STUDY):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                try:
                    result = zwidth.study(device, study, index_samples=16, seed=3)
                except zwidth.Error:
                    assert text == "", f"{file}: exit status {status}"
                    continue
            assert result.to_json() == text, f"{file}: exit status {status}"
            same += 1
        if text and json.loads(text)["worst"]:
            found = zwidth.critical_stiffness(result.worst_device())
            if found.status == "finite":
                assert found.critical_stiffness == pytest.approx(result.worst.critical_stiffness, rel=1e-12)
    print(f"{3 * len(files)} studies, {same} with an answer, all the same")
    assert same > len(files)


def test_recordings(tmp_path):
    """The commands about recordings, by the same paths; words without blanks, as answers() takes them."""
    chirp, motion, lhifam = "recordings/locked_chirp.csv", "recordings/free_motion.csv", "devices/lhifam.toml"
    device = zwidth.Device.from_toml(lhifam)
    columns = {"force": "force", "position": "position"}
    words = ["--force", "force", "--position", "position"]
    structure = {"structure": device, "free": "link.stiffness,link.damping", "locked": "handle"}
    asked = [
        (["frf", chirp, *words, "--points"], lambda: zwidth.frequency_response(chirp, points=True, **columns)),
        (["frf", chirp, motion, *words], lambda: zwidth.frequency_response(chirp, motion, **columns)),
        (["frf", chirp, "--force", "2", "--position", "3", "--aperiodic", "--lines", "1,2.5,7"],
         lambda: zwidth.frequency_response(chirp, force=2, position=3, aperiodic=True, lines=[1, 2.5, 7])),
        (["identify", chirp, *words, "--structure", lhifam, "--free", structure["free"], "--locked", "handle", "--points"],
         lambda: zwidth.identify(chirp, points=True, **structure, **columns)),
        (["identify", motion, *words, "--structure", "rigid"], lambda: zwidth.identify(motion, structure="rigid", **columns)),
        (["identify", motion, *words, "--method", "inverse-dynamics"],
         lambda: zwidth.identify(motion, method="inverse-dynamics", **columns)),
        (["identify", motion, *words, "--method", "frequency-response", "--structure", "rigid"],
         lambda: zwidth.identify(motion, method="frequency-response", structure="rigid", **columns)),
        (["identify", "--structure", lhifam, "--free", "body.handle.damping", "--limit", "K=8000,B=0,hz=6"],
         lambda: zwidth.identify(structure=device, free="body.handle.damping", limit="K=8000,B=0,hz=6")),
        (["relay", lhifam, "--recording", chirp, *words], lambda: zwidth.relay(device, recording=chirp, **columns)),
        (["diagnose", lhifam, "--recording", chirp, "--position", "position"],
         lambda: zwidth.diagnose(device, recording=chirp, position="position")),
        (["simulate", lhifam, "--user-force", chirp, "--user-force-column", "force", "--duration", "0.5", "--wall-position", "0"],
         lambda: zwidth.simulate(device, user_force=chirp, user_force_column="force", duration=0.5, wall_position=0)),
    ]  # fmt: skip
    theirs = answers([[*each, "--json"] for each, _ in asked], tmp_path)
    same = 0
    for (each, call), (text, status) in zip(asked, theirs):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                line = call().to_json()
            except zwidth.Error:
                line = ""
        assert line == text, f"{each}: exit status {status}"
        same += line != ""
    print(f"{len(asked)} commands about recordings, {same} with an answer, all the same")
    assert same >= 8
