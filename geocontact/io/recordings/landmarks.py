"""Landmarks of a surface: named points, such as those picked on a page, with the mesh that they belong to."""

from __future__ import annotations

import re
from dataclasses import dataclass
from os import fspath
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.io.text.plain_table import open_plain
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.storage_header import LONGEST_LINE
from geocontact.io.text.tables import listed
from geocontact.io.text.units import LENGTH, split_header

PLACE = ("x [m]", "y [m]", "z [m]")
EXAMPLE = "id, x [mm], y [mm], z [mm]"
_HEAD = re.compile(r"#\s*(mesh|mesh_sha256|unit|frame)\s*=\s*(.*?)[\s,;]*$")
_SHA256 = re.compile(r"[0-9a-f]{64}")


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Named points of a surface.

    Parameters
    ----------
    path
        Their file.
    names
        Of each, once.
    points
        In the frame of the mesh file [m], in the order of the file.
    mesh, sha256, unit, frame
        Name and hash of the mesh file, unit of its numbers and words for its frame, as `# mesh = ...` and so on above
        the table say; "" where they say nothing, as in files written by hand.
    table
        All columns of the file, SI units in their names.
    """

    path: Path
    names: tuple[str, ...]
    points: Float[np.ndarray, "n 3"]
    mesh: str
    sha256: str
    unit: str
    frame: str
    table: pd.DataFrame

    def point(self, name: str) -> Float[np.ndarray, " 3"]:
        """The point of that name [m]; InputError where there is none."""
        if name not in self.names:
            raise InputError(self.path, "", f"has no landmark {name!r}", f"name one of {listed(self.names)}")
        return np.asarray(self.points[self.names.index(name)])


def read_landmarks(path: Path, more: tuple[str, ...] = (), example: str = EXAMPLE) -> Landmarks:
    """Landmarks of a CSV `id, x [mm], y [mm], z [mm]` (any unit of length), as pages save them or as written by hand.

    `more` are columns that it must have besides. Refused: a missing column, a name that occurs twice, a hash or a unit
    above the table that is none, a unit above it that is not that of the columns.
    """
    wanted = ("id", *more, *PLACE)
    table, file = read_side_table(path, wanted), fspath(path)
    head, header, line = _read_head(path)
    missing = [name for name in wanted if name not in table.columns]
    if missing:
        what = f"no column {', '.join(missing)}; columns are {', '.join(map(str, table.columns))}"
        raise InputError(file, f"line {line}", what.replace("[m]", "with a unit of length"), f"write {example}")
    names = tuple(str(each) for each in table["id"])
    for k, name in enumerate(names):
        if name in names[:k]:
            raise InputError(file, "", f"id {name} occurs twice", "keep one")
    _refuse_other_unit(head.get("unit", ""), header, file, line)
    points = table[list(PLACE)].to_numpy(float)
    mesh, sha256, unit, frame = (head.get(key, "") for key in ("mesh", "mesh_sha256", "unit", "frame"))
    return Landmarks(path, names, points, mesh, sha256, unit, frame, table)


def _read_head(path: Path) -> tuple[dict[str, str], str, int]:
    """What the lines above the table say of the mesh; the row of column names, and its line."""
    found: dict[str, str] = {}
    number = 1
    with open_plain(path) as stream:
        while (text := stream.readline(LONGEST_LINE)).startswith("#"):
            if said := _HEAD.match(text):
                key, value = said.groups()
                found[key] = _checked(key, value, path, number)
            number += 1
    return found, text, number


def _checked(key: str, value: str, path: Path, number: int) -> str:
    odd = (key == "unit" and value not in LENGTH) or (key == "mesh_sha256" and not _SHA256.fullmatch(value))
    if odd:
        what = f"{key} is {value[:70]!r}"
        remedy = f"one of {listed(tuple(LENGTH))}" if key == "unit" else "64 hexadecimal digits"
        raise InputError(path, f"line {number}", what, f"write {remedy}, or pick the landmarks again")
    return value


def _refuse_other_unit(unit: str, header: str, file: str, line: int) -> None:
    """The unit of the mesh above the table is that of the columns: who changes one has to say which is meant."""
    columns = dict(split_header(cell.strip().strip('"').lower()) for cell in header.split(","))
    other = next((said for axis in "xyz" if unit and (said := columns.get(axis, unit)) != unit), None)
    if other is not None:
        what = f"the columns are in {other}, and the mesh in {unit} by the line `unit` above them"
        raise InputError(file, f"line {line}", what, "write both in the unit of the mesh")
