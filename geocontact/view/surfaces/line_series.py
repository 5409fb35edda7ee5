"""Lines over time for ParaView: one .vtp file per frame as text, and a .pvd collection that gives them their times."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
from jaxtyping import Float

DIGITS = 7
"""As many as float32 has."""
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
