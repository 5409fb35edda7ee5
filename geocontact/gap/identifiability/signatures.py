"""What an effect does to the predictions of given trials, in units of what noise and trial-to-trial variation hide.

The base model stands at fitted values; an effect of an amplitude moves its prediction by s, whitened as the diagnosis
whitens residuals (sensor noise, noise of the inputs, deviations of the trials). Refitted base parameters reproduce all
of it but P⊥ s: ½|s|² nats are there, ½|P⊥ s|² are **visible**, the rest is **absorbed**.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.gap.case.problem import Noise, Problem
from geocontact.gap.case.refit import ROUNDS, Measured, Refit, at, magnitude
from geocontact.gap.case.whitening import Whitening
from geocontact.gap.levels import SLIGHT
from geocontact.identify.optimise.bounded_gauss_newton import STEP

ADDS = 1e-9  # of the largest singular value, from which a direction counts
LEAST, FAINT = 1e-6, 1e-3  # of the way to the end of its bounds, and of the nats asked for, that are looked at


@dataclass(frozen=True)
class BaseState:
    """The base model on all trials of a case, calibration trials first, and what its residuals are weighed by.

    Parameters
    ----------
    system, values
        Base model and its free parameters.
    measured
        All trials.
    whitenings
        One per trial.
    slopes
        Derivatives of the prediction with respect to the base parameters, whitened.
    fitted_rows
        How many of the whitened rows, the first, are of calibration trials.
    """

    system: System
    values: Mapping[str, float]
    measured: Measured
    whitenings: tuple[Whitening, ...]
    slopes: Float[np.ndarray, "n q"]
    fitted_rows: int

    @cached_property
    def before(self) -> list[Float[np.ndarray, "_ c"]]:
        """Residuals of the base model."""
        return self.measured.residuals(self.system, self.values)

    @cached_property
    def base(self) -> Float[np.ndarray, "n q"]:
        """Orthonormal directions that base parameters move the prediction in."""
        return orthonormal(self.slopes)

    @property
    def share(self) -> float:
        """Calibration trials' part of all rows."""
        return self.fitted_rows / len(self.slopes)

    def whitened(self, parts: Sequence[Float[np.ndarray, "_ c"]]) -> Float[np.ndarray, " n"]:
        """Whitened values of what is given for all samples of all trials."""
        return np.concatenate([w(p[..., None])[:, 0] for w, p in zip(self.whitenings, parts, strict=True)])

    def moved(self, system: System, values: Mapping[str, float]) -> Float[np.ndarray, " n"]:
        """How far another model predicts from the base, whitened."""
        after = self.measured.residuals(system, values)
        return self.whitened([a - b for a, b in zip(self.before, after, strict=True)])

    def left(self, moved: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
        """What refitted base parameters do not reproduce of it, to first order."""
        return np.asarray(moved - self.base @ (self.base.T @ moved))


def base_state_of(problem: Problem, noise: Noise, values: Mapping[str, float]) -> BaseState:
    """The base model of a problem at these values, under a noise."""
    both = (problem.calibration, problem.evaluation)
    measured = replace(
        problem.calibration,
        trials=tuple(trial for one in both for trial in one.trials),
        outputs=tuple(outputs for one in both for outputs in one.outputs),
    )
    own = {name: values[name] for name in problem.plain.values}
    model: Refit = at(problem.system, measured, None, own)
    whitenings = problem.whitenings(noise, model)
    model = model.weighed(whitenings)
    rows = sum(len(w.directions) for w in whitenings[: len(problem.calibration.trials)])
    return BaseState(problem.system, own, measured, tuple(whitenings), model.whitened_jacobian, rows)


def orthonormal(columns: Float[np.ndarray, "n p"]) -> Float[np.ndarray, "n k"]:
    """Directions that columns span, those left out that hardly add one."""
    size = np.linalg.norm(columns, axis=0)
    left, singular, _ = np.linalg.svd(columns[:, size > 0.0] / size[size > 0.0], full_matrices=False)
    return np.asarray(left[:, singular > ADDS * max(singular.max(initial=0.0), 1e-300)])


def rest_of(candidate: Candidate, near: float = np.inf) -> float:
    """Amplitude at which an effect does nothing; the nearest bound where that is infinite."""
    amplitude = candidate.parameters[0]
    still = candidate.neutral.get(amplitude.name, 0.0)
    return float(np.clip(still, amplitude.lower, min(amplitude.upper, near)))


def reach_of(candidate: Candidate, start: Mapping[str, float]) -> float:
    """How far the amplitude may go from rest, with its sign, towards where a search sets out [its unit]."""
    amplitude, rest = candidate.parameters[0], rest_of(candidate)
    far = amplitude.upper if start[amplitude.name] >= rest and amplitude.upper > rest else amplitude.lower
    return far - rest


@dataclass(frozen=True)
class Sized:
    """An effect at an amplitude.

    Parameters
    ----------
    candidate
        The effect.
    values
        Of its own parameters.
    whole, visible
        ½|s|² and ½|P⊥ s|² [nats].
    """

    candidate: Candidate
    values: Mapping[str, float]
    whole: float
    visible: float

    @property
    def amplitude(self) -> float:
        """Value of its first parameter, in that one's unit."""
        return float(self.values[self.candidate.parameters[0].name])

    @property
    def absorbed(self) -> float:
        """What refitted base parameters reproduce [nats]."""
        return self.whole - self.visible


def sized(ground: BaseState, candidate: Candidate, values: Mapping[str, float]) -> Sized:
    """An effect at given values of its parameters; where values are missing, those it starts from."""
    own = {**candidate.starts[0], **values}
    moved = ground.moved(candidate.apply(ground.system), {**ground.values, **own})
    left = ground.left(moved)
    return Sized(candidate, own, 0.5 * float(moved @ moved), 0.5 * float(left @ left))


def at_nats(ground: BaseState, candidate: Candidate, nats: float) -> Sized:
    """An effect at the amplitude at which so much of it is visible, or as near to it as its bounds let it come."""
    first, start = candidate.parameters[0].name, candidate.starts[0]
    rest, reach = rest_of(candidate), reach_of(candidate, start)

    def at_share(share: float) -> Sized:
        return sized(ground, candidate, {**start, first: rest + share * reach})

    low, high, share = LEAST, 1.0, float(np.clip((start[first] - rest) / reach, LEAST, 1.0))
    best = one = at_share(share)
    for _ in range(ROUNDS):
        if _off(one, nats) < _off(best, nats):
            best = one
        if _off(best, nats) < SLIGHT or low >= high * (1.0 - 1e-6):
            break
        low, high = (share, high) if one.visible < nats else (low, share)
        quadratic = share * float(np.sqrt(nats / max(one.visible, FAINT * nats)))
        share = quadratic if low < quadratic < high else float(np.sqrt(low * high))
        if quadratic >= high == 1.0:
            share = low = 1.0
        one = at_share(share)
    return best


def _off(one: Sized, nats: float) -> float:
    """How far the visible nats are from those asked for: a logarithm."""
    return abs(float(np.log(max(one.visible, 1e-300) / nats)))


def own_slopes(
    ground: BaseState, candidate: Candidate, values: Mapping[str, float], at_values: Float[np.ndarray, " n"]
) -> Float[np.ndarray, "n p"]:
    """Derivatives of what an effect does with respect to its own parameters, whitened.

    `at_values` is what it does at `values`, `BaseState.moved`.
    """
    system, known = candidate.apply(ground.system), {**ground.values, **values}

    def slope(p: Parameter) -> Float[np.ndarray, " n"]:
        step = STEP * magnitude(p)
        step = -step if known[p.name] + step > p.upper else step
        return np.asarray((ground.moved(system, {**known, p.name: known[p.name] + step}) - at_values) / step)

    return np.stack([slope(p) for p in candidate.parameters], axis=1)
