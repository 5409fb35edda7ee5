"""Numbers of the work phases in arrays; Yao et al. (2024), Robotics 13:27, fig. 7 and table 3."""

from __future__ import annotations

from geocontact.shoulder_exoskeleton.work_phases import PHASES

REST, LIFT, SCREW, LOWER = (PHASES.index(name) for name in ("rest", "lift", "screw-in", "lower"))
"""Arms that are held up while the tool does not run count as lifted."""
SUPPORTED = (LIFT, SCREW, LOWER)
"""Phases that have a factor of support; at rest there is none."""
