"""One way in for every kind of motion file."""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.io.motion.poses import (
    is_pose_rows,
    motion_from_csv,
    motion_from_grood_suntay,
    motion_from_joint,
    motion_from_map,
    motion_from_rows,
)
from geocontact.io.opensim.osim import joint_names, read_joint
from geocontact.io.text.tables import CELLS, listed, read_table

SUFFIXES = (*CELLS, ".mot", ".sto", ".txt")
ROWS = (".csv", ".txt")
"""Files that may hold rows of numbers without a header."""


def read_motion(
    path: str | PathLike[str],
    *,
    osim: str | PathLike[str] | None = None,
    joint: str | None = None,
    moving: str = "child",
    mapping: str | None = None,
    order: str | None = None,
    angles: str | None = None,
    grood_suntay_side: str | None = None,
    unit: str | None = None,
    rate: float | None = None,
) -> Motion:
    """Poses of MOVING in FIXED from a motion file.

    Parameters
    ----------
    path
        `.csv` poses (`time [s], tx [mm], …, qw, qx, qy, qz` or `r11, … r33`, or `rx [deg], …` with `order`), `.csv` or
        `.txt` of rows of 16 or 12 numbers (`pose_rows.motion_from_rows`), `.mot` or `.sto`.
    osim, joint
        Model and joint whose functions turn coordinates into poses: FIXED is the joint's parent body, MOVING its child.
    moving
        "parent" swaps the two; with `grood_suntay_side`, "child" means that the tibia moves.
    mapping
        Columns by name instead of a model: "rz=knee_flexion,ry=-knee_rotation,tx=knee_tx".
    order
        Order of intrinsic rotations, "XYZ" for R = Rx Ry Rz.
    angles
        "deg" or "rad", where the file does not say or contradicts itself.
    grood_suntay_side
        "right" or "left": columns are knee angles after Grood and Suntay.
    unit, rate
        Unit of the translations and frames per second, for rows of numbers, which say neither.

    Raises
    ------
    InputError
        The file cannot be used, or does not say what poses, units or angles it holds.

    Examples
    --------
    >>> import geocontact as gc
    >>> gait = gc.read_motion("meshes/gait.csv")
    >>> len(gait.time), gait.poses.translation.shape
    (101, (101, 3))
    """
    suffix = _suffix_of(path)
    _require_model_and_joint(osim, joint)
    if suffix in ROWS and is_pose_rows(path):
        _refuse_columns(osim, mapping, grood_suntay_side)
        return motion_from_rows(path, unit, rate)
    _refuse_text(path, suffix)
    if osim is not None and joint is not None:
        return motion_from_joint(read_table(path), read_joint(osim, joint), moving, angles)
    if grood_suntay_side is not None:
        return motion_from_grood_suntay(read_table(path), mapping, grood_suntay_side, _bone(moving), angles)
    if mapping is not None:
        return motion_from_map(read_table(path), mapping, order, angles)
    if suffix not in CELLS:
        raise InputError(path, "", "coordinates need a model to become poses", "give `osim` and `joint`, or `map`")
    return motion_from_csv(path, order, angles)


def _bone(moving: str) -> str:
    """Which bone of a knee moves in the other one."""
    return "tibia" if moving == "child" else "femur"


def _suffix_of(path: str | PathLike[str]) -> str:
    """Ending of a file in small letters; InputError for one that is not read."""
    suffix = Path(fspath(path)).suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(path, "", "is not a motion file that is read", f"give one of {', '.join(SUFFIXES)}")
    return suffix


def _require_model_and_joint(osim: str | PathLike[str] | None, joint: str | None) -> None:
    """InputError for one of them without the other."""
    if (osim is None) != (joint is None):
        missing, given = ("`joint`", "`osim`") if joint is None else ("`osim`", "`joint`")
        remedy = "give the model" if osim is None else f"joints of the model are: {listed(joint_names(osim))}"
        raise InputError("", missing, f"is missing with {given}", remedy)


def _refuse_text(path: str | PathLike[str], suffix: str) -> None:
    """InputError for a .txt, which holds rows of numbers or nothing that is read."""
    if suffix == ".txt":
        what = "the first row of a .txt is not the 16 or 12 numbers of a pose"
        raise InputError(path, "", what, "give rows of numbers, or a .csv whose header names its columns")


def _refuse_columns(osim: object, mapping: str | None, side: str | None) -> None:
    """InputError for options that name columns, which rows of poses do not have."""
    for option, value in (("osim", osim), ("map", mapping), ("convention", side)):
        if value is not None:
            raise InputError("", f"`{option}`", "has no effect on rows of poses, which name no columns", "leave it out")
