"""Markers of a .c3d file, read by ezc3d in a process of its own as force plates are.

`python -m geocontact.io.c3d_markers FILE` writes an .npz of plain arrays to standard output.
"""

from __future__ import annotations

import sys
from os import PathLike, fspath

import numpy as np

from geocontact.data.errors import InputError
from geocontact.data.marker_trajectories import MarkerTrajectories
from geocontact.io.c3d_plates import Arrays, read_apart
from geocontact.io.units import LENGTH


def read_c3d_markers(path: str | PathLike[str]) -> MarkerTrajectories:
    """Markers in metres in the laboratory's axes; what is before a colon in a label is the subject and left out."""
    file = fspath(path)
    arrays = read_apart(path, __name__)
    unit, rate = str(arrays["unit"]), float(arrays["rate"])
    names = tuple(str(name).rpartition(":")[2] for name in arrays["names"])
    positions = np.asarray(arrays["positions"], float)
    if not names or not len(positions):
        raise InputError(file, "", "holds no markers", "give a file with recorded points")
    if unit not in LENGTH:
        raise InputError(file, "POINT:UNITS", f"is '{unit[:20]}'", f"expected one of {', '.join(LENGTH)}")
    if not (np.isfinite(rate) and rate > 0.0):
        raise InputError(file, "POINT:RATE", f"is {rate:g} Hz", "is the file complete?")
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InputError(file, "POINT:LABELS", f"'{twice[0]}' occurs {names.count(twice[0])} times", "rename one")
    lost = np.any(~np.isfinite(positions), axis=2) | np.all(positions == 0.0, axis=2)
    time = float(arrays["start"]) + np.arange(len(positions)) / rate
    return MarkerTrajectories(time, np.where(lost[..., None], np.nan, LENGTH[unit] * positions), names, file)


def markers_of(path: str) -> Arrays:
    """The same, in this process; points whose residual is negative were not seen."""
    import ezc3d  # type: ignore[import-untyped]

    content = ezc3d.c3d(path)
    head, told, data = content["header"]["points"], content["parameters"]["POINT"], content["data"]
    positions = np.moveaxis(data["points"][:3], (0, 1, 2), (2, 1, 0))
    residuals = data["meta_points"]["residuals"][0].T
    rate = float(head["frame_rate"])
    labels = [str(name).strip() for name in told["LABELS"]["value"]][: positions.shape[1]]
    units = told.get("UNITS", {"value": ["mm"]})["value"]
    return {
        "frames": np.array(len(positions)),
        "rate": np.array(rate),
        "start": np.array(float(head["first_frame"]) / max(rate, 1e-9)),
        "positions": np.where((residuals < 0.0)[..., None], np.nan, positions),
        "names": np.array(labels),
        "unit": np.array(str(units[0]).strip() if len(units) else "mm"),
    }


if __name__ == "__main__":
    np.savez(sys.stdout.buffer, **markers_of(sys.argv[1]))  # type: ignore[arg-type]
