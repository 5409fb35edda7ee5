"""Every case of a benchmark as it was worked, counts over them, and a row for each."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from geocontact.analyses.gap.benchmark.case import Worked
from geocontact.gap_benchmark.answers import Plain
from geocontact.gap_benchmark.drawing import KINDS
from geocontact.gap_benchmark.score import (
    GAPS,
    SURE,
    Rate,
    answers,
    brier,
    certainty,
    confidently_wrong,
    harmful,
    reduction_errors,
    visible,
    worse_channels,
)
from geocontact.gap_benchmark.table import OPPONENTS

SLOW = 10.0
"""Seconds of one core that a case may take."""
ALL = "all"


@dataclass(frozen=True)
class BenchmarkOutcome:
    """Every case of a benchmark, worked."""

    seed: int
    systems: tuple[str, ...]
    cases: tuple[Worked, ...]

    @cached_property
    def labels(self) -> dict[str, dict[str, Any]]:
        """Truth by case."""
        return {one.name: one.label for one in self.cases if one.label is not None}

    @cached_property
    def given(self) -> dict[str, dict[str, Plain]]:
        """Diagnoses by answerer and case."""
        whose = ("diagnosis", *OPPONENTS)
        return {who: {one.name: one.answers[who] for one in self.cases if one.label is not None} for who in whose}

    @cached_property
    def scopes(self) -> dict[str, BenchmarkOutcome]:
        """All cases, and those of each system where there are several."""
        each = {
            s: BenchmarkOutcome(self.seed, (s,), tuple(c for c in self.cases if c.lot.system == s))
            for s in self.systems
        }
        found = {"pooled": self, **each} if len(each) > 1 else each
        return {name: one for name, one in found.items() if one.labels}

    @property
    def kinds(self) -> dict[str, int]:
        """How many cases of each kind."""
        count = Counter(one.lot.kind for one in self.cases if one.label is not None)
        return {kind: count[kind] for kind in KINDS if count[kind]}

    @property
    def cpu(self) -> list[float]:
        """Seconds of the processor, of the cases whose diagnosis came about."""
        return [one.cpu for one in self.cases if np.isfinite(one.cpu)]

    @property
    def same(self) -> Rate:
        """How many of those diagnosed twice got the same answer."""
        return Rate.of(one.same for one in self.cases if one.same is not None)

    @property
    def fast(self) -> Rate:
        """How many took no longer than `SLOW`."""
        return Rate.of(seconds <= SLOW for seconds in self.cpu)

    @property
    def imitated(self) -> Rate:
        """How many of the visible effects outside the table a candidate imitates."""
        strange = [label for label in self.labels.values() if label["kind"] == "outside" and visible(label)]
        return Rate.of(bool(label.get("imitated")) for label in strange)


@dataclass(frozen=True)
class Alarms:
    """Cases of a system and a laboratory, or all: those with a false alarm, the certain and the harmful ones."""

    system: str
    laboratory: str
    claimed: Rate
    sure: Rate
    harmful: Rate


def alarms(outcome: BenchmarkOutcome) -> Iterator[Alarms]:
    """A row per system and laboratory, then one per laboratory over all systems, where there are several."""
    none = [one for one in outcome.cases if one.label is not None and one.lot.kind == "none"]
    places = list(dict.fromkeys(one.lot.laboratory for one in none))
    systems = list(dict.fromkeys(one.lot.system for one in none))
    for system in [*systems, *([ALL] if len(systems) > 1 else [])]:
        for place in [*places, *([ALL] if len(places) > 1 else [])]:
            chosen = [one for one in none if system in (ALL, one.lot.system) and place in (ALL, one.lot.laboratory)]
            said = [(one.label or {}, one.answers["diagnosis"]) for one in chosen]
            claimed = [b["verdict"] != "no_gap" for _, b in said]
            yield Alarms(
                system,
                place,
                Rate.of(claimed),
                Rate.of(c and certainty(b) >= SURE for c, (_, b) in zip(claimed, said, strict=True)),
                Rate.of(harmful(a, b) for a, b in said),
            )


def alarm_lines(outcome: BenchmarkOutcome) -> Iterator[str]:
    """The rows as a table."""
    yield f"| system | laboratory | false alarms | with p ≥ {SURE:g} | named, held out worse |"
    yield "|---|---|---|---|---|"
    for one in alarms(outcome):
        yield f"| {one.system} | {one.laboratory} | {one.claimed} | {one.sure} | {one.harmful} |"


def cases_table(outcome: BenchmarkOutcome) -> pd.DataFrame:
    """A row per case: the truth, what was said of it, and what that scores."""
    return pd.DataFrame([dict(_row(one)) for one in outcome.cases if one.label is not None])


def _row(one: Worked) -> Iterator[tuple[str, object]]:
    label, said = one.label or {}, one.answers["diagnosis"]
    opponent = one.answers["regression_aware"]
    first = label["kind"] in GAPS
    yield from (("case", one.name), ("system", one.lot.system), ("kind", label["kind"]))
    yield "laboratory", one.lot.laboratory
    yield "truth", " + ".join(label["effects"])
    yield "words", label["words"]
    yield "nats", min(label["nats"].values(), default=None)
    yield "imitation_left [-]", label.get("imitation", {}).get("left")
    yield "imitated_by", label.get("imitation", {}).get("by", "")
    yield "verdict", said["verdict"]
    yield "effects", " + ".join(said["effects"])
    yield "ambiguity", " ".join(said["ambiguity"])
    yield "absorbed", " ".join(said["absorbed"])
    top = max(said["probabilities"], key=lambda name: said["probabilities"][name], default="")
    yield from (("most_probable", top), ("top_probability [-]", said["probabilities"].get(top)))
    yield "first_right", answers(said)[:1] == label["effects"] if first else None
    yield "confidently_wrong", confidently_wrong(label, said)
    yield "brier [-]", brier(label, said)
    yield from (("harmful", harmful(label, said)), ("worse_channels", " ".join(worse_channels(label, said))))
    errors = [error for error, _ in reduction_errors(label, said)]
    inside = [held for _, held in reduction_errors(label, said) if held is not None]
    yield "reduction [-]", " ".join(f"{c}={v:.4f}" for c, v in label["reduction"].items() if v is not None)
    yield "reduction_error_mean [-]", mean(errors)
    yield "reduction_error_most [-]", max(errors, default=None)
    yield "channels_inside_ci95", f"{sum(inside)}/{len(inside)}"
    yield from (("cpu [s]", round(one.cpu, 3)), ("wall [s]", round(one.wall, 3)), ("same_again", one.same))
    yield from (("regression_verdict", opponent["verdict"]), ("regression_effects", " + ".join(opponent["effects"])))


def mean(values: Sequence[float]) -> float | None:
    """None where there is nothing."""
    return float(np.mean(values)) if values else None
