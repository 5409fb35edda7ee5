"""The knee's chain on the surfaces of subject DM, which are real; loads are synthetic: none belong to these poses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.knee import chain as knee_chain
from benchmarks.knee import truth as knee_truth
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.systems.catalogue import system_of
from geocontact.systems.knee_posed import PosedKnee


@pytest.fixture(scope="module")
def knee(data_dir: Path) -> knee_chain.Knee:
    return knee_chain.dm_knee(data_dir)


@pytest.fixture(scope="module")
def folder(knee: knee_chain.Knee, tmp_path_factory: pytest.TempPathFactory) -> Path:
    courses = knee_chain.courses_of(knee, 1, 2, 21)
    return knee_chain.write_case(tmp_path_factory.mktemp("dm") / "case", knee, courses, knee_truth.NOTHING, 1)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_areas_agree_with_other_code_and_with_their_interpolation(knee: knee_chain.Knee, folder: Path) -> None:
    """Measured: 0.04 % between the codes, 0.6 % of the largest area by interpolating around the recorded poses."""
    case = read_gap_case(folder)
    geometry = system_of(case).geometry
    assert isinstance(geometry, PosedKnee)
    pose = np.ascontiguousarray(knee.mean(np.linspace(0.0, 1.0, 3)).T)
    area, centre = knee.finer.patches(pose)
    found = geometry.areas.direct(pose)
    np.testing.assert_allclose(area, found[..., 0], rtol=2e-3)
    np.testing.assert_allclose(centre, found[..., 1] / found[..., 0], atol=5e-5)
    assert 2.1e-3 < area.sum(axis=1).max() < 2.8e-3, "the areas that the data are known for"
    assert geometry.areas.error(geometry.areas.grid(pose)) < 0.015


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_the_chain_predicts_cells_of_the_finer_code(knee: knee_chain.Knee, folder: Path) -> None:
    case = read_gap_case(folder)
    system, trial = system_of(case), case.calibration[0]
    said = system.simulate(trial, {"E_star": knee_truth.MODULUS})
    measured = np.column_stack([trial.column(name) for name in system.outputs])
    ratio = (said * measured).sum() / (said * said).sum()
    assert ratio == pytest.approx(1.0, abs=4 * knee_truth.VARIES)
    assert np.sqrt(np.mean((measured - ratio * said) ** 2)) < 4 * knee_truth.NOISE
