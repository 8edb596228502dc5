"""What is raised and what is warned of."""

from __future__ import annotations

import os
import sys
import warnings
from dataclasses import dataclass
from typing import Any, Mapping, Optional, Sequence

_PACKAGE = os.path.dirname(os.path.abspath(__file__))


class Error(Exception):
    """What zwidth raises."""


@dataclass(frozen=True)
class Place:
    """Where a problem lies, as far as it is known."""

    file: Optional[str] = None
    line: Optional[int] = None  #: from 1
    column: Optional[int] = None  #: from 1, in bytes
    key: Optional[str] = None  #: of the device file, or a recording's column
    option: Optional[str] = None  #: as a keyword


@dataclass(frozen=True)
class Problem:
    """What is wrong with an input, and what to write instead."""

    where: str
    what: str
    allowed: str = ""
    suggestion: Optional[str] = None  #: a value to put there, as `set` takes it
    place: Place = Place()
    code: Optional[str] = None  #: the kind of problem, "unknown_key"; None where it has words alone

    def __str__(self) -> str:
        text = f"{self.where}: {self.what}" if self.where else self.what
        return f"{text}; {self.allowed}" if self.allowed else text


class InputError(Error, ValueError):
    """An input was refused: `where` it is (`place` in parts), `what` is wrong, what is `allowed`, a `suggestion` to put there.

    Of the first of its `problems`, which are all of the same input.
    """

    def __init__(self, where: str, what: str, allowed: str = "", problems: Sequence[Problem] = ()) -> None:
        super().__init__(where, what, allowed)
        self.where = where
        self.what = what
        self.allowed = allowed
        self.problems = tuple(problems) or (Problem(where, what, allowed),)

    @property
    def place(self) -> Place:
        return self.problems[0].place

    @property
    def suggestion(self) -> Optional[str]:
        return self.problems[0].suggestion

    def __str__(self) -> str:
        return "\n".join(map(str, self.problems))


class WorkFailed(Error, RuntimeError):
    """The input is good, but the work did not succeed."""


class ResultWarning(UserWarning):
    """A result may be wrong, or is less than was asked for: a remark of severity "warning"."""


class DoubtfulResult(ResultWarning):
    """The verdict on a result is "doubtful", or "refused": then its numbers are None."""


def _level_of_caller() -> int:
    """Of the first frame outside this package, as warnings.warn() counts from the function that calls this."""
    level = 1
    frame = sys._getframe(1)
    while frame.f_back is not None and os.path.dirname(os.path.abspath(frame.f_code.co_filename)) == _PACKAGE:
        frame = frame.f_back
        level += 1
    return level


def warn_of_trust(verdict: str, reasons: Sequence[str]) -> None:
    """Warns unless the verdict is sound."""
    if verdict != "sound":
        warnings.warn(f"{verdict}: " + "; ".join(reasons), DoubtfulResult, stacklevel=_level_of_caller())


def warn_of_document(document: Mapping[str, Any]) -> None:
    """Warns of a document's trust, and of its remarks that are warnings."""
    trust = document.get("trust")
    if trust is not None:
        warn_of_trust(trust["verdict"], trust["reasons"])
    for remark in document.get("remarks") or ():
        if remark["severity"] == "warning":
            meaning = f": {remark['meaning']}" if remark["meaning"] else ""
            warnings.warn(remark["what"] + meaning, ResultWarning, stacklevel=_level_of_caller())
