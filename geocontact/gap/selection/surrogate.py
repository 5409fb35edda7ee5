"""A flexible surrogate for whatever a model misses: bumps over position, rate, both, and time, changing parameters.

A discrepancy as of Kennedy & O'Hagan (2001, J. R. Stat. Soc. B 63:425), on a grid of radial functions of which only
those are taken, one by one, that are worth their price (matching pursuit: Mallat & Zhang, IEEE Trans. Signal Process.
41:3397, 1993), their weights integrated out. It cannot name a cause. It answers whether
there is anything systematic to explain, and how much of it a named effect leaves over.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from jaxtyping import Float, Int

from geocontact.chain.differentiated_inputs import recorded
from geocontact.gap.case.noise_sources import usual_range
from geocontact.gap.case.problem import Problem, filled
from geocontact.gap.case.whitening import Whitening
from geocontact.gap.selection.evidence import Judged, log_evidence, prior_spread
from geocontact.gap.selection.evidence import judged as judged_as
from geocontact.identify.noise.covariance import Whitener
from geocontact.identify.optimise.bounded_gauss_newton import CLOSE

ALONG = (12, 30)  # bumps over one input's position or rate, wide ones and narrow ones
ACROSS = (6,)  # bumps per side over position and rate together
THROUGH = (6, 16, 40)  # bumps over a trial
ALONE = (5, 12)  # bumps over a trial that are a trial's own
STRETCHES = 8  # of a trial, that parameters may differ between
RENEWED = 2  # times that the noise is estimated anew with the surrogate in place
DEEPEST = 24  # bumps that are taken at most
Samples = Sequence[Int[np.ndarray, " k"]]
"""Which samples of each trial, in increasing order."""
Features = Callable[[Samples], list[Float[np.ndarray, "_ c m"]]]
"""Features at some samples of each trial; those of one family at a time, since they are thousands of columns."""
SIZES = (0.3, 1.0, 3.0, 10.0, 30.0)  # standard deviation of the weights, in noise levels of the channel


@dataclass(frozen=True)
class Surrogate:
    """What the best family adds to a model.

    Parameters
    ----------
    family
        "position of beta".
    gain
        Of evidence over all trials [nats].
    calibration
        The same on the calibration trials alone.
    price
        Of choosing family, bumps and sizes [nats].
    predicted
        What it predicts of the residual of every trial, in the channels' units; 0 in samples without an output.
    by_calibration
        The same with weights from the calibration trials alone.
    """

    family: str
    gain: float
    calibration: float
    price: float
    predicted: tuple[Float[np.ndarray, "_ c"], ...]
    by_calibration: tuple[Float[np.ndarray, "_ c"], ...]

    @property
    def nats(self) -> float:
        """Gain once the choice is paid for."""
        return self.gain - self.price


def surrogate(problem: Problem, judged: Judged) -> Surrogate:
    """The family that gains most on top of a model, under the noise that suits model and surrogate together.

    Noise that was fitted to what a model misses explains it away. So the surrogate is chosen under the model's own
    noise and under lower noise, and noise levels are estimated anew from what the latter's choice leaves over.
    """
    spread = prior_spread(judged.model.system, judged.model.values)
    made = [*families(problem), *lonely(problem, judged)]
    price = float(np.log(len(made) * (2 + RENEWED)))

    def under(one: Judged) -> Surrogate:
        whitenings = problem.whitenings_of_samples(one.noise, one.model)
        unbent = _without(one.whitened_basis)
        known, residual = unbent(one.model.whitened_jacobian * spread), unbent(one.model.whitened[:, None])[:, 0]
        nothing = tuple(np.zeros_like(each) for each in one.model.residuals)
        best = Surrogate("", 0.0, 0.0, 0.0, nothing, nothing)
        for name, features in made:
            parts = features(problem.samples)
            white = unbent(np.concatenate([_whitened(w, part) for w, part in zip(whitenings, parts, strict=True)]))
            found = chosen(residual, white, known, one.fitted_rows, price)
            if found.gain - found.price > best.nats:
                predicted, by_calibration = (
                    tuple(
                        filled(part[..., found.columns] @ told.weights, rows, len(jacobian))
                        + jacobian @ (spread * told.shift)
                        for part, rows, jacobian in zip(parts, problem.samples, one.model.jacobian, strict=True)
                    )
                    for told in (found.by_all, found.by_calibration)
                )
                best = Surrogate(name, found.gain, found.calibration, found.price, predicted, by_calibration)
        return best

    low_noise = judged_as(problem, judged.model, problem.with_lower_noise(judged.noise), judged.discrepancy_basis)
    found = [(judged, under(judged)), (low_noise, under(low_noise))]
    for _ in range(RENEWED):
        if not found[-1][1].family:
            break
        left = [a - b for a, b in zip(judged.model.residuals, found[-1][1].predicted, strict=True)]
        noise = problem.weighed(replace(judged.model, residuals=left), low_noise.noise, [found[-1][0].noise])
        other = judged_as(problem, judged.model, noise, judged.discrepancy_basis)
        found.append((other, under(other)))
    bare = max((one for one, _ in found), key=lambda one: one.nats)  # better noise alone is no gain of the surrogate
    gained = [
        replace(
            best,
            gain=best.gain + one.nats - bare.nats,
            calibration=best.calibration + one.calibration - bare.calibration,
        )
        for one, best in found
    ]
    return max(gained, key=lambda each: each.nats)


def _whitened(whitening: Whitening, features: Float[np.ndarray, "t c m"]) -> Float[np.ndarray, "n m"]:
    """Whitened features of a trial; those of other trials are nothing in it, many of a channel nothing in others."""
    felt, whitener = np.asarray(features.any(axis=0)), whitening.whitener
    out = np.zeros((len(whitening.directions), features.shape[-1]))
    if isinstance(whitener, Whitener) and (felt.sum(axis=0) <= 1).all():
        for c, own in enumerate(felt):
            out[:, own] = whitener.of_channel(features[:, c, own], c, len(felt))
        return whitening.without_variation(out)
    any_channel = felt.any(axis=0)
    out[:, any_channel] = whitening(features[..., any_channel])
    return out


def _without(
    discrepancy_basis: Float[np.ndarray, "n m"],
) -> Callable[[Float[np.ndarray, "n k"]], Float[np.ndarray, "n k"]]:
    """v → (I + B Bᵀ)^(-1/2) v: what the discrepancy of an effect may explain weighs less."""
    if not discrepancy_basis.shape[1]:
        return lambda values: values
    left, singular, _ = np.linalg.svd(discrepancy_basis, full_matrices=False)
    gains = 1.0 - 1.0 / np.sqrt(1.0 + singular**2)
    return lambda values: values - left @ (gains[:, None] * (left.T @ values))


@dataclass(frozen=True)
class FittedWeights:
    """Weights of chosen columns as some trials tell them.

    `shift` is how the fitted parameters move to make room, in units of their prior spread.
    """

    weights: Float[np.ndarray, " k"]
    shift: Float[np.ndarray, " p"]


@dataclass(frozen=True)
class Choice:
    """Columns of a family that are worth their price, their weights by all trials or few, and what they gain."""

    columns: list[int]
    by_all: FittedWeights
    by_calibration: FittedWeights
    gain: float
    calibration: float
    price: float


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
    none = FittedWeights(np.zeros(0), np.zeros(known.shape[1]))
    nothing = Choice([], none, none, 0.0, 0.0, price)
    if not columns.shape[1]:
        return nothing
    basis, _ = np.linalg.qr(np.concatenate([known, CLOSE * np.eye(known.shape[1])]))
    basis = basis[: len(known)]
    left, free = residual - basis @ (basis.T @ residual), columns - basis @ (basis.T @ columns)
    each = float(np.log(columns.shape[1] * len(SIZES)))
    taken: list[int] = []
    directions, spread = np.zeros((0, len(left))), np.zeros(0)
    squares = np.array(SIZES)[:, None] ** 2
    power, along = (free**2).sum(axis=0), free.T @ left
    while len(taken) < DEEPEST:
        gains = 0.5 * along**2 / (power + 1.0 / squares) - 0.5 * np.log1p(squares * power)
        size, column = np.unravel_index(int(np.argmax(gains)), gains.shape)
        if gains[size, column] < each:
            break
        taken.append(int(column))
        spread = np.append(spread, SIZES[size])
        direction = free[:, column] - directions.T @ (directions @ free[:, column])
        direction /= np.linalg.norm(direction)
        directions = np.vstack([directions, direction])
        shared = free.T @ direction
        power, along = np.maximum(power - shared**2, 0.0), along - shared * (direction @ left)
    if not taken:
        return nothing
    design = free[:, taken]
    gain = log_evidence(left, design, spread) + 0.5 * float(left @ left)
    part = log_evidence(left[:rows], design[:rows], spread) + 0.5 * float(left[:rows] @ left[:rows])

    def told(by: slice) -> FittedWeights:
        weights = _posterior(left[by], design[by], spread)
        ridge = CLOSE * np.eye(known.shape[1])
        apart = np.concatenate([residual[by] - columns[by][:, taken] @ weights, np.zeros(known.shape[1])])
        return FittedWeights(weights, np.linalg.lstsq(np.concatenate([known[by], ridge]), apart, rcond=None)[0])

    return Choice(taken, told(slice(None)), told(slice(rows)), gain, part, price + each * len(taken))


def families(problem: Problem) -> Iterator[tuple[str, Features]]:
    """Name and features of every family: one array per trial, calibration first, channels with weights of their own."""
    trials = problem.calibration.trials + problem.evaluation.trials
    system, scale = problem.system, problem.floor_of_noise
    movements = [recorded(trial.signals, system.inputs, system.motion.reach) for trial in trials]
    for row, name in enumerate(system.inputs):
        position, rate = [m.position[row] for m in movements], [m.rate[row] for m in movements]
        yield f"position of {name}", partial(_bumps, position, ALONG, scale)
        yield f"rate of {name}", partial(_bumps, rate, ALONG, scale)
        yield f"position and rate of {name}", partial(_crossed, position, rate, scale)
    yield "time within the trial", partial(_bumps, phases(problem), THROUGH, scale)


def lonely(problem: Problem, judged: Judged) -> Iterator[tuple[str, Features]]:
    """Families whose weights are a trial's own: a disturbance in it, parameters that change during it."""
    phase, scale = phases(problem), problem.floor_of_noise
    count, edges = problem.fitted, np.arange(1, STRETCHES) / STRETCHES

    def changing(samples: Samples) -> list[Float[np.ndarray, "_ c m"]]:
        every = zip(judged.model.jacobian, phase, samples, strict=True)
        own = ((j[rows, :, :count] * problem.usual[:count], p[rows]) for j, p, rows in every)
        return [np.concatenate([j * (p > edge)[:, None, None] for edge in edges], axis=-1) for j, p in own]

    yield "stretches of single trials", lambda samples: _apart(_bumps(phase, ALONE, scale, samples))
    yield "parameters that change during a trial", lambda samples: _apart(changing(samples))
    yield "parameters that change at one moment of every trial", changing


def phases(problem: Problem) -> list[Float[np.ndarray, " _"]]:
    """Time within each trial, 0 at its beginning and 1 at its end."""
    times = [trial.time for trial in problem.calibration.trials + problem.evaluation.trials]
    return [(time - time[0]) / (time[-1] - time[0]) for time in times]


def _bumps(
    values: Sequence[Float[np.ndarray, " _"]], counts: Sequence[int], scale: Float[np.ndarray, " c"], samples: Samples
) -> list[Float[np.ndarray, "_ c m"]]:
    """Bumps over what has these values, for each channel."""
    return [_per_channel(bumps, scale) for bumps in _line(values, counts, samples)]


def _crossed(
    position: Sequence[Float[np.ndarray, " _"]],
    rate: Sequence[Float[np.ndarray, " _"]],
    scale: Float[np.ndarray, " c"],
    samples: Samples,
) -> list[Float[np.ndarray, "_ c m"]]:
    """Bumps over position and rate together, for each channel."""
    both = zip(_line(position, ACROSS, samples, 1), _line(rate, ACROSS, samples, 1), strict=True)
    return [_per_channel((a[:, :, None] * b[:, None, :]).reshape(len(a), -1), scale) for a, b in both]


def _apart(features: list[Float[np.ndarray, "_ c m"]]) -> list[Float[np.ndarray, "_ c k"]]:
    """The same features with weights for every trial."""
    out = []
    for i, own in enumerate(features):
        wide = np.zeros((*own.shape[:2], len(features), own.shape[2]))
        wide[:, :, i] = own
        out.append(wide.reshape(*own.shape[:2], -1))
    return out


def _line(
    values: Sequence[Float[np.ndarray, " _"]], counts: Sequence[int], samples: Samples, closer: int = 2
) -> list[Float[np.ndarray, "_ m"]]:
    """Gaussian bumps, evenly spaced over the range that 98 % of the samples are in.

    As wide as their distance if there were `counts` of them; they stand `closer` times as close: none falls in between.
    """
    low, high = usual_range(np.concatenate(values))
    clipped = [np.clip(v[rows], low, high)[:, None] for v, rows in zip(values, samples, strict=True)]
    made = []
    for count in counts:
        centres = np.linspace(low, high, closer * (count - 1) + 1)
        width = max((high - low) / (count - 1), 1e-300)
        made.append([np.exp(-0.5 * ((v - centres) / width) ** 2) for v in clipped])
    return [np.concatenate(scales, axis=1) for scales in zip(*made, strict=True)]


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
