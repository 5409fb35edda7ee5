"""Areas interpolated in the pose: exact where they should be, close elsewhere, from the surfaces beyond reach."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.errors import InputWarning
from geocontact.geometry.contact_area.area import AS_GIVEN
from geocontact.systems import knee_posed as pose_areas
from geocontact.systems.knee_posed import PosedKnee
from tests.systems.posed_knees import chain, poses

TIME, POSES = poses(24)


@pytest.fixture(scope="module")
def knee() -> PosedKnee:
    geometry = chain().geometry
    assert isinstance(geometry, PosedKnee)
    geometry.areas.at("t", TIME, POSES)
    return geometry


def moved(knee: PosedKnee, coordinate: int, share: float) -> np.ndarray:
    """All poses with one coordinate off by a share of its reach."""
    return POSES + share * knee.areas.reach * np.eye(6)[coordinate][:, None]


def test_recorded_poses_have_the_areas_of_the_surfaces(knee: PosedKnee) -> None:
    np.testing.assert_array_equal(knee.areas.at("t", TIME, POSES), knee.areas.direct(POSES))


@pytest.mark.parametrize("coordinate", range(6))
@pytest.mark.parametrize("share", [-1.0, 0.5])
def test_nodes_are_met(knee: PosedKnee, coordinate: int, share: float) -> None:
    rise = knee.areas.at("t", TIME, moved(knee, coordinate, share)) - knee.areas.direct(POSES)
    cut = knee.areas.direct(moved(knee, coordinate, share), AS_GIVEN) - knee.areas.direct(POSES, AS_GIVEN)
    np.testing.assert_allclose(rise, cut, rtol=0.0, atol=1e-9 * np.abs(cut).max())


@pytest.mark.parametrize("coordinate", range(6))
@pytest.mark.parametrize("share", [-0.75, 0.25, 0.4])
def test_between_the_nodes_the_error_is_small(knee: PosedKnee, coordinate: int, share: float) -> None:
    """Measured: at most 0.4 % of the area, 0.06 mm of the centre; areas change by up to 20 %."""
    pose = moved(knee, coordinate, share)
    found, exact = knee.areas.at("t", TIME, pose), knee.areas.direct(pose)
    assert np.abs(found[..., 0] / exact[..., 0] - 1.0).max() < 6e-3
    np.testing.assert_allclose(found[..., 1] / found[..., 0], exact[..., 1] / exact[..., 0], atol=1e-4)


def test_several_coordinates_together(knee: PosedKnee) -> None:
    rng = np.random.default_rng(3)
    pose = POSES + rng.uniform(-0.35, 0.35, POSES.shape) * knee.areas.reach
    found, exact = knee.areas.at("t", TIME, pose)[..., 0], knee.areas.direct(pose)[..., 0]
    assert np.abs(found / exact - 1.0).max() < 0.012
    changed = np.abs(exact / knee.areas.direct(POSES)[..., 0] - 1.0).max()
    assert changed > 0.1, "otherwise nothing was tested"


def test_beyond_reach_the_surfaces_are_asked(knee: PosedKnee) -> None:
    pose = POSES.copy()
    pose[3, 1:3] += 1.5 * knee.areas.reach[3]
    pose[4, 0] += 0.03
    found = knee.areas.at("t", TIME, pose)
    np.testing.assert_array_equal(found, knee.areas.direct(pose))
    assert (found[0] == 0.0).all(), "30 mm above there is no contact"


def test_mixed_differences_matter() -> None:
    """At 2 mm the error over random offsets is 0.3 % of the largest area; 1.1 % without them."""
    geometry = chain(threshold=2e-3).geometry
    assert isinstance(geometry, PosedKnee)
    grid = geometry.areas.grid(poses(12)[1])
    error, without = (geometry.areas.error(one) for one in (grid, replace(grid, mixed=np.zeros_like(grid.mixed))))
    assert error < 6e-3
    assert error < 0.5 * without


def test_an_error_that_is_too_large_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    geometry = chain().geometry
    assert isinstance(geometry, PosedKnee)
    monkeypatch.setattr(pose_areas, "TOLERATED", 1e-4)
    with pytest.warns(InputWarning, match=r"trial t: areas around its poses are interpolated with an error of 0\.\d %"):
        geometry.areas.at("t", TIME, POSES)
