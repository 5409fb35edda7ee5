"""The chair's force on a person who still sits: measured, an external load on the trunk, whose lowest part sits on it.

It is given over time as force forwards and up and as moment about the ground's origin, so that no point of it has to be
known. After seat-off it is 0, and the trial goes on as one that begins there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from geocontact.dynamics.inverse_dynamics import Wrenches

if TYPE_CHECKING:
    from casadi import SX

SITS = "trunk"
"""The trunk stands for the pelvis too."""
COMPONENTS = 3


def chair_on_person(chair: SX) -> Wrenches:
    """Of force forwards, force up [N] and moment about z through the ground's origin [N m], (3, 1)."""
    from casadi import vertcat

    return {SITS: (vertcat(chair[0], chair[1], 0.0), vertcat(0.0, 0.0, chair[2]))}
