"""How the exoskeleton's thigh moves against the person's at the strap, from coordinates of both chains.

These are the inputs of the base model `sit_to_stand`, whose force along them is the strap's normal one: stiffness times
displacement across the thigh, and dashpot times its rate. A strap that sits elsewhere than it was taken for is
displaced by its distance downwards times the turn more, as long as the turn is small: that is the base model's lever.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.chain import COORDINATES, Subject
from geocontact.standing_up.exoskeleton import EXO_JOINTS, SHIFT, two_chains

BELOW_THIGH = (("ankle", "knee"), EXO_JOINTS[:2])
"""Hinges between the foot and either thigh."""


@dataclass(frozen=True, eq=False)
class StrapMotion:
    """In the frame of the person's thigh, at the strap's place.

    Parameters
    ----------
    normal, tangential
        Of the exoskeleton's point from the person's, across the thigh (forwards) and along it (towards the hip) [m].
    rotation
        Of the exoskeleton's thigh against the person's [rad].
    """

    normal: Float[np.ndarray, " t"]
    tangential: Float[np.ndarray, " t"]
    rotation: Float[np.ndarray, " t"]


def strap_motion(subject: Subject, q: Float[np.ndarray, "t 9"], place: float) -> StrapMotion:
    """Along coordinates of both chains; `place` is the strap's distance from the person's knee [m]."""
    names = (*COORDINATES, *EXO_JOINTS)
    poses = two_chains(subject).poses(q)
    own = poses["thigh"].apply(np.array([0.0, place, 0.0]))
    other = poses["exo_thigh"].apply(np.array([0.0, place - SHIFT, 0.0]))
    off = poses["thigh"].rotation.inv().apply(other - own)
    person, device = (q[:, [names.index(each) for each in hinges]].sum(axis=1) for hinges in BELOW_THIGH)
    return StrapMotion(off[:, 0], off[:, 1], device - person)
