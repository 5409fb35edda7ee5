"""Congruence in the area analysis: columns where it is asked for, what it says, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from tests.analyses.area.calls import area
from tests.cli.calls import FEMUR, INSERT, SPHERE, gait, poses

COLUMNS = [f"relative_curvature_{end} [1/mm]" for end in ("min", "max")] + ["congruence_index [1/mm]"]


def test_a_ball_on_a_ball_has_twice_its_curvature(tmp_path: Path) -> None:
    """A tenth of 1/mm at both thresholds and in both frames; nothing where the ball is away; no columns unasked."""
    motion = poses(tmp_path, (0, 40.2, 0), (24, 0, 32.3), (0, 80, 0))
    result = area(SPHERE, SPHERE, motion, threshold=(1e-3, 2e-3), congruence=4e-3)
    table = result.table()
    for name in COLUMNS:
        np.testing.assert_allclose(table[name][:4], 0.1, rtol=0.02)
        assert table[name][4:].isna().all()
    np.testing.assert_allclose(table["congruence_share [-]"][:4], 1.0)
    assert "index of congruence within 1 mm: 0.1" in str(result) and "fitted within 4 mm" in str(result)
    assert result.record.results["congruence"]["radius_mm"] == pytest.approx(4.0)
    plain = area(SPHERE, SPHERE, motion, threshold=(1e-3, 2e-3))
    assert not any("congruence" in name or "curvature" in name for name in plain.table())
    assert plain.table().equals(table[list(plain.table())])


def test_a_radius_with_too_few_vertices_is_refused(tmp_path: Path) -> None:
    motion = poses(tmp_path, (0, 40.2, 0))
    # one cause where both were named before: a larger radius is tried, and works
    with pytest.raises(InputError, match=r"`congruence`: no congruence .*too few vertices.* give `congruence` 5.1mm"):
        area(SPHERE, SPHERE, motion, threshold=1e-3, congruence=0.5e-3)
    some = area(SPHERE, SPHERE, motion, threshold=4e-3, congruence=2.15e-3)
    assert 0.2 < some.table()["congruence_share [-]"][0] < 0.6
    assert any("the index of congruence is over" in line for line in some.warnings)


def test_a_threshold_without_congruence_leaves_the_others_theirs(tmp_path: Path) -> None:
    """The few vertices within 0.3 mm have too few neighbours for a curvature; some within 4 mm have enough."""
    motion = poses(tmp_path, (23.2, 23.2, 23.3))
    result = area(SPHERE, SPHERE, motion, threshold=(0.3e-3, 4e-3), congruence=2.15e-3)
    first, second = result.table()["congruence_index [1/mm]"]
    assert np.isnan(first) and second == pytest.approx(0.1, rel=0.05)
    assert any("no index of congruence within 0.3 mm" in line for line in result.warnings)


def test_the_shipped_knee_has_no_index_over_a_twentieth_of_its_area(tmp_path: Path) -> None:
    """4 mm reach the first neighbours of 3.2 mm edges only; the radius proposed gives one over most of the area."""
    motion = gait(tmp_path)
    few = area(FEMUR, INSERT, motion, congruence=4e-3)
    table = few.table()
    assert table[COLUMNS].isna().all(axis=None)
    assert table["congruence_share [-]"].between(0.0, 0.1).all()
    (line,) = [line for line in few.warnings if "congruence" in line]
    assert line.startswith("no index of congruence within 4 mm in 2 of 2 frames: both curvatures are known over ")
    assert "edges of the meshes are 3.2 and 2.2 mm at the median, give `congruence` 7.9mm" in line
    assert not any("congruence" in line for line in few.sentences)
    found = area(FEMUR, INSERT, motion, congruence=8e-3)
    assert (found.table()["congruence_share [-]"] > 0.8).all()
    assert found.table()[COLUMNS].notna().all(axis=None)
    assert not any("no index" in line for line in found.warnings)


def test_surfaces_that_do_not_face_each_other_get_no_radius_proposed(tmp_path: Path) -> None:
    """Two balls deep in each other: whatever lies within the other looks the same way, with any radius."""
    with pytest.raises(InputError, match=r"no radius to 10\.1 mm does better, so the surfaces do not face each other"):
        area(SPHERE, SPHERE, poses(tmp_path, (0, 3, 0)), threshold=1e-3, congruence=4e-3)
