"""Poses of segments in a .c3d file, as Theia writes them, and orientations of sensors in OpenSense's .sto.

A .c3d has them in the group ROTATION (c-motion's extension, read by ezc3d): LABELS such as pelvis_4X4, USED, RATE or
RATIO to the rate of points; of each a matrix of 4 x 4, its translation in the unit of points. A .sto of OpenSense has
`DataType=Quaternion` in its head and cells `w,x,y,z` (OpenSim 4.6, STOFileAdapter).

`python -m geocontact.io.mocap.segment_poses FILE` writes an .npz of plain arrays to standard output.
"""

from __future__ import annotations

import sys
from os import PathLike, fspath
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.data.errors import InputError
from geocontact.data.multibody.segments import SegmentPoses
from geocontact.io.mocap.c3d_plates import LARGEST, Arrays, point_metre, read_apart
from geocontact.io.text.file_preflight import open_file
from geocontact.io.text.tables import read_quaternions

ENDING = "_4X4"
HEAD = 65_536
"""Bytes of a .c3d that hold the labels of its segments."""
SKEWED = 1e-3
"""Entries of R Rᵀ - 1, and of |q| - 1, from which numbers are no rotation; files have seven digits or three."""
CLOCK = 1e-3
"""Part by which two rates in one file may differ."""


def holds_segments(path: str | PathLike[str]) -> bool:
    """Whether a file has orientations, or poses of segments and no points: by its ending and the head of a .c3d."""
    suffix = Path(fspath(path)).suffix.lower()
    if suffix != ".c3d":
        return suffix == ".sto"
    with open_file(path, LARGEST) as raw:
        head = raw.read(HEAD)
    return head[2:4] == b"\0\0" and ENDING.encode() in head


def read_segments(path: str | PathLike[str], c3d_unit: str | None = None) -> SegmentPoses:
    """Poses of the segments of a .c3d, or orientations of the sensors of a .sto, in the file's own axes.

    `c3d_unit` is that of a .c3d file whose own is empty.
    """
    return read_orientations(path) if Path(fspath(path)).suffix.lower() == ".sto" else read_c3d_poses(path, c3d_unit)


def read_c3d_poses(path: str | PathLike[str], c3d_unit: str | None = None) -> SegmentPoses:
    """Poses of segments [m]; NaN where a matrix is missing or marked as unreliable. Labels are without `_4X4`."""
    file = fspath(path)
    arrays = read_apart(path, __name__, analogs=False)
    matrices, labels = np.asarray(arrays["rotations"], float), [str(name) for name in arrays["labels"]]
    if not matrices.size:
        raise InputError(file, "ROTATION", "holds no poses of segments", "is the file complete?")
    if len(labels) != matrices.shape[1] or not all(labels):
        what = f"{len([x for x in labels if x])} labels of {matrices.shape[1]} segments"
        raise InputError(file, "ROTATION:LABELS", what, "export the file again")
    names = tuple(label.removesuffix(ENDING) for label in labels)
    metre, rate = point_metre(file, str(arrays["unit"]), c3d_unit), _rate(file, arrays)
    rotations, origins = matrices[:, :, :3, :3].copy(), metre * matrices[:, :, :3, 3]
    lost = ~np.isfinite(matrices).all(axis=(2, 3)) | (rotations == 0.0).all(axis=(2, 3))
    lost |= ~np.asarray(arrays["valid"], bool)
    rotations[lost], origins[lost] = np.nan, np.nan
    _require_rotations(file, rotations, names)
    time = float(arrays["start"]) + np.arange(len(matrices)) / rate
    return SegmentPoses(time, _exact(rotations), origins, names, file)


def _rate(file: str, arrays: Arrays) -> float:
    """Frames of poses in a second; InputError where the file says two of them, or none."""
    points, ratio, own = (float(arrays[key]) for key in ("rate", "ratio", "own_rate"))
    rates = [rate for rate in (points * ratio, own) if np.isfinite(rate) and rate > 0.0]
    if not rates:
        raise InputError(file, "ROTATION:RATE", f"is {own:g} Hz", "is the file complete?")
    if max(rates) > (1.0 + CLOCK) * min(rates):
        what = f"is {own:g} Hz, {ratio:g} poses in each frame of POINT:RATE {points:g} Hz are {points * ratio:g} Hz"
        raise InputError(file, "ROTATION:RATE", what, "correct the one that is wrong")
    return rates[-1]


def _require_rotations(file: str, rotations: Float[np.ndarray, "t s 3 3"], names: tuple[str, ...]) -> None:
    """InputError for a matrix that is not orthonormal, or mirrors."""
    off = np.abs(rotations @ np.swapaxes(rotations, 2, 3) - np.eye(3)).max(axis=(2, 3))
    odd = np.argwhere((off > SKEWED) | (np.linalg.det(np.nan_to_num(rotations)) < 0.0))
    if len(odd):
        frame, which = (int(k) for k in odd[0])
        what = f"the matrix of {names[which]} in frame {frame + 1} is no rotation ({off[frame, which]:.2g} off)"
        raise InputError(file, "ROTATION", what, "export the file again")


def _exact(rotations: Float[np.ndarray, "t s 3 3"]) -> Float[np.ndarray, "t s 3 3"]:
    """The nearest rotations, since files have seven digits."""
    found = rotations.copy()
    known = np.isfinite(rotations).all(axis=(2, 3))
    if known.any():
        found[known] = Rotation.from_matrix(rotations[known]).as_matrix()
    return found


def read_orientations(path: str | PathLike[str]) -> SegmentPoses:
    """Orientations of sensors, R_GS, from quaternions w, x, y, z; NaN where one of the four is missing."""
    table = read_quaternions(path)
    names = tuple(dict.fromkeys(channel.rpartition(" ")[0] for channel in table.channels))
    numbers = table.values.reshape(len(table.time), len(names), 4)
    known = np.isfinite(numbers).all(axis=2)
    norms = np.linalg.norm(numbers, axis=2)
    odd = np.argwhere(known & (np.abs(norms - 1.0) > SKEWED))
    if len(odd):
        row, which = (int(k) for k in odd[0])
        what = f"the quaternion of {names[which]} has the length {norms[row, which]:.4g}"
        raise InputError(table.file, f"line {table.lines[row]}", what, "write quaternions of length 1")
    rotations = np.full((*known.shape, 3, 3), np.nan)
    if known.any():
        rotations[known] = Rotation.from_quat(numbers[known], scalar_first=True).as_matrix()
    return SegmentPoses(table.time, rotations, None, names, table.file)


def poses_of(path: str) -> Arrays:
    """Matrices (frames, segments, 4, 4) of a .c3d, whether their reliability, the 17th number, is not below 0, labels,
    unit of points and rates, in this process.
    """
    import ezc3d  # type: ignore[import-untyped]

    content = ezc3d.c3d(path)
    head, told, data = content["header"]["points"], content["parameters"]["POINT"], content["data"]
    group = content["parameters"].get("ROTATION", {})
    rate = float(head["frame_rate"])
    units = told.get("UNITS", {"value": []})["value"]
    keys = ("LABELS", *(f"LABELS{k}" for k in range(2, 99)))
    matrices = np.moveaxis(data["rotations"], (3, 2), (0, 1))
    frames = data["points"].shape[2]
    recorded = content.c3d_swig.data()
    valid = [
        [shown.rotation(j).isValid() for j in range(matrices.shape[1])]
        for k in range(frames)
        for shown in recorded.frame(k).rotations().subframes()
    ]

    def one(key: str) -> float:
        values = np.asarray(group.get(key, {"value": []})["value"], float).ravel()
        return float(values[0]) if len(values) else float("nan")

    return {
        "frames": np.array(frames),
        "rate": np.array(rate),
        "start": np.array(float(head["first_frame"]) / max(rate, 1e-9)),
        "rotations": matrices,
        "valid": np.array(valid, bool).reshape(matrices.shape[:2]),
        "labels": np.array([str(text).strip() for key in keys if key in group for text in group[key]["value"]], str),
        "unit": np.array(str(units[0]).strip() if len(units) else ""),
        "ratio": np.array(len(matrices) / max(frames, 1)),
        "own_rate": np.array(one("RATE")),
    }


if __name__ == "__main__":
    np.savez(sys.stdout.buffer, **poses_of(sys.argv[1]))  # type: ignore[arg-type]
