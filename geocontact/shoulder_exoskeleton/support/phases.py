"""Work phases of an overhead task; Yao et al. (2024), Robotics 13:27, fig. 7 and table 3."""

from __future__ import annotations

from typing import Literal, get_args

Phase = Literal["rest", "lift", "screw-in", "lower"]
PHASES: tuple[Phase, ...] = get_args(Phase)
REST, LIFT, SCREW, LOWER = range(4)
"""Numbers of the phases in arrays. Arms that are held up while the tool does not run count as lifted."""
SUPPORTED = (LIFT, SCREW, LOWER)
"""Phases that have a factor of support; at rest there is none."""
