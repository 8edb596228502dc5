"""What Python's numbers, arrays and texts become: nothing is dropped, and what cannot be converted has its place."""

import warnings

import numpy as np
import pandas
import pytest
import zwidth
from test_bad_input import refusal


def test_masked_samples_are_missing(lhifam):
    """A mask dropped would make numbers of what is behind it."""
    stiffness = np.ma.masked_array([8e4, 9e4], [False, True])
    assert np.isnan(zwidth.critical_stiffness_many(lhifam, {"link.stiffness": stiffness}).critical_stiffness).tolist() == [False, True]
    generator = np.random.default_rng(3)
    columns = {"f": generator.normal(size=4000), "x": generator.normal(size=4000)}
    masked, missing = (dict(columns, x=np.ma.masked_array(columns["x"])), dict(columns, x=columns["x"].copy()))
    masked["x"].data[70], masked["x"][70], missing["x"][70] = 1e9, np.ma.masked, np.nan
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        answers = [zwidth.frequency_response(each, force="f", position="x", rate=1e3).to_dict() for each in (masked, missing)]
    assert answers[0] == answers[1]


class InMillimetres:
    """Like the arrays of pint and astropy."""

    units = "mm"

    def __array__(self, dtype=None):
        return np.arange(20.0)


def test_no_unit_is_dropped(lhifam):
    """NumPy's durations call themselves integers."""
    millisecond, times = np.timedelta64(1, "ms"), pandas.Series(pandas.to_timedelta(np.arange(20), unit="ms"))
    for duration in (millisecond, np.timedelta64(1, "ns"), np.datetime64("2026-01-01")):
        assert refusal(lambda: lhifam.with_(loop__delay=duration)).where == "device.loop.delay"
        assert refusal(lambda: zwidth.simulate(lhifam, duration=duration)).where == "options.duration"
        assert refusal(lambda: zwidth.Recording({"x": [1.0, 2.0]}, sampling_period=duration)).where == "recording: sampling_period"
    for column in (times, times.to_numpy(), pandas.Timestamp("2026-01-01") + times, InMillimetres()):
        error = refusal(lambda: zwidth.Recording({"time": column}))
        assert error.where == "recording: time" and error.what == "has a unit of its own"


@pytest.mark.parametrize(
    "call, where",
    [
        (lambda device: zwidth.Recording({"f": [1.0, 10**400]}), "recording: f"),
        (lambda device: zwidth.Recording({"\ud800": [1.0, 2.0]}), "recording: '\\ud800'"),
        (lambda device: zwidth.Recording({"f": [1.0, 2.0]}, name=3), "recording"),
        (lambda device: zwidth.Recording({"f": [1.0, 2.0]}, sampling_period=10**400), "recording: sampling_period"),
        (lambda device: zwidth.critical_stiffness_many(device, {"link.stiffness": [10**400]}), "device.link.stiffness"),
        (lambda device: zwidth.bode(device, points=10**5000), "options.points"),
        (lambda device: zwidth.bode(device, points="\ud800"), "options.points"),
        (lambda device: zwidth.bode(device, **{"\ud800": 1}), "options"),
        (lambda device: zwidth.frequency_response("\ud800", force=1, position=2), "recording"),
        (lambda device: zwidth.study(device, "\ud800"), "study"),
        (lambda device: zwidth.options(3), "command"),
    ],
)
def test_the_place_of_what_python_cannot_convert(lhifam, call, where):
    assert refusal(lambda: call(lhifam)).where == where
