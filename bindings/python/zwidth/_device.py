"""Python's values as a device file's keys; called by _core.Device."""

from __future__ import annotations

import json
import math
import numbers
import sys
from typing import Any, Dict, Iterable, List, Mapping

from ._errors import InputError


def text_of(where: str, text: str) -> str:
    """The text, which has a UTF-8 form."""
    try:
        text.encode()
    except UnicodeEncodeError:
        raise InputError(where, "has half of a character (a lone surrogate)", "a text that UTF-8 can hold") from None
    return text


def number_of(where: str, value: Any) -> float:
    """A number in SI units as a float."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real) or is_time(value):
        raise InputError(where, f"is of type {type(value).__name__}", "a number in SI units")
    try:
        return float(value)
    except OverflowError:
        raise InputError(where, "is an integer beyond every double", "a finite number") from None


def is_time(value: Any) -> bool:
    """Whether NumPy's or pandas' dates or durations, which pass for numbers of a unit of their own: 1 ms for 1, or 10^6."""
    return getattr(getattr(value, "dtype", None), "kind", "") in ("m", "M")


def _plain(where: str, value: Any) -> Any:
    """A value with NumPy's numbers and arrays as Python's."""
    if isinstance(value, str):
        return text_of(where, value)
    if isinstance(value, bool):
        return value
    if value is None:
        raise InputError(where, "is None", "a value; what is not known is left out")
    if isinstance(value, Mapping):
        return {text_of(where, str(key)): _plain(f"{where}.{key}", each) for key, each in value.items()}
    if is_time(value):
        raise InputError(where, f"is of type {type(value).__name__}", 'a number of seconds, or a text such as "1 ms"')
    if isinstance(value, numbers.Integral):
        if abs(int(value)) > sys.float_info.max:
            raise InputError(where, "is an integer beyond every double", "a finite number")
        return int(value)
    if isinstance(value, numbers.Real):
        number = float(value)
        if not math.isfinite(number):
            raise InputError(where, f"is {number}", "a finite number")
        return number
    if hasattr(value, "tolist"):
        return _plain(where, value.tolist())
    if isinstance(value, (list, tuple)):
        return [_plain(f"{where}.{i}", each) for i, each in enumerate(value)]
    raise InputError(where, f"is of type {type(value).__name__}", "a number, text, list or dict")


def json_of(keys: Mapping[str, Any], name: str = "device") -> str:
    """The keys of a device file, or of a study file, as JSON."""
    return json.dumps(_plain(name, keys))


def overrides(changes: Mapping[str, Any], keywords: Mapping[str, Any]) -> List[str]:
    """The changes as "KEY=VALUE"; in keywords "__" stands for a dot."""
    merged: Dict[str, Any] = dict(changes)
    for name, value in keywords.items():
        key = name.replace("__", ".")
        if key in merged:
            raise InputError(f"device.{key}", "is given twice", "once")
        merged[key] = value
    texts = []
    for key, value in merged.items():
        if not isinstance(key, str) or not key or "=" in key:
            raise InputError("device", f"{key!r} is no key", 'a key such as "link.stiffness"')
        text_of("device", key)
        if value is None:
            raise InputError(f"device.{key}", "is None", "a value; no key can be taken out")
        plain = _plain(f"device.{key}", value)
        texts.append(f"{key}={plain if isinstance(plain, str) else json.dumps(plain)}")
    return texts


def assignments(given: Any) -> List[str]:
    """Overrides as the caller has them: "KEY=VALUE", each a text."""
    if isinstance(given, (str, bytes)) or not isinstance(given, Iterable):
        raise InputError("set", f"is of type {type(given).__name__}", 'a list of texts such as ["loop.delay=1e-3"]')
    texts = list(given)
    for i, each in enumerate(texts):
        if not isinstance(each, str):
            raise InputError(f"set[{i}]", f"is of type {type(each).__name__}", 'a text such as "loop.delay=1e-3"')
        text_of(f"set[{i}]", each)
    return texts


def restored(toml: str) -> Any:
    """The device of a pickle."""
    from ._core import Device

    return Device.from_toml(toml)
