"""The chain on the ground: heel and toe spheres, the joints' torques, and what a force plate would see."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geocontact.dynamics.body_contact import together
from geocontact.dynamics.equations import Equations, equations_of_motion
from geocontact.dynamics.smooth_sphere_contact import OpenSimSphereLaw, StribeckFriction, smooth_sphere_wrench
from geocontact.dynamics.tree import tree_of
from geocontact.geometry.shapes import HalfSpace
from geocontact.sit_to_stand.chain import COORDINATES, JOINTS, Subject, leg_chain

if TYPE_CHECKING:
    from casadi import SX

RADIUS = 0.035
"""Of both spheres [m]; invented, a height cannot be told from it."""
CENTRE_HEIGHT = -0.06
"""Of the spheres' centres above the ankle [m], invented."""
DISSIPATION = 1.5
"""s/m; held, because flat feet do not tell it."""
FRICTION = StribeckFriction(0.2, 0.9, 0.7, 0.4)
STIFFNESS = 5e6
"""Pa, that a parameter of 0 stands for."""
PARAMETERS = ("log stiffness", "heel", "toe")
"""ln(K / `STIFFNESS`); place of either centre ahead of the ankle [m]."""


@dataclass(frozen=True)
class FeetOnGround:
    """Equations whose inputs are the torques of `JOINTS`, and the plate's readings.

    Parameters
    ----------
    equations
        Parameters are `PARAMETERS`.
    force
        Of the ground on both feet, forwards and up [N], (2, 1).
    centre
        Its centre of pressure, forwards [m].
    """

    equations: Equations
    force: SX
    centre: SX


def feet_on_ground(subject: Subject) -> FeetOnGround:
    """The chain with a heel and a toe sphere, by OpenSim's law.

    With the printed one the search for a motion came to no end. Its friction starts as the cube of the speed, so that a
    foot which stands slips freely; whether that is the cause was not tried by itself.
    """
    from casadi import SX, exp, vertcat

    tree = tree_of(leg_chain(subject))
    p, torque = SX.sym("p", len(PARAMETERS)), SX.sym("torque", len(JOINTS))
    law = OpenSimSphereLaw(STIFFNESS * exp(p[0]), DISSIPATION, RADIUS, FRICTION)
    ground = HalfSpace(normal=(0.0, 1.0, 0.0))
    wrenches = []
    for place in (p[1], p[2]):
        foot = tree.bodies["foot"]
        wrenches.append(smooth_sphere_wrench(foot, vertcat(place, CENTRE_HEIGHT, 0.0), law, ground))
    loads = together(*({"foot": wrench} for wrench in wrenches))
    along = {name: torque[k] for k, name in enumerate(JOINTS)}
    equations = equations_of_motion(tree, loads=loads, along=along, inputs=[torque], parameters=[p])
    if equations.names != COORDINATES:
        raise ValueError(f"coordinates are {equations.names}")
    force, moment = loads["foot"]
    return FeetOnGround(equations, force[:2, :], moment[2] / force[1])


PLANTED = np.array([0.2, -0.045, 0.135])
"""Parameters of synthetic trials, invented."""
