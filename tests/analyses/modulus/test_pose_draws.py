"""Error of the poses carried from areas into E*: by hand, and from the files of an area analysis."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.modulus.identified import describe
from geocontact.analyses.modulus.result import modulus
from geocontact.data.errors import InputError, InputWarning
from geocontact.io.recordings.area_table import read_area_table
from geocontact.io.recordings.pose_draws import PoseDraws, read_pose_draws
from tests.analyses.area.calls import area
from tests.analyses.modulus.synthetic_step import areas, forces
from tests.cli.calls import PLATE, SPHERE, poses, unpictured
from tests.identify.synthetic_contact import TRUE


def drawn(folder: Path, shares: np.ndarray) -> Path:
    """Areas of the synthetic step, all of them larger by one share in each draw."""
    table = read_area_table([areas(folder)])
    file = folder / "pose_draws.npz"
    PoseDraws(table.time, table.thresholds, table.areas["total"][:, :, None] * (1.0 + shares)).written(file)
    return file


def test_a_larger_area_is_a_softer_contact(tmp_path: Path) -> None:
    """The law has area to the power 1.5: E* of a draw is the true one over (1 + share)^1.5."""
    shares = np.linspace(-0.1, 0.1, 41)
    result = modulus(
        areas(tmp_path), forces(tmp_path, sides=False), radius=0.037, bootstrap=0, pose_draws=drawn(tmp_path, shares)
    )
    found = result.found.poses
    assert found is not None
    np.testing.assert_allclose(found.drawn, TRUE / (1.0 + shares) ** 1.5, rtol=1e-4)
    low, high = np.quantile(TRUE / (1.0 + shares) ** 1.5, (0.025, 0.975))
    numbers = describe(result.found)["pose_error"]
    assert numbers["E_star_ci95_Pa"] == pytest.approx([low, high], rel=1e-4)
    assert numbers["E_star_ci95_with_forces_Pa"] == pytest.approx([low, high], rel=1e-3), "the forces have no error"
    assert numbers["draws"] == 41 and "error of the pose: E*" in str(result)


def test_draws_of_another_motion_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "pose_draws.npz"
    PoseDraws(np.arange(3.0), np.array([1e-3]), np.ones((3, 1, 5))).written(file)
    with pytest.raises(InputError, match="has other frames or thresholds than the areas"):
        modulus(areas(tmp_path), forces(tmp_path, sides=False), radius=0.037, bootstrap=0, pose_draws=file)
    with pytest.raises(InputError, match=r"is no pose_draws\.npz"):
        read_pose_draws(areas(tmp_path))


def test_the_area_analysis_writes_what_modulus_reads(tmp_path: Path) -> None:
    """A ball that sinks towards a plate, its height known to 0.1 mm: one constant error of all frames."""
    motion = poses(tmp_path, *((0, 20.4 - 0.05 * k, 0) for k in range(9)))
    sd = {"pose_sd": (0.0, 1e-4, 0.0, 0.0, 0.0, 0.0), "draws": 40, "rule": "clip", "threshold": (1e-3,)}
    found = area(SPHERE, PLATE, motion, **sd)
    with unpictured(), warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        out = found.write(tmp_path / "out")
    draws = read_pose_draws(out / "pose_draws.npz")
    assert draws.area.shape == (9, 1, 40)
    interval = np.quantile(draws.area[:, 0], (0.025, 0.975), axis=1)
    table = found.table("pose_error")
    np.testing.assert_allclose(interval[0] * 1e6, table["drawn_lower [mm^2]"])


def test_the_search_is_on_record(tmp_path: Path) -> None:
    """Calls grow, costs fall, and the last cost is that of the start."""
    result = modulus(
        areas(tmp_path), forces(tmp_path, sides=False), radius=0.037, bootstrap=0, free={"threshold": (2e-3, 5e-3)}
    )
    numbers = describe(result.found)
    assert len(numbers["searches"]) == numbers["starts"]["count"] > 1
    for one, cost in zip(numbers["searches"], numbers["starts"]["costs"], strict=True):
        assert len(one["calls"]) == len(one["costs"]) == one["iterations"] + 1
        assert (np.diff(one["calls"]) >= 1).all() and (np.diff(one["costs"]) <= 1e-12).all()
        assert one["costs"][-1] == pytest.approx(cost) and one["end"]
