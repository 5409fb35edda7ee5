"""Points, axes, directions and planes as they are typed on the command line, or as a fit left them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from geocontact.analyses.frame.quantities import length, named_file, number
from geocontact.data.errors import InputError
from geocontact.data.plausible import LARGEST_MEANT
from geocontact.io.text.units import LENGTH

if TYPE_CHECKING:  # places are read before anything heavy is imported
    from scipy.spatial.transform import Rotation

    from geocontact.geometry.plane import Plane
    from geocontact.geometry.sagittal import Vector
    from geocontact.geometry.sweep import Axis

LONGEST_AXIS = 10_000
"""Bytes of a file with six numbers."""


def splitting_plane(text: str, unit: str) -> Plane:
    """ "z" or "z=1.5": the plane z = 0 or z = 1.5 (in the mesh unit)."""
    from geocontact.geometry.plane import Plane

    axis, _, at = text.partition("=")
    if axis.strip() not in ("x", "y", "z"):
        raise InputError("", "`split`", f"{text!r} is not an axis", "write x, y or z, or for example z=1.5")
    return Plane.across(axis.strip(), length(at, "`split`", unit) if at else 0.0)


def directions(text: str, option: str) -> tuple[Vector, Vector]:
    """ "-y,x" to two unit vectors along coordinate axes."""
    names = [part.strip() for part in text.split(",")]
    if len(names) != 2 or any(name.lstrip("+-") not in ("x", "y", "z") or len(name) > 2 for name in names):
        raise InputError("", option, f"{text!r} is not two directions", f"write for example {option}=-y,x")
    first, second = (tuple((-1.0 if name[0] == "-" else 1.0) * (name[-1] == axis) for axis in "xyz") for name in names)
    return (first[0], first[1], first[2]), (second[0], second[1], second[2])


def turned_axes(text: str, option: str) -> Rotation:
    """`x,z,-y`: which of the file's axes are our x, y and z. Mirrored or repeated axes are refused."""
    import numpy as np
    from scipy.spatial.transform import Rotation

    parts = [part.strip().lower() for part in text.split(",")]
    matrix = np.zeros((3, 3))
    for row, part in enumerate(parts[:3]):
        if part.lstrip("+-") in ("x", "y", "z"):
            matrix[row, "xyz".index(part.lstrip("+-"))] = -1.0 if part.startswith("-") else 1.0
    if len(parts) != 3 or not np.array_equal(matrix @ matrix.T, np.eye(3)):
        raise InputError("", option, f"{text!r} is not three different axes", "write x,z,-y for a file whose z is up")
    if np.linalg.det(matrix) < 0.0:
        raise InputError("", option, f"{text!r} mirrors", "turn one sign")
    return Rotation.from_matrix(matrix)


def centre(text: str, unit: str, option: str = "`centre`") -> Vector:
    """ "x,y,z" in the mesh unit, or a fit.json of a sphere, to metres."""
    file = named_file(text)
    if file is not None:
        fit = _fit(file, "sphere")
        return _three([float(value) * 1e-3 for value in fit["point_mm"]])
    parts = text.split(",")
    if len(parts) != 3:
        raise InputError("", option, f"{text!r} is neither a fit.json nor three numbers", "write x,y,z")
    return _three([number(part, option, "x,y,z") * LENGTH[unit] for part in parts])


def axis(text: str, unit: str) -> Axis:
    """ "x,y,z,dx,dy,dz" (point in the mesh unit, direction), a text file of them, or a fit.json."""
    file = named_file(text)
    source = text
    if file is not None:
        if file.suffix.lower() == ".json":
            return _axis_of_fit(file)
        from geocontact.io.text.file_preflight import read_bytes

        source = read_bytes(file, LONGEST_AXIS, "give six numbers").decode("utf-8-sig", errors="replace")
    parts = source.replace(",", " ").split()
    if len(parts) != 6:
        raise InputError("", "`axis`", f"{text!r} is neither a file nor six numbers", "write x,y,z,dx,dy,dz")
    values = [number(part, "`axis`", "x,y,z,dx,dy,dz") for part in parts]
    scale = LENGTH[unit]
    return _checked((values[0] * scale, values[1] * scale, values[2] * scale), (values[3], values[4], values[5]), text)


def _axis_of_fit(file: Path) -> Axis:
    fit = _fit(file, "cylinder")
    return _checked(
        _three([float(v) * 1e-3 for v in fit["point_mm"]]), _three(list(map(float, fit["axis"]))), str(file)
    )


def _fit(file: Path, shape: str) -> dict[str, list[float]]:
    """A fit.json of that shape, with three finite numbers wherever it says where."""
    from geocontact.io.text.file_preflight import read_json  # with numpy: not for --help

    keys = ("point_mm", "axis") if shape == "cylinder" else ("point_mm",)
    try:
        fit = read_json(file)
        if fit.get("shape", shape) != shape:
            raise KeyError(shape)
        found = {key: [float(value) for value in fit[key]] for key in keys}
        for values in found.values():
            if any(not abs(value) <= LARGEST_MEANT for value in _three(values)):
                raise ValueError("a number is not finite or too large")
    except InputError:
        raise
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        what = f"holds no {' and '.join(reversed(keys))} of a {shape}"
        raise InputError(file, "", what, f"give the fit.json of a {shape} fit") from error
    return found


def _three(values: list[float]) -> Vector:
    x, y, z = values
    return x, y, z


def _checked(point: tuple[float, float, float], direction: tuple[float, float, float], text: str) -> Axis:
    from geocontact.geometry.sweep import Axis

    try:
        return Axis(point, direction)
    except ValueError as error:
        raise InputError("", "`axis`", str(error), f"check {text!r}") from error
