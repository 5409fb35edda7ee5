"""What a force plate shows of a foot, at the frames of another recording."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.wrench import Wrench

ALIGNED = 0.7
"""Smallest cosine between the normals of one and the same ground, as two sources have it."""


@dataclass(frozen=True)
class PlateCurves:
    """Load on a plate at some frames of a motion, in the frame of its ground.

    Parameters
    ----------
    frames
        Which frames of the motion, from 0.
    force
        On the foot [N].
    centre
        Centre of pressure on the plate's surface [m]; NaN below the gate.
    free_moment
        About the plate's normal through the centre [N m]; NaN below the gate.
    """

    frames: Int[np.ndarray, " f"]
    force: Float[np.ndarray, "f 3"]
    centre: Float[np.ndarray, "f 3"]
    free_moment: Float[np.ndarray, " f"]


def load_on_plate(
    frames: Int[np.ndarray, " f"],
    reaction: Wrench,
    point: Float[np.ndarray, " 3"],
    normal: Float[np.ndarray, " 3"],
    gate: float,
) -> PlateCurves:
    """Force, centre and free moment of a plate's reaction on the foot.

    The centre follows from a reaction that was interpolated, and is not itself interpolated: between a loaded and an
    unloaded sample it has no meaning, the force has.

    Parameters
    ----------
    frames
        Frames of the motion that the reactions belong to.
    reaction
        One in each of the frames.
    point, normal
        A point of the plate's surface [m] and its unit normal, in the frame of the reaction.
    gate
        Force along the normal [N] below which there is no centre.
    """
    centre = reaction.centre_of_pressure(point, normal, gate)
    return PlateCurves(frames, reaction.force, centre, reaction.free_moment(centre, normal))


def same_way_up(normals: Float[np.ndarray, "t 3"], normal: Float[np.ndarray, " 3"]) -> bool:
    """Whether the mean cosine between unit normals of the ground, NaN where unknown, and that of a plate is `ALIGNED`.

    True where no normal is known.
    """
    known = normals[np.isfinite(normals[:, 0])]
    return not len(known) or float((known @ normal).mean()) >= ALIGNED
