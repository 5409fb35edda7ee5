"""Figures of verdicts alone, by system and laboratory, of answers made up here."""

from __future__ import annotations

from argparse import Namespace

from benchmarks.gap_verdicts import TOLD, report
from geocontact.gap_benchmark.answers import oracle_answer


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
