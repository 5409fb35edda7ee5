"""A case of the base model `shoulder` out of simulations in three dimensions, by projection on the arm's plane."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.shoulder_exoskeleton.synthetic import condition, participant, synthetic_trial, task
from meshes.overhead_files import trial_files
from tests.analyses.shoulder.test_simulate import simulated

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def gathered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Trials of two tasks at two levels, gathered as the first one's file says; the other is made by its own script."""
    home = tmp_path_factory.mktemp("plane")
    other = synthetic_trial(participant("P1"), task("T2"), condition("S50"))
    for name, text in trial_files(other).items():
        (home / name).write_text(text, encoding="utf-8")
    simulated(side="right").write(home / "first")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        options = {"tool": home / "tool.csv", "upright": (0.0, 0.5), "level": 0.5, "side": "right"}
        gc.shoulder.simulate(home / "markers.trc", **options).write(home / "second")
        file = home / "first" / "plane" / "right.toml"
        text = file.read_text(encoding="utf-8")
        with pytest.raises(gc.InputError, match=r"SECOND/plane/right\.csv: there is no such file"):
            gc.gather(file)
        file.write_text(of_two(text), encoding="utf-8")
        gc.gather(file).write(home / "case")
    return home


def of_two(text: str) -> str:
    """The file with one trial to fit to and one held out: enough to gather, not to diagnose."""
    before, _, numbers = text[: text.index("[from.t03]")], *text.partition("[constants]")[1:]
    before = before.replace('["t01", "t02"]', '["t01"]').replace('["t03"]', '["t02"]').replace("SECOND", "../../second")
    of_other = before.index("[trial.t02]")
    return f"{before[:of_other]}{before[of_other:].replace('level = 1', 'level = 0.5')}[constants]{numbers}"


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
    assert [t.covariates["level"] for t in (*case.calibration, *case.evaluation)] == [1.0, 0.5]


def test_it_says_how_far_the_hinge_moves(gathered: Path) -> None:
    text = (gathered / "first" / "plane" / "right.toml").read_text(encoding="utf-8")
    moved = [float(each) for each in re.findall(r"([\d.]+) mm", text.splitlines()[0])]
    assert len(moved) == 2 and 1.0 < moved[0] < 100.0
