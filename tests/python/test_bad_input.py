"""Bad input raises, with its place; nothing crashes."""

import io
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import zwidth


def refusal(call):
    with pytest.raises(zwidth.InputError) as caught:
        call()
    return caught.value


def test_the_place_of_what_is_wrong(tmp_path, lhifam):
    file = tmp_path / "bad.toml"
    file.write_text("[[body]]\nname = 'a'\nmass = -1\n[loop]\nsampling_period = 1e-3\n")
    error = refusal(lambda: zwidth.Device.from_toml(file))
    assert error.where.startswith(f"{file}:3:") and error.what == "is -1" and error.allowed
    assert isinstance(error, ValueError) and str(file) in str(error)
    assert refusal(lambda: lhifam.with_(link__stiffness=-5)).where == "device.link.0.stiffness"
    assert refusal(lambda: zwidth.analyze(lhifam, worst_usr=True)).where == "options.worst_usr"
    assert "worst_user" in refusal(lambda: zwidth.analyze(lhifam, worst_usr=True)).allowed
    assert refusal(lambda: zwidth.diagnose(lhifam, oscillates_hz=-1)).where == "options.oscillates_hz"
    assert "loop.dely" in refusal(lambda: lhifam.with_(loop__dely=1)).where
    assert "body" in refusal(lambda: zwidth.Device(body=[{"name": "a", "mass": float("nan")}], loop={})).where


def test_all_problems_of_a_device_with_what_to_write(lhifam):
    text = "[[body]]\nname = 'a'\nmass = -1\ndamping = '5 Ns/m'\n[loop]\nsampling_period = '2 kHz'\n"
    error = refusal(lambda: zwidth.Device.from_toml(text))
    damping, period, mass = error.problems
    assert damping.place == zwidth.Place("device", 4, 11, "body.a.damping") and damping.suggestion == "5 N s/m"
    assert period.place == zwidth.Place("device", 6, 19, "loop.sampling_period") and period.suggestion == "0.5 ms"
    assert mass.place == zwidth.Place("device", 3, 8, "body.a.mass") and mass.suggestion is None
    assert [each.code for each in error.problems] == ["unknown_unit", "unit_of_other_measure", "no_finite_number"]
    assert (error.where, error.what, error.allowed) == (damping.where, damping.what, damping.allowed)
    assert (error.place, error.suggestion) == (damping.place, damping.suggestion)
    assert len(str(error).splitlines()) == 3
    assert pickle.loads(pickle.dumps(error)).problems == error.problems
    assert refusal(lambda: lhifam.with_(loop__delay="2 kHz")).problems[0].suggestion == "0.5 ms"
    option = refusal(lambda: zwidth.diagnose(lhifam, oscillates_hz=-1)).problems[0]
    assert option.place.option == "oscillates_hz" and option.where == "options.oscillates_hz"


def test_options_are_called_as_in_python(lhifam):
    assert "give stiffness or safety_factor" in refusal(lambda: zwidth.export(lhifam, "c")).allowed
    assert refusal(lambda: zwidth.simulate(lhifam, duration="")).where == "options.duration"
    assert refusal(lambda: zwidth.simulate(lhifam, wall_position=[1, 2])).what == "has 2 values"
    assert refusal(lambda: zwidth.simulate(lhifam)).where == "options"
    doubtful = zwidth.Device.from_toml(lhifam.to_toml() + "\n[uncertainty]\nwarning = 'guessed'\n")
    with pytest.raises(zwidth.WorkFailed, match="; accept_doubt writes the wall all the same"):
        zwidth.export(doubtful, "c", stiffness=100)
    assert "guessed" in zwidth.export(doubtful, "c", stiffness=100, accept_doubt=True)


@pytest.mark.parametrize("source, type_name", [(b"[[body]]\n", "bytes"), (None, "NoneType"), (7, "int"), ([], "list")])
def test_what_is_no_device_file_is_not_taken_for_a_path(source, type_name):
    error = refusal(lambda: zwidth.Device.from_toml(source))
    assert error.where == "device" and error.what == f"is of type {type_name}" and "decode" in error.allowed


@pytest.mark.parametrize("given, where", [("loop.delay=1e-3", "set"), (b"x", "set"), (7, "set"), (None, "set"), ([1], "set[0]"), (["\ud800=1"], "set[0]")])
def test_overrides_are_a_list_of_texts(lhifam, given, where):
    assert refusal(lambda: zwidth.Device.from_toml(lhifam.to_toml(), set=given)).where == where


@pytest.mark.parametrize("period", [-1, 0, float("nan"), float("inf")])
def test_a_recording_is_refused_where_it_is_made(period):
    columns = {"f": [1.0, 2.0], "x": [0.0, 0.0]}
    assert refusal(lambda: zwidth.Recording(columns, sampling_period=period, name="bench")).where == "bench: sampling_period"
    assert "two at least" in refusal(lambda: zwidth.Recording({"f": [1.0, 2.0], "x": [0.0]})).allowed
    assert "equally many" in refusal(lambda: zwidth.Recording({"f": [1.0, 2.0, 3.0], "x": [0.0, 1.0]})).allowed
    assert "two at least" in refusal(lambda: zwidth.Recording({"f": [1.0]})).allowed


def test_no_part_of_a_number_is_dropped(lhifam):
    assert refusal(lambda: zwidth.Recording({"f": np.array([1j, 2.0])})).what == "is complex"
    assert refusal(lambda: zwidth.critical_stiffness_many(lhifam, {"link.stiffness": np.array([8e4 + 1j])})).what == "is complex"
    assert refusal(lambda: zwidth.critical_stiffness_many(lhifam, None)).where == "changes"
    assert refusal(lambda: zwidth.plot.bode(3)).where == "source"
    bodies = [{"name": "a", "mass": 1.0}, {"name": "b", "mass": float("nan")}]
    assert refusal(lambda: zwidth.Device(body=bodies, loop={})).where == "device.body.1.mass"


@pytest.mark.parametrize("call", [zwidth.sweep, zwidth.compare, zwidth.design_targets])
@pytest.mark.parametrize("nothing", [None, False, True, []])
def test_no_other_answer_is_given(lhifam, call, nothing):
    assert refusal(lambda: call(lhifam, nothing)).what == f"is {nothing!r}"


def test_none_is_no_value(lhifam):
    for key in ("name", "wall.stiffness", "x"):
        error = refusal(lambda: lhifam.with_({key: None}))
        assert error.where == f"device.{key}" and error.what == "is None"


@pytest.mark.parametrize(
    "changes",
    [
        {"link.stiffness": "stiff"},
        {"link.stiffness": [[1.0]]},
        {"link.stiffness": 1.0},
        {"link.stiffness": [1.0], "loop.delay": [0.0, 0.1]},
        {"link.stifness": [1.0]},
        {"link.stiffness": [1.0], "link.0.stiffness": [1.0]},
        {},
        {"link.stiffness": [1j]},
        {1: [1.0]},
    ],
)
def test_many_refuses(lhifam, changes):
    with pytest.raises((zwidth.InputError, TypeError)):
        zwidth.critical_stiffness_many(lhifam, changes)


@pytest.mark.parametrize(
    "call",
    [
        lambda device: zwidth.analyze(None),
        lambda device: zwidth.analyze("device"),
        lambda device: zwidth.critical_stiffness(None),
        lambda device: zwidth.critical_stiffness(object()),
        lambda device: zwidth.Device.from_toml("nowhere.toml"),
        lambda device: zwidth.Device.from_toml(""),
        lambda device: zwidth.Device.from_toml("-"),
        lambda device: zwidth.Device.from_toml("\n\0\xff"),
        lambda device: zwidth.Device.from_toml(b"\xff\xfe"),
        lambda device: zwidth.Device.from_toml(7),
        lambda device: zwidth.Device.from_toml("\ud800\n"),
        lambda device: zwidth.Device(wall={"stiffness": 10**400}),
        lambda device: zwidth.Device(name="\ud800"),
        lambda device: device.with_({"name": "\ud800"}),
        lambda device: device.with_({"\ud800": 1}),
        lambda device: device.with_({"link.stiffness": -(10**400)}),
        lambda device: zwidth.Device.from_toml(None),
        lambda device: zwidth.Device.from_toml(os.devnull),
        lambda device: zwidth.Device.from_toml(io.StringIO("x")),
        lambda device: zwidth.Device(),
        lambda device: zwidth.Device(body=lambda: 0),
        lambda device: zwidth.Device(body=[[]] * 5),
        lambda device: zwidth.Device(body=None),
        lambda device: device.with_({None: 1}),
        lambda device: device.with_({"link.stiffness": object()}),
        lambda device: device.with_(link__stiffness=float("inf")),
        lambda device: device.with_(link__stiffness="22 kg"),
        lambda device: device.with_({"link.stiffness": 1}, link__stiffness=2),
        lambda device: zwidth.analyze(device, users=""),
        lambda device: zwidth.analyze(device, users="\0"),
        lambda device: zwidth.analyze(device, users=object()),
        lambda device: zwidth.analyze(device, worst_user=3),
        lambda device: zwidth.analyze(device, help=True),
        lambda device: zwidth.analyze(device, report="x.html"),
        lambda device: zwidth.bode(device, points=float("nan")),
        lambda device: zwidth.bode(device, from_=np.array([[1.0]])),
        lambda device: zwidth.region(device, csv="x.csv"),
        lambda device: zwidth.design(device, sweep="loop.delay=0:1:2"),
        lambda device: zwidth.simulate(device, duration=-1),
        lambda device: zwidth.simulate(device, user_force=7),
        lambda device: zwidth.relay(device),
        lambda device: zwidth.relay(),
        lambda device: zwidth.frequency_response("nowhere.csv", force=1, position=2),
        lambda device: zwidth.frequency_response("-", force=1, position=2),
        lambda device: zwidth.frequency_response(b"x", force=1, position=2),
        lambda device: zwidth.frequency_response(None),
        lambda device: zwidth.frequency_response({}, force="f"),
        lambda device: zwidth.frequency_response({"f": [1.0, 2.0], "x": [1.0]}, force="f", position="x", rate=1000),
        lambda device: zwidth.frequency_response({"f": ["a", "b"]}, force="f", position="f", rate=1000),
        lambda device: zwidth.frequency_response({"f": np.zeros((2, 2))}, force="f", position="f", rate=1000),
        lambda device: zwidth.frequency_response({"f": [], "x": []}, force="f", position="x", rate=1000),
        lambda device: zwidth.frequency_response({"f": [np.nan] * 9, "x": [0.0] * 9}, force="f", position="x", rate=1e3),
        lambda device: zwidth.frequency_response({"f": [1.0] * 9, "x": [0.0] * 9}, force="f", position="x"),
        lambda device: zwidth.frequency_response({"f": [1.0] * 9, "x": [0.0] * 9}, table=True, rate=1000),
        lambda device: zwidth.Recording({"f": [1.0]}, sampling_period="fast"),
        lambda device: zwidth.Recording({"f": [1.0]}, name="--json"),
        lambda device: zwidth.Recording(memoryview(b"abc")),
        lambda device: zwidth.Recording(np.ones(3)),
        lambda device: zwidth.simulate(device, seed="x" * 100_000),
        lambda device: zwidth.excite(kind="x" * 1_000_000, amplitude=1),
        lambda device: zwidth.critical_stiffness_many(device, {"x" * 1_000_000: [1.0]}),
        lambda device: zwidth.identify({"f": [1.0] * 9, "x": [0.0] * 9}, structure="none", force="f", position="x", rate=1),
        lambda device: zwidth.export(device, "fortran"),
        lambda device: zwidth.export(device, "c"),
        lambda device: zwidth.frequency_response("recordings/locked_chirp.csv", list=True),
    ],
)
@pytest.mark.filterwarnings("ignore")
def test_raises(lhifam, call, tmp_path, monkeypatch):
    before = set(os.listdir("."))
    with pytest.raises((zwidth.Error, TypeError, ValueError)):
        call(lhifam)
    assert set(os.listdir(".")) == before


@pytest.mark.parametrize("kind", ["Device", "CriticalStiffness", "AnyUserLimit", "Answer", "RecordedColumns"])
def test_what_was_never_constructed_is_refused(kind):
    """Each in a process of its own, which it must not end."""
    program = (
        "import zwidth\n"
        f"kind = zwidth._core.{kind}\n"
        "raw = kind.__new__(kind)\n"
        "names = [each for each in dir(kind) if each not in object.__dict__] + ['__repr__', '__hash__']\n"
        "for name in names:\n"
        "    try:\n"
        "        value = getattr(raw, name)\n"
        "        value() if callable(value) else None\n"
        "    except Exception:\n"
        "        pass\n"
        "for call in (zwidth.critical_stiffness, zwidth.any_user_limit, zwidth.analyze, zwidth.frequency_response):\n"
        "    try:\n"
        "        call(raw)\n"
        "        raise SystemExit('took it')\n"
        "    except (zwidth.Error, TypeError, RuntimeError):\n"
        "        pass\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_pickling_by_every_protocol(protocol):
    program = (
        "import pickle, zwidth\n"
        "device = zwidth.Device.from_toml('devices/lhifam.toml')\n"
        f"assert pickle.loads(pickle.dumps(device, {protocol})) == device\n"
        "try:\n"
        f"    pickle.dumps(zwidth.critical_stiffness(device), {protocol})\n"
        "    raise SystemExit('pickled')\n"
        "except TypeError:\n"
        "    pass\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr


def test_a_closed_file_raises(tmp_path, lhifam):
    file = tmp_path / "device.toml"
    file.write_text(lhifam.to_toml())
    with open(file) as opened:
        pass
    with pytest.raises((zwidth.Error, TypeError, ValueError)):
        zwidth.Device.from_toml(opened)
    with pytest.raises((zwidth.Error, TypeError, ValueError)):
        zwidth.frequency_response(opened, force=1, position=2)


def test_the_callers_own_error_ends_the_work(lhifam):
    def stop(fraction):
        raise KeyError(fraction)

    with pytest.raises(KeyError):
        zwidth.sweep(lhifam, "loop.delay=0:8e-3:2000", progress=stop)
    with pytest.raises(KeyError):
        zwidth.critical_stiffness_many(lhifam, {"loop.delay": np.linspace(0, 8e-3, 2000)}, progress=stop)


def test_interrupt_ends_long_work(lhifam):
    signal.signal(signal.SIGINT, signal.default_int_handler)  # whoever started the tests in the background had it ignored
    begun = time.monotonic()
    threading.Timer(0.3, signal.raise_signal, [signal.SIGINT]).start()
    with pytest.raises(KeyboardInterrupt):
        # delays that are asked one by one: seconds of work
        zwidth.critical_stiffness_many(lhifam, {"loop.delay": np.linspace(13e-3, 20e-3, 300_000)})
    assert time.monotonic() - begun < 10


def test_threads_see_the_same_numbers(lhifam):
    expected = zwidth.analyze(lhifam).to_json()
    answers = []
    threads = [threading.Thread(target=lambda: answers.append(zwidth.analyze(lhifam).to_json())) for _ in range(8)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert answers == [expected] * 8


@pytest.mark.parametrize(
    "work",
    [
        "zwidth.critical_stiffness_many(device, {'loop.delay': numpy.linspace(13e-3, 20e-3, 5000)})",
        "zwidth.critical_stiffness_many(device, {'loop.delay': numpy.linspace(13e-3, 20e-3, 5000)}, progress=print)",
        "zwidth.region(device)",
        "[zwidth.critical_stiffness(device) for i in range(100000)]",
    ],
)
def test_a_thread_that_outlives_the_interpreter_is_no_crash(work):
    program = (
        "import threading, time, numpy, zwidth\n"
        "device = zwidth.Device.from_toml('devices/lhifam.toml')\n"
        f"threading.Thread(target=lambda: {work}, daemon=True).start()\n"
        "time.sleep(0.05)\n"
    )
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done.stderr


def test_a_subinterpreter_is_refused():
    program = (
        "import _xxsubinterpreters as interpreters, sys\n"
        "if '{first}': import zwidth\n"
        "made = interpreters.create()\n"
        "try:\n"
        "    interpreters.run_string(made, 'import zwidth')\n"
        "except interpreters.RunFailedError as error:\n"
        "    print(error)\n"
    )
    for first in ("", "first"):
        done = subprocess.run([sys.executable, "-c", program.format(first=first)], capture_output=True, text=True, timeout=60)
        assert done.returncode == 0 and "ImportError" in done.stdout + done.stderr, done.stdout + done.stderr


def test_a_forked_child_works(lhifam):
    child = os.fork()
    if child == 0:
        os._exit(0 if zwidth.analyze(lhifam).critical_stiffness else 1)
    assert os.waitpid(child, 0)[1] == 0


@pytest.mark.parametrize(
    "study, where",
    [
        (None, "study"),
        ("", "study"),
        ("-", "study"),
        ("none.toml", "study"),
        ({}, "study.parameter"),
        ({"samples": float("nan")}, "study.samples"),
        ({"parameter": [{"key": "link.stifness"}]}, "study.parameter.0.key"),
        ({"parameter": [{"key": "loop.delay", "distribution": "file", "file": "/etc/passwd"}]}, "study.parameter.0.file"),
        ("a =\nb = 1\n", "study:1:4"),
    ],
)
def test_studies_that_are_none(lhifam, study, where):
    with pytest.raises(zwidth.InputError) as raised:
        zwidth.study(lhifam, study)
    assert str(raised.value).startswith(where + ": ")


def test_a_study_ends_where_its_progress_raises(lhifam):
    class Enough(Exception):
        pass

    def stop(fraction):
        raise Enough

    study = {
        "samples": 10**6,
        "specification": {"any_user": 1000},
        "parameter": [{"key": "link.stiffness", "distribution": "normal", "relative_deviation": 0.08}],
    }
    with pytest.raises(Enough):
        zwidth.study(lhifam, study, progress=stop)
