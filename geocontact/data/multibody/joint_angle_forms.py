"""Names of the forms in which joint angles are written."""

from __future__ import annotations

from typing import Literal

TurnSequence = Literal["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ"]
"""Cardan and Euler sequences: axes in the order of the turns, each turned by the ones before it."""
JointAngleForm = Literal[
    "ISB", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ", "quaternion"
]
"""A sequence for all joints, that of the ISB for each, or quaternions."""
