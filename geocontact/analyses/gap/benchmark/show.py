"""What a benchmark reports: benchmark.json, lines of benchmark.md, stated probabilities against what came true."""

from __future__ import annotations

import os
import platform
from collections import Counter
from collections.abc import Iterator
from importlib import import_module
from pkgutil import walk_packages
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

import geocontact.gap
from geocontact.analyses.frame.collector import current
from geocontact.analyses.gap.benchmark.outcome import SLOW, BenchmarkOutcome, alarm_lines, alarms, mean
from geocontact.gap import attribute
from geocontact.gap.selection import verdict
from geocontact.gap_benchmark import answers, residual_regression, score
from geocontact.gap_benchmark.score import Rate, figures, reliability
from geocontact.gap_benchmark.table import OPPONENTS, ROWS, error_interval, lead, markdown, scores
from geocontact.view.curves.diagnosis_answers import Stated, reliability_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DRAWN = {"diagnosis": "diagnosis", "regression_aware": "residual regression"}
"""Whose reliability is drawn."""


def stated_figure(outcome: BenchmarkOutcome) -> Figure:
    """Reliability of the diagnosis and of the better opponent."""
    return reliability_figure({words: _stated(outcome, who) for who, words in DRAWN.items()})


def _stated(outcome: BenchmarkOutcome, who: str) -> Stated:
    bins, _ = reliability([(label, outcome.given[who][name]) for name, label in outcome.labels.items()])
    spans = [Rate(round(one.came_true * one.count), one.count).interval() for one in bins]
    return Stated(
        np.array([one.stated for one in bins]),
        np.array([one.came_true for one in bins]),
        np.array([low for low, _ in spans]),
        np.array([high for _, high in spans]),
        [one.count for one in bins],
    )


def content(outcome: BenchmarkOutcome, when: str) -> dict[str, Any]:
    """benchmark.json."""
    return {
        "date": when,
        "seed": outcome.seed,
        "machine": _machine() | current().versions(),
        "cases": {name: one.kinds for name, one in outcome.scopes.items()},
        "bars": {row.figure: row.bar for row in ROWS if row.bar},
        "thresholds": {
            "scoring": _constants(score) | {"imitation_left": answers.LEFT},
            "diagnosis": _constants(verdict) | _constants(attribute),
            "regression": _constants(residual_regression),
            "gap_modules": constants_of_all(geocontact.gap),
        },
        "figures": {
            name: {who: figures(one_score) for who, one_score in scores(one.labels, one.given).items()}
            for name, one in outcome.scopes.items()
        },
        "reduction_error_ci95": {
            name: {who: list(error_interval(one.labels, said)) for who, said in one.given.items()}
            for name, one in outcome.scopes.items()
        },
        "ahead": {
            name: {who: vars(lead(one.labels, one.given["diagnosis"], one.given[who])) for who in OPPONENTS}
            for name, one in outcome.scopes.items()
        },
        "cpu_seconds": {
            name: {"mean": mean(one.cpu), "most": max(one.cpu, default=None), "within_10": _rate(one.fast)}
            for name, one in outcome.scopes.items()
        },
        "same_in_another_dress": {name: _rate(one.same) for name, one in outcome.scopes.items()},
        "verdicts_by_kind": {name: _verdicts(one) for name, one in outcome.scopes.items()},
        "imitated": {name: _rate(one.imitated) for name, one in outcome.scopes.items()},
        "alarms_by_laboratory": [
            {
                "system": one.system,
                "laboratory": one.laboratory,
                "false_alarms": _rate(one.claimed),
                "sure": _rate(one.sure),
                "harmful": _rate(one.harmful),
            }
            for one in alarms(outcome)
        ],
        "trouble": [line for one in outcome.cases for line in one.trouble],
    }


def _machine() -> dict[str, Any]:
    return {"machine": platform.machine(), "processor": platform.processor(), "cores": os.cpu_count()}


def _constants(module: ModuleType) -> dict[str, Any]:
    return {name: v for name, v in vars(module).items() if name.isupper() and _is_numbers(v)}


def _is_numbers(value: Any) -> bool:
    table = isinstance(value, tuple) and bool(value) and all(map(_is_numbers, value))
    return table or isinstance(value, int | float)


def constants_of_all(package: ModuleType) -> dict[str, Any]:
    """Numbers and tables of every module of a package, by "module.NAME" as in docs/theory/gap_diagnosis.md."""
    home = f"{package.__name__}."
    modules = [name for _, name, is_package in walk_packages(package.__path__, home) if not is_package]
    return {
        f"{name.removeprefix(home)}.{constant}": value
        for name in modules
        for constant, value in _constants(import_module(name)).items()
    }


def _rate(rate: Rate) -> dict[str, Any]:
    return {"hits": rate.hits, "count": rate.count, "ci95": list(rate.interval())}


def _verdicts(one: BenchmarkOutcome) -> dict[str, dict[str, int]]:
    said = one.given["diagnosis"]
    return {
        kind: dict(Counter(said[name]["verdict"] for name, label in one.labels.items() if label["kind"] == kind))
        for kind in one.kinds
    }


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
