"""Knee angles of Grood and Suntay: flexion, adduction and internal rotation as poses.

Source: Grood & Suntay (1983), A joint coordinate system for the clinical description of three-dimensional motions,
J Biomech Eng 105:136-144. Axes as in the ISB recommendation for both legs: x anterior, y proximal, z to the right;
F is the femur's frame, T the tibia's.

- e1 = z_F, flexion about it; e3 = y_T, internal rotation about it; floating axis e2 = e3 × e1 / |e3 × e1|
  (anterior), adduction about it.
- flexion > 0: the distal tibia moves backwards. adduction > 0: the distal tibia moves towards the midline (varus).
  internal rotation > 0: the front of the tibia turns towards the midline.
- R_FT = Rz(-flexion) Rx(s adduction) Ry(s rotation), s = +1 for a right and -1 for a left knee: a left knee is the
  mirror image (z → -z) of a right one with the same angles.

Sources differ in what they call positive (abduction, valgus, external rotation): negate with `-name` in the map.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.io.columns import mapped, parse_map
from geocontact.io.tables import Table

_ANGLES = ("flexion", "adduction", "rotation")
_SHIFTS = ("tx", "ty", "tz")


def tibia_in_femur(
    flexion: Float[np.ndarray, " t"], adduction: Float[np.ndarray, " t"], rotation: Float[np.ndarray, " t"], side: str
) -> Rotation:
    """`R_FT` from knee angles [rad]; signs in the module's docstring."""
    s = _sign(side)
    cf, sf, ca, sa = np.cos(flexion), np.sin(flexion), np.cos(adduction), s * np.sin(adduction)
    cr, sr = np.cos(rotation), s * np.sin(rotation)
    rows = [
        [cf * cr + sf * sa * sr, sf * ca, cf * sr - sf * sa * cr],
        [cf * sa * sr - sf * cr, cf * ca, -sf * sr - cf * sa * cr],
        [-ca * sr, sa, ca * cr],
    ]
    return Rotation.from_matrix(np.moveaxis(np.array(rows, dtype=float), (0, 1), (-2, -1)))


def motion_from_grood_suntay(
    table: Table,
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
    _sign(side)
    if moving not in ("tibia", "femur"):
        raise InputError("", "--moving", f"'{moving}' is not a body of the knee", "MOVING is tibia or femur")
    present = [name for name in _ANGLES + _SHIFTS if name in table.channels]
    text = mapping or ",".join(f"{name}={name}" for name in present)
    if not text:
        raise InputError(table.file, "", "no columns flexion, adduction, rotation", "name them with --map")
    parsed = parse_map(text, _ANGLES + _SHIFTS)
    turned, moved = mapped(table, parsed, _ANGLES, _SHIFTS, angles)
    rotation = tibia_in_femur(turned[:, 0], turned[:, 1], turned[:, 2], side)
    poses = RigidTransform.from_components(moved, rotation if moving == "tibia" else rotation.inv())
    source = f"{table.file} with {text} (Grood-Suntay, {side} knee, {moving} moving)"
    heeded = frozenset({"angles", "convention"} if set(parsed) & set(_ANGLES) else ())
    return Motion(table.time, poses, source, table.time_unit, heeded=heeded)


def _sign(side: str) -> float:
    if side not in ("right", "left"):
        raise InputError("", "--side", f"'{side}' is not a side", "give right or left")
    return 1.0 if side == "right" else -1.0
