"""The surface with its residuals as one file for ParaView."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.view.surfaces.vtp_series import encoded_vtp, require_pyvista

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
