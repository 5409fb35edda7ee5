"""Six coordinates: the person with the exoskeleton rigidly on, its parts on the segments that they lie along.

As in the study, where nothing is known yet of the forces between the two: inverse dynamics of this chain has the
torques that person and exoskeleton have together at ankle, knee and hip.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.data.multibody.model import Body, Multibody
from geocontact.standing_up.chain import Subject, leg_chain
from geocontact.standing_up.exoskeleton import two_chains
from geocontact.standing_up.strap_sites import SHIFT

CARRIES = {"shank": ("exo_shank", 0.0), "thigh": ("exo_thigh", SHIFT), "trunk": ("exo_module", 0.0)}
"""By segment: part of the exoskeleton, and its origin above the segment's [m]."""


def coupled_chain(subject: Subject) -> Multibody:
    """The person's chain with the masses of both, aligned as with all angles at 0."""
    chain = leg_chain(subject)
    both = {body.name: body for body in two_chains(subject).bodies}
    bodies = [replace(body, mass=both[body.name].mass) for body in chain.bodies]
    joined = [_joined(body, both[CARRIES[body.name][0]], CARRIES[body.name][1]) if body.name in CARRIES else body
              for body in bodies]  # fmt: skip
    return replace(chain, name="sit to stand, rigidly coupled", bodies=tuple(joined))


def _joined(body: Body, other: Body, above: float) -> Body:
    """One rigid body of two, by the parallel axis theorem."""
    mass = body.mass + other.mass
    places = (body.centre, other.centre + np.array([0.0, above, 0.0]))
    centre = (body.mass * places[0] + other.mass * places[1]) / mass
    inertia = np.zeros((3, 3))
    for each, place in zip((body, other), places, strict=True):
        arm = place - centre
        inertia += each.inertia + each.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return Body(body.name, mass, centre, inertia)
