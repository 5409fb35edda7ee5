"""Knee angles of Grood and Suntay as a rotation.

Source: Grood & Suntay (1983), A joint coordinate system for the clinical description of three-dimensional motions,
J Biomech Eng 105:136-144. Axes as in the ISB recommendation for both legs: x anterior, y proximal, z to the right;
F is the femur's frame, T the tibia's.

- e1 = z_F, flexion about it; e3 = y_T, internal rotation about it; floating axis e2 = e3 × e1 / |e3 × e1|
  (anterior), adduction about it.
- flexion > 0: the distal tibia moves backwards. adduction > 0: the distal tibia moves towards the midline (varus).
  internal rotation > 0: the front of the tibia turns towards the midline.
- R_FT = Rz(-flexion) Rx(s adduction) Ry(s rotation), s = +1 for a right and -1 for a left knee: a left knee is the
  mirror image (z → -z) of a right one with the same angles.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

SIGN = {"right": 1.0, "left": -1.0}
"""s of either knee."""


def tibia_in_femur(
    flexion: Float[np.ndarray, " t"], adduction: Float[np.ndarray, " t"], rotation: Float[np.ndarray, " t"], side: str
) -> Rotation:
    """`R_FT` from knee angles [rad]; signs in the module's docstring."""
    s = SIGN[side]
    cf, sf, ca, sa = np.cos(flexion), np.sin(flexion), np.cos(adduction), s * np.sin(adduction)
    cr, sr = np.cos(rotation), s * np.sin(rotation)
    rows = [
        [cf * cr + sf * sa * sr, sf * ca, cf * sr - sf * sa * cr],
        [cf * sa * sr - sf * cr, cf * ca, -sf * sr - cf * sa * cr],
        [-ca * sr, sa, ca * cr],
    ]
    return Rotation.from_matrix(np.moveaxis(np.array(rows, dtype=float), (0, 1), (-2, -1)))


def angles_of_tibia(
    turned: Rotation, side: str
) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"], Float[np.ndarray, " t"]]:
    """Flexion, adduction and rotation [rad] of `R_FT`, the inverse of `tibia_in_femur`.

    Flexion and rotation within half a turn to either side, adduction within a quarter. At an adduction of a quarter
    turn the other two are not separable; only their sum or difference means anything there.
    """
    s = SIGN[side]
    m = turned.as_matrix()
    flexion = np.arctan2(m[:, 0, 1], m[:, 1, 1])
    adduction = s * np.arctan2(m[:, 2, 1], np.hypot(m[:, 0, 1], m[:, 1, 1]))
    return flexion, adduction, s * np.arctan2(-m[:, 2, 0], m[:, 2, 2])
