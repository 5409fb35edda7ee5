"""A simulated stance as that of the person's own side: what other programs read, of a left leg not its mirror image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.from_markers import of_side
from geocontact.below_knee_prosthesis.keel.on_tree import coordinates
from geocontact.below_knee_prosthesis.leg import Side
from geocontact.below_knee_prosthesis.leg_tree import RECORDED, SOCKET
from geocontact.below_knee_prosthesis.simulate import Stance

TURNED = ("pelvis_rotation", "pelvis_list", "pelvis_tz")
"""Coordinates whose sign is the laboratory's, not the leg's."""
LENGTHS = ("pelvis_tx", "pelvis_ty", "pelvis_tz", *SOCKET[3:])


@dataclass(frozen=True, eq=False)
class SideCoordinates:
    """Coordinates of pelvis, leg, socket and keel over a stance.

    Parameters
    ----------
    names
        Ending in _r or _l, but for those of the pelvis.
    values
        [rad, m].
    lengths
        Whether each is a length.
    """

    names: tuple[str, ...]
    values: Float[np.ndarray, "t n"]
    lengths: tuple[bool, ...]

    @property
    def in_degrees(self) -> Float[np.ndarray, "t n"]:
        """Angles in degrees, lengths in m."""
        return np.where(self.lengths, self.values, np.degrees(self.values))


def coordinates_of_side(stance: Stance, side: Side) -> SideCoordinates:
    """Pelvis, hip and knee as driven but for the pelvis' free places; socket and keel as simulated.

    Between the recorded frames pelvis, hip and knee are on splines. What was driven is the bushing's frame, on splines
    through its poses at these frames: the same there, and within micrometres between them.
    """
    values = stance.motion.at(stance.time)
    values[:, 3:5] = stance.found.q[:, :2]
    names = [*RECORDED, *SOCKET, *coordinates(stance.foot.keel)]
    table = np.hstack([values, stance.found.q[:, 2:]])
    if side == "left":
        table = np.where(np.isin(names, TURNED), -table, table)
    called = tuple(name if name.startswith("pelvis") else f"{name}_{side[0]}" for name in names)
    return SideCoordinates(called, table, tuple(name in LENGTHS for name in names))


def ground_reaction(stance: Stance, side: Side) -> tuple[Float[np.ndarray, "t 3"], Float[np.ndarray, "t 3"]]:
    """Force of the ground on the prosthetic foot [N] and the place where it acts [m].

    That is its centre of pressure; where nothing presses the point below the keel's end. The free moment about the
    vertical is left out.
    """
    force, centre = of_side(stance.force, side), of_side(stance.centre("ground"), side)
    below = of_side(stance.poses.translation, side) * np.array([1.0, 0.0, 1.0])
    return force, np.where(np.isfinite(centre), centre, below)
