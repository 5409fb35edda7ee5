"""A flexible stand-in for whatever a model misses: bumps over position, rate, both, and time, changing parameters.

A discrepancy as of Kennedy & O'Hagan (2001, J. R. Stat. Soc. B 63:425), on a grid of radial functions of which only
those are taken, one by one, that are worth their price (matching pursuit: Mallat & Zhang, IEEE Trans. Signal Process.
41:3397, 1993), their weights integrated out. It cannot name a cause. It answers whether
there is anything systematic to explain, and how much of it a named effect leaves over.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.chain.movement import recorded
from geocontact.gap.evidence import Judged, judged_anew, log_evidence, prior_spread
from geocontact.gap.problem import Problem

ALONG = 12  # bumps over one input's position or rate
ACROSS = 6  # bumps per side over position and rate together
THROUGH = 16  # bumps over a trial
ALONE = 10  # bumps over a trial that are a trial's own
STRETCHES = 8  # of a trial, that parameters may differ between
SLOWLY = 6  # broad bumps over a trial
DEEPEST = 10  # bumps that are taken at most
RIDGE = 1e-6  # against parameters that do nothing
SIZES = (0.3, 1.0, 3.0, 10.0, 30.0)  # standard deviation of the weights, in noise levels of the channel


@dataclass(frozen=True)
class Surrogate:
    """What the best family adds to a model.

    Parameters
    ----------
    family
        "position of beta".
    nats
        Gain of evidence over all trials, the choice of family and size paid for.
    calibration
        The same on the calibration trials alone.
    predicted
        What it predicts of the residual of every trial, in the channels' units.
    """

    family: str
    nats: float
    calibration: float
    predicted: tuple[Float[np.ndarray, "_ c"], ...]


def surrogate(problem: Problem, judged: Judged) -> Surrogate:
    """The family that gains most on top of a model, under its own noise or under quieter noise.

    Noise that was fitted to what a model misses explains it away; with the stand-in in its place it may be quieter.
    """
    quiet = judged_anew(problem, judged.model, problem.quieter(judged.noise))
    spread = prior_spread(judged.model.system, judged.model.values)
    made = [*families(problem), *lonely(problem, judged)]
    best = Surrogate("", 0.0, 0.0, tuple(np.zeros_like(each) for each in judged.model.residuals))
    for one in (judged, quiet):
        weighings = problem.weighings(one.noise, one.model)
        known = one.model.whitened_jacobian * spread
        behind = one.nats - judged.nats
        behind_calibration = one.calibration - judged.calibration
        for name, features in made:
            white = np.concatenate([w(part) for w, part in zip(weighings, features, strict=True)])
            found = chosen(one.model.whitened, white, known, judged.fitted_rows, float(np.log(2 * len(made))))
            if found.nats + behind > best.nats:
                predicted = tuple(part[..., found.columns] @ found.weights for part in features)
                best = Surrogate(name, found.nats + behind, found.calibration + behind_calibration, predicted)
    return best


@dataclass(frozen=True)
class Choice:
    """Columns of a family that are worth their price, their weights, and what they gain."""

    columns: list[int]
    weights: Float[np.ndarray, " k"]
    nats: float
    calibration: float


def chosen(
    residual: Float[np.ndarray, " n"],
    columns: Float[np.ndarray, "n m"],
    known: Float[np.ndarray, "n p"],
    rows: int,
    price: float,
) -> Choice:
    """Bumps taken one by one, each the one that gains most, as long as it gains more than its choice costs.

    `known` are the derivatives of the fitted parameters times their prior spread; what they explain counts for nothing.
    `rows` is how many of the rows are of calibration trials.
    """
    basis, _ = np.linalg.qr(np.concatenate([known, RIDGE * np.eye(known.shape[1])]))
    basis = basis[: len(known)]
    left, free = residual - basis @ (basis.T @ residual), columns - basis @ (basis.T @ columns)
    each = float(np.log(columns.shape[1] * len(SIZES)))
    taken: list[int] = []
    total, design, spread = -price, np.zeros((len(left), 0)), np.zeros(0)
    before = -0.5 * float(left @ left)
    sizes = np.array(SIZES)
    rest = left
    while len(taken) < DEEPEST:
        power, along = (free**2).sum(axis=0), free.T @ rest
        gains = 0.5 * along**2 / (power + 1.0 / sizes[:, None] ** 2) - 0.5 * np.log1p(sizes[:, None] ** 2 * power)
        size, column = np.unravel_index(int(np.argmax(gains)), gains.shape)
        if gains[size, column] < each:
            break
        taken.append(int(column))
        design = np.column_stack([design, columns[:, column] - basis @ (basis.T @ columns[:, column])])
        spread = np.append(spread, sizes[size])
        total = log_evidence(left, design, spread) - before - each * len(taken) - price
        direction = free[:, column] / np.sqrt(power[column])
        rest = rest - direction * (direction @ rest)
        free = free - np.outer(direction, direction @ free)
    if not taken:
        return Choice([], np.zeros(0), 0.0, 0.0)
    part = log_evidence(left[:rows], design[:rows], spread) + 0.5 * float(left[:rows] @ left[:rows])
    return Choice(taken, _posterior(left, design, spread), total, part - each * len(taken) - price)


def families(problem: Problem) -> Iterator[tuple[str, list[Float[np.ndarray, "_ c m"]]]]:
    """Name and features of every family: one array per trial, calibration first, channels with weights of their own."""
    trials = problem.calibration.trials + problem.evaluation.trials
    system, scale = problem.system, problem.floor_of_noise
    movements = [recorded(trial.signals, system.inputs) for trial in trials]
    for row, name in enumerate(system.inputs):
        position = [m.position[row] for m in movements]
        rate = [m.rate[row] for m in movements]
        yield f"position of {name}", [_per_channel(bumps, scale) for bumps in _line(position, ALONG)]
        yield f"rate of {name}", [_per_channel(bumps, scale) for bumps in _line(rate, ALONG)]
        both = zip(_line(position, ACROSS), _line(rate, ACROSS), strict=True)
        crossed = [(a[:, :, None] * b[:, None, :]).reshape(len(a), -1) for a, b in both]
        yield f"position and rate of {name}", [_per_channel(bumps, scale) for bumps in crossed]
    phase = [(t.time - t.time[0]) / (t.time[-1] - t.time[0]) for t in trials]
    yield "time within the trial", [_per_channel(bumps, scale) for bumps in _line(phase, THROUGH)]
    yield "broad stretches of the trial", [_per_channel(bumps, scale) for bumps in _line(phase, SLOWLY)]


def lonely(problem: Problem, judged: Judged) -> Iterator[tuple[str, list[Float[np.ndarray, "_ c m"]]]]:
    """Families whose weights are a trial's own: a disturbance in it, parameters that change during it."""
    trials = problem.calibration.trials + problem.evaluation.trials
    phase = [(t.time - t.time[0]) / (t.time[-1] - t.time[0]) for t in trials]
    bumps = [_per_channel(each, problem.floor_of_noise) for each in _line(phase, ALONE)]
    yield "stretches of single trials", _apart(bumps)
    count, edges = len(problem.usual), np.arange(1, STRETCHES) / STRETCHES
    changing = [
        np.concatenate([j[..., :count] * problem.usual * (p > edge)[:, None, None] for edge in edges], axis=-1)
        for j, p in zip(judged.model.jacobian, phase, strict=True)
    ]
    yield "parameters that change during a trial", _apart(changing)
    yield "parameters that change at one moment of every trial", changing


def _apart(features: list[Float[np.ndarray, "_ c m"]]) -> list[Float[np.ndarray, "_ c k"]]:
    """The same features with weights for every trial."""
    out = []
    for i, own in enumerate(features):
        wide = np.zeros((*own.shape[:2], len(features), own.shape[2]))
        wide[:, :, i] = own
        out.append(wide.reshape(*own.shape[:2], -1))
    return out


def _line(values: list[Float[np.ndarray, " _"]], count: int) -> list[Float[np.ndarray, "_ m"]]:
    """Gaussian bumps, evenly spaced over the range that 98 % of the samples are in, as wide as their distance."""
    low, high = np.percentile(np.concatenate(values), [1.0, 99.0])
    centres = np.linspace(low, high, count)
    width = max((high - low) / (count - 1), 1e-300)
    return [np.exp(-0.5 * ((np.clip(v, low, high)[:, None] - centres) / width) ** 2) for v in values]


def _per_channel(bumps: Float[np.ndarray, "t m"], scale: Float[np.ndarray, " c"]) -> Float[np.ndarray, "t c k"]:
    """The same bumps for each channel, in its noise level."""
    channels = len(scale)
    out = np.zeros((len(bumps), channels, channels, bumps.shape[1]))
    for c in range(channels):
        out[:, c, c] = scale[c] * bumps
    return out.reshape(len(bumps), channels, -1)


def _posterior(
    residual: Float[np.ndarray, " n"], design: Float[np.ndarray, "n p"], spread: Float[np.ndarray, " p"]
) -> Float[np.ndarray, " p"]:
    scaled = design * spread
    return spread * np.linalg.solve(np.eye(len(spread)) + scaled.T @ scaled, scaled.T @ residual)
