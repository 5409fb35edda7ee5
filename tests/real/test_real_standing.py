"""Phase A on steps of a real walk: solved and certified, and a step that was not used stays near."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

import pytest

from benchmarks.standing.real import steps


@pytest.mark.slow
def test_feet_of_a_recorded_walk(data_dir: Path) -> None:
    found = steps(Namespace(data=data_dir, nodes=60.0))
    for kind in ("calibrated", "held out"):
        assert found[kind]["ending"] == "solved"
        for step in found[kind]["steps"].values():
            assert step["certified"] and step["CoP [mm]"] < 10.0 and max(step["foot [mm]"]) < 10.0, step
