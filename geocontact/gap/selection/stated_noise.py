"""A test of fit that no evidence overrides: what a model misses, against the noise that the case states.

Noise that is fitted to residuals grows with what the model misses, and trials may be said to differ by as much. A case
that states the noise of a channel gives a second measure. In each trial the most probable deviation of the base
parameters and of the placement is taken off the residual. Of what stays the part counts that neighbours in time share,
their mean product: what a model misses is smooth, while noise that grows with the signal, or has heavy tails, is not.
It is compared with the stated noise, the noise of the inputs beside it. Up to `loudest` times that is put down to noise
(`gap.case.whitening`). A model **misfits** a channel where it misses more in the middle trial.

"No gap" then is "unknown". A named effect stays named while what it leaves beyond the noise is at most `LEFT_OVER` of
what the base model leaves there: the form of a real effect is never exactly that of a candidate.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.gap.case.problem import Problem, noise_variance
from geocontact.gap.case.whitening import SENSOR_LOUDER
from geocontact.gap.levels import LEFT_OVER
from geocontact.gap.selection.evidence import Judged
from geocontact.gap.selection.held_out_rules import TrialWeight
from geocontact.gap.selection.model_comparison import Contender
from geocontact.gap.selection.verdict import MOST, Answer
from geocontact.identify.noise.noise_levels import BEYOND


def loudest() -> float:
    """Times the stated noise of a sensor that is put down to noise at the most: 1.62."""
    return float(SENSOR_LOUDER * np.exp(BEYOND))


@dataclass(frozen=True)
class Misfit:
    """What a model misses in a channel, against the stated noise.

    Parameters
    ----------
    channel
        Name of the output.
    ratio
        Root of the mean product of neighbouring residuals in the middle trial, the trial's own deviation taken off,
        over the noise: stated, and of the inputs.
    """

    channel: str
    ratio: float

    @property
    def sure(self) -> bool:
        """Whether something is beyond what is put down to noise."""
        return self.beyond > 0.0

    @property
    def beyond(self) -> float:
        """Squared error beyond what is put down to noise, in squares of the noise."""
        return max(self.ratio**2 - loudest() ** 2, 0.0)

    @property
    def words(self) -> str:
        """Channel and size in a remark."""
        return f"{self.channel} is missed by {self.ratio:.1f} times its stated noise"


def misfits(problem: Problem, stated: Mapping[str, float], one: Judged, base: Judged) -> tuple[Misfit, ...]:
    """Misfits of each channel whose noise the case states.

    Parameters
    ----------
    problem
        The case, samples without weights of heavy tails: tails could be what a model misses.
    stated
        Standard deviation of the noise of channels, in their units.
    one
        The model that is tested.
    base
        The base model, whose derivatives and variation say what trials differ by.
    """
    low = problem.with_lower_noise(base.noise).levels
    low = replace(low, growing=np.full_like(low.growing, 1e-12))
    varied = problem.varied(base.model.jacobian)
    squares = []
    trials = zip(one.model.residuals, varied, problem.layouts, problem.recorded.present, strict=True)
    for residual, spread, layout, present in trials:
        weight = TrialWeight.of(present, problem.floor, spread * base.noise.varies)
        left = weight.cleared(residual) * problem.floor
        both = present[1:] & present[:-1]
        squares.append([_mean(left[1:] * left[:-1], both), _mean(noise_variance(layout, low), present)])
    found = []
    for c, name in enumerate(problem.system.outputs):
        if name not in stated:
            continue
        missed, noise = (np.array([each[k][c] for each in squares]) for k in (0, 1))
        ratios = np.sqrt(np.maximum(missed, 0.0) / np.maximum(noise, stated[name] ** 2))
        found.append(Misfit(name, float(np.nanmedian(ratios)) if np.isfinite(ratios).any() else 0.0))
    return tuple(found)


def _mean(values: Float[np.ndarray, "t c"], present: Bool[np.ndarray, "t c"]) -> Float[np.ndarray, " c"]:
    """Mean of the measured samples of each channel; NaN where there are none."""
    counts = present.sum(axis=0)
    return np.where(counts > 0, np.where(present, values, 0.0).sum(axis=0) / np.maximum(counts, 1), np.nan)


def with_misfit(said: Answer, before: Sequence[Misfit], after: Sequence[Misfit], base: Contender) -> Answer:
    """The answer, unknown where the model that it rests on misfits a channel whose noise is stated.

    Parameters
    ----------
    before, after
        Misfits of the base model and of the model that the answer rests on, of the same channels.
    base
        The base model.
    """
    if said.verdict not in ("no_gap", "explained") or not any(one.sure for one in after):
        return said
    left, whole = (sum(one.beyond for one in each) for each in (after, before))
    if said.verdict == "explained" and left <= LEFT_OVER * whole:
        return said
    moved = ("none", *said.effects)
    odds = {name: 0.0 if name in moved else p for name, p in said.probabilities.items()}
    odds["unknown"] = odds.get("unknown", 0.0) + sum(said.probabilities.get(name, 0.0) for name in moved)
    odds = dict(sorted(odds.items(), key=lambda each: -each[1]))
    ambiguity = tuple(dict.fromkeys([*said.effects, *said.ambiguity]))[:MOST]
    return Answer("unknown", (), odds, ambiguity, base)
