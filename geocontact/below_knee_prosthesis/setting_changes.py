"""Change between two settings of a foot, by person: predicted beside measured, and the error of a model for changes.

What a person's stances have in common cancels in a change. So the model's error is that of predicted less measured
about each person's own mean, over the stances that are not compared: s, with as many degrees of freedom as there are
stances less persons among them. The difference of means over n and m stances then has the standard error
s (1/n + 1/m)^1/2, and the predicted change its interval by Student's t. No stance has a part in the error that it is
judged by.

The measured change has Welch's interval where both settings have two stances or more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Literal

import numpy as np
from jaxtyping import Float
from scipy.special import stdtrit

from geocontact.below_knee_prosthesis.evaluation import ANKLE, JudgedStance

Verdict = Literal["predicted", "right direction", "wrong direction", "within the model's error", "error not known"]
LEAST_FREEDOM = 2
"""Degrees of freedom below which the model's error is not known."""
OUTCOMES = {
    "largest vertical force": "-",
    "largest braking force": "-",
    "largest propulsion": "-",
    "impulse": "s",
    "mean centre of pressure": "-",
    "largest ankle moment": "N m/kg",
    "stance time": "s",
}
"""Units of what is compared: forces over body weight, centres over the foot's length."""


@dataclass(frozen=True)
class StanceOutcome:
    """One outcome of a stance, predicted and measured; `fulcrum` orders the settings [m]."""

    outcome: str
    person: str
    setting: str
    fulcrum: float
    predicted: float
    measured: float


@dataclass(frozen=True)
class SettingChange:
    """Change of an outcome from one setting to a stiffer one.

    Parameters
    ----------
    stances
        At both settings.
    predicted, lower, upper
        Change by the model and its interval by the model's error; NaN where that is not known.
    measured, measured_lower, measured_upper
        By the plates.
    verdict
        "predicted": the interval is on one side of 0 and holds the measured change. "right direction" and "wrong
        direction": it is on one side of 0 and does not. "within the model's error": it holds 0, so that the model
        predicts no change here.
    """

    outcome: str
    person: str
    settings: tuple[str, str]
    stances: tuple[int, int]
    predicted: float
    lower: float
    upper: float
    measured: float
    measured_lower: float
    measured_upper: float
    verdict: Verdict


def outcomes_of(stances: Sequence[JudgedStance]) -> list[StanceOutcome]:
    """Every outcome of every stance that nothing was fitted to; what was not simulated to its end is left out."""
    found = []
    for one in stances:
        if one.calibrated or not np.isfinite(one.errors.stance[0]):
            continue
        for name, (model, seen) in _values(one).items():
            found.append(StanceOutcome(name, one.person, one.setting, one.stance.fulcrum, model, seen))
    return found


def _values(one: JudgedStance) -> dict[str, tuple[float, float]]:
    """Predicted and measured value of each of `OUTCOMES`."""
    pairs = {name: one.errors.curves[name] for name in ("vertical", "fore_aft", "impulse", "cop_ground", ANKLE)}
    return {
        "largest vertical force": _pair(pairs["vertical"], np.nanmax),
        "largest braking force": _pair(pairs["fore_aft"], lambda values: -np.nanmin(values)),
        "largest propulsion": _pair(pairs["fore_aft"], np.nanmax),
        "impulse": _pair(pairs["impulse"], np.nanmax),
        "mean centre of pressure": _pair(_both_known(*pairs["cop_ground"]), np.mean),
        "largest ankle moment": _pair(pairs[ANKLE], np.nanmax),
        "stance time": one.errors.stance,
    }


def _both_known(
    model: Float[np.ndarray, " s"], seen: Float[np.ndarray, " s"]
) -> tuple[Float[np.ndarray, " k"], Float[np.ndarray, " k"]]:
    known = np.isfinite(model) & np.isfinite(seen)
    return model[known], seen[known]


def _pair(curves: tuple[np.ndarray, np.ndarray], of: Callable[[np.ndarray], float]) -> tuple[float, float]:
    return float(of(curves[0])), float(of(curves[1]))


def setting_changes(outcomes: Sequence[StanceOutcome], level: float = 0.95) -> list[SettingChange]:
    """By outcome, person and pair of settings, from the lower fulcrum to the higher."""
    found: list[SettingChange] = []
    for name in dict.fromkeys(one.outcome for one in outcomes):
        own = [one for one in outcomes if one.outcome == name]
        for person in dict.fromkeys(one.person for one in own):
            found += _of_person(name, person, own, level)
    return found


def _of_person(name: str, person: str, all_of: Sequence[StanceOutcome], level: float) -> Iterator[SettingChange]:
    own = [one for one in all_of if one.person == person]
    places = {one.setting: one.fulcrum for one in own}
    for pair in combinations(sorted(places, key=lambda setting: places[setting]), 2):
        sides = [[one for one in own if one.setting == setting] for setting in pair]
        rest = [one for one in all_of if one.person != person or one.setting not in pair]
        yield _change(name, person, pair, sides, model_error(rest), level)


def model_error(outcomes: Sequence[StanceOutcome]) -> tuple[float, int]:
    """Standard deviation of predicted less measured about each person's mean, and its degrees of freedom."""
    square, freedom = 0.0, 0
    for person in dict.fromkeys(one.person for one in outcomes):
        off = np.array([one.predicted - one.measured for one in outcomes if one.person == person])
        square += float(((off - off.mean()) ** 2).sum())
        freedom += len(off) - 1
    return (float(np.sqrt(square / freedom)) if freedom else float("nan")), freedom


def _change(
    name: str,
    person: str,
    pair: tuple[str, str],
    sides: Sequence[Sequence[StanceOutcome]],
    error: tuple[float, int],
    level: float,
) -> SettingChange:
    predicted, measured = (
        float(np.subtract(*(np.mean([getattr(one, kind) for one in side]) for side in reversed(sides))))
        for kind in ("predicted", "measured")
    )
    counts = (len(sides[0]), len(sides[1]))
    sd, freedom = error
    half = float("nan")
    if freedom >= LEAST_FREEDOM:
        half = float(stdtrit(freedom, 0.5 + 0.5 * level) * sd * np.sqrt(1.0 / counts[0] + 1.0 / counts[1]))
    own = _welch([np.array([one.measured for one in side]) for side in sides], level)
    ends = predicted - half, predicted + half
    verdict = _verdict(predicted, measured, half)
    return SettingChange(
        name, person, pair, counts, predicted, *ends, measured, measured - own, measured + own, verdict
    )


def _welch(sides: Sequence[Float[np.ndarray, " _"]], level: float) -> float:
    """Half the interval of a difference of means of unequal variances; NaN with a single value on a side."""
    if min(map(len, sides)) < 2:
        return float("nan")
    parts = [float(side.var(ddof=1)) / len(side) for side in sides]
    total = sum(parts)
    if not total > 0.0:
        return 0.0
    freedom = total**2 / sum(part**2 / (len(side) - 1) for part, side in zip(parts, sides, strict=True))
    return float(stdtrit(freedom, 0.5 + 0.5 * level) * np.sqrt(total))


def _verdict(predicted: float, measured: float, half: float) -> Verdict:
    if not np.isfinite(half):
        return "error not known"
    if abs(predicted) <= half:
        return "within the model's error"
    if abs(predicted - measured) <= half:
        return "predicted"
    return "right direction" if predicted * measured > 0.0 else "wrong direction"
