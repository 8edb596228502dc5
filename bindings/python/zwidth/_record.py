"""Parts of a result document as objects: a declared field is an attribute with its meaning and unit as docstring."""

from __future__ import annotations

import html
from typing import Any, Callable, Dict, Generic, Iterator, List, Mapping, Optional, Tuple, Type, TypeVar, Union, overload

import numpy as np
import numpy.typing as npt

from . import _core

T = TypeVar("T")
R = TypeVar("R", bound="Record")
Array = npt.NDArray[np.float64]


class Record:
    """An object of a result document: its keys are attributes. What does not exist is None."""

    def __init__(self, answer: _core.Answer, path: str = "", values: Optional[Dict[str, Any]] = None) -> None:
        self._answer = answer
        self._path = path
        self._values: Dict[str, Any] = answer.value(path) if values is None else values
        self._made: Dict[str, Any] = {}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self._values:
            known = ", ".join(self._values) if not name.startswith("_") else ""
            raise AttributeError(f"{type(self).__name__} has no {name!r}; it has {known}")
        return self._part(name, Record)

    def _part(self, name: str, kind: Type["Record"]) -> Any:
        if name not in self._made:
            path = f"{self._path}/{name.replace('~', '~0').replace('/', '~1')}"
            self._made[name] = _wrapped(self._answer, path, self._values[name], kind)
        return self._made[name]

    def to_dict(self) -> Dict[str, Any]:
        """All of it as a new dict: of a whole result equal to the command's --json."""
        made: Dict[str, Any] = self._answer.value(self._path)
        return made

    def keys(self) -> Iterator[str]:
        """Names of the attributes, in the document's order."""
        return iter(self._values)

    def __dir__(self) -> List[str]:
        return sorted({*super().__dir__(), *(name for name in self._values if name.isidentifier())})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and self.to_dict() == other.to_dict()

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        shown = ", ".join(f"{key}={_short(value)}" for key, value in list(self._values.items())[:8])
        return f"<{type(self).__name__} {shown}{', ...' if len(self._values) > 8 else ''}>"

    def _repr_html_(self) -> str:
        return html_of(self._values)


def html_of(values: Mapping[str, Any]) -> str:
    """A table for notebooks."""
    rows = "".join(
        f'<tr><th style="text-align:left">{html.escape(key)}</th>'
        f'<td style="text-align:left">{html.escape(_short(value))}</td></tr>'
        for key, value in values.items()
    )
    return f"<table>{rows}</table>"


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_short(each)}" for key, each in list(value.items())[:4]) + "}"
    if isinstance(value, list) and (len(value) > 3 or any(isinstance(each, (dict, list)) for each in value)):
        return f"[{len(value)} entries]"
    if isinstance(value, list):
        return "[" + ", ".join(_short(each) for each in value) + "]"
    return repr(value)


def _wrapped(answer: _core.Answer, path: str, value: Any, kind: Type[Record]) -> Any:
    if isinstance(value, dict):
        return kind(answer, path, value)
    if isinstance(value, list) and any(isinstance(each, (dict, list)) for each in value):
        return [_wrapped(answer, f"{path}/{i}", each, kind) for i, each in enumerate(value)]
    return list(value) if isinstance(value, list) else value


class Field(Generic[T]):
    """A declared key of a document."""

    def __init__(self, doc: str, read: Callable[[Record, str], Any], is_optional: bool = False) -> None:
        self.__doc__ = doc
        self._read = read
        self._is_optional = is_optional
        self._name = ""

    def __set_name__(self, owner: Type[Any], name: str) -> None:
        self._name = name.rstrip("_")

    @overload
    def __get__(self, record: None, owner: Type[Any]) -> "Field[T]": ...

    @overload
    def __get__(self, record: Record, owner: Type[Any]) -> T: ...

    def __get__(self, record: Optional[Record], owner: Type[Any]) -> Union["Field[T]", T]:
        if record is None:
            return self
        if self._name not in record._values and not self._is_optional:
            raise AttributeError(f"{type(record).__name__} has no {self._name!r}: {self.__doc__}")
        made: T = self._read(record, self._name)
        return made

    def __set__(self, record: Record, value: Any) -> None:
        raise AttributeError("a result does not change")


def _plain(record: Record, name: str) -> Any:
    return record._part(name, Record)


def anything(doc: str) -> Field[Any]:
    """What has no type of its own: lists of lists, what no document is known to have."""
    return Field(doc, _plain)


def or_none(field: Field[T]) -> Field[Optional[T]]:
    """The same, None where the document has no such key."""
    return Field(field.__doc__ or "", lambda record, name: field._read(record, name) if name in record._values else None, is_optional=True)


def text(doc: str) -> Field[str]:
    return Field(doc, _plain)


def maybe_text(doc: str) -> Field[Optional[str]]:
    return Field(doc, _plain)


def flag(doc: str) -> Field[bool]:
    return Field(doc, _plain)


def maybe_flag(doc: str) -> Field[Optional[bool]]:
    return Field(doc, _plain)


def count(doc: str) -> Field[int]:
    return Field(doc, _plain)


def maybe_count(doc: str) -> Field[Optional[int]]:
    return Field(doc, _plain)


def number(doc: str) -> Field[float]:
    return Field(doc, _plain)


def maybe(doc: str) -> Field[Optional[float]]:
    """A number, or None where there is none."""
    return Field(doc, _plain)


def interval(doc: str) -> Field[Optional[Tuple[Optional[float], Optional[float]]]]:
    """(lower, upper) or None; an end is None where it is unbounded."""
    return Field(doc, lambda record, name: None if record._values[name] is None else tuple(record._values[name]))


def intervals(doc: str) -> Field[List[Tuple[Optional[float], Optional[float]]]]:
    return Field(doc, lambda record, name: [tuple(each) for each in record._values[name]])


def texts(doc: str) -> Field[List[str]]:
    return Field(doc, _plain)


def _array(record: Record, name: str) -> Any:
    if name not in record._made:
        record._made[name] = record._answer.array(f"{record._path}/{name}")
    return record._made[name]


def array(doc: str) -> Field[Array]:
    """A read-only array that owns its buffer; NaN where the document has null."""
    return Field(doc, _array)


def complexes(doc: str) -> Field[npt.NDArray[np.complex128]]:
    """The same of pairs [re, im], seen as complex numbers."""
    return Field(doc, lambda record, name: _array(record, name).view(np.complex128)[:, 0])


def one(kind: Type[R], doc: str) -> Field[R]:
    return Field(doc, lambda record, name: record._part(name, kind))


def maybe_one(kind: Type[R], doc: str) -> Field[Optional[R]]:
    return Field(doc, lambda record, name: record._part(name, kind))


def many(kind: Type[R], doc: str) -> Field[List[R]]:
    return Field(doc, lambda record, name: record._part(name, kind))


class Result(Record):
    """A whole document, with its schema."""

    schema = text('Its schema and version, such as "zwidth.analysis/1".')

    def __init__(self, answer: _core.Answer) -> None:
        super().__init__(answer)

    def _series(self, name: str) -> Array:
        samples = self._answer.series(name)
        if samples is None:
            raise IndexError(f"there is no {name}")
        return samples

    def to_json(self) -> str:
        """The line that the command prints with --json, byte for byte."""
        return self._answer.printed
