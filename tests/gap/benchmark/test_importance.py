"""Figures by importance, of made-up labels and diagnoses."""

from __future__ import annotations

from typing import Any

import pytest

from geocontact.gap_benchmark.importance import by_importance, importance, wrong


def label(kind: str, reduction: float, *effects: str) -> dict[str, Any]:
    """Of one channel; a true floor of 0.8 in an error of 1."""
    return {
        "kind": kind,
        "effects": list(effects),
        "reduction": {"force": reduction},
        "rmse_before": {"force": 1.0},
        "rmse_after": {"force": 1.0 - reduction},
        "floor": {"force": 0.8},
    }


def said(verdict: str, *effects: str, share: float = 0.0, **more: Any) -> dict[str, Any]:
    parts = {"effects": {"share": share, "ci95": [share - 0.1, share + 0.1]}, "sensor": {"share": 1.0 - share}}
    return {"verdict": verdict, "effects": list(effects), "budget": {"force": parts}, **more}


def test_importance_is_the_true_reduction_or_what_is_above_the_floor() -> None:
    assert importance(label("single", 0.3, "damping")) == 0.3
    assert importance(label("outside", 0.0)) == pytest.approx(0.2)
    assert importance(label("none", 0.0)) == 0.0


def test_rates_count_by_importance() -> None:
    alike = {"one_law": [["filter_lag", "time_shift"]]}
    pairs = [
        (label("single", 0.3, "damping"), said("explained", "damping", share=0.5)),  # 1 - 0.7² = 0.51
        (label("single", 0.3, "time_shift"), said("explained", "filter_lag", share=0.9, **alike)),
        (label("single", 0.3, "slip"), said("explained", "damping")),
        (label("single", 0.02, "slip"), said("no_gap", detected=[{"effect": "slip"}])),
        (label("single", 0.02, "slip"), said("no_gap")),
        (label("single", 0.001, "slip"), said("no_gap")),
        (label("pair", 0.4, "slip", "damping"), said("partly_explained", "slip")),
        (label("pair", 0.4, "slip", "damping"), said("explained", "slip", "damping", share=0.64)),
        (label("outside", 0.0), said("partly_explained", "slip")),
        (label("outside", 0.0), said("no_gap")),
        (label("none", 0.0), said("explained", "slip")),
    ]
    found = {name: (rate.hits, rate.count) for name, rate in by_importance(pairs).items()}
    assert found == {
        "large_named": (2, 3),
        "large_wrong": (1, 3),
        "small_detected": (1, 2),
        "pair_both": (1, 2),
        "pair_one": (2, 2),
        "pair_no_wrong": (2, 2),
        "strange_unknown": (1, 2),
        "strange_wrong": (2, 3),
        "budget_inside": (2, 3),
        "budget_closed": (11, 11),
    }


def test_one_of_two_effects_is_not_wrong_and_a_phantom_beside_one_is() -> None:
    two = label("pair", 0.4, "slip", "damping")
    assert not wrong(two, said("explained", "slip")) and wrong(two, said("explained", "slip", "preload"))
    assert wrong(label("none", 0.0), said("explained", "slip")) and not wrong(label("none", 0.0), said("no_gap"))
