"""Analog channels of a .c3d file, read by ezc3d in a process of its own as force plates are.

`python -m geocontact.io.mocap.c3d_analogs FILE` writes an .npz of plain arrays to standard output.
"""

from __future__ import annotations

import sys
from os import PathLike, fspath

import numpy as np

from geocontact.io.mocap.c3d_plates import Arrays, read_apart
from geocontact.io.text.storage_header import AngleEvidence
from geocontact.io.text.tables import TextTable


def read_c3d_analogs(path: str | PathLike[str], plates: bool = True) -> TextTable:
    """Table of the analog channels, each with the unit that the file says; those of force plates too by default."""
    arrays = read_apart(path, __name__)
    kept = np.arange(arrays["values"].shape[1]) if plates else np.flatnonzero(~np.asarray(arrays["of_plates"], bool))
    values = np.asarray(arrays["values"], float)[:, kept]
    time = float(arrays["start"]) + np.arange(len(values)) / float(arrays["rate"])
    names = tuple(str(name) for name in arrays["names"][kept])
    units = tuple(str(unit) for unit in arrays["units"][kept])
    lines = np.arange(1, len(values) + 1, dtype=np.int64)
    return TextTable(time, values, names, units, fspath(path), lines, AngleEvidence(), opensim=False)


def analogs_of(path: str) -> Arrays:
    """The same, in this process, with the frames of points that the file holds."""
    import ezc3d  # type: ignore[import-untyped]

    content = ezc3d.c3d(path)
    points, analogs = content["header"]["points"], content["header"]["analogs"]
    told = content["parameters"]["ANALOG"]
    values = content["data"]["analogs"][0].T
    units = [str(unit).strip() for unit in told.get("UNITS", {"value": []})["value"]]
    plates = content["parameters"].get("FORCE_PLATFORM", {}).get("CHANNEL", {"value": []})["value"]
    of_plates = np.isin(np.arange(values.shape[1]) + 1, np.asarray(plates, int).ravel())
    return {
        "frames": np.array(content["data"]["points"].shape[2]),
        "rate": np.array(float(analogs["frame_rate"])),
        "start": np.array(float(points["first_frame"]) / max(float(points["frame_rate"]), 1e-9)),
        "values": values,
        "names": np.array([str(name).strip() for name in told["LABELS"]["value"]][: values.shape[1]]),
        "of_plates": of_plates,
        "units": np.array((units + [""] * values.shape[1])[: values.shape[1]]),
    }


if __name__ == "__main__":
    np.savez(sys.stdout.buffer, **analogs_of(sys.argv[1]))  # type: ignore[arg-type]
