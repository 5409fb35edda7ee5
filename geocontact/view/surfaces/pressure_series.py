"""Pressures over time for ParaView: FIXED with those of its faces and MOVING where it is, a .vtp file per frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import RigidTransform

from geocontact.view.surfaces.vtp_series import BODIES, MM, MPA, encoded_vtp, pvd_text, require_pyvista


@dataclass(frozen=True, eq=False)
class PressureSeries:
    """Two bodies over time.

    Parameters
    ----------
    time
        [s].
    fixed, moving
        Vertices in the body's own frame [m] and faces.
    poses
        Of MOVING in FIXED.
    pressure
        Of FIXED's faces [Pa] in a frame.
    """

    time: Float[np.ndarray, " t"]
    fixed: tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]
    moving: tuple[Float[np.ndarray, "k 3"], Int[np.ndarray, "j 3"]]
    poses: RigidTransform
    pressure: Callable[[int], Float[np.ndarray, " m"]]


def write_pressure_series(series: PressureSeries, folder: Path) -> None:
    """both.pvd over frames/fixed_000.vtp …: positions [mm] in FIXED's frame, `pressure [MPa]` of FIXED's faces."""
    require_pyvista()
    import pyvista

    (folder / "frames").mkdir(parents=True, exist_ok=True)
    digits = max(3, len(str(len(series.time) - 1)))
    rows = []
    for k, time in enumerate(series.time.tolist()):
        places = (series.fixed[0], series.poses[k].apply(series.moving[0]))
        for body, faces, vertices in zip(BODIES, (series.fixed[1], series.moving[1]), places, strict=True):
            surface = pyvista.PolyData.from_regular_faces((vertices * MM).astype(np.float32), faces)
            if body == "fixed":
                surface.cell_data["pressure [MPa]"] = (series.pressure(k) * MPA).astype(np.float32)
            surface.field_data["TimeValue"] = np.array([time])
            surface.field_data["length unit"] = ["mm"]
            name = f"frames/{body}_{k:0{digits}d}.vtp"
            (folder / name).write_bytes(encoded_vtp(surface))
            rows.append((time, body, name))
    (folder / "both.pvd").write_text(pvd_text(rows, BODIES), encoding="utf-8")
