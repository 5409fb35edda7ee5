"""Time series for ParaView: one .vtp file per body and frame, and .pvd collections that give them their times."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import RigidTransform

from geocontact.data.errors import InputError, memory_is_short
from geocontact.data.xml_text import quoteattr
from geocontact.view.surfaces.child import INSTALL
from geocontact.view.surfaces.scene import ContactSeries

if TYPE_CHECKING:
    from pyvista import PolyData


DIGITS = 7
"""Significant digits of float32."""
HEAD = '<?xml version="1.0"?>\n<VTKFile type="{kind}" version="0.1" byte_order="LittleEndian">\n'


@dataclass(frozen=True, eq=False)
class LineSeries:
    """Points that move, and lines through some of them.

    Parameters
    ----------
    time
        [s].
    points
        In one frame [m].
    lines
        Points of each line, in order.
    """

    time: Float[np.ndarray, " t"]
    points: Float[np.ndarray, "t n 3"]
    lines: Sequence[tuple[int, ...]]


def write_line_series(
    folder: Path, name: str, series: LineSeries, vectors: Mapping[str, Float[np.ndarray, "t n 3"]]
) -> Path:
    """Write `name`.pvd and `frames/name_000.vtp` …; returns the collection, which is what ParaView opens.

    Parameters
    ----------
    vectors
        On every point, by name with unit: what ParaView's filter Glyph draws as arrows.
    """
    frames = folder / "frames"
    frames.mkdir(parents=True, exist_ok=True)
    digits = max(3, len(str(len(series.time) - 1)))
    rows = []
    for k, time in enumerate(series.time.tolist()):
        file = f"frames/{name}_{k:0{digits}d}.vtp"
        (folder / file).write_text(_polydata(series, k, vectors), encoding="utf-8")
        rows.append(f'    <DataSet timestep="{time:.6f}" part="0" file={quoteattr(file)}/>\n')
    written = folder / f"{name}.pvd"
    text = HEAD.format(kind="Collection") + "  <Collection>\n" + "".join(rows) + "  </Collection>\n</VTKFile>\n"
    written.write_text(text, encoding="utf-8")
    return written


def _polydata(series: LineSeries, k: int, vectors: Mapping[str, Float[np.ndarray, "t n 3"]]) -> str:
    joined = [str(i) for line in series.lines for i in line]
    ends = np.cumsum([len(line) for line in series.lines]).tolist()
    own = "".join(_array(name, values[k]) for name, values in vectors.items())
    return (
        HEAD.format(kind="PolyData")
        + f'  <PolyData>\n    <Piece NumberOfPoints="{series.points.shape[1]}" NumberOfVerts="0" '
        + f'NumberOfLines="{len(series.lines)}" NumberOfStrips="0" NumberOfPolys="0">\n'
        + f"      <PointData>\n{own}      </PointData>\n"
        + f"      <Points>\n{_array('points', series.points[k])}      </Points>\n"
        + f"      <Lines>\n{_integers('connectivity', joined)}{_integers('offsets', map(str, ends))}      </Lines>\n"
        + "    </Piece>\n  </PolyData>\n</VTKFile>\n"
    )


def _array(name: str, values: Float[np.ndarray, "n 3"]) -> str:
    cells = " ".join(f"{x:.{DIGITS}g}" for x in values.ravel().tolist())
    head = f'type="Float32" Name={quoteattr(name)} NumberOfComponents="3" format="ascii"'
    return f"        <DataArray {head}>{cells}</DataArray>\n"


def _integers(name: str, values: Iterable[str]) -> str:
    return f'        <DataArray type="Int32" Name="{name}" format="ascii">{" ".join(values)}</DataArray>\n'


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
    `pressure [MPa]` and `wear [mm]`, where these were computed. Field data also give TimeValue, the units, the
    thresholds, the frame of reference and the program.

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
            if mapped.wear is not None:
                surface.cell_data["wear [mm]"] = (mapped.wear * MM).astype(np.float32)
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
        if memory_is_short(error):
            raise
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
