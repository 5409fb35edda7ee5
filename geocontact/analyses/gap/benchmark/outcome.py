"""Every case of a benchmark as it was worked, and counts over them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from geocontact.analyses.gap.benchmark.case import Worked
from geocontact.gap_benchmark.answers import Plain
from geocontact.gap_benchmark.drawing import KINDS
from geocontact.gap_benchmark.rates import Rate
from geocontact.gap_benchmark.score import visible
from geocontact.gap_benchmark.table import OPPONENTS

SLOW = 10.0
"""Seconds of one core that a case may take."""


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
        """Of those diagnosed twice, how many got the same answer."""
        return Rate.of(one.same for one in self.cases if one.same is not None)

    @property
    def fast(self) -> Rate:
        """How many took no longer than `SLOW`."""
        return Rate.of(seconds <= SLOW for seconds in self.cpu)

    @property
    def imitated(self) -> Rate:
        """Of the visible effects outside the table, how many a candidate imitates."""
        strange = [label for label in self.labels.values() if label["kind"] == "outside" and visible(label)]
        return Rate.of(bool(label.get("imitated")) for label in strange)
