"""What is left over at the joint to the ground, and how much of it may be.

The joint to the ground has no muscle: what is found along its coordinates is what motion, masses and plates do not
agree upon. Hicks et al. 2015 (Is my model good enough?, J Biomech Eng 137, 020905) ask for peaks below 5 % of the
largest net external force, and for moments below 1 % of that force times the height of the mass centre. OpenSim's
documentation of residual reduction calls a largest force up to 10 N good, up to 25 N okay, and more bad.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.motion.inverse_dynamics.forces import Forces
from geocontact.analyses.run_record import Record
from geocontact.data.multibody.model import GROUND

FORCE, MOMENT = 0.05, 0.01
"""Shares of the largest net external force, and of that times the height of the mass centre."""
GOOD, OKAY = 10.0, 25.0
"""N that OpenSim calls good and okay after residual reduction."""


@dataclass(frozen=True)
class Peak:
    """The largest size of a residual, when it is [s], and what it is measured by, in the same unit; 0 for nothing."""

    size: float
    time: float
    whole: float
    allowed: float

    @property
    def share(self) -> float:
        """Of what it is measured by; NaN where that is nothing."""
        return self.size / self.whole if self.whole > 0.0 else float("nan")

    @property
    def too_large(self) -> bool:
        """Whether it is beyond what is allowed."""
        return self.share > self.allowed


def force_left(forces: Forces) -> Peak:
    """Of the force [N], by the largest measured force, or by the weight where nothing was measured."""
    whole = forces.peak if forces.peak > 0.0 else forces.weight
    return _peak(forces, forces.residual_forces, whole, FORCE)


def moment_left(forces: Forces) -> Peak:
    """Of the moments along the coordinates [N m], by the largest measured force at the height of the mass centre."""
    return _peak(forces, forces.residual_moments, forces.peak * forces.height, MOMENT)


def _peak(forces: Forces, sizes: Float[np.ndarray, " t"], whole: float, allowed: float) -> Peak:
    frame = int(np.argmax(sizes))
    return Peak(float(sizes[frame]), float(forces.time[frame]), whole, allowed)


def words(forces: Forces) -> str:
    """What is left over, in one clause; empty where no body is free."""
    if not forces.at_ground.any():
        return ""
    force, moment = force_left(forces), moment_left(forces)
    text = f"left over at the joint to the {GROUND}: {force.size:.3g} N at most, {force.share:.1%} of the"
    if forces.peak == 0.0:
        return f"{text} weight, as nothing but gravity acts"
    return (
        f"{text} largest measured force (below {FORCE:.0%} is asked for), and {moment.size:.3g} N m, "
        f"{moment.share:.1%} of that force at the height of the mass centre (below {MOMENT:.0%})"
    )


def warn_of_residuals(record: Record, forces: Forces) -> None:
    """One line where more is left over than Hicks et al. allow, or where nothing tells."""
    if not forces.at_ground.any():
        record.warn(f"no joint frees a body from the {GROUND} with six coordinates: nothing tells what is left over")
    elif forces.peak == 0.0 and force_left(forces).too_large:
        record.warn(
            f"{words(forces)} ({force_left(forces).time:.3g} s): give `loads`, or `plates` with `plate`; moments are "
            "those of a body in the air"
        )
    elif force_left(forces).too_large or moment_left(forces).too_large:
        when = f"at {force_left(forces).time:.3g} and {moment_left(forces).time:.3g} s, limits of Hicks et al. 2015"
        record.warn(
            f"{words(forces)}, {when}: check which plate acts on which body, masses, whether plates and markers have "
            "one clock, and `cutoff`"
        )


def verdict(size: float) -> str:
    """What OpenSim calls a largest residual force [N] after residual reduction."""
    return "good" if size <= GOOD else "okay" if size <= OKAY else "bad"
