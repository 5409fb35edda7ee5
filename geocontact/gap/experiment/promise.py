"""How often the proposed trials would tell explanations apart: what a next experiment promises.

Where A is true, what the trials say for A over B, in nats, is the lead d that it has on the trials that exist and the
evidence of the new ones. That is the logarithm of a ratio of likelihoods of normal numbers whose means differ: normal
itself, with mean Δ and variance 2 Δ, Δ what B leaves of A's prediction on them (Van Trees 1968, Detection, Estimation,
and Modulation Theory I, section 2.2). B is out of question once it is T nats behind, with probability
Φ((d + Δ - T) / √(2 Δ)). T is what the verdict asks (`selection.verdict`): its smallest probability, and the
tolerance of the form, which grows with what there is to explain. What is promised of all others is 1 - Σ (1 - p), the
least that their probabilities p admit, however they depend on each other (Bonferroni). Whether A is then named is
another question: an effect that is not worth a name is not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from geocontact.gap.levels import SLIGHT


@dataclass(frozen=True)
class Outlook:
    """One explanation as if it were true.

    Parameters
    ----------
    weight
        Probability of it among those in question, up to a factor.
    leads
        By how much it is ahead of each of the others on the trials that exist [nats]; negative where it is behind.
    gains
        What each of the others would leave of it on the new trials [nats].
    """

    weight: float
    leads: Sequence[float]
    gains: Sequence[float]


def margin(most: float) -> float:
    """Nats behind the best model from which an effect is out of question, where that gains `most` over the base."""
    return float(-np.log(SLIGHT)) * (1.0 + SLIGHT * max(most, 0.0))


def share_told_apart(outlooks: Sequence[Outlook], most: float) -> float:
    """Share of repetitions of the new trials, at the least, after which only the true explanation is in question.

    Parameters
    ----------
    most
        What the best model gains over the base on all trials, new ones included [nats].
    """
    total = sum(one.weight for one in outlooks)
    return sum(one.weight / total * _ahead(one, margin(most)) for one in outlooks)


def _ahead(one: Outlook, needed: float) -> float:
    """Probability that all others fall behind far enough, at the least."""
    missed = 0.0
    for lead, gain in zip(one.leads, one.gains, strict=True):
        kept = max(gain, 1e-12)
        missed += NormalDist().cdf((needed - lead - kept) / float(np.sqrt(2.0 * kept)))
    return max(1.0 - missed, 0.0)


def outlooks_of(
    names: Sequence[str],
    nats: Mapping[str, float],
    weights: Mapping[str, float],
    gains: Mapping[tuple[str, str], float],
) -> list[Outlook]:
    """Every explanation with all others.

    Parameters
    ----------
    nats
        Evidence of each on the trials that exist.
    weights
        Probability of each; equal where none has one.
    gains
        By (true, fitted instead): what is left on the new trials [nats].
    """
    known = weights if sum(weights.get(name, 0.0) for name in names) > 0.0 else dict.fromkeys(names, 1.0)
    return [
        Outlook(
            known.get(own, 0.0),
            [nats[own] - nats[other] for other in names if other != own],
            [gains[own, other] for other in names if other != own],
        )
        for own in names
    ]
