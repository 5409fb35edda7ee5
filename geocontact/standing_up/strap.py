"""A strap between exoskeleton and person: how it moves, and the force and moment that it passes on.

These are the inputs of the base model `sit_to_stand`, whose force along them is the strap's normal one: stiffness times
displacement across the thigh, and dashpot times its rate. A strap that sits elsewhere than it was taken for is
displaced by its distance downwards times the turn more, as long as the turn is small: that is the base model's lever.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.contact.bushing import bushing_force
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


STEP = 1e-6
"""Step of the time along the rates, for rates of displacements [s]."""


@dataclass(frozen=True, eq=False)
class StrapForce:
    """In the ground's axes.

    Parameters
    ----------
    own, place
        Points of the person's and of the exoskeleton's segment [m]; the force acts at the latter.
    force, moment
        Of one strap on the person [N], [N m].
    """

    own: Float[np.ndarray, "t 3"]
    place: Float[np.ndarray, "t 3"]
    force: Float[np.ndarray, "t 3"]
    moment: Float[np.ndarray, "t 3"]


def strap_force(
    subject: Subject,
    q: Float[np.ndarray, "t 9"],
    u: Float[np.ndarray, "t 9"],
    values: Mapping[str, float],
    site: StrapSite = THIGH_STRAP,
) -> StrapForce:
    """Springs and dashpots as `exoskeleton.strap_at` has them; `values` are those of the site's parameters in SI."""
    *stiffness, at = (values[name] for name in site.names)
    moved, before, after = (_displaced(subject, q + h * u, at, site) for h in (0.0, -STEP, STEP))
    rate = (after - before) / (2.0 * STEP)
    across, along, turning = (
        bushing_force(moved[:, k], rate[:, k], k_n, b)
        for k, (k_n, b) in enumerate(zip(stiffness, (site.damping, site.damping, site.turning_damping), strict=True))
    )
    poses, none = two_chains(subject).poses(q), np.zeros(len(q))
    force = poses[site.person].rotation.apply(np.column_stack([across, along, none]))
    own = poses[site.person].apply(np.array([0.0, at, 0.0]))
    place = poses[site.device].apply(np.array([0.0, at - site.above, 0.0]))
    return StrapForce(own, place, force, np.column_stack([none, none, turning]))


def _displaced(
    subject: Subject, q: Float[np.ndarray, "t 9"], place: float, site: StrapSite
) -> Float[np.ndarray, "t 3"]:
    moved = strap_motion(subject, q, place, site)
    return np.column_stack([moved.normal, moved.tangential, moved.rotation])
