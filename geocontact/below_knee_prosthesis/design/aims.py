"""Names of what a foot is chosen by."""

from __future__ import annotations

from typing import Literal

Aim = Literal[
    "ankle_moment",
    "socket_moment",
    "energy",
    "radius",
    "loading_rate",
    "ankle_mean",
    "socket_mean",
    "knee_moment",
    "knee_mean",
    "hip_moment",
    "hip_mean",
    "metabolic",
]
