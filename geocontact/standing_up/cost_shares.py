"""What each term of a phase contributes to the cost of a solution."""

from __future__ import annotations

import numpy as np

from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.standing_up.phase import PhaseProblem

MOST_OF_IT = 0.99
"""Share from which on one term is nearly all of the cost."""


def cost_shares(phase: PhaseProblem, found: CollocationResult) -> dict[str, float]:
    """By term, integrated as the problem integrates it; the parameters' belief is left out. They add up to 1."""
    from casadi import Function, vertcat

    s = phase.control.system
    terms = Function("terms", [s.x, s.u, s.w, s.p], [vertcat(*phase.terms.values())])
    total = np.zeros(len(phase.terms))
    for trial, motion in zip(phase.control.trials, found.motions, strict=True):
        lengths = np.diff(motion.breaks)
        points = (motion.breaks[:-1, None] + lengths[:, None] * motion.scheme.points).ravel()
        weights = (lengths[:, None] * motion.scheme.weights).ravel()
        x = motion.states[:, 1:].reshape(len(points), -1)
        u = motion.controls.reshape(len(points), -1)
        given = (x.T, u.T, trial.inputs(points).T, np.tile(found.p[:, None], (1, len(points))))
        total += terms.map(len(points))(*given).full() @ weights
    return dict(zip(phase.terms, (total / total.sum()).tolist(), strict=True))
