"""What is computed of a device: one class per document (docs/*.md say all of each)."""

from __future__ import annotations

from . import _core
from ._errors import Error
from ._parts import Finding, Trust, Mechanism, Mode, Crossover, Remark, HoldingLimits, WallMargins, AnyUser, _Limited
from ._record import (
    Record, Result, array, count, interval, intervals, many, maybe, maybe_one, maybe_text, number, one, text, texts,
)  # fmt: skip


class Analysis(_Limited):
    """What a device renders stably: docs/analysis_json.md."""

    device = text("The device's name.")
    units = one(Record, "Names of the units of stiffness and damping.")
    status = text('"finite", "none_stable", "unbounded" or "refused".')
    critical_stiffness = maybe("With the file's user: K_CR, N/m or N m/rad; 0 when none is stable, None when unbounded or refused.")
    limits = one(HoldingLimits, "With nobody holding, the file's user, any passive user.")
    critical_stiffness_db = maybe("20 log10 of it; None unless finite.")
    critical_frequency_rad_s = maybe("Of the oscillation just above it, rad/s.")
    critical_frequency_hz = maybe("Hz")
    limited_by = maybe_one(Mechanism, "What limits it.")
    stable_intervals = intervals("(lower, upper) of every stable interval of K > 0; an unbounded end is None.")
    crossovers = many(Crossover, "All of them, by rising frequency.")
    modes = many(Mode, "Vibration modes, by rising frequency.")
    suspended_rigid_body = maybe_one(Mode, "Where springs tie the device to ground.")
    rigid_approximation = maybe_one(Record, "The device with rigid links; None for a transfer function.")
    q_criterion = maybe_one(Record, "Eq. 24 of Díaz & Gil; two-body devices.")
    any_user = maybe_one(AnyUser, "The limit over all passive users; None for a transfer function.")
    user_family = maybe_one(Record, "With users=...: the worst of a family of users.")
    virtual_damper = maybe_one(Record, "The wall's damper, closed while K varies.")
    wall_filters = many(Record, "The wall's filters, in the order in which they run.")
    wall = maybe_one(WallMargins, "The wall's margins; None without wall.stiffness.")
    walls = maybe_one(Record, "With walls=True: the stiffest wall with a damper, and the one to run.")
    force_per_count = maybe_one(Record, "Force after one step of the encoder, N or N m.")
    quantisation_passivity = maybe_one(Record, "Up to where friction dissipates what the encoder generates.")
    critical_stiffness_interval = interval("95 % interval that the device's uncertainty makes of critical_stiffness.")
    other_mechanism_share = maybe("Share of the drawn devices that another mechanism limits.")
    assumed = texts("Keys of the device's numbers that nobody has measured or stated, only assumed to begin with.")
    uncertainty_warning = maybe_text("Why the device's numbers are not to be trusted.")


class BodeCurve(Record):
    """A frequency response, arrays of one length."""

    frequency_rad_s = array("rad/s")
    magnitude_db = array("20 log10 of m/N or rad/(N m).")
    phase_deg = array("Unwrapped, degrees.")


class Bode(_Limited):
    """Frequency responses of a device: docs/bode_json.md."""

    device = text("The device's name.")
    sampling_period_s = number("s")
    delay_s = number("s")
    nyquist_rad_s = number("pi/T, rad/s.")
    sampled = one(BodeCurve, "What the sampled wall sees up to Nyquist, delay included.")
    continuous = one(BodeCurve, "The device alone.")
    crossovers = many(Crossover, "All of them, in the range or not.")


class Region(_Limited):
    """Every stable wall (K, B): docs/region.md."""

    device = text("The device's name.")
    units = one(Record, "Names of the units of stiffness and damping.")
    velocity_filter_hz = number("Of the damper's velocity, Hz; 0: none.")
    wall_filters = many(Record, "The wall's filters.")
    status = text('"bounded", "none_stable", "unbounded" or "refused".')
    critical_stiffness = maybe("K_CR at B = 0.")
    stiffest = maybe_one(Record, "The point of the boundary with the largest K.")
    most_damped = maybe_one(Record, "The same of B.")
    area = maybe("Of all components, stiffness times damping.")
    components = many(Record, "Connected parts of the region by falling area.")
    nobody = maybe_one(Record, "The same with nobody holding; None without an [operator]: then that is what stands above.")
    nobody_and_user = maybe_one(Record, "The walls to build on, stable with both; None without an [operator].")
    any_user = maybe_one(Record, "The walls that no passive user destabilises.")
    approximations = many(Record, "Formulas of the literature beside it.")
    force_per_count = maybe_one(Record, "Force after one step of the encoder, for any wall here.")


class Design(_Limited):
    """What each number of a device does to the limit: docs/design.md."""

    device = text("The device's name.")
    units = one(Record, "Names of the units.")
    status = text('"finite", "none_stable", "unbounded" or "refused".')
    critical_stiffness = maybe("K_CR.")
    critical_stiffness_db = maybe("20 log10 of it.")
    critical_frequency_rad_s = maybe("rad/s")
    critical_frequency_hz = maybe("Hz")
    limited_by = maybe_one(Mechanism, "What limits it.")
    any_user_stiffness = maybe("The limit over all passive users.")
    sensitivities = many(Record, "Slope of both limits by every number.")
    branch_switches = many(Record, "Where another crossover takes over; None above 8 bodies.")


class SweepPoint(Record):
    """The limit at one point of a sweep."""

    status = text('"finite", "none_stable", "unbounded" or "refused".')
    critical_stiffness = maybe("K_CR.")
    frequency_rad_s = maybe("rad/s")
    limited_by = maybe_one(Mechanism, "What limits it.")
    any_user_stiffness = maybe("With any_user=True: the limit over all passive users.")
    trust = one(Trust, "Of the device, and of the computations at this point.")


class SweepAxis(Record):
    """A number that is swept."""

    parameter = text("Its key.")
    unit = text("Its unit.")
    values = array("Its values.")


class Sweep(Result):
    """The limit along one number or two: docs/design.md."""

    device = text("The device's name.")
    units = one(Record, "Names of the units.")
    axes = many(SweepAxis, "One or two.")
    points = many(SweepPoint, "The last axis runs fastest.")
    trust = one(Trust, "Of the device, and of the points as a whole; each point has its own.")
    findings = many(Finding, "What trust and remarks are written from, each once.")


class Comparison(Result):
    """Several values of one key side by side: docs/design.md."""

    device = text("The device's name.")
    units = one(Record, "Names of the units.")
    parameter = text("The key compared.")
    operator = maybe_one(Record, "The user.")
    designs = many(Record, "One per value.")
    best = one(Record, "The value that is best, by each limit.")
    trust = one(Trust, "The worst of the designs'.")
    findings = many(Finding, "What trust and remarks are written from, each once.")


class Notch(_Limited):
    """A notch for the wall: docs/design.md."""

    device = text("The device's name.")
    units = one(Record, "Names of the units.")
    goal = text("What was asked.")
    drift = number("Share by which the mode may drift.")
    gain_margin = number("A factor.")
    phase_margin_rad = number("rad")
    notch = maybe_one(Record, "None where none makes the worst wall stiffer.")
    stiffness_without = maybe("The stiffest wall with the margins, least over the drift.")
    stiffness_with = maybe("The same with the notch.")
    low_frequency_delay_s = maybe("By how much it delays slow forces, s.")
    over_drift = many(Record, "Both, per drift.")
    without = maybe_one(Record, "The device as it is.")
    with_ = maybe_one(Record, "The device with the notch.")


class DesignTargets(_Limited):
    """What each number alone must be for the limit to reach a target: docs/design.md."""

    device = text("The device's name.")
    units = one(Record, "Names of the units.")
    goal = text('"critical_stiffness", "any_user_limit"; of a damper alone "critical_damping", "any_user_damping".')
    target = maybe("K (B of a damper alone) asked for.")
    stiffness_now = maybe("The limit of the device as it is.")
    damping_now = maybe("The same of a damper alone.")
    any_user_now = maybe("The same with any passive user.")
    targets = many(
        Record,
        "Per parameter value_now, value_needed, why, any_user_then, safe; the smallest change first, then those that "
        "are not safe: they lower the limit with any passive user.",
    )


class WallRecommendation(_Limited):
    """The wall to render: docs/recommendation.md."""

    device = text("The device's name.")
    units = one(Record, "Names of the units.")
    goal = text('"stiffness", "width", "critical-damping" or "damper".')
    asked = one(Record, "Margins, ripple and drift of the modes.")
    drifts_checked = count("Drifts of the modes at which every wall was held against its margins.")
    status = text('"found", "none", "unbounded" or "refused".')
    reason = maybe_text("Why there is none.")
    wall = maybe_one(Record, "stiffness, damping, velocity_filter_hz, filters, has_new_notch; None unless found.")
    bounded_by = maybe_one(Record, "What is met first with more of each.")
    margins = maybe_one(Record, "Of the device as it is.")
    force_per_count = maybe_one(Record, "Force after one step of the encoder.")
    alternatives = many(Record, "The trade-off: walls that keep the same.")


class Diagnosis(_Limited):
    """What an oscillation is, and what moves it: docs/diagnosis.md."""

    device = text("The device's name.")
    units = one(Record, "Names of the units.")
    oscillates_rad_s = maybe("rad/s")
    oscillates_hz = maybe("Hz")
    amplitude = maybe("m or rad")
    stiffness = maybe("K of the wall.")
    damping = maybe("B of the wall.")
    limit_of = text('"stiffness", or "damping" of a damper alone (K = 0): what the limits are of.')
    cause = maybe_text("None: none fits.")
    nearest = maybe_text("The cause, or else the one that fits with the least otherwise; what the changes move.")
    any_user_now = maybe("The limit with any passive user.")
    candidates = many(Record, "The likeliest first; of those that do not fit what would have to be otherwise.")
    changes = many(Record, "Each alone and recomputed, with any_user_then and safe; those that are not safe last.")


class Quantile(Record):
    """A quantile of the limit over the units."""

    probability = number("Share of the units with less.")
    status = text('"finite", "unbounded", "refused" (a unit without an answer) or "too_few_samples".')
    stiffness = maybe("N/m or N m/rad; None unless finite.")
    interval = interval("95 % interval, whatever the distribution; an end is None where it is unbounded or unknown.")


class Study(Result):
    """How the limit varies over many units of one design: docs/study.md."""

    device = text("The device's name.")
    units = one(Record, "Names of the units.")
    limits = one(HoldingLimits, "Of the device as its file has it, with nobody and with the file's user.")
    samples = count("Units drawn.")
    seed = count("Of the random numbers.")
    sampling = text('"random", "latin-hypercube" or "sobol".')
    parameters = texts("Keys of what varies.")
    specification = one(Record, "What every unit must reach.")
    yield_ = maybe("Share of the units that meet the specification; None without one.")
    yield_interval = interval("95 % interval of it (Clopper and Pearson).")
    yields = one(Record, "Of each specification by itself.")
    quantiles = many(Quantile, "Of the critical stiffness.")
    any_user_quantiles = maybe_one(Quantile, "Of the any-user limit, where it is asked for.")
    reached_by_95_percent = maybe("95 % of all units reach it, with 95 % confidence.")
    histogram = one(Record, "Of the finite limits: edges, counts, yields.")
    none_stable = count("Units that no wall suits.")
    unbounded = count("Units that every wall suits.")
    doubtful = count("Units whose own answer is doubtful.")
    failed_count = count("Units without an answer.")
    failed = many(Record, "The first 1000 of them: sample, reason.")
    clusters = many(Record, "Units that miss the specification, by what limits them.")
    sobol_indices = maybe_one(Record, "By parameter; None where a remark says why.")
    tightening = maybe_one(Record, "By parameter: yield gained by half the spread; None without a specification.")
    rare_failures = maybe_one(Record, "With rare_samples=...: the share of failures by importance sampling.")
    regions = maybe_one(Record, "With region_units=...: the walls (K, B) that 99, 50 and 1 % of the units render.")
    worst = maybe_one(Record, "The worst unit found.")
    worst_any_user = maybe_one(Record, "The one with the lowest any-user limit, where it is asked for.")
    tighten_first = maybe_text("The parameter whose halved spread gains most, where that is more than chance; else None.")
    trust = one(Trust, "How far the numbers may be relied on.")
    remarks = many(Remark, "What was left out or noticed.")
    findings = many(Finding, "What trust and remarks are written from, each once.")

    def worst_device(self) -> _core.Device:
        """The worst unit as a device, as study --output-device writes it."""
        found = self._answer.device
        if found is None:
            raise Error("no unit has a limit: there is no worst one")
        return _core.Device.from_toml(found)
