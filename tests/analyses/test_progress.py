"""Analyses that take long say how far they are."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from geocontact.analyses.frame.job import Call, execute
from geocontact.analyses.frame.record import Listener
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.result import mat
from geocontact.analyses.shape.options import ShapeOptions
from geocontact.analyses.shape.result import fit_shape

MESHES = Path(__file__).resolve().parents[2] / "meshes"


class Hearing(Listener):
    """Keeps the stages and counts the steps."""

    def __init__(self) -> None:
        self.named: list[str] = []

    @contextmanager
    def stages(self, label: str) -> Iterator[Callable[[str], None]]:
        yield lambda stage: self.named.append(f"{label}: {stage}")


@pytest.fixture
def hearing() -> Hearing:
    return Hearing()


def test_fit_names_what_it_fits(hearing: Hearing, tmp_path: Path) -> None:
    options = ShapeOptions(MESHES / "sphere_r20.stl", unit="mm", shape="sphere", split="x", medial="-")
    execute(fit_shape, options, tmp_path / "out", Call({}, hearing))
    assert [stage.partition(": ")[2].partition(" through")[0] for stage in hearing.named] == ["sphere"] * 3


def test_mat_names_its_stages(hearing: Hearing, tmp_path: Path) -> None:
    folder = MESHES / "mat_thigh_16x8"
    laid = {"surface": MESHES / "thigh.stl", "landmarks": folder / "landmarks.csv"}
    options = MatOptions(folder / "frames.csv", layout=folder / "layout.toml", unit="mm", **laid)
    execute(mat, options, tmp_path / "out", Call({}, hearing))
    assert [stage.partition(": ")[2].split()[0] for stage in hearing.named] == ["recording", "mat", "loads"]
