"""Nine trials of standing up in a finer simulation: a toe joint, three spheres, padded straps on soft tissue.

Nothing of it is measured; all numbers are invented. The foot ends at the ball, where the toes turn on a spring, and
three spheres of different stiffness press under heel, ball and toes, which two spheres of one foot cannot imitate. The
straps are those of `benchmarks.standing.truth`. Three trials are passive, in six the exoskeleton helps by different
shares. Speeds and postures differ as those of one person do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import RigidTransform

from benchmarks.standing.truth import PLANTED, padded_strap, padded_straps
from geocontact.data.multibody.joint import revolute
from geocontact.data.multibody.model import Body, Multibody
from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.dynamics.equations import equations_of_motion
from geocontact.dynamics.sphere_contact import OpenSimSphereLaw, smooth_sphere_wrench, together
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.geometry.shapes import HalfSpace
from geocontact.standing_up.chain import COMPONENTS, FOOT_PARAMETERS, FRICTION, Subject, chair_on_person
from geocontact.standing_up.exoskeleton import two_chains
from geocontact.standing_up.phase import JudgedMotion, PhaseProblem, judged
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import THIGH_STRAP, StrapSite
from geocontact.standing_up.trials import seen_in, standing_up
from meshes.standing_study import RATE, SEATED, SECONDS

VISCOUS, COULOMB = np.array([2.0, 3.0, 2.5]), np.array([1.5, 2.5, 2.0])
"""Friction of the exoskeleton's hinges [N m s/rad, N m]."""
TURNS = np.radians(1.0)
BALL, BOTTOM = 0.125, 0.089
"""Of the toe joint ahead of the ankle, and of the sole below it [m]."""
SPHERES = (
    ("foot", -0.045, 0.030, 5.5e6),
    ("foot", BALL - 0.005, 0.025, 4.0e6),
    ("toes", 0.040, 0.015, 2.5e6),
)
"""Body, place along it [m], radius [m], modulus [Pa]."""
DISSIPATION = 1.0
TOES = 0.6
"""Mass of the toes of both feet [kg], taken from the feet."""
TOE_SPRING, TOE_DAMPER = 40.0, 0.8
"""Of both feet [N m/rad, N m s/rad]."""
HELPED = (
    ("P1", 1.40, (20.0, 72.0, 48.0), 0.25),
    ("P2", 1.55, (23.0, 70.0, 42.0), 0.15),
    ("P3", 1.30, (19.0, 74.0, 50.0), 0.30),
    ("P4", 1.65, (24.0, 69.0, 38.0), 0.20),
    ("P5", 1.45, (21.0, 71.0, 45.0), 0.35),
    ("P6", 1.60, (22.0, 73.0, 40.0), 0.10),
)
"""Assisted trials: duration [s], leans of shank, thigh and trunk at seat-off [deg], share of the person's torque."""
ON_CHAIR, LEAVING, BEHIND = 300.0, 0.3, -0.35
"""Of a chair that is let go: its force [N], how long that takes [s], and how far ahead of the ankle it acts [m]."""
INTERVALS = 32
"""Of each motion, of degree 4."""
CHANNELS = ("time", "q", "u", "force", "centre", "torque", "strap")


@dataclass(frozen=True, eq=False)
class FinerTrial:
    """One motion of the finer simulation.

    Parameters
    ----------
    judged
        Certificate, and what is left of the balance between its points.
    """

    name: str
    assistance: float
    motion: CollocatedMotion
    judged: JudgedMotion


def chain_with_toes(subject: Subject) -> Multibody:
    """Both chains, with toes behind the exoskeleton's hinges so that the coordinates before keep their order."""
    chain = two_chains(subject)
    bodies = [replace(body, mass=body.mass - TOES) if body.name == "foot" else body for body in chain.bodies]
    bodies.append(Body("toes", TOES, np.array([0.03, -0.07, 0.0]), 1.5e-3 * np.eye(3)))
    joint = revolute(
        "toe_joint", "foot", "toes", np.array([0.0, 0.0, 1.0]), RigidTransform.from_translation([BALL, 0.0, 0.0])
    )
    return replace(chain, bodies=tuple(bodies), joints=(*chain.joints, joint))


def finer_model(
    subject: Subject, sites: Sequence[StrapSite] = (THIGH_STRAP,), *, seated: bool = False
) -> StandingModel:
    """Ten coordinates, torques of the six hinges that have one; only the straps' part of the parameters acts.

    Straps are at the thigh, or at all sites; `seated` with the force of a chair among the inputs.
    """
    from casadi import SX

    tree = tree_of(chain_with_toes(subject))
    parameters = (*FOOT_PARAMETERS, *(each for site in sites for each in site.parameters))
    p, torque = SX.sym("p", len(parameters)), SX.sym("torque", 6)
    law = padded_strap if len(sites) == 1 else padded_straps
    at = tree.names.index("toe_joint")
    along = {name: torque[k] for k, name in enumerate(tree.names[3:9])}
    along["toe_joint"] = -TOE_SPRING * tree.q[at] - TOE_DAMPER * tree.u[at]
    ground, strap = under_three_spheres(tree), law(tree, p[len(FOOT_PARAMETERS) :, :])
    sat_on = [SX.sym("chair", COMPONENTS)] if seated else []
    loads = together(ground, strap.loads, *(chair_on_person(each) for each in sat_on))
    e = equations_of_motion(tree, loads=loads, along=along, inputs=[torque, *sat_on], parameters=[p])
    force, moment = (sum(wrench[k] for wrench in ground.values()) for k in range(2))
    return StandingModel(
        e,
        parameters,
        force[:2, :],
        moment[2] / force[1],
        strap.normal,
        strap.shear,
        strap.energy,
        strap.normal_energy,
        given=COMPONENTS if seated else 0,
        elsewhere=strap.elsewhere,
    )


def let_go(time: np.ndarray) -> np.ndarray:
    """Force of the chair forwards and up [N] and its moment about the ground's origin [N m], (t, 3)."""
    up = ON_CHAIR * np.clip(1.0 - time / LEAVING, 0.0, 1.0) ** 3
    return np.column_stack([0.0 * up, up, BEHIND * up])


def under_three_spheres(tree: Tree) -> Any:
    """Force and moment on foot and toes."""
    from casadi import vertcat

    ground = HalfSpace(normal=(0.0, 1.0, 0.0))
    loads = []
    for body, place, radius, modulus in SPHERES:
        law = OpenSimSphereLaw(modulus, DISSIPATION, radius, FRICTION)
        centre = vertcat(place, radius - BOTTOM, 0.0)
        loads.append({body: smooth_sphere_wrench(tree.bodies[body], centre, law, ground)})
    return together(*loads)


def finer_trials(
    model: StandingModel,
    subject: Subject,
    intervals: int = INTERVALS,
    names: tuple[str, ...] = (),
    planted: np.ndarray = PLANTED,
) -> list[FinerTrial]:
    """All nine, or those named, on a chair at first if the model has one. ArithmeticError where one is not found."""
    passive = [(f"T{k + 1}", SECONDS[k], tuple(np.degrees(SEATED[k])), 0.0) for k in range(3)]
    found = []
    for name, seconds, seated, assistance in (*passive, *HELPED):
        if names and name not in names:
            continue
        problem, one = standing_up(
            model,
            subject,
            seconds=seconds,
            seated=np.radians(seated),
            planted=planted,
            assistance=assistance,
            intervals=intervals,
            chair=let_go if model.given else None,
        )
        if not one.solved:
            raise ArithmeticError(f"{name}: {one.ending}")
        (seen,) = judged(model.stepper, range(6), model.turning, PhaseProblem(problem, {}, (), ()), one)
        found.append(FinerTrial(name, assistance, one.motions[0], seen))
    return found


def write_truth(
    file: Path,
    subject: Subject,
    intervals: int = INTERVALS,
    sites: Sequence[StrapSite] = (THIGH_STRAP,),
    planted: np.ndarray = PLANTED,
    names: tuple[str, ...] = (),
    *,
    seated: bool = False,
) -> None:
    """Everything that a perfect recording of the nine would hold, 100 samples a second, in SI."""
    model, saved = finer_model(subject, sites, seated=seated), {}
    for one in finer_trials(model, subject, intervals, names, planted):
        time = np.linspace(0.0, one.motion.breaks[-1], round(RATE * float(one.motion.breaks[-1])) + 1)
        seen = seen_in(model, one.motion, planted, time, one.name)
        told = one.judged.certificate
        saved |= {f"{one.name} {name}": getattr(seen, name) for name in CHANNELS}
        if seated:
            saved[f"{one.name} chair"] = let_go(time)
        saved |= {f"{one.name} {site} strap": force for site, force in seen.elsewhere.items()}
        saved[f"{one.name} residual"] = np.array([one.judged.force.max(), one.judged.moment.max()])
        saved[f"{one.name} certified"] = np.array(told is not None and told.converged)
        print(one.name, saved[f"{one.name} residual"], saved[f"{one.name} certified"], flush=True)
    np.savez(file, **saved)


def friction(rates: np.ndarray) -> np.ndarray:
    """Friction of the exoskeleton's hinges, against their rates [N m]."""
    return np.asarray(VISCOUS * rates + COULOMB * np.tanh(rates / TURNS))


def unloaded_motors(subject: Subject) -> tuple[np.ndarray, ...]:
    """Angles, rates, accelerations of the exoskeleton alone, and what its motors give then, 100 samples a second."""
    from casadi import Function

    from geocontact.dynamics.inverse_dynamics import generalised_forces

    time = np.arange(0.0, 30.0, 1.0 / RATE)[:, None]
    rate = 2.0 * np.pi * np.array([[0.13, 0.21, 0.31], [0.47, 0.61, 0.37]])[:, None, :]
    size = np.array([[0.25, 0.5, 0.4], [0.06, 0.10, 0.12]])[:, None, :]
    q = (size * np.sin(rate * time)).sum(axis=0) + np.array([-0.2, 0.8, -0.6])
    u, a = (size * rate * np.cos(rate * time)).sum(axis=0), (-size * rate**2 * np.sin(rate * time)).sum(axis=0)
    tree = tree_of(two_chains(subject))
    whole = [np.hstack([np.zeros((len(q), 6)), each]) for each in (q, u, a)]
    forces = Function("forces", [tree.q, tree.u, tree.a], [generalised_forces(tree)]).map(len(q))
    return q, u, a, forces(*(each.T for each in whole)).full().T[:, 6:] + friction(u)
