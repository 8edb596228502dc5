"""Python's values as a mechanism's, and arrays as the options of the command `workspace`; called by _core.Mechanism."""

from __future__ import annotations

import math
import numbers
import os
from typing import Any, Dict, List, Mapping, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from ._device import is_time, number_of, text_of
from ._errors import InputError

TRANSMISSION = ("ratio", "inertia", "motor_damping", "stiffness", "damping")


def source_of(source: Any) -> Tuple[str, str]:
    """(path, "") or ("", text): a text has more than one line, which no path has."""
    if isinstance(source, str) and "\n" in text_of("mechanism", source):
        return "", source
    if not isinstance(source, (str, os.PathLike)) or not isinstance(os.fspath(source), str):
        raise InputError("mechanism", f"is of type {type(source).__name__}", "a path, or the text itself")
    path = text_of("mechanism", os.fspath(source))
    if not path or "\0" in path:
        raise InputError("mechanism", "is empty or has a character of code 0", "a path")
    return path, ""


def names_of(names: Any) -> List[str]:
    """The encoders."""
    if isinstance(names, (str, bytes)) or not isinstance(names, (list, tuple)):
        raise InputError("encoders", f"is of type {type(names).__name__}", "a list of joints")
    for i, each in enumerate(names):
        if not isinstance(each, str):
            raise InputError(f"encoders[{i}]", f"is of type {type(each).__name__}", "a joint's name")
        text_of(f"encoders[{i}]", each)
    return list(names)


def positions_of(pose: Any, joints: Sequence[str]) -> Dict[str, float]:
    """Positions by joint, of a mapping or of numbers in the order of `joints`."""
    if isinstance(pose, Mapping):
        positions = {text_of("pose", str(key)): number_of(f"pose.{key}", value) for key, value in pose.items()}
        for key, value in positions.items():
            if not math.isfinite(value):
                raise InputError(f"pose.{key}", f"is {value}", "a finite number")
        return positions
    found = real_numbers("pose", pose, 1)
    if len(found) != len(joints):
        raise InputError("pose", f"has {len(found)} numbers", f"{len(joints)}: {', '.join(joints)}")
    return dict(zip(joints, found.tolist()))


def transmissions_of(motors: Any) -> List[Tuple[str, Dict[str, float]]]:
    """(joint, its other numbers) of each."""
    found = []
    for i, each in enumerate(motors):
        where = f"transmissions[{i}]"
        if not isinstance(each, Mapping) or not isinstance(each.get("joint"), str):
            raise InputError(where, "names no joint", 'a dict such as {"joint": "shoulder", "inertia": 8e-5}')
        for key in each:
            if key != "joint" and key not in TRANSMISSION:
                raise InputError(f"{where}.{key}", "is no key of a transmission", f"joint, {', '.join(TRANSMISSION)}")
        given = {key: number_of(f"{where}.{key}", each[key]) for key in TRANSMISSION if key in each}
        found.append((text_of(where, each["joint"]), given))
    return found


def real_numbers(where: str, values: npt.ArrayLike, dimensions: int) -> npt.NDArray[np.float64]:
    """An array of finite numbers."""
    if np.iscomplexobj(values) or is_time(values) or isinstance(values, np.ma.MaskedArray):
        raise InputError(where, "is complex, masked, or of times", "real numbers")
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(where, f"is no array of numbers: {error}", "real numbers") from None
    if array.ndim != dimensions:
        raise InputError(where, f"has {array.ndim} dimensions", str(dimensions))
    if not np.isfinite(array).all():
        raise InputError(where, "has a number that is not finite", "finite numbers")
    return array


def point_of(point: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """Three numbers."""
    array = real_numbers("point", point, 1)
    if array.shape != (3,):
        raise InputError("point", f"has {len(array)} numbers", "three: x, y, z in m")
    return array


def vectors_text(where: str, vectors: Union[str, npt.ArrayLike]) -> str:
    """Rows of three numbers, as the command takes them; one vector alone is one row. A text stays as it is."""
    if isinstance(vectors, str):
        return vectors
    array = real_numbers(where, vectors, 1 if np.ndim(vectors) == 1 else 2).reshape(-1, np.shape(vectors)[-1])
    if array.shape[1] != 3 or not len(array):
        raise InputError(where, f"is of shape {np.shape(vectors)}", "rows of three numbers")
    return ";".join(",".join(map(repr, row)) for row in array.tolist())


def count_of(where: str, value: Any) -> int:
    """A whole number of at least one."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or value < 1:
        raise InputError(where, f"is {value!r}", "a whole number >= 1")
    return int(value)


def poses_text(device: Any, poses: Any) -> Union[str, List[str]]:
    """Poses as the command takes them: texts of grids as they are, numbers by joint or in columns as a list of poses."""
    if isinstance(poses, str) or isinstance(poses, (list, tuple)) and poses and all(isinstance(each, str) for each in poses):
        return list(poses) if not isinstance(poses, str) else poses
    if isinstance(poses, Mapping):
        joints = [text_of("poses", str(each)) for each in poses]
        columns = [real_numbers(f"poses.{joint}", poses[joint], 1) for joint in joints]
        if not columns or len({len(each) for each in columns}) != 1:
            raise InputError("poses", "has columns of different lengths, or none", "an array of one length for each joint")
        rows = np.column_stack(columns)
    else:
        from . import _core

        joints = _core.Mechanism.of(device).pose_joints
        rows = real_numbers("poses", poses, 2)
        if rows.shape[1] != len(joints):
            raise InputError("poses", f"has {rows.shape[1]} columns", f"{len(joints)}: {', '.join(joints)}")
    if not len(rows):
        raise InputError("poses", "has no rows", "one pose at least")
    for joint in joints:
        if any(mark in joint for mark in ",;"):
            raise InputError("poses", f"joint {joint!r} has a comma or a semicolon in its name", "a name without")
    return ";".join(",".join(f"{joint}={value!r}" for joint, value in zip(joints, row)) for row in rows.tolist())
