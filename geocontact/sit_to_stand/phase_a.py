"""Phase A: parameters of the feet from passive trials, all at once.

Tracks coordinates, rates, ground reaction force and centre of pressure; little torque and jerk besides (Table I of the
study, interface forces none). Here the ground's force follows from the states; in the study it is a control that is
held to the law. Each deviation counts in parts of its noise, so that the cost is a sum of squares of the order of the
number of channels; the weights of torque and jerk are ours, the study's are not printed.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float
from numpy.polynomial import Polynomial
from scipy.interpolate import CubicSpline

from geocontact.dynamics.collocation.multibody import jerk_controlled
from geocontact.dynamics.collocation.problem import ControlProblem, Course
from geocontact.sit_to_stand.chain import JOINTS, Subject
from geocontact.sit_to_stand.feet import PARAMETERS, FeetOnGround
from geocontact.sit_to_stand.trials import N, StandingNoise, StandingTrial, problem_scales, standing_trial

LOWER, UPPER = np.array([-2.5, -0.08, 0.08]), np.array([2.5, -0.01, 0.2])
START = np.array([-0.5, -0.03, 0.11])
LITTLE_TORQUE, LITTLE_JERK = 1e-6, 1e-4


def phase_a(
    feet: FeetOnGround, subject: Subject, trials: Sequence[StandingTrial], noise: StandingNoise
) -> ControlProblem:
    """The problem whose solution has the parameters."""
    from casadi import SX, sumsqr, vertcat

    e, seen, jerk = feet.equations, SX.sym("seen", 2 * N + 3), SX.sym("jerk", N)
    sizes = np.r_[[noise.length] * 2, [noise.angle] * 4, [noise.rate] * N, [noise.force] * 2, noise.centre]
    off = (vertcat(e.q, e.u, feet.force, feet.centre) - seen) / sizes
    cost = sumsqr(off) + LITTLE_TORQUE * sumsqr(e.w) + LITTLE_JERK * sumsqr(jerk)
    system = jerk_controlled(
        e, controlled=range(3), control_names=JOINTS, data=seen, jerk=jerk, cost=cost, parameter_names=PARAMETERS
    )
    made = []
    for k, trial in enumerate(trials):
        course = CubicSpline(trial.time, np.column_stack([trial.q, trial.u, trial.force, trial.centre]))
        seconds = float(np.ptp(trial.time))
        made.append(standing_trial(f"trial {k + 1}", seconds, feet, START, _smooth(trial), course))
    return ControlProblem(system, tuple(made), (LOWER, UPPER), START, *problem_scales(subject))


def _smooth(trial: StandingTrial) -> Course:
    """Polynomials of degree 7 through the coordinates: where the search starts, accelerations must not be noise."""
    fits = [Polynomial.fit(trial.time, q, 7) for q in trial.q.T]

    def coordinates(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 6"]:
        return np.column_stack([fit(time) for fit in fits])

    return coordinates
