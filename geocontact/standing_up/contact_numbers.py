"""What trials tell of each parameter of a contact: value, interval, and whether it is known or only assumed.

Motion and parameters are sought together. Where the motion can follow the noise of the plate, the parameters go along,
and always in the same sense, however many samples there are: the mode of the joint posterior is not that of the
parameters alone (Neyman & Scott (1948), Consistent estimates based on partially consistent observations, Econometrica
16, 1-32). So the answer is taken for the truth, trials with fresh noise are made of it, and calibrated: the mean of
what comes out, less the answer, is taken off (parametric bootstrap; Efron & Tibshirani (1993), ch. 10).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float
from scipy.special import ndtri

from geocontact.dynamics.collocation.optimality import inverse_reduced_hessian
from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.identify.identifiability import Identifiability, identifiability
from geocontact.standing_up.assumed_shares import assumed_shares
from geocontact.standing_up.phase import RATE, PhaseProblem
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import ContactParameter
from geocontact.standing_up.trials import StandingNoise, StandingTrial, recorded

Build = Callable[[Sequence[StandingTrial], "Float[np.ndarray, ' p'] | None"], PhaseProblem]
Solve = Callable[[PhaseProblem, "CollocationResult | None"], CollocationResult]


@dataclass(frozen=True, eq=False)
class Resampled:
    """Answers of calibrations on trials made of one answer.

    Parameters
    ----------
    off
        What they found less what they were made with, of what is searched, a row for each.
    """

    off: Float[np.ndarray, "r p"]

    @property
    def bias(self) -> Float[np.ndarray, " p"]:
        """Their mean."""
        return np.asarray(self.off.mean(axis=0))

    @property
    def widening(self) -> float:
        """Factor of a standard deviation, because the mean of so few is not known exactly."""
        return float(np.sqrt(1.0 + 1.0 / len(self.off)))


def resampled(
    model: StandingModel,
    trials: Sequence[StandingTrial],
    noise: StandingNoise,
    found: CollocationResult,
    build: Build,
    solve: Solve,
    count: int,
    seed: int,
) -> Resampled | None:
    """`count` of them that were solved, of at most twice as many; None where there are fewer than two.

    Parameters
    ----------
    build, solve
        Make the phase's problem of trials and of where the parameters start, and solve it from a result.
    """
    rows: list[Float[np.ndarray, " p"]] = []
    for k in range(2 * count):
        again = [
            _like(recorded(model, motion, found.p, trial.rate, noise, 1000 * seed + 100 * k + j, trial.name), trial)
            for j, (trial, motion) in enumerate(zip(trials, found.motions, strict=True))
        ]
        end = solve(build(again, found.p), found)
        if end.ending.startswith("interrupted"):
            break
        if end.solved:
            rows.append(end.p - found.p)
        if len(rows) == count:
            break
    return Resampled(np.array(rows)) if len(rows) > 1 else None


def _like(again: StandingTrial, trial: StandingTrial) -> StandingTrial:
    """On the same chair, and without the straps that were not recorded."""
    again = replace(again, chair=trial.chair)
    if again.strap is None or trial.strap is None or not trial.elsewhere:
        return again
    strap = np.where(np.isnan(trial.strap), np.nan, again.strap)
    others = {name: np.where(np.isnan(trial.elsewhere[name]), np.nan, of) for name, of in again.elsewhere.items()}
    return replace(again, strap=strap, elsewhere=others)


Told = Literal["known", "prior-dominated", "held", "on its bound", "not separable", "not settled", "untested"]
WITH_INTERVAL = ("known", "prior-dominated", "untested")
"""Verdicts of numbers whose interval is that of the curvature."""
CONFRONTED = ("force", "centre", "strap")
"""Channels that a contact makes; without any of them its numbers are those that coordinates and their noise leave."""
HALF = 0.5
"""Share of the belief's standard deviation that is left of a number that the trials make known, at most."""
NEAR = 1e-3
"""Share of the room between the bounds: a parameter that near to one is on it."""


@dataclass(frozen=True)
class ContactNumber:
    """One parameter.

    Parameters
    ----------
    value, lower, upper
        In `unit`; of the interval, not a number where there is none.
    before, after
        Standard deviation of what is searched, of the prior and with the trials; `after` is infinite on a bound.
    verdict
        "known": the trials at least halve the prior's deviation. "prior-dominated": they do not. "held": it was not
        sought. "on its bound": the search wanted to go on, so that the value says where the bound is. "not separable":
        another minimum that costs little more has another value (`other_minima`). "not settled": the search was ended
        before its time. "untested": the trials at least halve the deviation, but no force of the contact was recorded,
        so that a wrong model of the coordinates' noise alone could make the number.
    assumed
        Part of `after`, in squares, that comes of what is taken as given (`assumed_shares`).
    """

    name: str
    unit: str
    value: float
    lower: float
    upper: float
    before: float
    after: float
    verdict: Told
    assumed: float = 0.0

    @property
    def by_trials(self) -> float:
        """The rest of `after`: Laplace's."""
        return float(np.sqrt(max(self.after**2 - self.assumed**2, 0.0)))


@dataclass(frozen=True, eq=False)
class ContactNumbers:
    """Values and intervals of all parameters.

    Parameters
    ----------
    numbers
        In the order of the parameters.
    correlation
        Of those that are sought and on no bound, in their order: `names`.
    told_apart
        By the trials alone, without the prior; None where fewer than two are sought.
    directions
        How often more sharply than the prior the trials alone tell the combinations that they tell best to worst: ratio
        of standard deviations; below 1 the belief is all there is.
    """

    numbers: tuple[ContactNumber, ...]
    names: tuple[str, ...]
    correlation: Float[np.ndarray, "k k"]
    told_apart: Identifiability | None
    directions: Float[np.ndarray, " k"]


def contact_numbers(
    phase: PhaseProblem,
    found: CollocationResult,
    level: float = 0.95,
    again: Resampled | None = None,
    held: Float[np.ndarray, "p p"] | None = None,
) -> ContactNumbers:
    """Values and intervals of a phase that was solved.

    Intervals are Laplace's: the curvature of the cost at its least, with the prior in it. With resampled trials
    the bias that they show is taken off, and the intervals are widened for its own error. With the covariance of what
    is `held` they have the shares of it and of the sizes of the jerk as well. A number on its bound may lie inside: it
    counts as held there, with its prior, and its neighbours have its share.

    ValueError where the curvature does not exist.
    """
    low, high = phase.control.p
    sought, on_bound = low < high, on_their_bounds(phase, found.p)
    covariance = 2.0 / RATE * inverse_reduced_hessian(phase.control, found, on_bound.tolist())
    sd = np.sqrt(np.diag(covariance))
    reach = float(ndtri(0.5 + 0.5 * level))
    best = corrected(phase, found, again)
    if again is not None:
        sd = sd * again.widening
    assumed = _assumed(phase, found, held, on_bound)
    sd = np.hypot(sd, assumed)
    numbers = []
    for k, each in enumerate(phase.parameters):
        verdict: Told = "known" if sd[k] <= HALF * each.sd else "prior-dominated"
        if verdict == "known" and not set(CONFRONTED) & set(phase.terms):
            verdict = "untested"
        verdict = "held" if not sought[k] else "on its bound" if on_bound[k] else verdict
        told = verdict in WITH_INTERVAL
        low_end, high_end = (each.value(best[k] + s * reach * sd[k]) if told else float("nan") for s in (-1.0, 1.0))
        after = {"held": 0.0, "on its bound": np.inf}.get(verdict, float(sd[k]))
        before = each.sd if sought[k] else 0.0
        value = each.value(float(best[k]))
        own = float(assumed[k]) if told else 0.0
        numbers.append(ContactNumber(each.name, each.unit, value, low_end, high_end, before, after, verdict, own))
    kept = np.flatnonzero(sought & ~on_bound)
    return _together(tuple(numbers), [phase.parameters[k] for k in kept], covariance[np.ix_(kept, kept)])


def on_their_bounds(phase: PhaseProblem, p: Float[np.ndarray, " p"]) -> Bool[np.ndarray, " p"]:
    """Which of the sought parameters are on a bound."""
    low, high = phase.control.p
    margin = NEAR * (high - low)
    return np.asarray((low < high) & ((p <= low + margin) | (p >= high - margin)))


def _assumed(
    phase: PhaseProblem,
    found: CollocationResult,
    held: Float[np.ndarray, "p p"] | None,
    on_bound: Bool[np.ndarray, " p"],
) -> Float[np.ndarray, " p"]:
    """Standard deviations that what is given makes: what is held, sizes of the jerk, numbers on their bounds."""
    given = np.zeros((len(on_bound), len(on_bound))) if held is None else held.copy()
    given[on_bound], given[:, on_bound] = 0.0, 0.0
    given[on_bound, on_bound] = [each.sd**2 for each, on in zip(phase.parameters, on_bound, strict=True) if on]
    if not given.any() and held is None:
        return np.zeros(len(on_bound))
    shares = assumed_shares(phase, found, given, on_bound.tolist())
    return shares.sd if held is not None else np.asarray(np.sqrt(np.diag(shares.held)))


def prior_covariance(parameters: Sequence[ContactParameter], names: Collection[str]) -> Float[np.ndarray, "p p"]:
    """Prior covariance of what is searched, where a phase holds its numbers at the prior: of `names`."""
    return np.diag([each.sd**2 if each.name in names else 0.0 for each in parameters])


def corrected(phase: PhaseProblem, found: CollocationResult, again: Resampled | None) -> Float[np.ndarray, " p"]:
    """What is searched less the bias that resampled trials show, within its bounds: tables and motions have these.

    What is held, or on a bound, stays.
    """
    if again is None:
        return found.p
    low, high = phase.control.p
    sought, on_bound = low < high, on_their_bounds(phase, found.p)
    return np.asarray(np.where(sought & ~on_bound, np.clip(found.p - again.bias, *phase.control.p), found.p))


def held_covariance(of: ContactNumbers, parameters: Sequence[ContactParameter]) -> Float[np.ndarray, "p p"]:
    """Covariance of what is searched, as a phase that held them afterwards has to take it: of the numbers.

    What the trials tell counts by their interval and correlation; what they do not (held there, or on a bound) by
    its prior.
    """
    sizes = [
        n.after if n.verdict in (*WITH_INTERVAL, "not separable") else of_n.sd
        for n, of_n in zip(of.numbers, parameters, strict=True)
    ]
    found = np.diag(np.array(sizes) ** 2)
    at = [[n.name for n in of.numbers].index(name) for name in of.names]
    sd = np.array([sizes[k] for k in at])
    found[np.ix_(at, at)] = of.correlation * np.outer(sd, sd)
    return found


def unsettled_numbers(phase: PhaseProblem, found: CollocationResult) -> ContactNumbers:
    """Values of a search that was ended before its time: their intervals are not known."""
    low, high = phase.control.p
    none, numbers = float("nan"), []
    for k, each in enumerate(phase.parameters):
        sought = bool(low[k] < high[k])
        value, before, after = each.value(float(found.p[k])), each.sd if sought else 0.0, np.inf if sought else 0.0
        verdict: Told = "not settled" if sought else "held"
        numbers.append(ContactNumber(each.name, each.unit, value, none, none, before, after, verdict))
    return ContactNumbers(tuple(numbers), (), np.zeros((0, 0)), None, np.zeros(0))


def _together(
    numbers: tuple[ContactNumber, ...], kept: Sequence[ContactParameter], covariance: Float[np.ndarray, "k k"]
) -> ContactNumbers:
    names = tuple(each.name for each in kept)
    sd = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(sd, sd)
    belief = np.array([each.sd for each in kept])
    # in parts of the prior, the trials' own information is the whole less 1
    scaled = np.linalg.inv(covariance / np.outer(belief, belief)) - np.eye(len(kept)) if len(kept) else covariance
    values, vectors = np.linalg.eigh(scaled)
    sharp = np.sqrt(np.maximum(values, 0.0))
    apart = identifiability(names, sharp[:, None] * vectors.T) if len(kept) > 1 else None
    return ContactNumbers(numbers, names, correlation, apart, sharp[::-1])
