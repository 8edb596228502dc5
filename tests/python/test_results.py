"""Results: every key is declared, arrays are NumPy's over their own memory, recordings come from files and arrays."""

import json
import keyword
import math
import pickle
import subprocess
import warnings
from pathlib import Path

import numpy as np
import pandas
import pytest
import zwidth
from command_line import answers
from conftest import PROGRAM, ROOT
from zwidth._results import CLASSES


def some_results(device):
    files = "recordings/locked_chirp.csv"
    columns = {"force": "force", "position": "position"}
    yield zwidth.analyze(device.with_(wall__stiffness=5000), worst_user=True, users="mass=0:2")
    yield zwidth.bode(device)
    yield zwidth.region(device)
    yield zwidth.design(device)
    yield zwidth.sweep(device, "loop.delay=0:4e-3:3", any_user=True)
    yield zwidth.compare(device, "loop.delay=0,1e-3")
    yield zwidth.design_targets(device, 12000)
    yield zwidth.recommend_wall(device)
    yield zwidth.diagnose(device, oscillates_hz=6.3, stiffness=9500)
    yield zwidth.simulate(device, points=True, duration=0.5, set="wall.stiffness=5000")
    yield zwidth.relay(device, amplitude=5, trials=1, duration=2)
    yield zwidth.study(device, "devices/studies/lhifam.toml", samples=300, index_samples=0)
    yield zwidth.workspace(zwidth.Device.from_toml("devices/mechanisms/planar_arm.toml"), poses={"elbow": [1.2]}, directions=6)
    yield zwidth.excite(amplitude=1, lowest_hz=1, highest_hz=100, rate=1000, duration=5)
    yield zwidth.frequency_response(files, points=True, **columns)
    yield zwidth.identify(
        files, structure=device, free="link.stiffness,link.damping", locked="handle", points=True, **columns
    )
    yield zwidth.identify("recordings/free_motion.csv", method="inverse-dynamics", **columns)
    yield zwidth.design_notch(zwidth.Device.from_toml("devices/lhifam_reduced_pretension.toml"), drift_percent=10)


@pytest.mark.filterwarnings("ignore")
def test_every_key_is_a_documented_attribute(lhifam):
    seen = set()
    for result in some_results(lhifam):
        document = result.to_dict()
        seen.add(document["schema"])
        assert type(result) is CLASSES[document["schema"]]
        for key in document:
            name = f"{key}_" if keyword.iskeyword(key) else key
            declared = getattr(type(result), name, None)
            assert declared is not None and declared.__doc__, f"{type(result).__name__}.{key} is not declared"
            getattr(result, name)
        assert type(result).__doc__ and "<table>" in result._repr_html_() and type(result).__name__ in repr(result)
        declared = {key for kind in type(result).__mro__ for key, field in vars(kind).items() if hasattr(field, "_read")}
        name = document["schema"].replace("/", ".")
        schema = json.loads((ROOT / f"docs/schemas/{name}.json").read_text())
        assert {key.rstrip("_") for key in declared} == set(schema["properties"]), type(result).__name__
    assert seen == set(CLASSES)


def test_arrays_are_views_that_live_by_themselves(lhifam):
    sampled = zwidth.bode(lhifam).sampled
    frequency = sampled.frequency_rad_s
    assert frequency is sampled.frequency_rad_s and frequency.dtype == np.float64
    assert not frequency.flags.owndata and not frequency.flags.writeable
    expected = zwidth.bode(lhifam).to_dict()["sampled"]["frequency_rad_s"]
    del sampled
    assert frequency.tolist() == expected
    force = zwidth.relay(lhifam, amplitude=5, trials=1, duration=2).force()
    assert force.shape == (2000,) and set(np.abs(force)) == {5.0}


def test_nested_values_are_attributes(lhifam):
    analysis = zwidth.analyze(lhifam)
    assert analysis.limited_by.kind == "rigid_body" and analysis.limited_by.mode is None
    assert analysis.crossovers[0].stiffness == analysis.critical_stiffness
    assert analysis.trust.verdict == "sound" and analysis.wall is None
    assert analysis.stable_intervals[0] == (0.0, analysis.critical_stiffness)
    with pytest.raises(AttributeError, match="has no 'nothing'"):
        analysis.nothing
    with pytest.raises(AttributeError):
        analysis.critical_stiffness = 1.0
    assert zwidth.critical_stiffness(lhifam).critical_stiffness == analysis.critical_stiffness
    assert zwidth.any_user_limit(lhifam).critical_stiffness == analysis.any_user.critical_stiffness


KNOB = """name = "knob"
motion = "rotary"
[[body]]
name = "knob"
inertia = 2e-3
damping = 7.1e-3
[loop]
sampling_period = 1e-3
[operator]
damping = 6.5e-2
[wall]
stiffness = 40
"""


def test_limits_say_who_holds(lhifam):
    """A knob that its user damps: the limit with the user was called the device's."""
    knob = zwidth.Device.from_toml(KNOB)
    analysis = zwidth.analyze(knob)
    assert analysis.limits.nobody.critical_stiffness == pytest.approx(14.2, abs=0.05)
    assert analysis.limits.user.critical_stiffness == analysis.critical_stiffness > 135
    assert analysis.limits.any_user.critical_stiffness == analysis.any_user.critical_stiffness
    assert analysis.limits.nobody.limited_by.kind == "rigid_body" and analysis.limits.any_user.limited_by is None
    assert analysis.wall.stable is False
    assert (analysis.wall.stable_for.nobody, analysis.wall.stable_for.user, analysis.wall.stable_for.any_user) == (False, True, False)
    assert analysis.to_dict()["limits"]["nobody"]["critical_stiffness"] == analysis.limits.nobody.critical_stiffness
    assert zwidth.critical_damping(knob).critical_damping == analysis.limits.user.critical_damping
    free = knob.with_(operator__damping=0)
    assert zwidth.critical_damping(free).critical_damping == analysis.limits.nobody.critical_damping
    assert zwidth.critical_damping(free).critical_damping_limited_by == {"kind": "rigid_body"}
    assert zwidth.any_user_damping(knob).critical_damping == analysis.limits.any_user.critical_damping
    assert zwidth.any_user_damping(knob).critical_damping == pytest.approx(7.1e-3)  # Colgate and Schenkel: b
    assert zwidth.analyze(lhifam).limits.user is None
    with pytest.raises(zwidth.InputError):
        zwidth.any_user_damping(zwidth.Device(transfer_function={"numerator": [1.0], "denominator": [1.0, 2.0, 0.0]}, loop={"sampling_period": 1e-3}))
    region = zwidth.region(knob)
    assert region.nobody_and_user.stiffest.stiffness == region.nobody.stiffest.stiffness
    assert zwidth.region(lhifam).nobody is None
    simulation = zwidth.simulate(knob, duration=0.2)
    assert simulation.linear.stable_for.nobody is False and simulation.linear.wall_stable


def test_a_device_from_keys_and_with_changes(lhifam):
    assert zwidth.Device(**lhifam.to_dict()) == lhifam
    assert zwidth.Device.from_toml(lhifam.to_toml()) == lhifam and hash(lhifam) == hash(pickle.loads(pickle.dumps(lhifam)))
    changed = lhifam.with_(link__stiffness=np.float32(8e4), body__motor__mass="250 g")
    assert changed.numbers["link.0.stiffness"] == 8e4 and changed.numbers["body.motor.mass"] == 0.25
    assert lhifam.numbers["body.motor.mass"] == 0.3
    assert changed == lhifam.with_({"link.stiffness": "80 kN/m", "body.motor.mass": 0.25})
    rotary = zwidth.Device(motion="rotary", body=[{"name": "a", "inertia": "22 kg cm^2"}], loop={"sampling_period": "1 ms"})
    assert rotary.numbers["body.a.mass"] == pytest.approx(22e-4) and rotary.motion == "rotary"
    assert zwidth.Device.from_toml(Path("devices/lhifam.toml"), set=["loop.delay=1e-3"]).delay == 1e-3


def test_recordings_from_arrays_and_pandas_are_those_of_the_file():
    path = "recordings/locked_chirp.csv"
    columns = {"force": "force", "position": "position"}
    frame = pandas.read_csv(path, comment="#")
    from_file = zwidth.frequency_response(path, **columns).to_dict()
    recordings = [frame, {key: frame[key].to_numpy() for key in frame}]
    period = from_file["sampling_period_s"]
    recordings.append(zwidth.Recording({key: list(frame[key]) for key in frame if "time" not in key}, sampling_period=period))
    for each in recordings:
        answer = zwidth.frequency_response(each, **columns).to_dict()
        for key in ("critical_stiffness", "critical_stiffness_interval", "crossovers", "measured_band_hz"):
            assert answer[key] == from_file[key]
    holes = frame.copy()
    holes.loc[5, "position"] = np.nan
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        zwidth.frequency_response(holes, **columns)
    assert any("position" in str(each.message) for each in caught)
    heard = zwidth.simulate(zwidth.Device.from_toml("devices/lhifam.toml"), duration=0.5, points=True,
                            wall_position=0.0, user_force=zwidth.Recording({"force": np.full(500, 2.0)}, sampling_period=1e-3),
                            user_force_column="force")  # fmt: skip
    assert heard.points.user_force[1] == 2.0


def test_an_identified_device_goes_on(lhifam):
    found = zwidth.identify("recordings/locked_chirp.csv", structure=lhifam, free="link.stiffness,link.damping",
                            locked="handle", force="force", position="position", points=True)  # fmt: skip
    device = found.to_device()
    assert device.numbers["link.0.stiffness"] == found.parameters[0].value
    assert zwidth.analyze(device).critical_stiffness == found.critical_stiffness
    measured = found.points.measured
    assert measured.dtype == np.complex128 and measured[0] == complex(*found.to_dict()["points"]["measured"][0])


def test_doubt_travels_as_a_warning(lhifam):
    doubtful = zwidth.Device.from_toml(lhifam.to_toml() + '\n[uncertainty]\nwarning = "misfit of 3"\n')
    sweep = lambda device: zwidth.sweep(device, "loop.delay=0:1e-3:2")
    for call in (zwidth.analyze, zwidth.critical_stiffness, zwidth.any_user_limit, zwidth.region, zwidth.bode, sweep):
        with pytest.warns(zwidth.DoubtfulResult, match="misfit of 3") as caught:
            call(doubtful)
        assert caught[0].filename == __file__
    refused = zwidth.Device.from_toml(lhifam.to_toml() + '\n[uncertainty]\nverdict = "refused"\nreasons = ["noise"]\n')
    with pytest.warns(zwidth.DoubtfulResult, match="noise"):
        assert zwidth.analyze(refused).critical_stiffness is None
        assert zwidth.critical_stiffness(refused).critical_stiffness is None
        assert zwidth.any_user_limit(refused).critical_stiffness is None
        assert [point.critical_stiffness for point in sweep(refused).points] == [None, None]
        many = zwidth.critical_stiffness_many(refused, {"loop.delay": [0.0]})
    assert np.isnan(many.critical_stiffness[0]) and many.reasons[0] == ["noise"] and many.status == ["refused"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(zwidth.DoubtfulResult):
            zwidth.critical_stiffness(doubtful)
        zwidth.analyze(lhifam)


def test_many_devices_are_each_that_device_alone(lhifam, random_devices):
    generator = np.random.default_rng(11)
    changes = {"link.stiffness": generator.uniform(1e4, 1e5, 300), "loop.delay": generator.uniform(0.0, 3e-3, 300)}
    many = zwidth.critical_stiffness_many(lhifam, changes)
    for i, (stiffness, delay) in enumerate(zip(*changes.values())):
        alone = zwidth.critical_stiffness(lhifam.with_(link__stiffness=stiffness, loop__delay=delay))
        assert math.isclose(many.critical_stiffness[i], alone.critical_stiffness, rel_tol=1e-12)
        assert math.isclose(many.critical_frequency_rad_s[i], alone.critical_frequency_rad_s, rel_tol=1e-12)
        assert many.status[i] == alone.status
        assert many.limited_by[i] == alone.limited_by
    kept = pickle.loads(pickle.dumps(many))
    assert kept.limited_by == many.limited_by and kept.status == many.status and len(kept) == 300
    many.limited_by[0]["mode"] = "mine"
    assert "mine" not in many.limited_by[1].values() and many.limited_by[0]["mode"] == "mine"
    broken = zwidth.critical_stiffness_many(lhifam, {"link.stiffness": [8e4, -1.0, np.nan, np.inf]})
    assert np.isnan(broken.critical_stiffness).tolist() == [False, True, True, True]
    assert many.scalar_count < 10 and broken.scalar_count == 3
    assert sorted(broken.reasons) == [1, 2, 3] and "link.0.stiffness" in broken.reasons[1][0]
    for file in random_devices[::7]:
        device = zwidth.Device.from_toml(file)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                alone = zwidth.critical_stiffness(device).critical_stiffness
            except zwidth.Error:
                alone = None
            period = [device.sampling_period]
            (one,) = zwidth.critical_stiffness_many(device, {"loop.sampling_period": period}).critical_stiffness
        assert alone is None and not np.isfinite(one) or math.isclose(alone, one, rel_tol=1e-12)


def test_what_an_option_says_of_itself():
    assert "worst_user" in zwidth.options("analyze") and "HZ" in zwidth.options("diagnose")["oscillates_hz"]
    assert "json" not in zwidth.options("analyze")
    with pytest.raises(zwidth.InputError):
        zwidth.options("nothing")


def test_notebooks_show_a_table(lhifam):
    assert "link" in lhifam._repr_html_() and "<pre>" in lhifam._repr_html_()
    for result in (zwidth.critical_stiffness(lhifam), zwidth.any_user_limit(lhifam), zwidth.region(lhifam)):
        assert "critical_stiffness" in result._repr_html_()


def test_an_analysis_prints_as_the_command(lhifam):
    for options, words in (({}, []), ({"set": "loop.delay=1e-3", "worst_user": True}, ["--set=loop.delay=1e-3", "--worst-user"])):
        command = [PROGRAM, "analyze", "devices/lhifam.toml", *words]
        printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        analysis = zwidth.analyze(lhifam, **options)
        # In lines of 100 letters, where a pipe gets whole paragraphs.
        assert str(analysis).split() == printed.split()
        assert max(map(len, str(analysis).splitlines())) < max(map(len, printed.splitlines()))
        assert repr(analysis).startswith("<Analysis")


def test_texts_are_exported(lhifam):
    assert "zwidth" in zwidth.export(lhifam, "octave")
    assert zwidth.model(lhifam).schema == json.loads(zwidth.model(lhifam).to_json())["schema"]


@pytest.mark.filterwarnings("ignore::zwidth.ResultWarning")
def test_what_a_structure_assumes_and_the_record_does_not_show_stays_assumed(lhifam):
    text = lhifam.to_toml() + "\n[uncertainty]\nassumed = ['link.stiffness', 'body.handle.mass', 'loop.sampling_period']\n"
    assumed = zwidth.Device.from_toml(text)
    with pytest.warns(zwidth.DoubtfulResult, match="assumed, not measured: link.stiffness, body.handle.mass"):
        assert zwidth.analyze(assumed).assumed == ["link.stiffness", "body.handle.mass", "loop.sampling_period"]
    columns = {"force": "force", "position": "position", "free": "link.stiffness,link.damping", "locked": "handle"}
    for more in ({}, {"method": "frequency-response"}):
        found = zwidth.identify("recordings/locked_chirp.csv", structure=assumed, **columns, **more)
        assert found.trust.verdict == "doubtful"
        assert "assumed, not measured: body.handle.mass, loop.sampling_period; give the device's own" in found.trust.reasons
        assert found.to_device().to_dict()["uncertainty"]["assumed"] == ["body.handle.mass", "loop.sampling_period"]
        assert zwidth.Device.from_toml(found.device_toml) == found.to_device()


@pytest.mark.filterwarnings("ignore::zwidth.ResultWarning")
def test_what_a_structure_is_doubtful_of_and_the_record_does_not_show_stays_doubtful(lhifam):
    """The masses are the structure's; of a rigid body the record shows every number."""
    warning = "\n[uncertainty]\nwarning = 'weighed by eye'\n"
    doubtful = zwidth.Device.from_toml(lhifam.to_toml() + warning)
    columns = {"force": "force", "position": "position"}
    for more in ({}, {"method": "frequency-response"}):
        found = zwidth.identify("recordings/locked_chirp.csv", structure=doubtful, free="link.stiffness,link.damping",
                                locked="handle", **columns, **more)  # fmt: skip
        assert found.trust.verdict == "doubtful" and "weighed by eye" in found.trust.reasons
        with pytest.warns(zwidth.DoubtfulResult, match="weighed by eye"):
            zwidth.critical_stiffness(found.to_device())
    refused = zwidth.Device.from_toml(lhifam.to_toml() + warning + "verdict = 'refused'\n")
    found = zwidth.identify("recordings/locked_chirp.csv", structure=refused, free="link.stiffness", locked="handle", **columns)
    assert found.trust.verdict == "refused" and found.critical_stiffness is None
    rigid = zwidth.Device.from_toml(zwidth.Device.from_toml("devices/lhifam_rigid.toml").to_toml() + warning)
    found = zwidth.identify("recordings/free_motion.csv", structure=rigid, **columns)
    assert all(each.identifiable for each in found.parameters) and "weighed by eye" not in found.trust.reasons


def test_the_text_of_a_doubtful_device_is_warned_of(lhifam):
    doubtful = zwidth.Device.from_toml(lhifam.to_toml() + "\n[uncertainty]\nwarning = 'misfit of 3'\n")
    for form, options in (("octave", {}), ("python", {}), ("json", {}), ("c", {"stiffness": 100, "accept_doubt": True})):
        with pytest.warns(zwidth.DoubtfulResult, match="misfit of 3") as caught:
            zwidth.export(doubtful, form, **options)
        assert caught[0].filename == __file__


def test_limits_of_an_export_and_of_designs_compared(tmp_path):
    file = tmp_path / "knob.toml"
    file.write_text(KNOB)
    (exported, _), (compared, _) = answers([["export", str(file), "--format", "json"],
                                            ["design", str(file), "--compare", "loop.delay=0,1e-3", "--json"]], tmp_path)
    for design, delay in zip(json.loads(compared)["designs"], (0.0, 1e-3)):
        assert design["limits"] == zwidth.analyze(zwidth.Device.from_toml(KNOB).with_(loop__delay=delay)).to_dict()["limits"]
    assert json.loads(exported)["limits"] == zwidth.analyze(zwidth.Device.from_toml(KNOB)).to_dict()["limits"]
