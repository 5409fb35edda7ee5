"""What a real effect may do otherwise than its candidate: its contribution, bent by smooth functions of the movement.

No real effect has exactly the form of a candidate. What a candidate adds to the prediction, as far as the base
parameters cannot make up for it, is multiplied by monomials of inputs, rates and time, channel by channel, and weights
of these are integrated out (a discrepancy as of Kennedy & O'Hagan, 2001, J. R. Stat. Soc. B 63:425, but proportional to
the effect). All weights together are worth a set share of the effect's own energy, so a wrong effect is not bent into a
right one for nothing.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.chain.candidate import Candidate
from geocontact.chain.differentiated_inputs import recorded
from geocontact.chain.system import System
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import Refit
from geocontact.gap.case.usual_range import usual_range
from geocontact.identify.optimise.tolerances import CLOSE

BENT = 0.15  # root mean square of the bending, as a share of the effect's
POWERS = ((1, 0), (2, 0), (0, 1), (0, 2), (1, 1))  # of an input's position and of its rate
TIMES = (1, 2, 3, 4, 5)  # of time within a trial: two turns of a slow drift


def discrepancy_basis(
    problem: Problem, candidates: tuple[Candidate, ...], model: Refit
) -> list[Float[np.ndarray, "_ c m"]]:
    """Discrepancy basis of each effect of a model in all trials, calibration first; weights have the standard deviation
    1.
    """
    everything = [*problem.calibration.trials, *problem.evaluation.trials]
    floor, base = problem.floor, problem.fitted
    slopes = [j[..., :base] / floor[:, None] for j in model.jacobian]
    jacobian = np.concatenate([each.reshape(len(each) * len(floor), base) for each in slopes])
    monomials = _monomials(problem)
    made: list[list[np.ndarray]] = [[] for _ in everything]
    system = problem.system
    for one in candidates:
        after = one.apply(system)
        if one.somewhere is None:
            for parts, columns in zip(
                made, _of_one_effect(problem, model, system, after, jacobian, monomials), strict=True
            ):
                parts.append(columns)
        system = after
    channels = len(floor)
    return [
        np.concatenate(parts, axis=-1) if parts else np.zeros((len(t), channels, 0))
        for parts, t in zip(made, everything, strict=True)
    ]


def _of_one_effect(
    problem: Problem,
    model: Refit,
    before: System,
    after: System,
    jacobian: Float[np.ndarray, "n q"],
    monomials: list[Float[np.ndarray, "_ m"]],
) -> list[Float[np.ndarray, "_ c k"]]:
    added = []
    for measured in (problem.calibration, problem.evaluation):
        pairs = zip(measured.residuals(before, model.values), measured.residuals(after, model.values), strict=True)
        added += [(a - b) / problem.floor for a, b in pairs]
    whole = np.concatenate([each.ravel() for each in added])
    whole = whole - jacobian @ np.linalg.lstsq(jacobian, whole, rcond=None)[0]
    channels = len(problem.floor)
    net = whole.reshape(-1, channels)
    every = np.concatenate(monomials)
    columns = np.zeros((len(net), channels, channels, every.shape[1]))
    for c in range(channels):
        columns[:, c, c] = net[:, c, None] * every
    flat = columns.reshape(net.size, -1)
    left, singular, _ = np.linalg.svd(flat, full_matrices=False)
    kept = left[:, singular > CLOSE * max(singular[0], 1e-300)]
    size = BENT * float(np.linalg.norm(whole)) / np.sqrt(max(kept.shape[1], 1))
    out = (kept * size).reshape(len(net), channels, -1) * problem.floor[:, None]
    return np.split(out, np.cumsum([len(b) for b in monomials])[:-1])


def _monomials(problem: Problem) -> list[Float[np.ndarray, "_ m"]]:
    """Of every input's position and rate, each over its range, and of time within the trial."""
    trials = [*problem.calibration.trials, *problem.evaluation.trials]
    movements = [recorded(t.signals, problem.system.inputs, problem.system.motion.reach) for t in trials]
    columns = [[np.ones(len(t))] for t in trials]
    for row in range(len(problem.system.inputs)):
        p = _within([m.position[row] for m in movements])
        v = _within([m.rate[row] for m in movements])
        for made, a, b in zip(columns, p, v, strict=True):
            made += [a**i * b**j for i, j in POWERS]
    for made, t in zip(columns, trials, strict=True):
        phase = 2.0 * (t.time - t.time[0]) / (t.time[-1] - t.time[0]) - 1.0
        made += [phase**k for k in TIMES]
    return [np.stack(made, axis=1) for made in columns]


def _within(values: list[Float[np.ndarray, " _"]]) -> list[Float[np.ndarray, " _"]]:
    """-1 … 1 over the range that 98 % of the samples are in."""
    low, high = usual_range(np.concatenate(values))
    return [np.clip(2.0 * (v - low) / max(high - low, 1e-300) - 1.0, -1.0, 1.0) for v in values]
