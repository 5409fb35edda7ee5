"""Synthetic files of segments: poses in a .c3d as Theia writes them, quaternions in a .sto as OpenSense has them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from scipy.spatial.transform import RigidTransform

RATE = 100.0


def write_theia(file: Path, poses: Mapping[str, RigidTransform], unit: str = "mm", **parameters: object) -> Path:
    """Poses [m] of each segment in a .c3d without points, through ezc3d's own writer."""
    import ezc3d  # type: ignore[import-untyped]

    matrices = np.stack([each.as_matrix() for each in poses.values()])
    matrices[:, :, :3, 3] *= {"mm": 1e3, "m": 1.0, "": 1e3}[unit]
    return write_matrices(ezc3d, file, tuple(poses), matrices, unit, **parameters)


def write_matrices(
    ezc3d: object, file: Path, names: tuple[str, ...], matrices: np.ndarray, unit: str, **parameters: object
) -> Path:
    """Matrices (segments, frames, 4, 4) as they are."""
    content = ezc3d.c3d()  # type: ignore[attr-defined]
    content["parameters"]["POINT"]["RATE"]["value"] = [RATE]
    content["parameters"]["POINT"]["UNITS"]["value"] = [unit]
    content["data"]["points"] = np.zeros((4, 0, matrices.shape[1]))
    own = {"LABELS": [f"{name}_4X4" for name in names], "USED": [len(names)], "RATE": [RATE], **parameters}
    for name, value in own.items():
        content.add_parameter("ROTATION", name, value)
    content["data"]["rotations"] = np.moveaxis(matrices, (0, 1), (2, 3))
    content.write(str(file))
    return file


def write_sensors(file: Path, time: np.ndarray, rotations: Mapping[str, np.ndarray], kind: str = "Quaternion") -> Path:
    """Quaternions w, x, y, z (frames, 4) of each sensor."""
    head = f"DataRate={RATE}\nDataType={kind}\nversion=3\nOpenSimVersion=4.6\nendheader\n"
    rows = ["\t".join(["time", *rotations])]
    for k, t in enumerate(time):
        cells = [",".join(f"{value:.15g}" for value in each[k]) for each in rotations.values()]
        rows.append("\t".join([f"{t:.10g}", *cells]))
    file.write_text(head + "\n".join(rows) + "\n")
    return file
