"""A leg exoskeleton on the same feet: three more hinges beside the person's, and straps, one at the thigh at least.

Both legs are one planar chain, here as for the person: masses of the exoskeleton's bodies are those of both sides. The
numbers of a strap at thigh or shank are those of one leg, as a mat on one leg sees it; two of them act in parallel
between the chains. That is the only place where a 2 enters besides the masses; the pelvis has one module. Numbers of
the exoskeleton are those of `Subject.device`; those of the shipped one are invented but for the straps' dashpots. A
hinge of an exoskeleton that is set to the person lies where the person's does, but for the knee, which is higher by
`WornDevice.knee_above`; one of own lengths has its knee and hip where these lengths put them.

As in the study, where nothing is known yet of the forces between the two: inverse dynamics of this chain has the
torques that person and exoskeleton have together at ankle, knee and hip.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.contact.bushing import bushing_force
from geocontact.data.multibody.joint import revolute
from geocontact.data.multibody.model import Body, Multibody
from geocontact.dynamics.equations import equations_of_motion
from geocontact.dynamics.inverse_dynamics import Wrenches
from geocontact.dynamics.sphere_contact import together
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.standing_up.chain import (
    COMPONENTS,
    FOOT_PARAMETERS,
    GROUND_LAW,
    JOINTS,
    Subject,
    chair_on_person,
    ground_on_feet,
    leg_chain,
)
from geocontact.standing_up.standing_model import ModelConstants, StandingModel
from geocontact.standing_up.strap_sites import THIGH_STRAP, ContactParameter, StrapSite, searched
from geocontact.standing_up.worn_device import PARTS, WornDevice

if TYPE_CHECKING:
    from casadi import SX


LEGS = THIGH_STRAP.count
"""Straps in parallel at the thigh."""
DAMPING, TURNING_DAMPING = THIGH_STRAP.damping, THIGH_STRAP.turning_damping
"""Damping of one strap [N s/m], [N m s/rad]."""
EXO_JOINTS = ("exo_ankle", "exo_knee", "exo_hip")
STRAP_PARAMETERS = THIGH_STRAP.parameters
"""Parameters of one strap at the thigh: stiffness across it, along it and in turning, and its distance from the
knee."""
WORN_PARAMETERS = (*FOOT_PARAMETERS, *STRAP_PARAMETERS)
STRAP = tuple(each.name for each in STRAP_PARAMETERS)
STRAP_PLANTED = searched(STRAP_PARAMETERS, [4.5e3, 2e3, 30.0, 0.22])
"""Parameters of synthetic trials, invented."""


@dataclass(frozen=True)
class Strap:
    """Force and moment of all straps on the person, and what one of them is like.

    Parameters
    ----------
    loads
        On the person's bodies and against it on the exoskeleton's.
    normal
        Force of the thigh's strap of one leg on the person across the thigh, forwards positive [N].
    shear
        The same along the thigh, towards the hip positive [N].
    energy, normal_energy
        Of the springs of all, without the normal ones, which a mat sees, and of those [J].
    elsewhere
        Normal force of one strap at each further site [N], by its name.
    sites
        Whose straps these are, where they are of sites.
    """

    loads: Wrenches
    normal: SX
    shear: SX
    energy: SX
    normal_energy: SX
    elsewhere: Mapping[str, SX] = field(default_factory=dict)
    sites: tuple[StrapSite, ...] = ()


StrapLaw = Callable[[Tree, "SX"], Strap]
"""The law of a strap, of what is searched of `STRAP_PARAMETERS` and of what stands behind them."""


def two_chains(subject: Subject) -> Multibody:
    """The person's chain, with foot plates, and the exoskeleton's on the same feet."""
    alone = leg_chain(subject)
    device = subject.device
    bodies = [_heavier(body, device.masses.foot_plate) if body.name == "foot" else body for body in alone.bodies]
    joints, lengths = list(alone.joints), part_lengths(subject)
    parent, at = "foot", RigidTransform.identity()
    for name, joint, part, length in zip(PARTS, EXO_JOINTS, device.bodies(lengths), lengths, strict=True):
        bodies.append(Body(name, part.mass, np.array([part.across, part.along, 0.0]), part.inertia * np.eye(3)))
        joints.append(revolute(joint, parent, name, np.array([0.0, 0.0, 1.0]), at))
        parent, at = name, RigidTransform.from_translation([0.0, length, 0.0])
    return Multibody("sit to stand with an exoskeleton", tuple(bodies), tuple(joints), (), alone.gravity)


def part_lengths(subject: Subject) -> tuple[float, float, float]:
    """Lengths of the exoskeleton's shank, thigh and module, set to a person [m]."""
    segments = subject.segments
    return subject.device.set_to(segments["shank"].length, segments["thigh"].length)


def hinges_above(subject: Subject) -> dict[str, float]:
    """Height of the exoskeleton's hinge over the person's below each segment [m]."""
    segments = subject.segments
    knee, hip = subject.device.above(segments["shank"].length, segments["thigh"].length)
    return {"shank": 0.0, "thigh": knee, "trunk": hip}


def _heavier(body: Body, more: float) -> Body:
    """With a plate whose mass centre is the body's."""
    return Body(body.name, body.mass + more, body.centre, body.inertia)


def with_exoskeleton(
    subject: Subject,
    strap: StrapLaw | None = None,
    further: tuple[ContactParameter, ...] = (),
    *,
    seated: bool = False,
) -> StandingModel:
    """Nine coordinates: the person's six, then the exoskeleton's; torques of both. The strap is `thigh_strap` by
    default, with `further` parameters behind its usual ones; `seated` with the force of a chair among the inputs.
    """
    from casadi import SX

    tree = tree_of(two_chains(subject))
    parameters = (*WORN_PARAMETERS, *further)
    p, torque = SX.sym("p", len(parameters)), SX.sym("torque", len(tree.names) - 3)
    along = {name: torque[k] for k, name in enumerate(tree.names[3:])}
    chair = SX.sym("chair", COMPONENTS) if seated else None
    return worn_model(tree, p, along, torque, parameters, strap, chair, device=subject.device)


def strapped(subject: Subject, sites: Sequence[StrapSite], *, seated: bool = False) -> StandingModel:
    """The same with straps at sites, the first of which is the thigh."""
    further = tuple(parameter for site in sites[1:] for parameter in site.parameters)
    return with_exoskeleton(subject, straps_at(sites), further, seated=seated)


def worn_model(
    tree: Tree,
    p: SX,
    along: Mapping[str, SX],
    inputs: SX,
    parameters: tuple[ContactParameter, ...],
    law: StrapLaw | None = None,
    chair: SX | None = None,
    *,
    device: WornDevice | None = None,
) -> StandingModel:
    """Both chains on the ground with a strap between them.

    Parameters
    ----------
    p
        What is searched of `parameters`, which begin with those of feet and strap.
    along
        Torques by coordinate, of the inputs and of `p`.
    law
        Of the strap; `thigh_strap` by default.
    chair
        Force and moment of a chair, given over time behind the other inputs.
    device
        Of which `tree` has the bodies.
    """
    feet = len(FOOT_PARAMETERS)
    ground = ground_on_feet(tree, p[:feet, :], GROUND_LAW)
    strap = (law or thigh_strap)(tree, p[feet:, :])
    sat_on = [] if chair is None else [chair]
    loads = together(ground, strap.loads, *(chair_on_person(each) for each in sat_on))
    equations = equations_of_motion(tree, loads=loads, along=along, inputs=[inputs, *sat_on], parameters=[p])
    force, moment = ground["foot"]
    return StandingModel(
        equations,
        parameters,
        force[:2, :],
        moment[2] / force[1],
        strap.normal,
        strap.shear,
        strap.energy,
        strap.normal_energy,
        0 if chair is None else COMPONENTS,
        strap.elsewhere,
        ModelConstants(tree.model, GROUND_LAW, strap.sites, device),
    )


def thigh_strap(tree: Tree, p: SX) -> Strap:
    """The one strap that is always there; `p` is what is searched of `STRAP_PARAMETERS`."""
    return strap_at(tree, p, THIGH_STRAP)


def straps_at(sites: Sequence[StrapSite]) -> StrapLaw:
    """All of them; `p` is what is searched of the parameters of each, one site after the other."""

    def law(tree: Tree, p: SX) -> Strap:
        each, at = [], 0
        for site in sites:
            each.append(strap_at(tree, p[at : at + len(site.parameters), :], site))
            at += len(site.parameters)
        first, *others = each
        energy, normal_energy = first.energy, first.normal_energy
        for strap in others:
            energy, normal_energy = energy + strap.energy, normal_energy + strap.normal_energy
        return Strap(
            together(*(strap.loads for strap in each)),
            first.normal,
            first.shear,
            energy,
            normal_energy,
            {site.name: strap.normal for site, strap in zip(sites[1:], others, strict=True)},
            tuple(sites),
        )

    return law


def strap_at(tree: Tree, p: SX, site: StrapSite) -> Strap:
    """Springs and dashpots in the frame of the person's segment; `p` is what is searched of the site's parameters.

    The force acts at the exoskeleton's point on both bodies, as that of springs whose displacement is seen from the
    person's segment must: then it is the derivative of their energy.
    """
    from casadi import cross, exp, mtimes, vertcat

    person, device = tree.bodies[site.person], tree.bodies[site.device]
    normal, tangential, turning = (site.parameters[k].usual * exp(p[k]) for k in range(3))
    own = mtimes(person.rotation, vertcat(0.0, p[3], 0.0))
    # the same height over the person's hinge, so that nothing is displaced while all angles are 0
    other = mtimes(device.rotation, vertcat(0.0, p[3] - site.above, 0.0))
    gap = device.place + other - person.place - own
    speed = device.speed + cross(device.spin, other) - person.speed - cross(person.spin, own)
    off = mtimes(person.rotation.T, gap)
    rate = mtimes(person.rotation.T, speed - cross(person.spin, gap))
    turn, turn_rate = _turn_between(tree, site.hinges)
    across = bushing_force(off[0], rate[0], normal, site.damping)
    lengthwise = bushing_force(off[1], rate[1], tangential, site.damping)
    force = site.count * mtimes(person.rotation, vertcat(across, lengthwise, 0.0))
    moment = site.count * vertcat(0.0, 0.0, bushing_force(turn, turn_rate, turning, site.turning_damping))
    about = cross(device.place + other, force) + moment
    energy = 0.5 * site.count * (tangential * off[1] ** 2 + turning * turn**2)
    loads = {site.person: (force, about), site.device: (-force, -about)}
    normal_energy = 0.5 * site.count * normal * off[0] ** 2
    return Strap(loads, across, lengthwise, energy, normal_energy, sites=(site,))


def _turn_between(tree: Tree, hinges: int) -> tuple[SX, SX]:
    """How far the exoskeleton's body is turned against the person's [rad], and its rate: sums along both chains."""
    at = {name: k for k, name in enumerate(tree.names)}

    def between(values: SX) -> SX:
        turned = [values[at[device]] - values[at[person]] for device, person in zip(EXO_JOINTS, JOINTS, strict=True)]
        return sum(turned[1:hinges], turned[0])

    return between(tree.q), between(tree.u)


CARRIES = {"shank": "exo_shank", "thigh": "exo_thigh", "trunk": "exo_module"}
"""Part of the exoskeleton by segment."""


def coupled_chain(subject: Subject) -> Multibody:
    """The person's chain with the masses of both, aligned as with all angles at 0."""
    chain, above = leg_chain(subject), hinges_above(subject)
    both = {body.name: body for body in two_chains(subject).bodies}
    bodies = [replace(body, mass=both[body.name].mass) for body in chain.bodies]
    joined = [
        _joined(body, both[CARRIES[body.name]], above[body.name]) if body.name in CARRIES else body for body in bodies
    ]
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
