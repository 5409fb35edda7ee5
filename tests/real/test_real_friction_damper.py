"""A real friction damper whose model is a simulator with a force law: friction withheld is named, and not otherwise."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.devices import friction_damper


def test_friction_withheld_is_named(data_dir: Path) -> None:
    told = friction_damper.findings(data_dir, rubbing=False).diagnosis
    assert (told.verdict, told.effects) == ("explained", ("dry_friction",))
    limit = told.parameters["dry_friction.stroke.limit"].value
    assert limit == pytest.approx(friction_damper.PUBLISHED, rel=0.1)
    gap = told.gap["force"]
    assert gap.rmse_after < 0.7 * gap.rmse_before


def test_nothing_is_named_where_the_base_has_it(data_dir: Path) -> None:
    told = friction_damper.findings(data_dir, rubbing=True).diagnosis
    assert told.verdict == "no_gap" and told.effects == ()
