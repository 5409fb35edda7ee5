"""Parts of the surface with a name, and the cells that lie on each."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Bool

from geocontact.analyses.bodies import chosen_faces
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.quantities import named_file
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.geometry.surface import Surface
from geocontact.loads.mat.map import MatMap

Parts = Mapping[str, str | Bool[np.ndarray, " f"]]


def read_segments(record: Record, scan: Surface, o: MatOptions) -> Parts:
    """Expression of each part, or the faces that a file lists."""
    found: dict[str, str | Bool[np.ndarray, " f"]] = {}
    for text in o.segment:
        name, sign, expression = (part.strip() for part in text.partition("="))
        if not sign or not name.replace("_", "").replace("-", "").isalnum() or name in found:
            raise InputError("", "`segment`", f"{text!r} has no name of its own", 'write for example "upper=y > 20"')
        faces = None if named_file(expression) is None else chosen_faces(record, "`segment`", expression, scan, o.unit)
        found[name] = expression if faces is None else faces
    return found


def cells_of(
    record: Record, parts: Parts, surface: Surface, placed: MatMap, o: MatOptions
) -> dict[str, Bool[np.ndarray, " n"]]:
    """Cells of each part: those that lie for the most part on its faces, which are chosen in the frame of `surface`."""
    found: dict[str, Bool[np.ndarray, " n"]] = {}
    for name, part in parts.items():
        faces = chosen_faces(record, "`segment`", part, surface, o.unit) if isinstance(part, str) else part
        found[name] = np.asarray(placed.share.T @ np.asarray(faces, float) >= 0.5)
        if not found[name].any():
            raise InputError("", "`segment`", f"no cell lies on '{name}'", "check the expression and the frame")
    if found:
        counted = np.sum(list(found.values()), axis=0)
        for what, cells in (("in no segment", counted == 0), ("in more than one segment", counted > 1)):
            if cells.any():
                record.warn(f"{int(cells.sum())} cells are {what}: segments do not add up to the whole")
    return found
