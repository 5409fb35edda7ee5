"""Gait cycles: heel strikes as typed, from plates and from .c3d files; curves cut at them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.motion.gait_cycles import (
    cycles_figure,
    gait_cycles,
    strikes_marked,
    strikes_on_plates,
    strikes_typed,
)
from geocontact.data.errors import InputError
from geocontact.data.wrench import Wrench
from tests import legs

TIME = np.arange(501) / 100.0
UP = np.array([0.0, 1.0, 0.0])


def test_each_side_is_cut_at_its_own_strikes() -> None:
    """A cosine of 1.25 s: strikes at its crests for the right, half a period later for the left; the rest as right."""
    wave = np.cos(2.0 * np.pi * TIME / 1.25)
    values = np.column_stack([wave, wave, 3.0 + wave, np.full(len(TIME), 7.0)])
    strikes = {"left": 0.625 + 1.25 * np.arange(4), "right": 1.25 * np.arange(9)}
    names = ("knee_r", "knee_l", "pelvis_tilt", "mtp_r")
    cycles = gait_cycles(TIME, names, ("deg",) * 4, values, strikes)
    assert cycles.counts == {"right": 4, "left": 3}, "strikes beyond the recording do not count"
    shape = np.cos(2.0 * np.pi * np.arange(101) / 100.0)
    for name, expected in (("knee_r", shape), ("knee_l", -shape), ("pelvis_tilt", 3.0 + shape)):
        np.testing.assert_allclose(cycles.curves[name], np.broadcast_to(expected, cycles.curves[name].shape), atol=2e-3)
    assert "mtp_r" not in cycles.curves, "locked"
    table = cycles.table()
    assert table["knee_l_mean [deg]"][0] == pytest.approx(-1.0, abs=2e-3) and table["knee_l_sd [deg]"].max() < 1e-3
    shown = [axes for axes in cycles_figure(cycles).axes if axes.axison]
    assert [axes.get_ylabel() for axes in shown] == ["knee [deg]", "pelvis_tilt [deg]"]
    assert not gait_cycles(TIME, names, ("deg",) * 4, values, {"right": np.array([1.0])})


def test_plates_tell_strikes_by_the_side_of_their_bodies() -> None:
    """Right feet on from 1 to 1.7 and 2.2 to 2.9 s, left feet once; a body without a side tells nothing."""

    def load(*spans: tuple[float, float]) -> Wrench:
        on = np.any([np.logical_and(a <= TIME, b > TIME) for a, b in spans], axis=0)
        force = np.outer(np.where(on, 700.0, 0.0), UP)
        return Wrench(force, 0.0 * force, 0.0 * force, "ground")

    loads = {"calcn_r": load((1.0, 1.7), (2.2, 2.9)), "calcn_l": load((1.6, 2.3)), "hand": load((0.5, 0.9), (1.5, 2.0))}
    found = strikes_on_plates(TIME, loads, UP)
    np.testing.assert_allclose(found["right"], [1.0, 2.2], atol=0.01)
    assert set(found) == {"right", "left"} and len(found["left"]) == 0


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
    found = strikes_marked(tmp_path / "walk.c3d")
    np.testing.assert_allclose(found["right"], [1.25, 62.5], atol=1e-5)
    np.testing.assert_allclose(found["left"], [1.8], atol=1e-5)
    assert strikes_marked(tmp_path / "walk.trc") == {}


@pytest.mark.slow
def test_cycles_stand_on_the_page_and_in_a_table(tmp_path: Path) -> None:
    file, model, time, values = legs.planted(tmp_path)
    markers = legs.trc_file(tmp_path, legs.markers_of(model, time, values))
    angles = gc.inverse_kinematics(markers, model=file, events="right=0.1,0.3,0.5")
    assert angles.table("cycles").shape == (101, 1 + 2 * 11)
    folder = angles.write(tmp_path / "ik")
    assert (folder / "cycles.csv").exists()
    assert "Over the gait cycle" in (folder / "report.html").read_text(encoding="utf-8")
    with pytest.warns(gc.InputWarning, match="nothing but gravity acts"):
        moments = gc.inverse_dynamics(folder / "ik.mot", model=file, events=("right=0.1,0.3,0.5",))
    assert [name for name in moments.table("cycles") if name.startswith("knee_")] == [
        "knee_mean [N m/kg]",
        "knee_sd [N m/kg]",
    ]
    knee, mass = moments.table()["knee_moment [N m]"], sum(legs.BODIES.values())
    expected = 0.5 * (knee[10] + knee[30]) / mass
    assert moments.table("cycles")["knee_mean [N m/kg]"][0] == pytest.approx(expected, rel=1e-6)
