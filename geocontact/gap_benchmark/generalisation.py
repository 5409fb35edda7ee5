"""Figures of a diagnosis at home and abroad, and the loss between the two.

`figures_of` counts, beside what `score` does: *first, ahead* and *set, ahead*: of visible single effects whose own
candidate is clearly ahead for somebody who knows the noise (`attainable`), those ranked first, or in a set of three;
*class, elsewhere*: of the other visible ones, those where an effect of the same class is ranked first; *class, named*:
those where one effect is named that is the truth, or that the diagnosis itself says these trials cannot tell from it
(`one_law` of a diagnosis). *class, right*: of all diagnoses that state such a class, those where each class stated
holds something that was planted; in a case that lacks nothing, or lacks what has no name, none does. A class of all
effects is always right, so *class size*, the mean size of a class, stands beside. The *log score* is where the mean
logarithm of the probability of the truth (`LEAST` at least) lies between the constant answer's, 0, and certainty, 1.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from geocontact.gap_benchmark.answers import Plain, clearly_ahead, constant_answer, one_law, true_distribution
from geocontact.gap_benchmark.importance import by_importance
from geocontact.gap_benchmark.score import Rate, answers, score, small_set, visible

LEAST = 1e-3
"""Probability as which a smaller one counts in the log score."""
SCORED = (
    "false_alarms",
    "sure_alarms",
    "first_right",
    "first_right_anew",
    "in_small_set",
    "named_right",
    "missed",
    "confidently_wrong",
    "both_found",
    "unknown_called",
    "coverage",
)
"""Shares that `score` counts."""
NUMBERS = ("reduction_error", "reduction_error_median", "log_score", "class_size", "seconds_median", "seconds_most")


@dataclass(frozen=True)
class LaboratoryFigures:
    """Figures of some cases: shares and numbers by name, and how many cases there are."""

    cases: int
    shares: Mapping[str, Rate]
    numbers: Mapping[str, float]


@dataclass(frozen=True)
class Loss:
    """Home less abroad of a share, in 0..1, with a conservative 95 % interval: of two exact ones at 97.5 %."""

    points: float
    low: float
    high: float

    @classmethod
    def of(cls, home: Rate, abroad: Rate) -> Loss:
        """NaN where either has no case."""
        (a, b), (c, d) = home.interval(0.975), abroad.interval(0.975)
        return cls(home.value - abroad.value, a - d, b - c)


def figures_of(pairs: Sequence[tuple[Plain, Plain]]) -> LaboratoryFigures:
    """Figures of labels (`Label.as_dict`, with `left`) and diagnoses."""
    names = [str(place) for place in range(len(pairs))]
    every = score(
        {name: label for name, (label, _) in zip(names, pairs, strict=True)},
        {name: said for name, (_, said) in zip(names, pairs, strict=True)},
    )
    one = [(label, said) for label, said in pairs if label["kind"] == "single" and visible(label) and label.get("left")]
    ahead = [(label, said) for label, said in one if clearly_ahead(label)]
    beside = [(label, said) for label, said in one if not clearly_ahead(label)]
    shares = {name: getattr(every, name) for name in SCORED}
    shares["ahead"] = Rate(len(ahead), len(one))
    shares["first_ahead"] = Rate.of(answers(said)[:1] == list(label["effects"]) for label, said in ahead)
    shares["set_ahead"] = Rate.of(set(label["effects"]) <= small_set(said) for label, said in ahead)
    classes = [(label, stated) for label, said in pairs if (stated := stated_classes(said))]
    shares["class_named"] = Rate.of(
        len(said["effects"]) == 1 and set(label["effects"]) <= set(said["effects"]).union(*stated_classes(said))
        for label, said in beside
    )
    shares["class_right"] = Rate.of(all(one & set(label["effects"]) for one in stated) for label, stated in classes)
    shares |= by_importance(pairs)
    shares["class_elsewhere"] = Rate.of(set(answers(said)[:1]) & one_law(label) != set() for label, said in beside)
    seconds = [float(said["seconds"]) for _, said in pairs if "seconds" in said]
    numbers = {
        "reduction_error": every.reduction_error,
        "reduction_error_median": every.reduction_error_median,
        "log_score": log_score(pairs),
        "class_size": float(np.mean([len(one) for _, stated in classes for one in stated]))
        if classes
        else float("nan"),
        "seconds_median": float(np.median(seconds)) if seconds else float("nan"),
        "seconds_most": max(seconds, default=float("nan")),
    }
    return LaboratoryFigures(len(pairs), shares, numbers)


def stated_classes(said: Plain) -> list[set[str]]:
    """Classes of effects that a diagnosis says these trials cannot tell apart; none before it stated any."""
    return [set(one) for one in said.get("one_law") or ()]


def log_score(pairs: Sequence[tuple[Plain, Plain]]) -> float:
    """1 for certainty, 0 for the constant answer, below 0 for less; NaN where the constant answer is certain."""
    constant = constant_answer(label for label, _ in pairs)
    best, said, same = (
        sum(log_probability(label, given) for label, given in those)
        for those in (
            [(label, {"probabilities": true_distribution(label)}) for label, _ in pairs],
            pairs,
            [(label, constant) for label, _ in pairs],
        )
    )
    return (said - same) / (best - same) if best > same else float("nan")


def log_probability(label: Plain, said: Plain) -> float:
    """Logarithm of the probability of the truth as it is stated [nats], `LEAST` at the least; of two effects the
    mean.
    """
    stated = said["probabilities"]
    return sum(p * math.log(max(float(stated.get(name, 0.0)), LEAST)) for name, p in true_distribution(label).items())


def losses(home: LaboratoryFigures, abroad: LaboratoryFigures) -> dict[str, Loss]:
    """Losses of every share that both have; an earlier run has fewer."""
    return {name: Loss.of(rate, abroad.shares[name]) for name, rate in home.shares.items() if name in abroad.shares}
