"""The exoskeleton helps at the knee with a share of the person's torque, and how a person stands up with help.

Its torque there is s g(t/T) times that of the person's knee, with g = exp(-((t/T - c)/w)²/2): the share s and the time
c are to be chosen, the width w is invented. Its ankle turns freely; its hip holds the module, which no strap holds.

The person does not give way to spare the strap: what is chosen of the exoskeleton changes forces, and the movement only
as far as its own cost lets it. Sizes are those of the synthetic trials: deviations count in parts of 1 cm and 2°, the
module's lean against the trunk's in parts of 5°; invented.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.motion import CollocatedMotion
from geocontact.dynamics.collocation.multibody import jerk_controlled
from geocontact.dynamics.collocation.problem import ControlledTrial, ControlProblem
from geocontact.dynamics.symbols import residual
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.standing_up.chain import COORDINATES, FOOT_PARAMETERS, Subject
from geocontact.standing_up.exoskeleton import WORN_PARAMETERS, Strap, StrapLaw, straps_at, two_chains, worn_model
from geocontact.standing_up.phase import smooth_coordinates
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import PELVIS_STRAP, SHANK_STRAP, THIGH_STRAP, ContactParameter, StrapSite
from geocontact.standing_up.trials import StandingTrial, problem_scales, seen_in, standing_trial

if TYPE_CHECKING:
    from casadi import SX


WIDTH = 0.25
"""Width of the help, in parts of the movement; invented."""
ASSISTANCE_PARAMETERS = (
    ContactParameter("share", "-", 0.25, 0.25, 0.0, 2.0),
    ContactParameter("timing", "-", 0.25, 0.25, 0.0, 0.8),
)
"""Share of the person's knee torque, and where in the movement it is most."""
ASSISTED_PARAMETERS = (*WORN_PARAMETERS, *ASSISTANCE_PARAMETERS)
FURTHER_SITES = (SHANK_STRAP, PELVIS_STRAP)
EVERY_ASSISTED = (*ASSISTED_PARAMETERS, *(each for site in FURTHER_SITES for each in site.parameters))
"""With straps elsewhere: those of both further sites, of which a site that is not there has no effect."""
SHARE, TIMING = (len(WORN_PARAMETERS) + k for k in range(2))
KNEE = 1
"""Index of the knee among the torques."""
TORQUES = ("ankle torque", "knee torque", "hip torque", "exo_hip torque")
"""What is sought over time."""
DRIVEN = (3, 4, 5, 8)
"""Coordinates that these turn."""


@dataclass(frozen=True)
class AssistedModel:
    """Two chains whose exoskeleton helps.

    Parameters
    ----------
    standing
        Its equations have the part of the movement as their first input, then `TORQUES`.
    help
        Of `standing`'s inputs and parameters: torque of the exoskeleton's knee [N m].
    width
        Of the help, in parts of the movement.
    """

    standing: StandingModel
    help: SX
    width: float

    @property
    def controlled(self) -> range:
        """Inputs of the equations that are sought."""
        return range(1, 1 + len(TORQUES))


def assisted_parameters(sites: Sequence[StrapSite]) -> tuple[ContactParameter, ...]:
    """Parameters of the model with straps at these sites, the first of which is the thigh."""
    return ASSISTED_PARAMETERS if len(sites) == 1 else EVERY_ASSISTED


def assisted_model(
    subject: Subject,
    strap: StrapLaw | None = None,
    width: float = WIDTH,
    sites: Sequence[StrapSite] = (THIGH_STRAP,),
) -> AssistedModel:
    """The model of a person who wears the exoskeleton, with the straps that are calibrated unless another law is."""
    from casadi import SX, exp, vertcat

    parameters = assisted_parameters(sites)
    p, part, torque = SX.sym("p", len(parameters)), SX.sym("part"), SX.sym("torque", len(TORQUES))
    helped = p[SHARE] * exp(-0.5 * ((part - p[TIMING]) / width) ** 2) * torque[KNEE]
    along = {name: torque[k] for k, name in enumerate(("ankle", "knee", "hip", "exo_hip"))} | {"exo_knee": helped}
    tree = tree_of(two_chains(subject))
    law = strap or _at_sites(sites)
    standing = worn_model(tree, p, along, vertcat(part, torque), parameters, law, device=subject.device)
    return AssistedModel(standing, helped, width)


def _at_sites(sites: Sequence[StrapSite]) -> StrapLaw:
    """The law of all straps, of what is searched behind the feet's parameters: the thigh's, the help, the others."""
    names = [each.name for each in EVERY_ASSISTED[len(FOOT_PARAMETERS) :]]
    at = [names.index(name) for site in sites for name in site.names]
    law = straps_at(sites)

    def chosen(tree: Tree, p: SX) -> Strap:
        return law(tree, p[at, :])

    return chosen


def seen_assisted(
    model: AssistedModel,
    motion: CollocatedMotion,
    p: Float[np.ndarray, " p"],
    time: Float[np.ndarray, " t"],
    name: str,
) -> StandingTrial:
    """What perfect encoders, plates and mats see of a motion; torques of all joints, the exoskeleton's too."""
    from casadi import Function

    seen = seen_in(model.standing, motion, p, time, name)
    sought, e = motion.control(time)[:, model.standing.count :], model.standing.equations
    part = (time - motion.breaks[0]) / np.ptp(motion.breaks)
    helped = Function("help", [e.w, e.p], [model.help]).map(len(time))
    knee = helped(np.column_stack([part, sought]).T, np.tile(p[:, None], (1, len(time)))).full()[0]
    torque = np.column_stack([sought[:, :3], np.zeros(len(time)), knee, sought[:, 3]])
    return replace(seen, torque=torque)


PLACE, TURN, LEAN = 0.01, float(np.radians(2.0)), float(np.radians(5.0))
LITTLE_JERK, LITTLE_TORQUE = 1e-5, 1e-6
N = len(COORDINATES)


@dataclass(frozen=True)
class HabitSizes:
    """What the terms of the movement's cost are measured by.

    Parameters
    ----------
    place, turn, lean
        Deviations that count as 1 [m, rad].
    jerk, torque
        Weights of their squares.
    degree
        Of the polynomials through the coordinates that are kept to.
    """

    place: float = PLACE
    turn: float = TURN
    lean: float = LEAN
    jerk: float = LITTLE_JERK
    torque: float = LITTLE_TORQUE
    degree: int = 7


def habit(
    model: AssistedModel,
    subject: Subject,
    trials: Sequence[StandingTrial],
    p: Float[np.ndarray, " p"],
    sizes: HabitSizes = HabitSizes(),
) -> ControlProblem:
    """The problem whose solution is the movement with all parameters given; `p` is what is searched of them."""
    from casadi import SX, sum1, sumsqr

    e, n = model.standing.equations, model.standing.count
    wanted, jerk = SX.sym("wanted", N), SX.sym("jerk", n)
    off = residual(e.q[:N, :], wanted, np.array([sizes.place, sizes.place, *[sizes.turn] * (N - 2)]))
    leans = (sum1(e.q[N:, :]) - sum1(e.q[3:N, :])) / sizes.lean
    torque = e.w[1:, :]
    cost = sumsqr(off) + leans**2 + sizes.jerk * sumsqr(jerk) + sizes.torque * sumsqr(torque)
    system = jerk_controlled(
        e,
        controlled=model.controlled,
        control_names=TORQUES,
        data=wanted,
        jerk=jerk,
        cost=cost,
        parameter_names=[each.name for each in model.standing.parameters],
    )
    made = tuple(_trial(model, trial, p, sizes.degree) for trial in trials)
    scales = problem_scales(subject, n)
    return ControlProblem(system, made, (p, p), p, scales[0], scales[1], scales[2][: n + len(TORQUES)])


def _trial(model: AssistedModel, trial: StandingTrial, p: Float[np.ndarray, " p"], degree: int) -> ControlledTrial:
    """From the trial's own start on."""
    course, seconds = smooth_coordinates(trial, degree), float(np.ptp(trial.time))

    def given(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t w"]:
        return np.column_stack([time / seconds, course(time)[:, :N]])

    return standing_trial(trial.name, seconds, model.standing, p, course, given, DRIVEN)
