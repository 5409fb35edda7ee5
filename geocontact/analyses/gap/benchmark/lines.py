"""Figures of a benchmark as lines of benchmark.md."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from geocontact.analyses.gap.benchmark.alarms import alarm_lines
from geocontact.analyses.gap.benchmark.outcome import SLOW, BenchmarkOutcome
from geocontact.gap_benchmark.table import markdown


def page_lines(outcome: BenchmarkOutcome, when: str) -> Iterator[str]:
    """benchmark.md: a table per scope."""
    yield "# Gap benchmark"
    yield ""
    yield f"Seed {outcome.seed}, {when}, {len(outcome.labels)} synthetic cases with withheld labels. Shares carry exact"
    yield "95 % intervals (Clopper–Pearson); ✓ and ✗ hold the figure, not its interval, against the bar."
    for name, one in outcome.scopes.items():
        yield ""
        yield f"## {name}: " + ", ".join(f"{count} {kind}" for kind, count in one.kinds.items())
        yield ""
        yield from markdown(one.labels, one.given, list(_extra(one)))
    if any(label["kind"] == "none" for label in outcome.labels.values()):
        yield ""
        yield "## Cases that lack nothing, by laboratory"
        yield ""
        yield from alarm_lines(outcome)
    broken = [line for one in outcome.cases for line in one.trouble]
    if broken:
        yield ""
        yield f"{len(broken)} broke down and count as wrong: " + "; ".join(broken)


def _extra(one: BenchmarkOutcome) -> Iterator[tuple[str, str, str]]:
    """Figures that only the diagnosis has."""
    if one.cpu:
        most = max(one.cpu)
        within = f"{one.fast} of the cases; mean {np.mean(one.cpu):.1f} s, most {most:.1f} s"
        yield "seconds of one core per case", "≤ 10 s", f"{'✓' if most <= SLOW else '✗'} {within}"
    if one.same.count:
        mark = "✓" if one.same.hits == one.same.count else "✗"
        yield "same answer under other names, order and units", "all", f"{mark} {one.same}"
    if one.imitated.count:
        yield "outside the table, imitated by a candidate (not counted above)", "", str(one.imitated)
