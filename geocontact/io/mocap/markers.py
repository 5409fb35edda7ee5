"""One way in for every kind of marker file."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.io.mocap.c3d_markers import read_c3d_markers
from geocontact.io.mocap.csv_markers import read_csv_markers
from geocontact.io.mocap.trc import read_trc


def read_markers(path: str | PathLike[str], c3d_unit: str | None = None) -> MarkerTrajectories:
    """Marker trajectories of a .trc, .c3d or .csv file in metres, in the file's own axes.

    `c3d_unit` is that of a .c3d file whose own is empty.
    """
    suffix = Path(fspath(path)).suffix.lower()
    if suffix == ".trc":
        return read_trc(path)
    if suffix == ".c3d":
        return read_c3d_markers(path, c3d_unit)
    if suffix == ".csv":
        return read_csv_markers(path)
    raise InputError(path, "", f"'{suffix}' is not a file of markers", "give a .trc, .c3d or .csv file")
