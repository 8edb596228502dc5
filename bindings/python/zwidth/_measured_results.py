"""What is recorded or simulated: one class per document (docs/*.md say all of each)."""

from __future__ import annotations

from typing import List

from . import _core
from ._errors import Error
from ._parts import Finding, HoldingLimits, Remark, Mechanism, Mode, _Limited
from ._record import (Array, Record, Result, array, complexes, count, flag, interval, intervals, many, maybe, maybe_count, maybe_flag, maybe_one, maybe_text, number, one, text, texts)


def _device_of(result: Record) -> _core.Device:
    found = result._answer.device
    if found is None:
        raise Error("no device was found")
    return _core.Device.from_toml(found)


class _Points(Record):
    frequency_hz = array("Hz")
    measured = complexes("Position per force.")
    fitted = complexes("The same of the fit.")


class Identification(_Limited):
    """A device from a recording: docs/identification.md."""

    source = text("The recording.")
    device = text("Its name.")
    units = one(Record, "Names of the units.")
    recorded_sampling_period_s = maybe("s")
    band_hz = interval("Lowest and highest frequency used, Hz.")
    point_count = maybe_count("Number of points.")
    parameters = many(Record, "key, value, unit, identifiable, standard_deviation, interval.")
    correlations = many(Record, "Pairs above 0.95.")
    misfit = maybe("Root mean square of residual over noise.")
    model_error = maybe("Relative error of the model.")
    held_to_measured_critical_point = flag("Whether the fit was held to it.")
    critical_stiffness_without_hold = maybe("K_CR of the fit that was not.")
    status = maybe_text("As of Analysis; None where refused.")
    critical_stiffness = maybe("K_CR of the fitted device; None where refused.")
    critical_stiffness_interval = interval("95 %.")
    critical_frequency_hz = maybe("Hz")
    limited_by = maybe_one(Mechanism, "What limits it.")
    limits = maybe_one(HoldingLimits, "Of the fitted device, by who holds it; None where refused.")
    modes = many(Mode, "Of the fitted device.")
    basis = one(Record, "What is closed around the device in K_CR.")
    points = one(_Points, "With points=True: measured and fitted response.")
    device_toml = text("The device file.")

    @property
    def unidentifiable(self) -> List[List[str]]:
        """Parameters of which only a combination shows, or nothing."""
        return [list(each) for each in self._values["unidentifiable"]]

    def to_device(self) -> _core.Device:
        """The device with what was found and how sure it is, as identify --output-device writes it."""
        return _device_of(self)


class RigidBodyIdentification(_Limited):
    """Mass and friction of a rigid body from its motion: docs/inverse_dynamics.md."""

    source = text("The recording.")
    parameters = many(Record, "key, value, unit, identifiable, standard_deviation, interval.")
    relative_residual = maybe("Share of the force that stays unexplained.")
    cutoff_hz = number("Of the low-pass, Hz.")
    decimation = count("Every so many samples.")
    equations = count("How many.")
    device_toml = text("The device file.")

    def to_device(self) -> _core.Device:
        """The rigid device with what was found, as identify --output-device writes it."""
        return _device_of(self)


class FrequencyResponse(_Limited):
    """A measured response and the critical stiffness that it shows: docs/frf_json.md."""

    recording = text("Its name.")
    units = one(Record, "Names of the units of force, position, stiffness.")
    status = maybe_text('"found", "not_in_band", "undetermined"; None of a continuous response.')
    critical_stiffness = maybe("Only when found.")
    critical_stiffness_db = maybe("20 log10 of it.")
    critical_stiffness_interval = interval("95 %.")
    critical_frequency_rad_s = maybe("rad/s")
    critical_frequency_hz = maybe("Hz")
    critical_frequency_interval_hz = interval("95 %, Hz.")
    limited_by = maybe_one(Mechanism, "Always None: data alone do not tell it; identify() does.")
    softest_proven = maybe_one(Record, "The crossover of least stiffness that the data prove.")
    crossovers = many(Record, "All that the data prove.")
    doubtful_bands_hz = intervals("Bands that may hide a softer crossover, Hz.")
    measured_band_hz = interval("Where the phase is known, Hz.")
    excited_band_hz = interval("Lowest and highest line, Hz.")
    lines = count("How many.")
    averages = maybe("Effective number of independent averages.")
    amplitude_dependence = maybe_one(Record, "Where recordings differ by more than their noise.")
    sampling_period_s = maybe("s")
    basis = one(Record, "What is closed around the device: nothing.")
    frequency_hz = array("With points=True: Hz, one per line; so all below.")
    magnitude = array("Position per force.")
    magnitude_lower = array("95 %; NaN: not known.")
    magnitude_upper = array("95 %; NaN: not known.")
    phase_rad = array("Unwrapped, rad.")
    phase_lower_rad = array("95 %; NaN: not known.")
    phase_upper_rad = array("95 %; NaN: not known.")
    coherence = array("0 to 1; NaN: not known.")


class BodyMotion(Record):
    """How one body moves."""

    body = text("Its name.")
    position = array("m or rad")
    velocity = array("m/s or rad/s")


class Motion(Record):
    """The motion of a run, arrays of one length."""

    time_s = array("s")
    measured = array("What the encoder gave, m or rad.")
    command = array("The limited force, N or N m.")
    user_force = array("N or N m")
    bodies = many(BodyMotion, "Each body; none of a transfer function.")


class Simulation(_Limited):
    """The sampled loop in time: docs/simulation.md."""

    device = text("The device's name.")
    units = one(Record, "Names of the units.")
    sampling_period_s = number("s")
    duration_s = number("s, as simulated.")
    samples = count("As simulated.")
    wall = maybe_one(Record, "The wall as it ran.")
    start = many(Record, "Per body.")
    user_force = maybe_one(Record, "Of the user.")
    faults = one(Record, "Of the controller.")
    verdict = text('"settles", "limit_cycle", "forced", "unstable", "drifts" or "undecided".')
    oscillation = maybe_one(Record, "At the end of the run.")
    growth_rate_per_s = maybe("Of the oscillation's envelope, 1/s.")
    settling_time_s = maybe("s")
    final_position = maybe("m or rad")
    peak_penetration = maybe("m or rad")
    generated_energy = maybe("J")
    peak_generated_energy = maybe("J")
    force_ripple = maybe_one(Record, "Of the force, from the encoder's steps.")
    encoder_chatters = maybe_flag("Whether that ripple is all that moves the force at the end.")
    stick_slip_instants = count("How often a body stuck or broke away.")
    nonlinear_parts = texts("What acts in the run and is left out by linear analysis.")
    linear = maybe_one(Record, "What linear analysis says.")
    points = one(Motion, "With points=True: the motion.")


class Relay(_Limited):
    """The relay experiment: docs/relay.md."""

    source = text('"simulation" or "recording".')
    recording = maybe_text("Its name.")
    device = maybe_text("The device's name.")
    units = one(Record, "Names of the units.")
    sampling_period_s = number("s")
    delay_s = maybe("s")
    relay = one(Record, "amplitude, hysteresis.")
    friction_level = maybe("Largest Coulomb friction over the relay's force.")
    trials = many(Record, "Each with its result, or why there is none.")
    mean = maybe_one(Record, "Over the trials that oscillate.")
    predictions = maybe_one(Record, "What theory expects.")
    explanation = texts("Sentences.")
    limit_reading = text('"confirms", "coincides", "unsafe", "too_cautious" or "none".')

    def force(self, trial: int = 0) -> Array:
        """The relay's force in a trial (from 0), every sample: N or N m."""
        return self._series(f"force_{trial + 1}")

    def position(self, trial: int = 0) -> Array:
        """The position in that trial, m or rad."""
        return self._series(f"position_{trial + 1}")


class Excitation(Result):
    """A signal to excite a device with: docs/excitation.md."""

    kind = text("Its kind.")
    units = one(Record, "Names of the units.")
    lowest_hz = maybe("Hz")
    highest_hz = maybe("Hz")
    rate_hz = number("Hz")
    samples = count("How many.")
    duration_s = number("s")
    period_samples = maybe_count("None where not periodic.")
    peak_force = number("N or N m")
    rms_force = number("N or N m")
    crest_factor = number("Peak over rms.")
    remarks = many(Remark, "What was noticed.")
    findings = many(Finding, "What the remarks are written from, each once.")
    check = maybe_one(Record, "Played through a device: its motion.")

    def force(self) -> Array:
        """Every sample of the signal, N or N m."""
        return self._series("samples")
