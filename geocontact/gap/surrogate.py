"""A flexible stand-in for whatever a model misses: bumps over position, rate, both, and time, shared by all trials.

Each family is a linear model with independent Gaussian weights of one standard deviation: the discrepancy of Kennedy &
O'Hagan (2001, J. R. Stat. Soc. B 63:425) on a grid of radial functions. It cannot name a cause. It answers whether
there is anything systematic to explain, and how much of it a named effect leaves over.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.chain.movement import recorded
from geocontact.gap.evidence import Judged, log_evidence, prior_spread
from geocontact.gap.problem import Problem

ALONG = 12  # bumps over one input's position or rate
ACROSS = 6  # bumps per side over position and rate together
THROUGH = 16  # bumps over a trial
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
    """The family that gains most on top of a model."""
    model = judged.model
    weighings = problem.weighings(judged.noise, model)
    spread = prior_spread(model.system, model.values)
    rows = judged.fitted_rows
    r, fitted = model.whitened, model.whitened_jacobian
    plain = log_evidence(r, fitted, spread)
    plain_calibration = log_evidence(r[:rows], fitted[:rows], spread)
    best = Surrogate("", 0.0, 0.0, tuple(np.zeros_like(each) for each in model.residuals))
    choices = float(np.log(sum(1 for _ in families(problem)) * len(SIZES)))
    for name, features in families(problem):
        white = np.concatenate([w(part) for w, part in zip(weighings, features, strict=True)])
        for size in SIZES:
            both = np.concatenate([fitted, white], axis=1)
            wide = np.concatenate([spread, np.full(white.shape[1], size)])
            calibration = log_evidence(r[:rows], both[:rows], wide) - plain_calibration - choices
            gain = log_evidence(r, both, wide) - plain - choices
            if gain > best.nats:
                weights = _posterior(r, both, wide)[len(spread) :]
                best = Surrogate(name, gain, calibration, tuple(part @ weights for part in features))
    return best


def families(problem: Problem) -> Iterator[tuple[str, list[Float[np.ndarray, "_ c m"]]]]:
    """Name and features of every family, one array per trial, calibration first, each channel with weights of its own."""
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
