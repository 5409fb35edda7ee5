"""Options that several analyses share: sweeps, layers, medial sides. Light to import."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from geocontact.analyses.frame.marks import Spelled, Typed
from geocontact.data.errors import InputError
from geocontact.data.plausible import JOINT_ANGLE, LAYER, POSE, SHARE

Sweep = Annotated[
    tuple[str, float, float, float],
    Typed("rad", "sweep_range", '("flexion", *gc.deg(0, 90, 1))'),
    Spelled(dashed=True),
    JOINT_ANGLE,
]
"""Name, start, stop and step."""


BodyPair = Annotated[tuple[str, str], Typed("-", "body_pair", '("femur_r", "tibia_r")')]
"""Names in an OpenSim model of MOVING's body and FIXED's."""

RAYS = "rays"
"""Said of a thickness that is measured along the normal."""

Thickness = Annotated[float | Literal["rays"], Typed("m", "thickness", "gc.mm(8)"), LAYER]


CyclePart = Annotated[float | Literal["stance"], Typed("-", "cycle_part", "0.6"), SHARE]
"""First part of each cycle, or up to its toe off."""

PROGRAMS = ("febio", "abaqus", "opensim")
"""Programs that bodies and their motion are written for."""

Programs = Annotated[tuple[str, ...], Typed("-", "programs", '("febio", "abaqus")')]

PoseSd = Annotated[tuple[float, ...], Typed("m, rad", "pose_sd", "(5e-4, 5e-4, 5e-4, *gc.deg(1, 1, 1))"), POSE]
"""Standard deviations of three shifts and three turns of a pose."""


def refuse_pose_sd(sd: tuple[float, ...] | None) -> None:
    """InputError unless there are six, one above 0."""
    if sd is not None and (len(sd) != 6 or not max(sd) > 0.0):
        raise InputError("", "`pose_sd`", "needs three shifts and three turns, one above 0", "give t=0.5,r=1")


Side = Literal["right", "left"]
Medial = Annotated[Literal["-", "+"], Spelled(dashed=True)]

TO_THE_RIGHT = "z"
"""Axis of a body frame that points to the subject's right: x forward, y up, as ISB (Wu & Cavanagh 1995) and OpenSim."""
MEDIAL = {"right": "-", "left": "+"}
"""Side of a plane across that axis that is medial, by the side of the body: towards the other leg."""


@dataclass(frozen=True)
class MedialSide:
    """The medial side of a plane across a coordinate axis.

    Parameters
    ----------
    sign
        +1 or -1, as the axis points or against it.
    axis
        "x", "y" or "z".
    why
        How it is known.
    """

    sign: int
    axis: str
    why: str

    @property
    def words(self) -> str:
        """For people: "-z (right side, z to the right)"."""
        return f"{'+' if self.sign > 0 else '-'}{self.axis} ({self.why})"


def refuse_other_axes(space: str, name: str, side: str | None, medial: str | None) -> None:
    """InputError where the side is to say what is medial in a frame whose file says that z points up."""
    from geocontact.data.mesh import AXES  # numpy: not for --help

    if space and side is not None and medial is None:
        towards = MEDIAL[side] if space == "RAS" else {"-": "+", "+": "-"}[MEDIAL[side]]
        what = f"does not say which side of z is medial in {name}: its header says SPACE={space}, {AXES[space]}"
        raise InputError("", "`side`", what, f"give `split` x and `medial` {towards}")


def medial_side(split: str, side: str | None, medial: str | None) -> MedialSide:
    """What is medial of the plane `split` ("z", "z=1.5"), as said or by the side of the body; InputError if neither."""
    axis = split.partition("=")[0].strip()
    if medial is not None:
        return MedialSide(1 if medial == "+" else -1, axis, "as given")
    if side is None:
        remedy = "give `side` right or left where z points to the subject's right, else `medial` - or +"
        raise InputError("", "`split`", f"{split!r} does not say which side of the plane is medial", remedy)
    if axis in ("x", "y"):
        what = f"{side} does not say which side of a plane across {axis} is medial: z is what points to the right"
        raise InputError("", "`side`", what, "give `medial` - or +")
    return MedialSide(1 if MEDIAL[side] == "+" else -1, axis, f"{side} side, z to the right")


def refuse_thresholds(thresholds: tuple[float, ...]) -> None:
    """InputError where there is none, or one twice."""
    if not thresholds:
        raise InputError("", "`threshold`", "there is none", "give for example 4 mm")
    if len(set(thresholds)) < len(thresholds):
        raise InputError("", "`threshold`", f"{thresholds} names a threshold twice", "give each once")


def refuse_programs(asked: tuple[str, ...] | None, osim: Path | None) -> None:
    """InputError for a program that is not known or named twice, and for OpenSim without a model."""
    for name in asked or ():
        if name not in PROGRAMS:
            raise InputError("", "`export`", f"{name!r} is not a program", f"name one of: {', '.join(PROGRAMS)}")
    if asked is not None and (not asked or len(set(asked)) < len(asked)):
        raise InputError("", "`export`", "names no program, or one twice", "give for example febio")
    if "opensim" in (asked or ()) and osim is None:
        what = "opensim attaches the meshes to the bodies of a joint, and there is no model"
        raise InputError("", "`export`", what, "give `osim` and `joint`")
