"""Markers in other axes than the model's, and markers whose names are exchanged, on a synthetic leg."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import geocontact as gc
from geocontact.analyses.motion.markers import axes_upright
from tests import legs

UP = np.array([0.0, 1.0, 0.0])


def solved(folder: Path, markers, **options) -> list[str]:
    """What inverse kinematics warns of."""
    file = legs.model_file(folder)
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        gc.inverse_kinematics(legs.trc_file(folder, markers), model=file, **options)
    return [str(each.message) for each in heard]


def recorded(folder: Path):
    """Markers of a few frames in the model's axes."""
    _, model, time, values = legs.planted(folder)
    return legs.markers_of(model, time[::10], values[::10])


@pytest.mark.parametrize(
    ("turn", "given", "meant"),
    [
        (Rotation.from_euler("x", 90, degrees=True), None, "x,z,-y"),  # z is up in the file
        (Rotation.from_euler("z", 90, degrees=True), None, "y,-x,z"),  # -x is up
        (Rotation.identity(), "x,z,-y", "x,y,z"),  # turned although it was right
    ],
)
def test_a_subject_on_its_side_is_told_with_the_axes_that_would_mend_it(tmp_path: Path, turn, given, meant) -> None:
    markers = recorded(tmp_path)
    options = {} if given is None else {"axes": given}
    (line,) = [w for w in solved(tmp_path, markers.turned(turn), **options) if "from upright" in w]
    assert "pelvis is 9" in line or "pelvis is 8" in line
    suggested = line.rpartition("`axes` ")[2]
    assert suggested == meant
    assert not any("from upright" in w for w in solved(tmp_path, markers.turned(turn), axes=suggested))


def test_who_stands_is_not_warned_of(tmp_path: Path) -> None:
    assert not solved(tmp_path, recorded(tmp_path))
    assert not solved(tmp_path, recorded(tmp_path).turned(Rotation.from_euler("y", 90, degrees=True)))


@pytest.mark.parametrize("found", [v for k in range(3) for v in (np.eye(3)[k], -np.eye(3)[k])])
def test_suggested_axes_turn_what_is_up_into_up(found: np.ndarray) -> None:
    from geocontact.analyses.frame.places import turned_axes

    np.testing.assert_allclose(turned_axes(axes_upright(found, UP), "`axes`").apply(found), UP, atol=1e-12)
    after = turned_axes(axes_upright(found, UP, turned_axes("z,x,y", "`axes`")), "`axes`")
    np.testing.assert_allclose(after.apply(turned_axes("z,x,y", "`axes`").inv().apply(found)), UP, atol=1e-12)


@pytest.mark.parametrize(
    "pairs",
    [(("femur_r0", "tibia_r1"),), (("pelvis0", "foot_r2"),), (("femur_r0", "tibia_r1"), ("pelvis1", "foot_r0"))],
)
def test_exchanged_markers_are_named_and_the_map_mends_them(tmp_path: Path, pairs) -> None:
    markers = recorded(tmp_path)
    swapped = markers.renamed({a: b for pair in pairs for a, b in (pair, pair[::-1])})
    (line,) = [w for w in solved(tmp_path, swapped) if "exchanged?" in w]
    named = {
        frozenset(part.split(" and ")) for part in line.split("are markers ")[1].split(" exchanged?")[0].split(", ")
    }
    assert named == {frozenset(pair) for pair in pairs}
    assert "would leave 0.0 mm in place of" in line
    mapped = line.rpartition("`markers_map` ")[2]
    assert not solved(tmp_path, swapped, markers_map=mapped)


def test_markers_far_away_for_another_reason_are_not_called_exchanged(tmp_path: Path) -> None:
    markers = recorded(tmp_path)
    markers.positions[:, 3] += [0.2, 0.1, 0.0]
    told = solved(tmp_path, markers)
    assert any("mm from the model" in w for w in told)
    assert not any("exchanged?" in w for w in told)
