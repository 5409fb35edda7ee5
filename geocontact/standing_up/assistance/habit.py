"""How a person stands up with help: as in the trial, with little jerk and torque, whatever the strap does.

The person does not give way to spare the strap: what is chosen of the exoskeleton changes forces, and the movement only
as far as its own cost lets it. Sizes are those of the synthetic trials: deviations count in parts of 1 cm and 2°, the
module's lean against the trunk's in parts of 5°; invented.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.multibody import jerk_controlled
from geocontact.dynamics.collocation.problem import ControlledTrial, ControlProblem
from geocontact.dynamics.symbols import residual
from geocontact.standing_up.assistance.assisted_model import ASSISTED_PARAMETERS, DRIVEN, TORQUES, AssistedModel
from geocontact.standing_up.chain import COORDINATES, Subject
from geocontact.standing_up.phase import smooth_coordinates
from geocontact.standing_up.trials import StandingTrial, problem_scales, standing_trial

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
        parameter_names=[each.name for each in ASSISTED_PARAMETERS],
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
