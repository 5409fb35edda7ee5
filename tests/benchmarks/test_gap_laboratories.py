"""The benchmark of laboratories goes on where it ended, and draws from its own side only."""

from __future__ import annotations

import copy
import json
import sys
from pathlib import Path

import pytest

from benchmarks.gap import laboratories as gap_laboratories
from geocontact.analyses.gap.benchmark.case import Worked
from geocontact.gap_benchmark.drawing import Lot
from geocontact.gap_benchmark.synthetic.laboratories.kinds import kinds_of

RESULTS = Path(__file__).parents[2] / "benchmarks" / "results"
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


def run(monkeypatch: pytest.MonkeyPatch, out: Path, *more: str, kinds: str = "abroad") -> list[Lot]:
    """Cases that were worked."""
    worked: list[Lot] = []

    def instead(work: tuple[Lot, float]) -> Worked:
        worked.append(work[0])
        return Worked(work[0], "c", LABEL, {"diagnosis": {**SAID, "gap": GAP}}, cpu=2.0)

    monkeypatch.setattr(gap_laboratories, "diagnosed", instead)
    monkeypatch.setattr(sys, "argv", ["x", "--kinds", kinds, "--seed", "1", "--out", str(out), *more])
    assert gap_laboratories.main() == 0
    return worked


def test_runs_from_before_a_figure_was_counted_are_tabulated() -> None:
    """Neither has it: no row, as in the documentation; one has: the other's cell says so."""
    home, abroad = (
        json.loads((RESULTS / f"gap_laboratories_{side}_3.json").read_text(encoding="utf-8"))
        for side in ("home", "abroad")
    )
    before = list(gap_laboratories.table(home, abroad))
    assert before[0].startswith("| figure | home | abroad | loss, points | elbow, abroad |")
    words = [gap_laboratories.WORDS[name] for name in ("class_named", "class_right", "class_size")]
    assert not any(word in line for word in words for line in before)
    newer = copy.deepcopy(abroad)
    newer["asked"]["kinds"] = "fresh"
    for row in newer["figures"].values():
        row["shares"]["class_named"] = {"hits": 3, "count": 4}
        row["numbers"]["class_size"] = 2.5
    table = list(gap_laboratories.table(home, newer))
    assert table[0].startswith("| figure | home | fresh | loss, points | elbow, fresh |")
    assert len(table) == len(before) + 2 and len({line.count("|") for line in table}) == 1
    named, size = (next(line for line in table if line.startswith(f"| {word} |")) for word in (words[0], words[2]))
    assert named.startswith(f"| {words[0]} | not counted | 3/4 = 75.0 % [") and "| not told | 3/4 =" in named
    other_way = [line for line in gap_laboratories.table(newer, home) if line.startswith(f"| {words[0]} |")]
    assert other_way[0].startswith(f"| {words[0]} | 3/4 = 75.0 % [") and "| not counted | not told |" in other_way[0]
    assert size.startswith(f"| {words[2]} | not counted | 2.5 | not told | 2.5 |")


def test_a_class_that_is_stated_is_counted_and_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(SAID, "one_law", [["damping", "filter_lag"]])
    out = tmp_path / "labs.json"
    assert {one.laboratory for one in run(monkeypatch, out, "--none", "1", kinds="fresh")} <= set(kinds_of("fresh"))
    written = json.loads(out.read_text())
    assert written["figures"]["all"]["shares"]["class_right"]["hits"] == 0
    assert written["figures"]["all"]["shares"]["class_right"]["count"] == 5
    assert all(line["one_law"] == [["damping", "filter_lag"]] for line in written["cases"])


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
