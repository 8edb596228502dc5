"""Parts that several results have."""

from __future__ import annotations

from typing import Optional

from ._record import Record, Result, count, flag, interval, many, maybe, maybe_flag, maybe_one, maybe_text, number, one, text, texts

_text = text  # where a key has this name


class Trust(Record):
    """How far a number that states a limit may be relied on."""

    verdict = text('"sound", "doubtful" or "refused": then no number is given.')
    reasons = texts("Why, each with its remedy; empty when sound.")


class Remark(Record):
    """Something that a result's user should know."""

    severity = text('"note" or "warning".')
    what = text("What was noticed, in one line.")
    meaning = text("Consequence and remedy in one line.")
    consequence = text("What it means for the result; may be empty.")
    remedy = text("What to do about it; may be empty.")


class Finding(Record):
    """Something that zwidth knows about an input or an answer, as data: docs/findings.md."""

    code = text('What was found, as a name: "wall_not_surely_stable".')
    severity = text('"note", "doubt" or "refusal".')
    key = maybe_text("The device file's, that it concerns; None where there is none.")
    evidence = one(Record, "The numbers that it rests on, by name, in SI units.")
    effect = maybe_one(Record, "The limit with it, by name; None where that is not known.")
    remedy = text("What to do about it; may be empty.")
    text = _text("The sentence, as in trust.reasons or remarks.")


class Mechanism(Record):
    """What limits: the rigid body or a vibration mode."""

    kind = text('"rigid_body" or "vibration_mode".')

    @property
    def mode(self) -> Optional[int]:
        """Number of the vibration mode by rising frequency, from 1; None for the rigid body."""
        return self._values.get("mode")


class Mode(Record):
    """A mode of the free device."""

    frequency_rad_s = number("rad/s")
    frequency_hz = number("Hz")
    damping_ratio = number("1; above 1: two real poles.")


class Crossover(Record):
    """A stiffness that puts a closed-loop pole on the unit circle."""

    frequency_rad_s = number("rad/s; 0 where a real pole passes z = 1.")
    frequency_hz = number("Hz")
    stiffness = number("K, N/m or N m/rad.")
    stiffness_db = number("20 log10 of it.")
    limited_by = one(Mechanism, "The modal term of largest magnitude there.")
    poles_leaving = count("Poles that leave the circle as K rises through it; negative: that return.")


class HolderLimit(Record):
    """The limits that one holder of the device leaves."""

    critical_stiffness = maybe("K_CR, N/m or N m/rad; 0: soft walls are unstable; None: no wall is, or refused.")
    frequency_rad_s = maybe("Where the loop oscillates there, rad/s.")
    limited_by = maybe_one(Mechanism, "What oscillates; None for any passive user.")
    critical_damping = maybe("The largest B at K = 0, N s/m or N m s/rad; None: none is too large, or it is not known.")
    critical_damping_frequency_rad_s = maybe("Where the loop oscillates at that B, rad/s.")
    critical_damping_limited_by = maybe_one(Mechanism, "What oscillates there.")


class HoldingLimits(Record):
    """The limits by who holds the device."""

    nobody = one(HolderLimit, "With nobody holding.")
    user = maybe_one(HolderLimit, "With the file's user; None without an [operator].")
    any_user = maybe_one(HolderLimit, "With any passive user; None where that is not known or not asked for.")


class StableFor(Record):
    """Whom a wall is stable with."""

    nobody = flag("With nobody holding.")
    user = maybe_flag("With the file's user; None without an [operator].")
    any_user = maybe_flag("With any passive user; None where that limit is not known.")


class WallMargins(Record):
    """Margins of a wall (K, B); None where the loop is unstable or there is none."""

    stiffness = number("K, N/m or N m/rad.")
    damping = number("B, N s/m or N m s/rad.")
    stable = flag("With nobody holding and with the file's user: a person lets go.")
    stable_for = one(StableFor, "Whom it is stable with.")
    gain_margin_db = maybe("How far the wall may be scaled up, dB.")
    phase_margin_rad = maybe("rad")
    delay_margin_s = maybe("Least added delay that destabilises, s.")
    spectral_radius = maybe("Largest closed-loop |z|.")
    lower_gain_margin_db = maybe("How far it may be scaled down, dB.")
    stiffness_margin_db = maybe("How far K alone may grow while B stays, dB.")


class AnyUser(Record):
    """The limit over all passive users."""

    critical_stiffness = maybe("N/m or N m/rad; 0: some user destabilises every wall; None: none does.")
    frequency_rad_s = maybe("Of the worst user, rad/s; None where the limit is 0 or None.")
    truncation = maybe("Relative: what the bounds leave open; it is taken off.")
    critical_stiffness_interval = interval("95 % interval that the device's uncertainty makes of it; up to four bodies.")
    worst_user = maybe_one(Record, "With worst_user=True: a user that proves the limit tight.")


class _Limited(Result):
    trust = one(Trust, "How far the numbers may be relied on.")
    remarks = many(Remark, "What was left out or noticed.")
    findings = many(Finding, "What trust and remarks are written from, each once.")
