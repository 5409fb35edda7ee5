"""Bands of elevation and forces under errors of the arm's markers."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.shoulder.devices import wearer_named
from geocontact.analyses.shoulder.simulate.marker_band import displaced
from tests.shoulder_exoskeleton.arms import lifted

TRIAL = "meshes/overhead_P1T1S100/markers.trc"


def test_a_marker_that_is_off_stays_so_on_the_arm() -> None:
    """Distances from the true markers are constant, and both markers shifted along the arm keep its elevation."""
    motion = lifted()
    lower, upper = np.array([3e-3, -4e-3, 5e-3]), np.array([1e-3, 2e-3, -1e-3])
    moved = displaced(motion, lower, upper)
    for own, true, off in ((moved.interface, motion.interface, lower), (moved.shoulder, motion.shoulder, upper)):
        np.testing.assert_allclose(np.linalg.norm(own - true, axis=1), np.linalg.norm(off), atol=1e-12)
    along = (motion.interface - motion.shoulder) / np.linalg.norm(motion.interface - motion.shoulder, axis=1)[:, None]
    np.testing.assert_allclose(np.einsum("ti,ti->t", moved.interface - motion.interface, along), -5e-3, atol=1e-12)
    slid = displaced(motion, np.array([0.0, 0.0, 2e-3]), np.array([0.0, 0.0, 2e-3]))
    np.testing.assert_allclose(slid.elevation, np.asarray(motion.elevation), atol=1e-9)


def test_the_band_holds_the_motion_and_widens_with_the_error() -> None:
    given = {"side": "right", "level": 1.0, "upright": "0:0.5", "time": "0:1.5", "draws": 20}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        small, large = (gc.shoulder.simulate(TRIAL, marker_error=error, **given) for error in ("1mm", "4mm"))
        again = gc.shoulder.simulate(TRIAL, marker_error="4mm", **given)
    width = []
    for one in (small, large):
        table = one.tables()["marker_band"]
        own = np.degrees(one.arms[0].simulation.elevation)
        inside = (table["elevation lower [deg]"] <= own) & (own <= table["elevation upper [deg]"])
        assert inside.mean() > 0.9
        width.append((table["supporting upper [N]"] - table["supporting lower [N]"]).mean())
    assert 2.0 < width[1] / width[0] < 8.0
    np.testing.assert_array_equal(large.tables()["marker_band"].iloc[:, 1:], again.tables()["marker_band"].iloc[:, 1:])
    assert any("markers off by 4 mm (standard deviation)" in line for line in large.sentences)


def test_draws_are_enough_for_a_band() -> None:
    with pytest.raises(gc.InputError, match="`draws`: 5 is not between 20 and 1000"):
        gc.shoulder.simulate(TRIAL, marker_error="2mm", draws=5)


def test_a_torso_that_changes_nothing_is_warned_of(tmp_path: Path) -> None:
    file = tmp_path / "person.toml"
    file.write_text('torso = { value = 480, unit = "mm" }\n', encoding="utf-8")
    with pytest.warns(gc.InputWarning, match="torso changes no arm and no force"):
        wearer_named(file)
    assert wearer_named(file, back=True).torso == pytest.approx(0.48)
