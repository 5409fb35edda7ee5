"""Bodies that stand up: feet, shanks, thighs and trunk in the sagittal plane, on the ground and on the chair.

x points forwards, y up, turns are about z. Both legs move alike, so that their masses are added and the ground's force
is that of both feet. Segments are those of `person_segments`; head, arms and trunk are one
rigid body.

It is given over time as force forwards and up and as moment about the ground's origin, so that no point of it has to be
known. After seat-off it is 0, and the trial goes on as one that begins there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.data.body_segments import Sex
from geocontact.data.multibody.joint import prismatic, revolute
from geocontact.data.multibody.model import Body, Multibody
from geocontact.dynamics.equations import equations_of_motion
from geocontact.dynamics.inverse_dynamics import Wrenches
from geocontact.dynamics.sphere_contact import OpenSimSphereLaw, StribeckFriction, smooth_sphere_wrench, together
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.geometry.shapes import HalfSpace
from geocontact.standing_up.person_segments import PersonSegment, segments_of
from geocontact.standing_up.standing_model import GroundLaw, ModelConstants, StandingModel
from geocontact.standing_up.strap_sites import ContactParameter, searched
from geocontact.standing_up.worn_device import SHIPPED_DEVICE, WornDevice

if TYPE_CHECKING:
    from casadi import SX


COORDINATES = ("foot_x", "foot_y", "foot_turn", "ankle", "knee", "hip")
TURNING = (False, False, True, True, True, True)
"""Which coordinates are angles."""
JOINTS = ("ankle", "knee", "hip")
GRAVITY = np.array([0.0, -9.81, 0.0])
X, Y, Z = np.eye(3)


@dataclass(frozen=True)
class Subject:
    """Body mass [kg] and height [m], the exoskeleton where one is worn, and whose segments the person has.

    Parameters
    ----------
    sex
        Row of de Leva's table.
    own
        The person's own values of segments, as `person_segments.segments_of` takes them.
    age
        Of a child [years].
    """

    mass: float = 70.0
    height: float = 1.75
    device: WornDevice = SHIPPED_DEVICE
    sex: Sex = "male"
    own: Mapping[str, Mapping[str, float]] = field(default_factory=dict, hash=False)
    age: float | None = None

    @property
    def segments(self) -> dict[str, PersonSegment]:
        """Foot, shank, thigh and trunk in kg and m, masses of both sides."""
        return segments_of(self.mass, self.height, self.sex, self.own, self.age)


def leg_chain(subject: Subject) -> Multibody:
    """The chain; with all coordinates at 0 it stands upright with the ankle at the ground's origin."""
    bodies = [Body("fore_aft", 0.0, np.zeros(3), np.zeros((3, 3))), Body("upwards", 0.0, np.zeros(3), np.zeros((3, 3)))]
    segments = subject.segments
    bodies.append(_body("foot", segments["foot"], X, -0.05))
    joints = [
        prismatic("foot_x", "ground", "fore_aft", X),
        prismatic("foot_y", "fore_aft", "upwards", Y),
        revolute("foot_turn", "upwards", "foot", Z),
    ]
    parent, at = "foot", RigidTransform.identity()
    for name, joint in (("shank", "ankle"), ("thigh", "knee"), ("trunk", "hip")):
        bodies.append(_body(name, segments[name], Y, 0.0))
        joints.append(revolute(joint, parent, name, Z, at))
        parent, at = name, RigidTransform.from_translation([0.0, segments[name].length, 0.0])
    return Multibody("sit to stand", tuple(bodies), tuple(joints), (), GRAVITY)


def _body(name: str, segment: PersonSegment, along: np.ndarray, height: float) -> Body:
    inertia = segment.mass * segment.gyration**2
    return Body(name, segment.mass, along * segment.centre + Y * height, inertia * np.eye(3))


SITS = "trunk"
"""The trunk stands for the pelvis too."""
COMPONENTS = 3


def chair_on_person(chair: SX) -> Wrenches:
    """Load of force forwards, force up [N] and moment about z through the ground's origin [N m], (3."""
    from casadi import vertcat

    return {SITS: (vertcat(chair[0], chair[1], 0.0), vertcat(0.0, 0.0, chair[2]))}


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
"""Parameters of both spheres: modulus, places of the centres ahead of the ankle, how far they reach below it, radius,
dissipation, factor of the friction. Their prior is invented. The height of the centres instead of their
lowest points would be one number with the radius: estimates of the two had a correlation of 0.994."""
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
"""Parameters of synthetic trials where all but `LAW` are known, invented."""
EVERY_PLANTED = searched(FOOT_PARAMETERS, [6.1e6, -0.045, 0.135, 0.089, 0.032, 1.0, 1.3])
"""Parameters of synthetic trials where none is, invented."""
