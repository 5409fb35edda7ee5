"""Profiles made on all persons but one, judged on that one, with what the model does not know of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.shoulder_exoskeleton.support.arm_trial import (
    ArmTrial,
    ModelError,
    Support,
    Transfer,
    support_case,
    varied_case,
)
from geocontact.shoulder_exoskeleton.support.outcome import Factors, SupportOutcome, outcome
from geocontact.shoulder_exoskeleton.support.profile_limits import SupportCase

Maker = Callable[[Sequence[ArmTrial], Sequence[ArmTrial]], Factors]
"""Makes a profile from the others' trials for the person of the second ones, of whom only the arm's weight counts."""
Reaches = Callable[[ArmTrial, Factors], Transfer | None]
"""How the cylinder's torque reaches an arm under a profile; None: all of it, at the human elevation."""
COVERED = (0.05, 0.95)
"""Quantiles of the intervals."""


@dataclass(frozen=True)
class HeldOutSupport:
    """A profile on a person that it was not made with.

    Parameters
    ----------
    factors
        The person's own.
    outcomes
        In the person's cases by name, as the model has them.
    reduction
        In the mean over these cases.
    interval
        Of that mean under the model's errors.
    gain
        Reduction more than that of the profile it is compared with, which the others made as well, and its interval,
        draw by draw.
    pushed_up, excess
        Largest share of the time in which the arm is pushed up in a case, and largest excess [N m]; then the same with
        which 95 % of the draws get by.
    """

    factors: Factors
    outcomes: dict[str, SupportOutcome]
    reduction: float
    interval: tuple[float, float]
    gain: float
    gain_interval: tuple[float, float]
    pushed_up: tuple[float, float]
    excess: tuple[float, float]

    @property
    def gain_is_beyond_the_error(self) -> bool:
        """Whether the interval of the gain lies above 0 and the arm is pushed up in none of 95 % of the draws.

        What pushes the arm up within the model's error is no gain.
        """
        return self.gain_interval[0] > 0.0 and max(self.pushed_up) == 0.0


def held_out(
    trials: Sequence[ArmTrial],
    support: Support,
    make: Maker,
    compared: Maker,
    error: ModelError | None = None,
    draws: int = 200,
    seed: int = 0,
    reaches: Reaches = lambda trial, factors: None,
) -> dict[str, HeldOutSupport]:
    """For each person the profile that the others make, beside another that they make.

    Parameters
    ----------
    make
        A profile from the others' trials, such as `ClosedLoop.settled`.
    compared
        Makes the profile that gains are counted from, such as one factor for everything.
    draws
        Of the model's errors for each person.
    reaches
        Such as `ClosedLoop.transfer`.

    ValueError where there is one person only.
    """
    persons = list(dict.fromkeys(trial.person for trial in trials))
    if len(persons) < 2:
        raise ValueError("one person alone cannot be held out")
    made, beside = dict[str, Factors](), dict[str, Factors]()
    for person in persons:
        theirs = [trial for trial in trials if trial.person == person]
        others = [trial for trial in trials if trial.person != person]
        made[person], beside[person] = make(others, theirs), compared(others, theirs)
    return judged(trials, support, made, beside, error, draws, seed, reaches)


def judged(
    trials: Sequence[ArmTrial],
    support: Support,
    factors: Mapping[str, Factors],
    compared: Mapping[str, Factors],
    error: ModelError | None = None,
    draws: int = 200,
    seed: int = 0,
    reaches: Reaches = lambda trial, factors: None,
) -> dict[str, HeldOutSupport]:
    """For each person named in `factors` what these do to it, beside those in `compared`."""
    found = {}
    for number, person in enumerate(factors):
        theirs = [trial for trial in trials if trial.person == person]
        both = []
        for own in (factors[person], compared[person]):
            rng = np.random.default_rng([seed, number])  # the same errors for both
            ways = [reaches(trial, own) for trial in theirs]
            pairs = list(zip(theirs, ways, strict=True))
            exact = _outcomes([support_case(trial, support, transfer=way) for trial, way in pairs], own)
            varied = []
            for _ in range(draws):
                cases = [varied_case(t, support, error or ModelError(), rng, transfer=way) for t, way in pairs]
                varied.append(_outcomes(cases, own))
            both.append((exact, varied))
        (exact, with_error), (base, base_error) = both
        reductions = np.array([_mean(each) for each in with_error])
        found[person] = HeldOutSupport(
            factors=factors[person],
            outcomes={trial.name: each for trial, each in zip(theirs, exact, strict=True)},
            reduction=_mean(exact),
            interval=_interval(reductions),
            gain=_mean(exact) - _mean(base),
            gain_interval=_interval(reductions - [_mean(each) for each in base_error]),
            pushed_up=_worst("pushed_up", exact, with_error),
            excess=_worst("excess", exact, with_error),
        )
    return found


def _outcomes(cases: Sequence[SupportCase], factors: Factors) -> list[SupportOutcome]:
    return [outcome(case, factors) for case in cases]


def _mean(outcomes: Sequence[SupportOutcome]) -> float:
    return float(np.mean([each.reduction for each in outcomes]))


def _interval(values: Float[np.ndarray, " d"]) -> tuple[float, float]:
    low, high = np.quantile(values, COVERED)
    return float(low), float(high)


def _worst(
    name: str, exact: Sequence[SupportOutcome], with_error: Sequence[Sequence[SupportOutcome]]
) -> tuple[float, float]:
    largest = [max(getattr(each, name) for each in draw) for draw in with_error]
    return max(getattr(each, name) for each in exact), float(np.quantile(largest, COVERED[1]))
