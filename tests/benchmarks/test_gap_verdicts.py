"""Figures of verdicts alone, by system and laboratory, of answers made up here."""

from __future__ import annotations

import json
from argparse import Namespace
from dataclasses import asdict
from pathlib import Path

from benchmarks.gap.verdicts import TOLD, done, report
from geocontact.gap_benchmark.answers import oracle_answer
from geocontact.gap_benchmark.drawing import Lot


def row(system: str, laboratory: str, claimed: tuple[str, ...]) -> dict[str, object]:
    """A case that lacks nothing, and what was said of it; held-out errors double where something was."""
    gap = {"rmse_before": 1.0, "rmse_after": 2.0, "reduction": -1.0}
    label = {"kind": "none", "effects": [], "nats": {}, "reduction": {"force": 0.0}, "floor": {"force": 0.5}}
    label |= {"rmse_before": {"force": 1.0}, "rmse_after": {"force": 1.0}, "imitated": None}
    said = oracle_answer(label) | {"gap": {"force": gap} if claimed else {}}
    said |= {"verdict": "explained", "effects": list(claimed), "probabilities": {claimed[0]: 0.95}} if claimed else {}
    return {"lot": {"system": system, "laboratory": laboratory}, "label": label, "answer": said}


def test_alarms_are_counted_by_system_and_laboratory() -> None:
    rows = [row("foot", "inputs", ("damping",)), row("foot", "inputs", ()), row("knee", "recorder", ())]
    asked = Namespace(seed=1, laboratory="abroad", kinds=["none"], cases=3)
    found = report(asked, "abc", rows)
    assert (found["commit"], found["seed"], found["done"]) == ("abc", 1, 3)
    alarms = {name: (f["false_alarms"]["hits"], f["false_alarms"]["count"]) for name, f in found["figures"].items()}
    assert alarms["all"] == (1, 3) and alarms["foot"] == alarms["foot, inputs"] == (1, 2)
    assert alarms["knee"] == alarms["recorder"] == (0, 1)
    pooled = found["figures"]["all"]
    assert pooled["sure_alarms"]["hits"] == pooled["harm_in_sum"]["hits"] == 1
    assert set(TOLD) < set(pooled)


def test_a_run_goes_on_where_one_of_the_same_commit_ended(tmp_path: Path) -> None:
    log, lots = tmp_path / "out.rows", [Lot("knee", "none", 1, place) for place in range(3)]
    assert done(log, "abc", lots) == []
    written = [{"commit": what, "lot": asdict(lot)} for what, lot in (("old", lots[0]), ("abc", lots[1]))]
    log.write_text("".join(json.dumps(one) + "\n" for one in written), encoding="utf-8")
    assert done(log, "abc", lots) == written[1:]
    assert done(log, "abc", lots[:1]) == []
