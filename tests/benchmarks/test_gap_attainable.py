"""How near other effects come to a planted one: told from the truth, and the same as is found by hand."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import pytest

from benchmarks.gap.attainable import ASKED, asked, beside, margin, said, summary
from geocontact.gap_benchmark.drawing import Lot
from tests.elsewhere import Elsewhere

CASES = """case,kind,truth,nats,effects,ambiguity
elbow_1,single,damping,12.5,damping,damping relaxation
elbow_2,single,damping,30,,
elbow_3,none,,,damping + slip,
"""


def test_lots_are_those_of_the_gap_benchmark() -> None:
    lots = list(asked(argparse.Namespace(systems=["knee"], of=200, seed=5)))
    assert {lot.kind for lot in lots} == set(ASKED) and len(lots) == 73
    assert lots[0] == Lot("knee", "single", 5, 0)


def test_what_was_ranked_first_is_read(tmp_path: Path) -> None:
    (tmp_path / "cases.csv").write_text(CASES, encoding="utf-8")
    first = said(tmp_path / "cases.csv")
    assert [first[f"elbow_{k}"][0] for k in (1, 2, 3)] == ["damping", "", "damping"] and said(None) == {}
    row = {"name": "elbow_1", "nats": 12.5}
    assert beside(row, first) == row | {"first": "damping"} and beside(row, {}) == row
    with pytest.raises(SystemExit, match="drawn by another version"):
        beside(row | {"nats": 12.6}, first)


def test_margins_are_counted_where_they_belong() -> None:
    rows = [
        {"margin": 3.0, "effect": "slip", "first": "slip"}, {"margin": 40.0, "effect": "slip", "first": "damping"},
        {"margin": 2.9, "effect": "slip"}, {"margin": -3.0, "effect": "slip", "first": "slip"},
        {"margin": -3.1, "effect": "slip", "first": "damping"},
    ]  # fmt: skip
    found = [summary(rows)[name] for name in ("ahead", "hardly", "behind")]
    assert [(one["hits"], one["count"]) for one in found] == [(2, 5), (2, 5), (1, 5)]
    assert [(one["ranked_first"], one["of"]) for one in found] == [(1, 2), (1, 1), (0, 1)]
    rng = np.random.default_rng(0)
    margins = np.array([row["margin"] for row in rows])
    seen = margins + np.sqrt(2.0 * np.abs(margins)) * rng.standard_normal((20000, len(rows)))
    assert summary(rows)["attainable"] == pytest.approx((seen > 0.0).mean(), abs=0.01)


@pytest.mark.slow
def test_a_gain_of_one_side_and_an_asymmetry_cannot_be_told_and_a_drift_can(elsewhere: Elsewhere) -> None:
    """Of the knee, without noise: places of a seed that is used."""
    alike, apart = (elsewhere(margin, Lot("knee", "single", 20261132, place)) for place in (8, 7))
    assert (alike["effect"], alike["rival"]) == ("sensor_gain", "asymmetry")
    assert abs(alike["margin"]) < 0.1 < 0.01 * alike["base"]
    assert (apart["effect"], apart["rival"]) == ("sensor_drift", "sensor_offset")
    assert apart["margin"] > 100.0 and apart["own"] < 0.1 * apart["base"] < 0.2 * apart["nats"]
    assert elsewhere(margin, Lot("knee", "single", 20261132, 1)) is None, "not visible"
