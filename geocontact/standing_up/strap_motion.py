"""How the exoskeleton moves against the person at a strap, from coordinates of both chains.

These are the inputs of the base model `sit_to_stand`, whose force along them is the strap's normal one: stiffness times
displacement across the thigh, and dashpot times its rate. A strap that sits elsewhere than it was taken for is
displaced by its distance downwards times the turn more, as long as the turn is small: that is the base model's lever.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.chain import COORDINATES, JOINTS, Subject
from geocontact.standing_up.exoskeleton import EXO_JOINTS, two_chains
from geocontact.standing_up.strap_sites import THIGH_STRAP, StrapSite


@dataclass(frozen=True, eq=False)
class StrapMotion:
    """In the frame of the person's segment, at the strap's place.

    Parameters
    ----------
    normal, tangential
        Of the exoskeleton's point from the person's, across the segment (forwards) and along it (upwards) [m].
    rotation
        Of the exoskeleton's segment against the person's [rad].
    """

    normal: Float[np.ndarray, " t"]
    tangential: Float[np.ndarray, " t"]
    rotation: Float[np.ndarray, " t"]


def strap_motion(
    subject: Subject, q: Float[np.ndarray, "t 9"], place: float, site: StrapSite = THIGH_STRAP
) -> StrapMotion:
    """Along coordinates of both chains; `place` is the strap's distance from the person's hinge [m]."""
    names = (*COORDINATES, *EXO_JOINTS)
    poses = two_chains(subject).poses(q)
    own = poses[site.person].apply(np.array([0.0, place, 0.0]))
    other = poses[site.device].apply(np.array([0.0, place - site.above, 0.0]))
    off = poses[site.person].rotation.inv().apply(other - own)
    below = (hinges[: site.hinges] for hinges in (JOINTS, EXO_JOINTS))
    person, device = (q[:, [names.index(each) for each in hinges]].sum(axis=1) for hinges in below)
    return StrapMotion(off[:, 0], off[:, 1], device - person)
