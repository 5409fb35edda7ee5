"""The benchmark of laboratories goes on where it ended, and draws from its own side only."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from benchmarks import gap_laboratories
from geocontact.analyses.gap.benchmark.case import Worked
from geocontact.gap_benchmark.drawing import Lot
from geocontact.gap_benchmark.synthetic.laboratories.kinds import kinds_of

LABEL = {
    "kind": "none",
    "effects": [],
    "nats": {},
    "reduction": {"force": 0.0},
    "rmse_before": {"force": 1.0},
    "floor": {"force": 1.0},
}
SAID = {"verdict": "no_gap", "effects": [], "ambiguity": [], "probabilities": {"none": 1.0}, "seconds": 2.0}
GAP = {"force": {"rmse_before": 1.0, "rmse_after": 1.0, "reduction": 0.0, "ci95": [0.0, 0.0]}}


def run(monkeypatch: pytest.MonkeyPatch, out: Path, *more: str) -> list[Lot]:
    """Cases that were worked."""
    worked: list[Lot] = []

    def instead(work: tuple[Lot, float]) -> Worked:
        worked.append(work[0])
        return Worked(work[0], "c", LABEL, {"diagnosis": {**SAID, "gap": GAP}}, cpu=2.0)

    monkeypatch.setattr(gap_laboratories, "diagnosed", instead)
    monkeypatch.setattr(sys, "argv", ["x", "--kinds", "abroad", "--seed", "1", "--out", str(out), *more])
    assert gap_laboratories.main() == 0
    return worked


def test_a_run_goes_on_where_it_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "labs.json"
    first = run(monkeypatch, out, "--none", "1")
    assert {one.laboratory for one in first} <= set(kinds_of("abroad")) and len(first) == 5
    again = run(monkeypatch, out, "--none", "2", "--pairs", "1")
    assert len(again) == 10 and not set(first) & set(again)
    written = json.loads(out.read_text())
    assert written["figures"]["all"]["cases"] == 15 and len(written["cases"]) == 15
    table = list(gap_laboratories.table(written, written))
    assert (
        any("false alarms" in line and "+0 [" in line for line in table)
        and len({line.count("|") for line in table}) == 1
    )
