"""Markers of a .c3d file, read by ezc3d in a process of its own as force plates are.

`python -m geocontact.io.mocap.c3d_markers FILE` writes an .npz of plain arrays to standard output.
"""

from __future__ import annotations

import sys
import warnings
from os import PathLike, fspath

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.c3d_plates import Arrays, point_metre, read_apart
from geocontact.io.mocap.segment_poses import holds_segments
from geocontact.io.mocap.trc import without_subject


def read_c3d_markers(path: str | PathLike[str], c3d_unit: str | None = None) -> MarkerTrajectories:
    """Markers in metres in the laboratory's axes; `c3d_unit` is that of a file whose own is empty.

    What stands before a colon in a label is the subject; it is left out where that leaves no two names alike. Of
    markers with one label the one that is seen in most frames is taken, with a warning. Markers without a label, or
    behind the last one, are passed over with one warning.
    """
    file = fspath(path)
    try:
        arrays = read_apart(path, __name__, analogs=False)
    except InputError:
        _refuse_segments(path)
        raise
    if not arrays["positions"].size:
        _refuse_segments(path)
    metre, rate = point_metre(file, str(arrays["unit"]), c3d_unit), float(arrays["rate"])
    positions = np.asarray(arrays["positions"], float)
    positions = np.where(np.all(positions == 0.0, axis=2, keepdims=True), np.nan, positions)
    names, kept = _named(file, [str(name) for name in arrays["names"]], positions)
    positions = positions[:, kept]
    if not names or not len(positions):
        raise InputError(file, "", "holds no markers", "give a file with recorded points")
    if not (np.isfinite(rate) and rate > 0.0):
        raise InputError(file, "POINT:RATE", f"is {rate:g} Hz", "is the file complete?")
    lost = np.any(~np.isfinite(positions), axis=2)
    time = float(arrays["start"]) + np.arange(len(positions)) / rate
    return MarkerTrajectories(time, np.where(lost[..., None], np.nan, metre * positions), names, file)


def _refuse_segments(path: str | PathLike[str]) -> None:
    """InputError for poses of segments in place of points, as Theia writes them: labels such as pelvis_4X4."""
    if holds_segments(path):
        what = "holds poses of segments (…_4X4), as Theia writes them, in place of markers"
        raise InputError(path, "ROTATION:LABELS", what, "`ik` reads them; else export markers as .trc or .c3d")


def _named(file: str, labels: list[str], positions: Float[np.ndarray, "t m 3"]) -> tuple[tuple[str, ...], list[int]]:
    """Names without the subject where they stay different, and which points have them."""
    there = [k for k, label in enumerate(labels) if label]
    if unnamed := positions.shape[1] - len(there):
        what = "1 marker without a name is" if unnamed == 1 else f"{unnamed} markers without a name are"
        warnings.warn(InputWarning(f"{file}: {what} passed over"), stacklevel=4)
    names = without_subject([labels[k] for k in there])
    counts = np.isfinite(positions).all(axis=2).sum(axis=0)
    kept: dict[str, int] = {}
    for k, name in zip(there, names, strict=True):
        before = kept.setdefault(name, k)
        if before == k:
            continue
        frames = f"seen in {counts[before]} and {counts[k]} frames"
        used = "first" if counts[k] == counts[before] else "one with more frames"
        warnings.warn(InputWarning(f"{file}: marker '{name}' occurs twice, {frames}; the {used} is used"), stacklevel=4)
        kept[name] = k if counts[k] > counts[before] else before
    return tuple(kept), list(kept.values())


def markers_of(path: str) -> Arrays:
    """The same, in this process; points whose residual is negative were not seen."""
    import ezc3d  # type: ignore[import-untyped]

    content = ezc3d.c3d(path)
    head, told, data = content["header"]["points"], content["parameters"]["POINT"], content["data"]
    positions = np.moveaxis(data["points"][:3], (0, 1, 2), (2, 1, 0))
    residuals = data["meta_points"]["residuals"][0].T
    rate = float(head["frame_rate"])
    lists = [told[key]["value"] for key in ("LABELS", *(f"LABELS{k}" for k in range(2, 99))) if key in told]
    labels = [str(name).strip() for each in lists for name in each][: positions.shape[1]]
    units = told.get("UNITS", {"value": []})["value"]
    return {
        "frames": np.array(len(positions)),
        "rate": np.array(rate),
        "start": np.array(float(head["first_frame"]) / max(rate, 1e-9)),
        "positions": np.where((residuals < 0.0)[..., None], np.nan, positions),
        "names": np.array(labels),
        "unit": np.array(str(units[0]).strip() if len(units) else ""),
    }


if __name__ == "__main__":
    np.savez(sys.stdout.buffer, **markers_of(sys.argv[1]))  # type: ignore[arg-type]
