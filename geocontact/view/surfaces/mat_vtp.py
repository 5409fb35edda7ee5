"""A scan with the pressure of a mat on it as one file for ParaView."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from geocontact.view.surfaces.vtp_series import encoded_vtp, require_pyvista

MM = 1e3


def write_mat_vtp(
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
