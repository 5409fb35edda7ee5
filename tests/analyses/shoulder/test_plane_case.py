"""A case of the base model `shoulder` out of simulations in three dimensions, by projection on the arm's plane."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from tests.analyses.shoulder.test_simulate import simulated

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def gathered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Simulations at two levels, gathered as the file that they write says, with the second trial added."""
    home = tmp_path_factory.mktemp("plane")
    for name, level in (("half", 0.5), ("full", 1.0)):
        simulated(level=level, side="right").write(home / name)
    text = (home / "half" / "plane" / "right.toml").read_text(encoding="utf-8")
    text = text.replace('"right', '"half/plane/right').replace('"support.csv"', '"half/plane/support.csv"')
    more = '[from.t02]\ninputs = "full/plane/right.csv"\noutputs = "full/plane/right_simulated.csv"\n'
    text = text.replace("[trial.t01]", f"{more}\n[trial.t02]\nlevel = 1.0\n\n[trial.t01]")
    (home / "gather.toml").write_text(text, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        gc.gather(home / "gather.toml").write(home / "case")
    return home


def test_the_base_model_takes_the_projected_simulation(gathered: Path) -> None:
    """Within what the plane leaves out: some degrees and newtons, told by how far the hinge moves."""
    case = gc.read_gap_case(gathered / "case")
    system = gc.system_of(case)
    values = {p.name: p.start for p in case.parameters}
    for trial in (*case.calibration, *case.evaluation):
        model = system.simulate(trial, values)
        measured = np.column_stack([trial.signals.column(name) for name in ("exo", "force")])
        off = model - measured
        assert np.degrees(np.sqrt(np.mean(off[:, 0] ** 2))) < 8.0
        assert np.corrcoef(model[:, 0], measured[:, 0])[0, 1] > 0.97
        assert np.sqrt(np.mean(off[:, 1] ** 2)) < 8.0
    assert [t.covariates["level"] for t in (*case.calibration, *case.evaluation)] == [0.5, 1.0]


def test_it_says_how_far_the_hinge_moves(gathered: Path) -> None:
    text = (gathered / "half" / "plane" / "right.toml").read_text(encoding="utf-8")
    moved = [float(each) for each in re.findall(r"([\d.]+) mm", text.splitlines()[0])]
    assert len(moved) == 2 and 1.0 < moved[0] < 100.0
