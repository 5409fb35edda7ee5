"""Poses of MOVING in FIXED over time, from tables, joints of models and single 4×4 matrices.

Axes and signs stand in `data.multibody.knee_angles`. Sources differ in what they call positive (abduction, valgus,
external rotation): negate with `-name` in the map.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from os import PathLike, fspath

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.motion import Motion, poses_in_parts
from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.knee_angles import SIGN, tibia_in_femur
from geocontact.data.plausible import LARGEST_MEANT
from geocontact.io.opensim.coordinates import columns_of, coordinates_of, warn_of_defaults
from geocontact.io.text.columns import angles_of, lengths, mapped, parse_map
from geocontact.io.text.file_preflight import open_text, read_text_bytes
from geocontact.io.text.tables import LARGEST_FILE, TextTable, listed, read_table
from geocontact.io.text.units import LENGTH

_ANGLES = ("flexion", "adduction", "rotation")


def motion_from_grood_suntay(
    table: TextTable,
    mapping: str | None,
    side: str,
    moving: str = "tibia",
    angles: str | None = None,
) -> Motion:
    """Motion of one knee component in the other from columns of knee angles.

    Parameters
    ----------
    mapping
        `"flexion=knee_flex,adduction=knee_add,rotation=knee_rot,tx=…,ty=…,tz=…"`; None takes columns of these names.
        rotation is internal rotation; `-name` negates; what is not mapped is 0, with a warning.
    side
        "right" or "left". Left mirrors adduction and rotation.
    moving
        "tibia" or "femur": MOVING; the other body is FIXED. The angles are the knee's either way.

    tx, ty, tz is the origin of MOVING along the x, y, z axes of FIXED (not Grood and Suntay's oblique e1, e2, e3).
    """
    _require_side(side)
    if moving not in ("tibia", "femur"):
        raise InputError("", "`moving_body`", f"'{moving}' is not a body of the knee", "MOVING is tibia or femur")
    present = [name for name in _ANGLES + _SHIFTS if name in table.channels]
    text = mapping or ",".join(f"{name}={name}" for name in present)
    if not text:
        raise InputError(table.file, "", "no columns flexion, adduction, rotation", "name them with `map`")
    parsed = parse_map(text, _ANGLES + _SHIFTS)
    turned, moved = mapped(table, parsed, _ANGLES, _SHIFTS, angles)
    rotation = tibia_in_femur(turned[:, 0], turned[:, 1], turned[:, 2], side)
    poses = RigidTransform.from_components(moved, rotation if moving == "tibia" else rotation.inv())
    source = f"{table.file} with {text} (Grood-Suntay, {side} knee, {moving} moving)"
    heeded = frozenset({"angles", "convention"} if set(parsed) & set(_ANGLES) else ())
    return Motion(table.time, poses, source, table.time_unit, heeded=heeded)


def _require_side(side: str) -> None:
    if side not in SIGN:
        raise InputError("", "`side`", f"'{side}' is not a side", "give right or left")


ENTRIES = tuple(f"r{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3))
"""Columns of a rotation matrix in a table, row by row."""
SIZES = (16, 12)
"""Numbers in a row: 4x4, or 3x4 without the last row."""
ROUNDED = 1e-4
"""How far off orthonormal a matrix may be without a word: files often have five digits."""
ROUGH = 2e-2
"""How far it may be with a warning: recorders interpolate entries of matrices, which bends them."""
PASS_RATE = "pass `rate`, the frames per second in Hz; 1 numbers the frames"
"""Remedy for rows without times."""
_SPLIT = re.compile(r"[,;\s]+")
_COMMENT = "#"


def is_pose_rows(path: str | PathLike[str]) -> bool:
    """Whether the first row of a text file is a matrix: 16 or 12 numbers and no header."""
    with open_text(path, errors="replace", most_bytes=LARGEST_FILE) as stream:
        first = next((line for line in stream if line.strip() and not line.lstrip().startswith(_COMMENT)), "")
    cells = _cells(first)
    return len(cells) in SIZES and all(map(_is_number, cells))


def motion_from_rows(path: str | PathLike[str], unit: str | None, rate: float | None) -> Motion:
    """Motion in a file whose rows are matrices, one frame each, without a header.

    Parameters
    ----------
    path
        Text; numbers separated by commas or blanks: the 4x4 pose row by row, or its first three rows, translation in
        the last column. Rows that are empty or begin with # are passed over.
    unit
        Unit of the translations.
    rate
        Frames per second [Hz]: such a file holds no times. 1 numbers the frames.
    """
    file = fspath(path)
    if unit not in LENGTH:
        raise InputError(
            file,
            "",
            "rows of poses do not say in which unit they are",
            "pass `unit`, or name columns in a header: time [s], r11, …, tx [mm], …",
        )
    if rate is None:
        raise InputError(file, "", "rows of poses hold no times", PASS_RATE)
    values, lines = _read(file)
    matrices = np.zeros((len(values), 4, 4))
    matrices[:, 3, 3] = 1.0
    matrices[:, : values.shape[1] // 4] = values.reshape(len(values), -1, 4)
    rotation = rotations(matrices, file, [f"line {line}" for line in lines], ROUGH)
    poses = RigidTransform.from_components(matrices[:, :3, 3] * LENGTH[unit], rotation)
    return Motion(np.arange(len(values)) / rate, poses, file, heeded=frozenset({"rate"}))


def rotations_of(table: TextTable) -> Rotation:
    """Rotations in the columns r11 … r33 of a table."""
    entries = np.column_stack([table.needed(name) for name in ENTRIES]).reshape(-1, 3, 3)
    matrices = np.tile(np.eye(4), (len(entries), 1, 1))
    matrices[:, :3, :3] = entries
    return rotations(matrices, table.file, [f"line {line}" for line in table.lines], ROUGH)


def rotations(matrices: Float[np.ndarray, "t 4 4"], file: str, places: Sequence[str], rough: float) -> Rotation:
    """The rotations nearest to matrices that are rigid poses within `rough`; InputError at the place of others."""
    turn = matrices[:, :3, :3]
    off = np.abs(np.swapaxes(turn, 1, 2) @ turn - np.eye(3)).max(axis=(1, 2))
    worst = int(np.argmax(off))
    foot = np.abs(matrices[:, 3] - [0.0, 0.0, 0.0, 1.0]).max(axis=1)
    lowest = int(np.argmax(foot))
    if foot[lowest] > 1e-6:
        across = np.abs(matrices[lowest, :, 3] - [0.0, 0.0, 0.0, 1.0]).max() <= 1e-6
        remedy = "write it row by row, not column by column" if across else "write the translation in the last column"
        raise InputError(file, places[lowest], "the last row of the matrix is not 0 0 0 1", remedy)
    if off[worst] > rough:
        what = f"rotation part is off orthonormal by {off[worst]:.2g}"
        raise InputError(file, places[worst], what, "scale or shear is not a pose")
    mirrored = np.flatnonzero(np.linalg.det(turn) < 0.0)
    if len(mirrored):
        what = "rotation part mirrors (determinant -1)"
        raise InputError(file, places[mirrored[0]], what, "mirror the mesh instead")
    if off[worst] > ROUNDED:
        count = np.count_nonzero(off > ROUNDED)
        what = f"rotation parts are off orthonormal in {count} of {len(off)} frames, by up to {off[worst]:.2g}"
        what += f" ({places[worst]}); the nearest rotations are taken"
        warnings.warn(InputWarning(f"{file}: {what}"), stacklevel=4)
    return Rotation.from_matrix(turn)


def _read(file: str) -> tuple[Float[np.ndarray, "t c"], list[int]]:
    rows: list[list[float]] = []
    lines: list[int] = []
    with open_text(file, errors="replace", most_bytes=LARGEST_FILE) as stream:
        for number, line in enumerate(stream, 1):
            if line.strip() and not line.lstrip().startswith(_COMMENT):
                rows.append(_row(line, file, number, len(rows[0]) if rows else 0))
                lines.append(number)
    return np.array(rows), lines


def _row(line: str, file: str, number: int, size: int) -> list[float]:
    cells = _cells(line)
    if len(cells) != (size or len(cells)) or not all(map(_is_number, cells)):
        what = f"{len(cells)} cells where {size} numbers are a pose"
        raise InputError(file, f"line {number}", what, "give every frame all of its numbers")
    values = [float(cell) for cell in cells]
    if not (np.abs(values) <= LARGEST_MEANT).all():
        raise InputError(file, f"line {number}", "the pose is not finite or too large", "fill the gap or cut the frame")
    return values


def _cells(line: str) -> list[str]:
    return [cell for cell in _SPLIT.split(line.strip()) if cell]


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


__all__ = ["motion_from_csv", "motion_from_grood_suntay", "motion_from_joint", "motion_from_map", "read_pose"]

_SHIFTS = ("tx", "ty", "tz")
_TURNS = ("rx", "ry", "rz")
_QUATERNION = ("qw", "qx", "qy", "qz")
_LARGEST_POSE = 65536
EXACT = 1e-6
"""How far off orthonormal a single pose may be: it is typed or exported with all its digits."""


def motion_from_csv(path: str | PathLike[str], order: str | None = None, angles: str | None = None) -> Motion:
    """Motion in a .csv of poses: `time [s], tx [mm], ty [mm], tz [mm]` and a quaternion, a matrix or Euler angles.

    Parameters
    ----------
    order
        Order of the Euler columns `rx [deg], ry [deg], rz [deg]`, intrinsic: "XYZ" is R = Rx Ry Rz. Without it Euler
        columns are refused.
    angles
        Unit of Euler columns whose header has none.

    Quaternions `qw, qx, qy, qz` off unit length by up to 1e-3 are normalised with a warning, others refused. A matrix
    is in the columns r11, r12, … r33 (`pose_rows`).
    """
    table = read_table(path)
    euler, quaternion, matrix = ([c for c in n if c in table.channels] for n in (_TURNS, _QUATERNION, ENTRIES))
    if (given := [found for found in (euler, quaternion, matrix) if found])[1:]:
        what = f"rotation is given both ways ({' and '.join(', '.join(found) for found in given)})"
        raise InputError(table.file, "", what, "keep the quaternion, the matrix or the Euler columns")
    if euler:
        if order is None:
            raise InputError(table.file, "", "Euler columns without an order", "pass `order`, e.g. `order` XYZ")
        sequence, turned = _sequence(order, "XYZ"), _in_order(angles_of(table, _TURNS, angles), order)
    else:
        sequence, turned = "", (rotations_of(table) if matrix else _quaternions(table)).as_quat()

    def posed(shift: Float[np.ndarray, "t 3"], turn: Float[np.ndarray, "t k"]) -> RigidTransform:
        rotation = Rotation.from_euler(sequence, turn) if sequence else Rotation.from_quat(turn)
        return RigidTransform.from_components(shift, rotation)

    poses = poses_in_parts(posed, lengths(table, _SHIFTS), turned)
    heeded = frozenset({"order", "angles"} if euler else ())
    return Motion(table.time, poses, table.file, table.time_unit, heeded=heeded)


def motion_from_joint(table: TextTable, joint: JointModel, moving: str = "child", angles: str | None = None) -> Motion:
    """Motion of a joint's child body in its parent body; `moving="parent"` gives the parent in the child.

    Columns are coordinates by name or by path (`/jointset/joint/name/value`). A coordinate without a column keeps its
    default value, with a warning; a table with none of them is refused.
    """
    if moving not in ("child", "parent"):
        raise InputError("", "`moving_body`", f"'{moving}' is not a body of the joint", "give child or parent")
    columns = columns_of(table, (joint,))
    pose = joint.pose(coordinates_of(table, (joint,), columns, angles), len(table.time))
    if not np.all(np.isfinite(pose.as_matrix())):
        raise InputError(table.file, "", f"pose of joint {joint.name} is not finite", "coordinates or model are absurd")
    warn_of_defaults(table, joint.coordinates, columns, f"joint {joint.name}")
    poses = pose.inv() if moving == "parent" else pose
    source = f"{table.file} with joint {joint.name} of {joint.file}"
    heeded = {"angles" for c in joint.coordinates if c.name in columns and c.kind == "rotational"}
    return Motion(table.time, poses, source, table.time_unit, heeded=frozenset(heeded))


def motion_from_map(table: TextTable, mapping: str, order: str | None = None, angles: str | None = None) -> Motion:
    """Motion from named columns: `"rz=knee_flexion,rx=knee_adduction,ry=-knee_rotation,tx=knee_tx"`.

    Rotations are intrinsic in the order in which the r* entries are written (`rz,rx,ry` is R = Rz Rx Ry) unless
    `order` says otherwise; the pose is T(tx, ty, tz) R. `-name` negates; what is not mapped is 0, with a warning.
    """
    parsed = parse_map(mapping, _TURNS + _SHIFTS)
    written = "".join(target[1] for target in parsed if target in _TURNS).upper()
    sequence = _sequence(order, written) if order else written
    turned, moved = mapped(table, parsed, _TURNS, _SHIFTS, angles)
    rotation = Rotation.identity(len(table.time))
    for axis in sequence:
        place = "XYZ".index(axis)
        rotation = rotation * Rotation.from_rotvec(turned[:, place, None] * np.eye(3)[place])
    poses = RigidTransform.from_components(moved, rotation)
    heeded = frozenset(("angles", "order")[: len(written)])  # one rotation has no order
    return Motion(table.time, poses, f"{table.file} with map {mapping}", table.time_unit, heeded=heeded)


def read_pose(path: str | PathLike[str], unit: str = "m") -> RigidTransform:
    """Rigid 4×4 matrix in a text file, rows separated by line breaks and cells by blanks or commas.

    Parameters
    ----------
    unit
        Unit of the translation, the mesh's own; the result is in m.

    Refused unless the rotation part is orthonormal with determinant +1 and the last row 0 0 0 1, within 1e-6.
    """
    file = fspath(path)
    if unit not in LENGTH:
        raise InputError(file, "", f"'{unit}' is not a unit of length here", f"give one of {', '.join(LENGTH)}")
    text = read_text_bytes(file, _LARGEST_POSE, "give 4 rows of 4 numbers").decode("utf-8-sig", errors="replace")
    rows = [line.replace(",", " ").split() for line in text.splitlines() if line.strip() and line.strip()[0] != "#"]
    try:
        matrix = np.array([[float(cell) for cell in row] for row in rows], dtype=float)
    except ValueError:
        matrix = np.zeros(0)
    if matrix.shape != (4, 4) or not np.all(np.abs(matrix) <= LARGEST_MEANT):
        between_blanks = any("," in line and len(line.split()) == 4 for line in text.splitlines())
        commas, points = (" (decimal commas?)", ", with decimal points") if between_blanks else ("", "")
        what = f"not a 4x4 matrix of finite numbers{commas}"
        raise InputError(file, "", what, f"give 4 rows of 4 numbers{points}")
    turn = rotations(matrix[None], file, [""], EXACT)[0]
    return RigidTransform.from_components(matrix[:3, 3] * LENGTH[unit], turn)


def _sequence(order: str, axes: str) -> str:
    """Order of intrinsic rotations in capitals: each axis at most once, and `axes` all among them."""
    sequence = order.upper()
    if set(sequence) - set("XYZ") or len(set(sequence)) != len(sequence) or not set(axes) <= set(sequence):
        what = f"'{order[:20]}' does not order the axes {', '.join(axes)}"
        raise InputError("", "`order`", what, "name each axis once, e.g. XYZ")
    return sequence


def _in_order(turned: Float[np.ndarray, "t 3"], order: str) -> Float[np.ndarray, "t 3"]:
    return turned[:, ["XYZ".index(axis) for axis in order.upper()]]


def _quaternions(table: TextTable) -> Rotation:
    missing = [name for name in _QUATERNION if name not in table.channels]
    if missing:
        what = f"no column {', '.join(missing)}"
        raise InputError(table.file, "", what, f"columns are: {listed(table.channels)}")
    values = np.column_stack([table.needed(name) for name in _QUATERNION])
    size = np.linalg.norm(values, axis=1)
    worst = int(np.argmax(np.abs(size - 1.0)))
    if abs(size[worst] - 1.0) > 1e-3:
        what = f"quaternion has length {size[worst]:.4g}, not 1"
        raise InputError(table.file, f"line {table.lines[worst]}", what, "normalise the columns qw, qx, qy, qz")
    if abs(size[worst] - 1.0) > 1e-6:
        what = f"quaternion length up to {size[worst]:.6f} (line {table.lines[worst]}); normalised"
        warnings.warn(InputWarning(f"{table.file}: {what}"), stacklevel=3)
    return Rotation.from_quat(values, scalar_first=True)
