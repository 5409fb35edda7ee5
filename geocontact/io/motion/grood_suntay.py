"""Knee angles of Grood and Suntay in a table: flexion, adduction and internal rotation as poses.

Axes and signs stand in `data.multibody.knee_angles`. Sources differ in what they call positive (abduction, valgus,
external rotation): negate with `-name` in the map.
"""

from __future__ import annotations

from scipy.spatial.transform import RigidTransform

from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.data.multibody.knee_angles import SIGN, tibia_in_femur
from geocontact.io.text.columns import mapped, parse_map
from geocontact.io.text.tables import TextTable

_ANGLES = ("flexion", "adduction", "rotation")
_SHIFTS = ("tx", "ty", "tz")


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
