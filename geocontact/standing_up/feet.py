"""The chain on the ground: heel and toe spheres, the joints' torques, and what a force plate would see."""

from __future__ import annotations

from typing import TYPE_CHECKING

from geocontact.dynamics.body_contact import together
from geocontact.dynamics.equations import equations_of_motion
from geocontact.dynamics.inverse_dynamics import Wrenches
from geocontact.dynamics.smooth_sphere_contact import OpenSimSphereLaw, StribeckFriction, smooth_sphere_wrench
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.geometry.shapes import HalfSpace
from geocontact.standing_up.chain import COORDINATES, JOINTS, Subject, leg_chain
from geocontact.standing_up.chair import COMPONENTS, chair_on_person
from geocontact.standing_up.contact_parameter import ContactParameter, searched
from geocontact.standing_up.model_constants import GroundLaw, ModelConstants
from geocontact.standing_up.standing_model import StandingModel

if TYPE_CHECKING:
    from casadi import SX

FRICTION = StribeckFriction(0.2, 0.9, 0.7, 0.4)
"""The usual one; the factor `friction` multiplies both coefficients."""
GROUND_LAW = GroundLaw(FRICTION)
FOOT_PARAMETERS = (
    ContactParameter("stiffness", "Pa", 3e6, 1.0, 2.5e5, 6e7, logarithm=True),
    ContactParameter("heel", "m", -0.03, 0.02, -0.09, 0.02),
    ContactParameter("toe", "m", 0.11, 0.03, 0.05, 0.22),
    ContactParameter("bottom", "m", 0.095, 0.007, 0.05, 0.14),
    ContactParameter("radius", "m", 0.035, 0.005, 0.01, 0.06),
    ContactParameter("dissipation", "s/m", 1.5, 0.5, 0.1, 20.0, logarithm=True),
    ContactParameter("friction", "-", 1.0, 0.3, 0.1, 5.0, logarithm=True),
)
"""Of both spheres: modulus, places of the centres ahead of the ankle, how far they reach below it, radius, dissipation,
factor of the friction. What is believed of them is invented. The height of the centres instead of their lowest points
would be one number with the radius: estimates of the two had a correlation of 0.994."""
LAW = ("stiffness", "heel", "toe")
"""What is free where the others are known."""
SOUGHT = tuple(each.name for each in FOOT_PARAMETERS if each.name != "dissipation")
"""What is free where little is known and nothing is worn. Dissipation acts by the few mm/s at which standing feet sink,
less than the noise of a rate: freed, it follows the noise, to 4 and 5 standard deviations too high on two of three."""
SOUGHT_WORN = tuple(each.name for each in FOOT_PARAMETERS)
"""With an exoskeleton feet move more: dissipation that is held at 1.5 s/m where 1 was planted puts the lowest point of
three trials 8 standard deviations off, freed it is 2 off itself and the lowest point 2.5."""


def feet_on_ground(subject: Subject, *, seated: bool = False) -> StandingModel:
    """The chain with a heel and a toe sphere, by OpenSim's law; `seated` with the force of a chair among the inputs.

    With the printed one the search for a motion came to no end. Its friction starts as the cube of the speed, so that a
    foot which stands slips freely; whether that is the cause was not tried by itself.
    """
    from casadi import SX

    tree = tree_of(leg_chain(subject))
    p, torque = SX.sym("p", len(FOOT_PARAMETERS)), SX.sym("torque", len(JOINTS))
    chair = SX.sym("chair", COMPONENTS if seated else 0)
    law = GROUND_LAW
    ground = ground_on_feet(tree, p, law)
    loads = together(ground, chair_on_person(chair)) if seated else ground
    along = {name: torque[k] for k, name in enumerate(JOINTS)}
    equations = equations_of_motion(tree, loads=loads, along=along, inputs=[torque, chair], parameters=[p])
    if equations.names != COORDINATES:
        raise ValueError(f"coordinates are {equations.names}")
    (force, moment), none = ground["foot"], SX(0, 1)
    seen = force[:2, :], moment[2] / force[1]
    built = ModelConstants(tree.model, law)
    return StandingModel(equations, FOOT_PARAMETERS, *seen, none, none, SX(0), SX(0), chair.numel(), constants=built)


def ground_on_feet(tree: Tree, p: SX, ground_law: GroundLaw = GROUND_LAW) -> Wrenches:
    """Force and moment on the foot from both spheres; `p` is what is searched of `FOOT_PARAMETERS`."""
    from casadi import exp, vertcat

    factor, usual = exp(p[6]), ground_law.friction
    friction = StribeckFriction(usual.v_t, usual.mu_s * factor, usual.mu_d * factor, usual.mu_v)
    stiffness, dissipation = (FOOT_PARAMETERS[k].usual * exp(p[k]) for k in (0, 5))
    smoothing = ground_law.hertz, ground_law.hunt_crossley, ground_law.constant
    law = OpenSimSphereLaw(stiffness, dissipation, p[4], friction, *smoothing)
    ground = HalfSpace(normal=(0.0, 1.0, 0.0))
    foot = tree.bodies["foot"]
    wrenches = [smooth_sphere_wrench(foot, vertcat(place, p[4] - p[3], 0.0), law, ground) for place in (p[1], p[2])]
    return together(*({"foot": wrench} for wrench in wrenches))


PLANTED = searched(FOOT_PARAMETERS, [6.1e6, -0.045, 0.135, 0.095, 0.035, 1.5, 1.0])
"""Of synthetic trials where all but `LAW` are known, invented."""
EVERY_PLANTED = searched(FOOT_PARAMETERS, [6.1e6, -0.045, 0.135, 0.089, 0.032, 1.0, 1.3])
"""Of synthetic trials where none is, invented."""
