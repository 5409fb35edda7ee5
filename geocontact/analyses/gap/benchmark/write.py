"""Everything a benchmark writes."""

from __future__ import annotations

import json
import os
import platform
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pandas as pd

from geocontact.analyses.gap.benchmark.case import Worked
from geocontact.analyses.json_file import plain
from geocontact.analyses.run_record import Record
from geocontact.gap import attribute
from geocontact.gap.selection import verdict
from geocontact.gap_benchmark import confounding as imitation
from geocontact.gap_benchmark import residual_regression, score
from geocontact.gap_benchmark.answers import Plain
from geocontact.gap_benchmark.drawing import KINDS
from geocontact.gap_benchmark.rates import Rate
from geocontact.gap_benchmark.score import GAPS, answers, brier, confidently_wrong, figures, reduction_errors, visible
from geocontact.gap_benchmark.table import OPPONENTS, ROWS, error_interval, lead, markdown, scores
from geocontact.io.text.results import write_table
from geocontact.view.curves.diagnosis.reliability import Stated, reliability_figure
from geocontact.view.curves.save import save

SLOW = 10.0
"""Seconds of one core that a case may take."""
DRAWN = {"diagnosis": "diagnosis", "regression_aware": "residual regression"}
"""Whose reliability is drawn."""
Given = dict[str, dict[str, Plain]]


@dataclass(frozen=True)
class Outcome:
    """Every case of a benchmark, worked."""

    seed: int
    systems: tuple[str, ...]
    cases: tuple[Worked, ...]

    @cached_property
    def labels(self) -> dict[str, dict[str, Any]]:
        """Truth by case."""
        return {one.name: one.label for one in self.cases if one.label is not None}

    @cached_property
    def given(self) -> Given:
        """Diagnoses by answerer and case."""
        whose = ("diagnosis", *OPPONENTS)
        return {who: {one.name: one.answers[who] for one in self.cases if one.label is not None} for who in whose}

    @cached_property
    def scopes(self) -> dict[str, Outcome]:
        """All cases, and those of each system where there are several."""
        each = {s: Outcome(self.seed, (s,), tuple(c for c in self.cases if c.lot.system == s)) for s in self.systems}
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


def write_results(record: Record, outcome: Outcome, folder: Path, kept: str) -> list[str]:
    """Write everything but run.json; the lines of benchmark.md come back."""
    when = datetime.now(UTC).isoformat(timespec="seconds")
    content = _content(record, outcome, when)
    _write_json(content, folder / "benchmark.json")
    lines = list(_markdown(outcome, when))
    (folder / "benchmark.md").write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")
    write_table(cases_table(outcome), folder, parquet=False, name="cases")
    figure = reliability_figure({words: _stated(outcome, who) for who, words in DRAWN.items()})
    for ending in ("png", "svg"):
        save(figure, folder / f"reliability.{ending}")
    if kept:
        _write_json(outcome.labels, folder / kept / "labels.json")
    record.results["cases"] = outcome.kinds
    return lines


def _write_json(content: Mapping[str, Any], file: Path) -> None:
    text = json.dumps(plain(content), indent=2, ensure_ascii=False, allow_nan=False)
    file.write_text(text + "\n", encoding="utf-8", newline="\n")


def _content(record: Record, outcome: Outcome, when: str) -> dict[str, Any]:
    """benchmark.json."""
    return {
        "date": when,
        "seed": outcome.seed,
        "machine": _machine() | record.versions(),
        "cases": {name: one.kinds for name, one in outcome.scopes.items()},
        "bars": {row.figure: row.bar for row in ROWS if row.bar},
        "thresholds": {
            "scoring": _constants(score) | {"imitation_left": imitation.LEFT},
            "diagnosis": _constants(verdict) | _constants(attribute),
            "regression": _constants(residual_regression),
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
            name: {"mean": _mean(one.cpu), "most": max(one.cpu, default=None), "within_10": _rate(_fast(one))}
            for name, one in outcome.scopes.items()
        },
        "same_in_another_dress": {name: _rate(one.same) for name, one in outcome.scopes.items()},
        "verdicts_by_kind": {name: _verdicts(one) for name, one in outcome.scopes.items()},
        "imitated": {name: _rate(_imitated(one)) for name, one in outcome.scopes.items()},
        "trouble": [line for one in outcome.cases for line in one.trouble],
    }


def _machine() -> dict[str, Any]:
    return {"machine": platform.machine(), "processor": platform.processor(), "cores": os.cpu_count()}


def _constants(module: ModuleType) -> dict[str, int | float]:
    return {name: v for name, v in vars(module).items() if name.isupper() and isinstance(v, int | float)}


def _rate(rate: Rate) -> dict[str, Any]:
    return {"hits": rate.hits, "count": rate.count, "ci95": list(rate.interval())}


def _mean(values: Sequence[float]) -> float | None:
    return float(np.mean(values)) if values else None


def _fast(one: Outcome) -> Rate:
    return Rate.of(seconds <= SLOW for seconds in one.cpu)


def _imitated(one: Outcome) -> Rate:
    strange = [label for label in one.labels.values() if label["kind"] == "outside" and visible(label)]
    return Rate.of(bool(label.get("imitated")) for label in strange)


def _verdicts(one: Outcome) -> dict[str, dict[str, int]]:
    said = one.given["diagnosis"]
    return {
        kind: dict(Counter(said[name]["verdict"] for name, label in one.labels.items() if label["kind"] == kind))
        for kind in one.kinds
    }


def _markdown(outcome: Outcome, when: str) -> Iterator[str]:
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
    broken = [line for one in outcome.cases for line in one.trouble]
    if broken:
        yield ""
        yield f"{len(broken)} broke down and count as wrong: " + "; ".join(broken)


def _extra(one: Outcome) -> Iterator[tuple[str, str, str]]:
    """Figures that only the diagnosis has."""
    if one.cpu:
        most = max(one.cpu)
        within = f"{_fast(one)} of the cases; mean {np.mean(one.cpu):.1f} s, most {most:.1f} s"
        yield "seconds of one core per case", "≤ 10 s", f"{'✓' if most <= SLOW else '✗'} {within}"
    if one.same.count:
        mark = "✓" if one.same.hits == one.same.count else "✗"
        yield "same answer under other names, order and units", "all", f"{mark} {one.same}"
    if _imitated(one).count:
        yield "outside the table, imitated by a candidate (not counted above)", "", str(_imitated(one))


def cases_table(outcome: Outcome) -> pd.DataFrame:
    """A row per case: the truth, what was said of it, and what that scores."""
    return pd.DataFrame([dict(_row(one)) for one in outcome.cases if one.label is not None])


def _row(one: Worked) -> Iterator[tuple[str, object]]:
    label, said = one.label or {}, one.answers["diagnosis"]
    opponent = one.answers["regression_aware"]
    first = label["kind"] in GAPS
    yield from (("case", one.name), ("system", one.lot.system), ("kind", label["kind"]))
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
    errors = [error for error, _ in reduction_errors(label, said)]
    inside = [held for _, held in reduction_errors(label, said) if held is not None]
    yield "reduction [-]", " ".join(f"{c}={v:.4f}" for c, v in label["reduction"].items() if v is not None)
    yield "reduction_error_mean [-]", _mean(errors)
    yield "reduction_error_most [-]", max(errors, default=None)
    yield "channels_inside_ci95", f"{sum(inside)}/{len(inside)}"
    yield from (("cpu [s]", round(one.cpu, 3)), ("wall [s]", round(one.wall, 3)), ("same_again", one.same))
    yield from (("regression_verdict", opponent["verdict"]), ("regression_effects", " + ".join(opponent["effects"])))


def _stated(outcome: Outcome, who: str) -> Stated:
    bins, _ = score.reliability([(label, outcome.given[who][name]) for name, label in outcome.labels.items()])
    spans = [Rate(round(one.came_true * one.count), one.count).interval() for one in bins]
    return Stated(
        np.array([one.stated for one in bins]),
        np.array([one.came_true for one in bins]),
        np.array([low for low, _ in spans]),
        np.array([high for _, high in spans]),
        [one.count for one in bins],
    )
