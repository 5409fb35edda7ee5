"""Marker trajectories as a .trc file in millimetres, which OpenSim reads."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.data.seconds import seconds

ASKED = (
    "DataRate",
    "CameraRate",
    "NumFrames",
    "NumMarkers",
    "Units",
    "OrigDataRate",
    "OrigDataStartFrame",
    "OrigNumFrames",
)


def write_trc(path: Path, markers: MarkerTrajectories) -> None:
    """Cells of a marker that was not seen are empty; the rate in the head is that of the mean step."""
    path.write_text(trc_text(path.name, markers), encoding="utf-8")


def trc_text(name: str, markers: MarkerTrajectories, decimals: int = 6) -> str:
    """The file's text, with so many decimals of a millimetre."""
    count, steps = len(markers.names), len(markers) - 1
    rate = steps / float(markers.time[-1] - markers.time[0]) if steps > 0 else 1.0
    told = (f"{rate:.6g}", f"{rate:.6g}", str(len(markers)), str(count), "mm", f"{rate:.6g}", "1", str(len(markers)))
    lines = [
        f"PathFileType\t4\t(X/Y/Z)\t{name}",
        "\t".join(ASKED),
        "\t".join(told),
        "Frame#\tTime\t" + "\t\t\t".join(markers.names),
        "\t\t" + "\t".join(f"{axis}{k + 1}" for k in range(count) for axis in "XYZ"),
        "",
    ]
    for k, (time, places) in enumerate(zip(markers.time, 1e3 * markers.positions, strict=True)):
        cells = ("" if np.isnan(value) else f"{value:.{decimals}f}" for value in places.ravel())
        lines.append("\t".join((str(k + 1), seconds(float(time), 9), *cells)))
    return "\n".join(lines) + "\n"
