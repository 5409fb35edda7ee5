"""Gait cycles: heel strikes as typed and from .c3d files; the table, the figure and the page of curves cut at them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.motion.gait_cycles import (
    cycles_curves,
    cycles_table,
    events_given,
    strikes_and_offs,
    strikes_typed,
)
from geocontact.data.errors import InputError
from geocontact.identify.signals.gait_cycles import gait_cycles
from geocontact.view.curves.declared import CurveSheet
from geocontact.view.curves.drawn import drawn
from tests import legs

TIME = np.arange(501) / 100.0


def test_the_table_and_the_figure_of_both_sides() -> None:
    """A cosine of 1.25 s, half a period later on the left: mean -1 at its strike; both knees share a panel."""
    wave = np.cos(2.0 * np.pi * TIME / 1.25)
    values = np.column_stack([wave, wave, 3.0 + wave])
    strikes = {"left": 0.625 + 1.25 * np.arange(4), "right": 1.25 * np.arange(5)}
    cycles = gait_cycles(TIME, ("knee_r", "knee_l", "pelvis_tilt"), ("deg",) * 3, values, strikes)
    table = cycles_table(cycles)
    assert table["knee_l_mean [deg]"][0] == pytest.approx(-1.0, abs=2e-3) and table["knee_l_sd [deg]"].max() < 1e-3
    knee, pelvis = cycles_curves(cycles)
    assert (knee.title, knee.unit, pelvis.title) == (
        "knee over the gait cycle",
        "deg",
        "pelvis_tilt over the gait cycle",
    )
    assert [curve.name for curve in knee.curves] == ["right, mean ± SD (n = 4)", "left, mean ± SD (n = 3)"]
    assert knee.over is not None and knee.over.values[[0, -1]].tolist() == [0.0, 100.0]
    assert np.array_equal(knee.curves[1].values, table["knee_l_mean [deg]"])
    assert [axes.get_title(loc="left") for axes in drawn(CurveSheet([knee, pelvis])).axes] == [knee.title, pelvis.title]


def test_typed_strikes() -> None:
    found = strikes_typed(("Right=0.6,1.8,3", "left=1.2, 2.4"))
    assert found["right"].tolist() == [0.6, 1.8, 3.0] and found["left"].tolist() == [1.2, 2.4]
    for text in ("both=1,2", "right", "right=1", "right=2,1", "right=a,b"):
        with pytest.raises(InputError, match="`events`"):
            strikes_typed((text,))


def test_strikes_that_a_c3d_file_marks(tmp_path: Path) -> None:
    ezc3d = pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    content = ezc3d.c3d()
    content["parameters"]["POINT"]["RATE"]["value"] = [100.0]
    content["parameters"]["POINT"]["LABELS"]["value"] = ["M0"]
    content["data"]["points"] = np.ones((4, 1, 500))
    content.add_parameter("EVENT", "CONTEXTS", ["Right", "Left", "Right", "Right"])
    content.add_parameter("EVENT", "LABELS", ["Foot Strike", "Foot Strike", "Foot Off", "Foot Strike"])
    content.add_parameter("EVENT", "TIMES", np.array([[0.0, 0.0, 0.0, 1.0], [1.25, 1.8, 1.9, 2.5]]))
    content.write(str(tmp_path / "walk.c3d"))
    found, offs = strikes_and_offs(events_given((), tmp_path / "walk.c3d"), "walk")
    np.testing.assert_allclose(found["right"], [1.25, 62.5], atol=1e-5)
    np.testing.assert_allclose(found["left"], [1.8], atol=1e-5)
    np.testing.assert_allclose(offs["right"], [1.9], atol=1e-5)
    assert events_given((), tmp_path / "walk.trc") == ()


@pytest.mark.slow
def test_cycles_stand_on_the_page_and_in_a_table(tmp_path: Path) -> None:
    file, model, time, values = legs.planted(tmp_path)
    markers = legs.trc_file(tmp_path, legs.markers_of(model, time, values))
    angles = gc.inverse_kinematics(markers, model=file, events="right=0.1,0.3,0.5")
    assert angles.table("cycles").shape == (101, 1 + 2 * 11)
    folder = angles.write(tmp_path / "ik")
    assert (folder / "cycles.csv").exists()
    assert "over the gait cycle" in (folder / "report.html").read_text(encoding="utf-8")
    with pytest.warns(gc.InputWarning, match="only gravity acts"):
        moments = gc.inverse_dynamics(folder / "ik.mot", model=file, events=("right=0.1,0.3,0.5",))
    assert [name for name in moments.table("cycles") if name.startswith("knee_")] == [
        "knee_mean [N m/kg]",
        "knee_sd [N m/kg]",
    ]
    knee, mass = moments.table()["knee_moment [N m]"], sum(legs.BODIES.values())
    expected = 0.5 * (knee[10] + knee[30]) / mass
    assert moments.table("cycles")["knee_mean [N m/kg]"][0] == pytest.approx(expected, rel=1e-6)
