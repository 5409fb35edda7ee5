"""Points with values as a .vtp of VTK, which ParaView opens; written as text, without VTK."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
from jaxtyping import Float

from geocontact.view.surfaces.line_series import HEAD

DIGITS = 7


def write_points_vtp(
    file: Path, points: Float[np.ndarray, "n 3"], fields: Mapping[str, Float[np.ndarray, " n"]]
) -> None:
    """Each point a vertex of its own; lengths in the unit that the fields' names tell, points in mm.

    Parameters
    ----------
    points
        [m].
    fields
        Values by name with unit; NaN where there is none.
    """
    count = len(points)
    own = "".join(_array(name, values, 1) for name, values in fields.items())
    numbers = " ".join(map(str, range(count)))
    ends = " ".join(map(str, range(1, count + 1)))
    text = (
        HEAD.format(kind="PolyData")
        + f'  <PolyData>\n    <Piece NumberOfPoints="{count}" NumberOfVerts="{count}" '
        + 'NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">\n'
        + f"      <PointData>\n{own}      </PointData>\n"
        + f"      <Points>\n{_array('points', 1e3 * points, 3)}      </Points>\n"
        + f'      <Verts>\n        <DataArray type="Int32" Name="connectivity" format="ascii">{numbers}</DataArray>\n'
        + f'        <DataArray type="Int32" Name="offsets" format="ascii">{ends}</DataArray>\n      </Verts>\n'
        + "    </Piece>\n  </PolyData>\n</VTKFile>\n"
    )
    file.write_text(text, encoding="utf-8")


def _array(name: str, values: Float[np.ndarray, ...], size: int) -> str:
    cells = " ".join(f"{x:.{DIGITS}g}" for x in values.ravel().tolist())
    head = f'type="Float32" Name={quoteattr(name)} NumberOfComponents="{size}" format="ascii"'
    return f"        <DataArray {head}>{cells}</DataArray>\n"
