"""What torques and straps of a recording have to be by its other channels: coordinates, ground reaction, stiffness.

The part below a joint is in balance: the torque that it passes upwards is the moment about the joint of the ground
reaction and of the weight below it. Its inertia is left out: feet and shanks of who stands up hardly accelerate, and
second derivatives of measured angles would be noise.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from geocontact.data.multibody.model import Multibody
from geocontact.standing_up.chain import GRAVITY, JOINTS
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.strap_sites import StrapSite

Times = Float[np.ndarray, " t"]
SMALL = 1e-6
"""rad, by which a coordinate is turned to see which way it turns."""


def torques_by_ground(
    chain: Multibody, q: Float[np.ndarray, "t n"], force: Float[np.ndarray, "t 2"], centre: Times
) -> Float[np.ndarray, "t j"]:
    """Torque of ankle, knee and hip of both legs, with those of the exoskeleton's hinges beside them [N m].

    Parameters
    ----------
    q
        Coordinates [m, rad].
    force, centre
        Of the ground on both feet, forwards and up [N], and its centre of pressure, forwards [m]; the ground is y = 0.
    """
    poses = chain.poses(q)
    names = [c.name for c in chain.coordinates]
    child = {joint.coordinates[0].name: joint.child for joint in chain.joints if joint.coordinates}
    found = np.empty((len(q), len(JOINTS)))
    below = ["foot"]
    for k, joint in enumerate(JOINTS):
        place = poses[child[joint]].translation
        moment = (centre - place[:, 0]) * force[:, 1] + place[:, 1] * force[:, 0]
        for body in chain.bodies:
            if body.name in below:
                at = poses[body.name].apply(body.centre)
                moment = moment - (at[:, 0] - place[:, 0]) * body.mass * -GRAVITY[1]
        turned = np.zeros(len(names))
        turned[names.index(joint)] = SMALL
        more = (poses[child[joint]].rotation.inv() * chain.poses(q + turned)[child[joint]].rotation).as_rotvec()
        found[:, k] = np.sign(np.median(more[:, 2])) * moment
        below += [child[joint], *(child[each] for each in EXO_JOINTS[k : k + 1] if each in child)]
    return found


def strap_by_coordinates(
    chain: Multibody, q: Float[np.ndarray, "t n"], site: StrapSite, values: Mapping[str, float]
) -> Times:
    """Normal force of one strap on the person by its spring, without its dashpot [N].

    `values` are those of the calibrated parameters by name [SI].
    """
    normal, place = (values[site.names[k]] for k in (0, 3))
    poses = chain.poses(q)
    person, device = poses[site.person], poses[site.device]
    gap = device.apply(np.array([0.0, place - site.above, 0.0])) - person.apply(np.array([0.0, place, 0.0]))
    return np.asarray(normal * person.rotation.inv().apply(gap)[:, 0])
