"""Time series for ParaView: one .vtp file per body and frame, and .pvd collections that give them their times."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, cast
from xml.sax.saxutils import quoteattr

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.view.surfaces.probe import INSTALL
from geocontact.view.surfaces.scene import ContactSeries

if TYPE_CHECKING:
    from pyvista import PolyData

MM = 1e3
MPA = 1e-6
BODIES = ("fixed", "moving")


def write_vtp_series(series: ContactSeries, folder: Path, program: str) -> tuple[Path, ...]:
    """Write both bodies in FIXED's frame for every frame; returns the collections, which are what ParaView opens.

    `both.pvd` plays both bodies; `fixed.pvd` and `moving.pvd` play one each, to be coloured on its own. Frames lie in
    `frames/fixed_000.vtp` and so on: positions [mm] and distances [mm] as float32 (1e-4 mm at 1 m), raw and compressed.

    Point data are `distance [mm]`, the signed distance to the other body, and `within 4 mm` (0 or 1) for each
    threshold. Distances are truncated at the field datum `truncated at [mm]`, so that value means "at least": not a
    number would leave holes in ParaView's contour lines and infinity would spoil its colour range. Cell data are
    `pressure [MPa]`, where pressures were computed. Field data also give TimeValue, the units, the thresholds, the
    frame of reference and the program.

    Parameters
    ----------
    series
        The bodies over the motion.
    folder
        Folder to write into, made if need be; the caller discards it when this raises (`InputError`, `OSError`).
    program
        Name and version of the program, for the record; ASCII, as VTK's texts are.
    """
    require_pyvista()
    frames = folder / "frames"
    frames.mkdir(parents=True, exist_ok=True)
    limit = truncation(series)
    digits = max(3, len(str(len(series) - 1)))
    names: dict[str, list[str]] = {body: [] for body in BODIES}
    for k in range(len(series)):
        placed = (series.fixed.vertices, series.placed(k))
        for body, mapped, vertices in zip(BODIES, (series.fixed, series.moving), placed, strict=True):
            surface = _surface(vertices, mapped.faces, mapped.distance[k], series.thresholds, limit)
            if mapped.pressure is not None:
                surface.cell_data["pressure [MPa]"] = (mapped.pressure[k] * MPA).astype(np.float32)
            _describe(surface, series, k, limit, body, program)
            names[body].append(f"frames/{body}_{k:0{digits}d}.vtp")
            (folder / names[body][-1]).write_bytes(encoded_vtp(surface))
    written = []
    for collection, bodies in (("both", BODIES), ("fixed", BODIES[:1]), ("moving", BODIES[1:])):
        written.append(folder / f"{collection}.pvd")
        rows = [(float(series.time[k]), body, names[body][k]) for k in range(len(series)) for body in bodies]
        written[-1].write_text(pvd_text(rows, bodies), encoding="utf-8")
    return tuple(written)


def truncation(series: ContactSeries) -> float:
    """Distance [m] at which those of a series are truncated: not below any that is known, and above the thresholds."""
    known = [np.abs(d[np.isfinite(d)]).max(initial=0.0) for d in (series.fixed.distance, series.moving.distance)]
    return float(max(*known, 1.25 * max(series.thresholds)))


def require_pyvista() -> None:
    """InputError where pyvista is not installed."""
    try:
        import pyvista  # noqa: F401
    except ImportError as error:
        raise InputError("", "VTP export", f"pyvista cannot be imported ({error})", INSTALL) from error


def _surface(
    vertices: Float[np.ndarray, "n 3"],
    faces: Int[np.ndarray, "m 3"],
    distance: Float[np.ndarray, " n"],
    thresholds: tuple[float, ...],
    limit: float,
) -> PolyData:
    import pyvista

    surface = pyvista.PolyData.from_regular_faces((vertices * MM).astype(np.float32), faces)
    for threshold in thresholds:
        surface.point_data[f"within {threshold * MM:g} mm"] = (distance <= threshold).astype(np.uint8)
    surface.point_data["distance [mm]"] = (np.clip(distance, -limit, limit) * MM).astype(np.float32)
    surface.set_active_scalars("distance [mm]")
    return surface


def _describe(surface: PolyData, series: ContactSeries, frame: int, limit: float, body: str, program: str) -> None:
    data = surface.field_data
    data["TimeValue"] = series.time[frame : frame + 1]  # the name by which VTK knows it
    data["time unit"] = [series.time_unit]
    data["length unit"] = ["mm"]
    data["thresholds [mm]"] = np.asarray(series.thresholds) * MM
    data["truncated at [mm]"] = np.array([limit * MM])
    data["signed"] = np.array([series.signed in ("both", body)], np.uint8)
    data["body"] = [body.upper()]
    data["frame of reference"] = ["FIXED"]
    data["program"] = [program]


def encoded_vtp(surface: PolyData) -> bytes:
    """Bytes of a .vtp file. VTK's own writing to a file ends the process when the disk is full."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(surface)
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.WriteToOutputStringOn()
    if not writer.Write():
        raise OSError("VTK could not write the surface")
    return cast("bytes", writer.GetOutputString())


def pvd_text(rows: list[tuple[float, str, str]], bodies: tuple[str, ...]) -> str:
    """Text of a .pvd file from times, bodies and the files that show them."""
    lines = [
        f'    <DataSet timestep="{time!r}" part="{bodies.index(body)}" name={quoteattr(body.upper())} '
        f"file={quoteattr(file)}/>"
        for time, body, file in rows
    ]
    return "\n".join(
        [
            '<?xml version="1.0"?>',
            '<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">',
            "  <Collection>",
            *lines,
            "  </Collection>",
            "</VTKFile>",
            "",
        ]
    )
