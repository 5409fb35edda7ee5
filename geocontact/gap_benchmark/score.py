"""What diagnoses of labelled cases score: every figure that the issue asks for, with exact intervals.

Labels and diagnoses are plain dictionaries by case. An effect is *visible* from 10 nats on; a pair when both are.

*False alarm*: no effect, and any verdict but "no_gap"; *certain* from a probability of 0.9 on, of what is named or of
any answer but "none". *Harm*: a named effect makes held-out predictions worse, see `harm`; over answers that name one.
*First*: the first of `ambiguity`, else of `effects`; *set*: both together, when they are three at most; *named*:
verdict "explained", and exactly the effect that is there. *Anew*: of effects that are visible even if all is placed
anew in every trial as is usual (`nats_anew`).
*Confidently wrong*: a named effect that is not there, `probabilities` of the named sum to one half
or more, and the hedge is missing: `ambiguity` (three at most) does not hold the whole truth. One of two true effects
named alone is incomplete, not wrong; a phantom beside a true one is wrong unless `ambiguity` hedges. An effect outside
the table that a candidate reproduces (`imitated`) is not separable from it, and naming one is not counted. Over all
cases. *Unknown called*: outside the table, visible, not reproduced, verdict "unknown". *Absorbed recognised*: verdict
"no_gap" and the effect listed in `absorbed`. *Error of reduction*: |stated - true| per channel over all cases that have
a true one (0 where nothing is missing or base parameters reproduce it); `coverage` of `ci95`: over channels of cases
with an effect of the table, if explained. *Brier*: sum over answers of (stated - true)^2, 0..2, mean over cases; the
reliability table pools every stated probability of 1 % or more and holds it against how much of the truth it got.

From what diagnosis.json says itself. A channel is *significantly worse* where its held-out error grows by more than
half the width of the interval that is stated for its reduction, and by more than `LEAST`; an answer is *worse in the
sum* where the squared held-out errors of all channels, in units of their true floors, sum to more than before.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import beta

from geocontact.gap_benchmark.answers import NONE, Plain, constant_answer, oracle_answer, true_distribution


@dataclass(frozen=True)
class Rate:
    """So many of so many; NaN where there are none."""

    hits: int
    count: int

    @classmethod
    def of(cls, answers: Iterable[bool]) -> Rate:
        """How many are true."""
        found = [bool(one) for one in answers]
        return cls(sum(found), len(found))

    @property
    def value(self) -> float:
        """Share in 0..1."""
        return self.hits / self.count if self.count else float("nan")

    def interval(self, level: float = 0.95) -> tuple[float, float]:
        """Exact interval of Clopper and Pearson (1934) Biometrika 26:404; conservative. (0, 1) where there are none."""
        if not self.count:
            return 0.0, 1.0
        tail = 0.5 * (1.0 - level)
        low = float(beta.ppf(tail, self.hits, self.count - self.hits + 1)) if self.hits else 0.0
        high = float(beta.isf(tail, self.hits + 1, self.count - self.hits)) if self.hits < self.count else 1.0
        return low, high

    def __str__(self) -> str:
        low, high = self.interval()
        return f"{self.hits}/{self.count} = {self.value:.1%} [{low:.1%}, {high:.1%}]" if self.count else "no case"


LEAST = 0.01
"""Growth of an error below which nobody cares."""
SURE = 0.9
"""Probability from which on a false claim is a certain one."""


def worse_channels(label: Plain, diagnosis: Plain) -> list[str]:
    """Channels that a named effect makes significantly worse; none where nothing is named."""
    found = []
    for channel, _, ratio in _named(label, diagnosis):
        low, high = diagnosis["gap"][channel].get("ci95") or (0.0, 0.0)
        if ratio - 1.0 > max(0.5 * (high - low), LEAST):
            found.append(channel)
    return found


def worse_in_sum(label: Plain, diagnosis: Plain) -> bool:
    """Whether a named effect makes the sum over channels worse."""
    squares = [(before / label["floor"][channel]) ** 2 for channel, before, _ in _named(label, diagnosis)]
    ratios = [ratio for *_, ratio in _named(label, diagnosis)]
    return bool(sum(s * r * r for s, r in zip(squares, ratios, strict=True)) > sum(squares))


def harmful(label: Plain, diagnosis: Plain) -> bool:
    """Either of them."""
    return bool(worse_channels(label, diagnosis)) or worse_in_sum(label, diagnosis)


def certainty(diagnosis: Plain) -> float:
    """Largest probability of anything but "none": of a single answer, or of what is named together."""
    stated = diagnosis["probabilities"]
    together = sum((float(stated.get(name, 0.0)) for name in diagnosis["effects"]), 0.0)
    return max([together, *(float(p) for name, p in stated.items() if name != NONE)])


def _named(label: Plain, diagnosis: Plain) -> Iterator[tuple[str, float, float]]:
    """Channel, error before, and after over before, where an effect is named; the true error where none is stated."""
    if not diagnosis["effects"]:
        return
    for channel, gap in diagnosis["gap"].items():
        before, after = gap.get("rmse_before"), gap.get("rmse_after")
        if before and after is not None:
            yield channel, float(before), float(after) / float(before)
        elif label["rmse_before"].get(channel):
            yield channel, float(label["rmse_before"][channel]), 1.0 - float(gap["reduction"])


VISIBLE = 10.0
"""Nats."""
CONFIDENT = 0.5
SMALL = 3
"""Largest set that counts as an answer."""
GAPS = ("single", "shift", "fault")
"""Kinds with one effect of the table."""
BINS = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0)
LISTED = 0.01


@dataclass(frozen=True)
class Bin:
    """Stated probabilities within a range: how many, their mean, and the share of them that came true."""

    low: float
    high: float
    count: int
    stated: float
    came_true: float


@dataclass(frozen=True)
class Score:
    """Figures of a set of cases; see the module for what each counts."""

    false_alarms: Rate
    sure_alarms: Rate
    harm: Rate
    harm_in_sum: Rate
    harm_in_channel: Rate
    first_right: Rate
    first_right_anew: Rate
    in_small_set: Rate
    named_right: Rate
    named_right_anew: Rate
    missed: Rate
    confidently_wrong: Rate
    both_found: Rate
    one_of_two: Rate
    unknown_called: Rate
    absorbed_recognised: Rate
    reduction_error: float
    reduction_error_median: float
    coverage: Rate
    brier: float
    brier_constant: float
    brier_oracle: float
    reliability: tuple[Bin, ...]
    calibration_error: float
    seconds: float
    seconds_most: float


def visible(label: Plain) -> bool:
    """Whether every effect of a case shows."""
    return bool(label["nats"]) and min(label["nats"].values()) >= VISIBLE


def answers(diagnosis: Plain) -> list[str]:
    """What is still alive, first the first-ranked."""
    return list(dict.fromkeys([*diagnosis.get("ambiguity", []), *diagnosis.get("effects", [])]))


def small_set(diagnosis: Plain) -> set[str]:
    """The answers, if they are few enough to count as one."""
    alive = answers(diagnosis)
    return set(alive) if len(alive) <= SMALL else set()


def confidently_wrong(label: Plain, diagnosis: Plain) -> bool:
    """A false claim without a hedge; see the module."""
    named = set(diagnosis["effects"])
    truth = set() if label["kind"] == "outside" else set(label["effects"])
    if named <= truth:
        return False
    if label["kind"] == "outside" and label.get("imitated"):
        return False
    if truth and truth <= small_set(diagnosis):
        return False
    return sum(float(diagnosis["probabilities"].get(name, 0.0)) for name in named) >= CONFIDENT


def brier(label: Plain, diagnosis: Plain) -> float:
    """Sum of squared differences between stated and true distribution, 0..2."""
    truth, stated = true_distribution(label), diagnosis["probabilities"]
    return float(sum((stated.get(one, 0.0) - truth.get(one, 0.0)) ** 2 for one in dict.fromkeys((*truth, *stated))))


def reduction_errors(label: Plain, diagnosis: Plain) -> Iterator[tuple[float, bool | None]]:
    """Per channel with a true reduction: the error, and whether the interval holds it (None where none is stated)."""
    for channel, true in label["reduction"].items():
        stated = diagnosis["gap"].get(channel)
        if true is None or stated is None:
            continue
        interval = stated.get("ci95")
        inside = None if interval is None else bool(interval[0] <= true <= interval[1])
        yield abs(float(stated["reduction"]) - true), inside


def reliability(pairs: Sequence[tuple[Plain, Plain]]) -> tuple[tuple[Bin, ...], float]:
    """Bins of stated probability, and the mean distance between stated and come true, weighted by count."""
    stated, true = [], []
    for label, diagnosis in pairs:
        truth = true_distribution(label)
        for name, p in diagnosis["probabilities"].items():
            if p >= LISTED:
                stated.append(float(p))
                true.append(truth.get(name, 0.0))
    p, t = np.array(stated), np.array(true)
    place = np.clip(np.searchsorted(BINS, p, side="right") - 1, 0, len(BINS) - 2)
    bins = []
    for i in range(len(BINS) - 1):
        inside = place == i
        if inside.any():
            bins.append(Bin(BINS[i], BINS[i + 1], int(inside.sum()), float(p[inside].mean()), float(t[inside].mean())))
    distance = sum(one.count * abs(one.stated - one.came_true) for one in bins) / max(len(p), 1)
    return tuple(bins), float(distance)


def score(labels: Mapping[str, Plain], diagnoses: Mapping[str, Plain]) -> Score:
    """Figures over the cases of `labels`; KeyError where a case was not diagnosed."""
    missing = [name for name in labels if name not in diagnoses]
    if missing:
        raise KeyError(f"no diagnosis of {', '.join(sorted(missing)[:5])}")
    pairs = [(label, diagnoses[name]) for name, label in labels.items()]

    def of(*kinds: str, shown: bool = False) -> list[tuple[Plain, Plain]]:
        return [(a, b) for a, b in pairs if a["kind"] in kinds and (visible(a) or not shown)]

    one = of(*GAPS, shown=True)
    anew = [(a, b) for a, b in one if (a.get("nats_anew") or 0.0) >= VISIBLE]
    two = of("pair", shown=True)
    strange = [(a, b) for a, b in of("outside", shown=True) if not a.get("imitated")]
    named = [(a, b) for a, b in pairs if b["effects"]]
    errors = [found for a, b in pairs for found in reduction_errors(a, b)]
    held = [
        inside
        for a, b in of(*GAPS, "pair")
        if b["effects"]
        for _, inside in reduction_errors(a, b)
        if inside is not None
    ]
    constant = constant_answer(labels.values())
    bins, distance = reliability(pairs)
    seconds = [float(b.get("seconds", np.nan)) for _, b in pairs]
    sizes = [error for error, _ in errors]
    return Score(
        false_alarms=Rate.of(b["verdict"] != "no_gap" for _, b in of("none")),
        sure_alarms=Rate.of(b["verdict"] != "no_gap" and certainty(b) >= SURE for _, b in of("none")),
        harm=Rate.of(harmful(a, b) for a, b in named),
        harm_in_sum=Rate.of(worse_in_sum(a, b) for a, b in named),
        harm_in_channel=Rate.of(bool(worse_channels(a, b)) for a, b in named),
        first_right=Rate.of(answers(b)[:1] == list(a["effects"]) for a, b in one),
        first_right_anew=Rate.of(answers(b)[:1] == list(a["effects"]) for a, b in anew),
        in_small_set=Rate.of(set(a["effects"]) <= small_set(b) for a, b in one),
        named_right=Rate.of(list(b["effects"]) == list(a["effects"]) for a, b in one),
        named_right_anew=Rate.of(list(b["effects"]) == list(a["effects"]) for a, b in anew),
        missed=Rate.of(b["verdict"] == "no_gap" for _, b in one),
        confidently_wrong=Rate.of(confidently_wrong(a, b) for a, b in pairs),
        both_found=Rate.of(set(a["effects"]) == set(b["effects"]) for a, b in two),
        one_of_two=Rate.of(bool(set(a["effects"]) & set(answers(b))) for a, b in two),
        unknown_called=Rate.of(b["verdict"] in ("unknown", "partly_explained") for _, b in strange),
        absorbed_recognised=Rate.of(
            b["verdict"] == "no_gap" and set(a["effects"]) <= set(b.get("absorbed", [])) for a, b in of("absorbed")
        ),
        reduction_error=mean(sizes),
        reduction_error_median=float(np.median(sizes)) if sizes else float("nan"),
        coverage=Rate.of(held),
        brier=mean([brier(a, b) for a, b in pairs]),
        brier_constant=mean([brier(a, constant) for a, _ in pairs]),
        brier_oracle=mean([brier(a, oracle_answer(a)) for a, _ in pairs]),
        reliability=bins,
        calibration_error=distance,
        seconds=mean(seconds),
        seconds_most=float(np.max(seconds)) if seconds else float("nan"),
    )


def mean(values: Sequence[float]) -> float:
    """Mean, NaN of nothing."""
    return float(np.mean(values)) if values else float("nan")


def figures(result: Score) -> dict[str, Any]:
    """The figures as JSON takes them: rates as [hits, count, low, high]."""
    plain: dict[str, Any] = {}
    for name, value in vars(result).items():
        if isinstance(value, Rate):
            plain[name] = {"hits": value.hits, "count": value.count, "ci95": list(value.interval())}
        elif isinstance(value, tuple):
            plain[name] = [vars(one) for one in value]
        else:
            plain[name] = value
    return plain
