"""Stances of walking in phase A: one leg on its foot, with what the rest of the body does to it as a given load.

Foot, shank and thigh stand in the sagittal plane on a heel and a toe sphere. On the thigh act a force and a moment that
are given over time: the plate's load less what accelerates the leg, all low-passed alike. So the balance asks the
spheres for about the force of the plate, and phase A finds their parameters and the motion within the markers' error.
The foot is rigid from heel to toe, which it is not after heel-off: only samples before it turns far are used.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.multibody.model import Body, Multibody
from geocontact.dynamics.equations import equations_of_motion
from geocontact.dynamics.inverse_dynamics import generalised_forces
from geocontact.dynamics.sphere_contact import together
from geocontact.dynamics.tree import tree_of
from geocontact.identify.signals.filters import zero_lag
from geocontact.standing_up.chain import (
    COMPONENTS,
    COORDINATES,
    FOOT_PARAMETERS,
    GROUND_LAW,
    JOINTS,
    Subject,
    ground_on_feet,
    leg_chain,
)
from geocontact.standing_up.exoskeleton import two_chains
from geocontact.standing_up.standing_model import ModelConstants, StandingModel

LEG = ("fore_aft", "upwards", "foot", "shank", "thigh")
CUTOFF = 12.0
"""Cut-off of coordinates and plates [Hz]; walking is faster than standing up."""
LEAST = 150.0
"""Force up from which a sample is used [N]."""
LIFTED = 1.0
"""Force [N] that keeps the centre of pressure a number where the search lifts the foot; 0.1 mm under a step."""
MOST_TURN = float(np.radians(30.0))
"""Forward turn of the foot up to which a sample is used: then the toes bend, which a rigid foot cannot."""
BENEATH = (-0.15, 0.3)
"""Centre of pressure ahead of the ankle [m], the median of a stance: beyond, another foot stands on the plate. Feet are
0.26 m long and reach 0.06 m behind the ankle, and nobody stands on the tip of the toes throughout."""
SIZES = {"length": 5e-3, "angle": float(np.radians(2.0)), "rate": 0.1, "force": 10.0, "centre": 5e-3}
"""Standard deviations of one sample from markers on soft tissue [m, rad, m/s and rad/s, N, m]; invented."""
JERK = {"foot_jerk": 1500.0, "joint_jerk": 6000.0}
"""Sizes that count as 1 [m/s^3, rad/s^3], some times those of a step."""
Times = Float[np.ndarray, " t"]


def one_leg(subject: Subject) -> Multibody:
    """Foot, shank and thigh of one leg."""
    both = leg_chain(subject)
    bodies = tuple(Body(b.name, 0.5 * b.mass, b.centre, 0.5 * b.inertia) for b in both.bodies if b.name in LEG)
    return Multibody("one leg in stance", bodies, both.joints[: len(LEG)], (), both.gravity)


def chain_of(subject: Subject, count: int) -> Multibody:
    """The chain with that many coordinates: one leg, the person, or the person with an exoskeleton."""
    if count < len(COORDINATES):
        return one_leg(subject)
    return two_chains(subject) if count > len(COORDINATES) else leg_chain(subject)


def standing_leg(subject: Subject) -> StandingModel:
    """Five coordinates, two torques, and the load on the thigh among the inputs."""
    from casadi import SX, vertcat

    tree = tree_of(one_leg(subject))
    p, torque, load = SX.sym("p", len(FOOT_PARAMETERS)), SX.sym("torque", 2), SX.sym("load", COMPONENTS)
    ground = ground_on_feet(tree, p)
    rest = {"thigh": (vertcat(load[0], load[1], 0.0), vertcat(0.0, 0.0, load[2]))}
    along = {name: torque[k] for k, name in enumerate(JOINTS[:2])}
    loads = together(ground, rest)
    equations = equations_of_motion(tree, loads=loads, along=along, inputs=[torque, load], parameters=[p])
    (force, moment), none = ground["foot"], SX(0, 1)
    seen = force[:2, :], moment[2] / (force[1] + LIFTED)
    built = ModelConstants(tree.model, GROUND_LAW)
    return StandingModel(equations, FOOT_PARAMETERS, *seen, none, none, SX(0), SX(0), COMPONENTS, constants=built)


def load_of_the_rest(
    subject: Subject, time: Times, q: Float[np.ndarray, "t 5"], ground: Float[np.ndarray, "t 3"]
) -> Float[np.ndarray, "t 3"]:
    """Force forwards and up [N] and moment about the ground's origin [N m] on the thigh that balance leg and ground.

    Parameters
    ----------
    q
        Coordinates of the leg, at even times, low-passed [m, rad].
    ground
        Force forwards and up [N] and moment about the ground's origin [N m] of the ground on the foot.
    """
    from casadi import Function

    step = float(np.ptp(time)) / (len(time) - 1)
    u = np.gradient(q, step, axis=0)
    a = np.gradient(u, step, axis=0)
    tree = tree_of(one_leg(subject))
    # what accelerates the leg along its foot's coordinates: force, and moment about the ankle
    needed = Function("needed", [tree.q, tree.u, tree.a], [generalised_forces(tree)[:3, :]]).map(len(q))
    balance = needed(q.T, u.T, a.T).full().T
    about = balance[:, 2] + q[:, 0] * balance[:, 1] - q[:, 1] * balance[:, 0]
    return np.asarray(np.column_stack([balance[:, :2], about]) - ground)


def smooth(time: Times, values: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "t c"]:
    """Low-passed at `CUTOFF`; ValueError for times that a filter cannot use."""
    return zero_lag(values, float(np.ptp(time)) / (len(time) - 1), CUTOFF)


def in_stance(up: Times, turn: Times) -> Bool[np.ndarray, " t"]:
    """Samples with a foot that is loaded and flat enough to be rigid."""
    return np.asarray((up > LEAST) & (turn > -MOST_TURN))


def off_the_foot(centre: Times, ankle: Times) -> float | None:
    """Median of the centre of pressure ahead of the ankle [m] where no foot reaches it; else None."""
    ahead = float(np.median(centre - ankle))
    return None if BENEATH[0] <= ahead <= BENEATH[1] else ahead


def stances(time: Times, up: Times, turn: Times, fewest: int) -> list[tuple[float, float]]:
    """Begin and end [s] of each run of at least that many samples in stance that begins within the recording."""
    inside = np.r_[False, in_stance(up, turn), False].astype(int)
    first, last = np.flatnonzero(np.diff(inside) > 0), np.flatnonzero(np.diff(inside) < 0) - 1
    return [(float(time[a]), float(time[b])) for a, b in zip(first, last, strict=True) if b - a + 1 >= fewest and a > 0]
