"""Points and surfaces with values as single .vtp files, which ParaView opens; written as text, without VTK."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.data.xml_text import quoteattr
from geocontact.view.surfaces.vtp_series import HEAD, encoded_vtp, require_pyvista

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


MM = 1e3


def write_fit_vtp(
    file: Path,
    vertices: Float[np.ndarray, "n 3"],
    faces: Int[np.ndarray, "m 3"],
    residual: Float[np.ndarray, " n"],
    chosen: Bool[np.ndarray, " m"],
    program: str,
) -> None:
    """Write positions [mm] with `residual [mm]` at the vertices (NaN off the patch) and `patch` (0 or 1) of the faces.

    Parameters
    ----------
    vertices, faces
        The surface [m].
    residual
        Signed distance of every vertex to the fitted shape [m]; NaN where it does not count.
    chosen
        Faces that count.
    program
        Name and version of the program, for the record; ASCII, as VTK's texts are.
    """
    require_pyvista()
    import pyvista

    body = pyvista.PolyData.from_regular_faces((vertices * MM).astype(np.float32), faces)
    body.point_data["residual [mm]"] = (residual * MM).astype(np.float32)
    body.cell_data["patch"] = chosen.astype(np.uint8)
    body.set_active_scalars("residual [mm]")
    body.field_data["length unit"] = ["mm"]
    body.field_data["program"] = [program]
    file.write_bytes(encoded_vtp(body))


def write_faces_vtp(
    file: Path,
    vertices: Float[np.ndarray, "n 3"],
    faces: Int[np.ndarray, "m 3"],
    numbers: Mapping[str, Float[np.ndarray, " m"]],
    program: str,
) -> None:
    """Write positions [mm] of the vertices, which are in m, and numbers of the faces, by their name with its unit.

    `program` is its name and version, for the record; ASCII, as VTK's texts are.
    """
    require_pyvista()
    import pyvista

    body = pyvista.PolyData.from_regular_faces((vertices * MM).astype(np.float32), faces)
    for name, values in numbers.items():
        body.cell_data[name] = values.astype(np.float32)
    body.set_active_scalars(next(iter(numbers)))
    body.field_data["length unit"] = ["mm"]
    body.field_data["program"] = [program]
    file.write_bytes(encoded_vtp(body))
