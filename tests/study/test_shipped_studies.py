"""The studies beside the guide run as they are: on the samples here, on public data in tests/real."""

from __future__ import annotations

from pathlib import Path

import pytest

from geocontact.study.description import read_study_file
from geocontact.study.steps import runs_of

ROOT = Path(__file__).parents[2]
STUDIES = ROOT / "docs" / "how-to" / "studies"
MESHES = ROOT / "meshes"


@pytest.mark.parametrize(
    ("name", "steps"),
    [
        ("knee", ["markers", "scale", "ik", "id", "contact", "modulus"]),
        ("prosthesis", ["scale", "ik", "id", *["prosthesis_simulate"] * 3]),
    ],
)
def test_every_step_of_a_shipped_study_is_planned(name: str, steps: list[str]) -> None:
    assert [run.step for run in runs_of(read_study_file(STUDIES / f"{name}.toml", MESHES))] == steps
