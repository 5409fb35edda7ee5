"""A mat on a scan: loads, uncertainty, what is said of a recording."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.frame.options import declared
from geocontact.analyses.mat.options import MatOptions
from tests.analyses.mat.samples import (
    CENTRE,
    COLS,
    FORCE,
    LAYOUT,
    MOMENT,
    ROWS,
    called,
    flat,
    marks,
    refusal,
    shipped,
    truth,
    uniform,
)
from tests.cli.calls import MESHES, written

WINDOWS = ((0.0, 0.5), (3.4, 3.9))


def test_a_uniform_pressure_has_its_closed_form(tmp_path: Path) -> None:
    result = flat(tmp_path, uniform())
    ours, force = result.table(), 10e3 * 12 * 1e-4
    np.testing.assert_allclose(ours[FORCE], [[0.0, 0.0, -force]] * 50, atol=1e-9)
    # r × F with r = (0.04, 0.045, 0) and F = (0, 0, -force)
    np.testing.assert_allclose(ours[MOMENT], [[-0.045 * force, 0.04 * force, 0.0]] * 50, atol=1e-9)
    np.testing.assert_allclose(ours["perpendicular [N]"], force, rtol=1e-9)
    np.testing.assert_allclose(ours["area [mm^2]"], 1200.0, rtol=1e-9)
    np.testing.assert_allclose(ours[CENTRE], [[40.0, 45.0, 0.0]] * 50, atol=1e-6)
    cells = result.table("cells")
    assert len(cells) == 12
    np.testing.assert_allclose(cells.loc[0, ["x [m]", "y [m]", "z [m]"]].astype(float), [0.025, 0.035, 0.0], atol=1e-9)
    assert list(result.tables()) == ["wrench", "uncertainty", "cells", "frames_cells"]
    assert list(result.table("frames_cells").columns[:2]) == ["time [s]", "c0 [Pa]"]


def test_fields_are_what_the_tables_show(tmp_path: Path) -> None:
    result = flat(tmp_path, uniform())
    np.testing.assert_array_equal(result.table()[FORCE], result.loads.wrench.force)
    np.testing.assert_array_equal(result.table()["normal [N]"], result.loads.pressing)
    np.testing.assert_array_equal(result.table("frames_cells").iloc[:, 1:], result.pressure)
    sd = np.sqrt(np.diagonal(result.uncertainty, axis1=1, axis2=2))
    np.testing.assert_array_equal(result.table("uncertainty").iloc[:, 1:], sd)
    assert result.surface.name == "skin.obj" and result.drape.covered.all() and result.agreement is None


def test_the_result_says_what_was_found(tmp_path: Path) -> None:
    result = flat(tmp_path, uniform(), layout=LAYOUT + "saturation_kPa = 10.0\n")
    assert str(result).splitlines() == [
        (
            "the result contradicts its data, and its numbers must not be used: "
            "cells clip on 100% of the area under the largest force"
        ),  # every cell is at its end: what presses is unknown
        "force up to 12.0 N at 0 s (sum of pressure × area), pressure up to 10.0 kPa, area up to 12 cm²",
        "warning: 12 cells clip at 10 kPa, in 100% of the frames: forces are too low",
        "warning: the mat never reads less than 12 N: if it was unloaded at some time, give this time as `unloaded`",
    ]
    assert result.figure() is not None


def test_a_loaded_corner_shows_where_it_is(tmp_path: Path) -> None:
    pressure = uniform(40, 0.0)
    pressure[:, 3, 0] = 50.0
    ours = flat(tmp_path, pressure, gate=0.0).table()
    np.testing.assert_allclose(ours[["cop_x [mm]", "cop_y [mm]"]], [[55.0, 35.0]] * 40, atol=1e-6)


def test_moments_refer_to_the_point_and_the_frame_has_its_name(tmp_path: Path) -> None:
    result = flat(tmp_path, uniform(), point="40,45,-7", frame="thigh")
    np.testing.assert_allclose(result.table()[MOMENT], 0.0, atol=1e-9)
    np.testing.assert_allclose(result.loads.wrench.origin[0], [0.04, 0.045, -0.007])
    assert result.loads.wrench.frame == "thigh"


@pytest.mark.parametrize(("touched", "area", "mean"), [(1e3, 1200.0, 6.5e3), (5e3, 600.0, 10e3)])
def test_area_and_mean_pressure_are_those_of_touched_cells(
    tmp_path: Path, touched: float, area: float, mean: float
) -> None:
    pressure = uniform(30, 10.0)
    pressure[:, :2] = 3.0
    result = flat(tmp_path, pressure, touched=touched, segment=("all=x > 0",))
    for table in (result.table(), result.table("segments")):
        np.testing.assert_allclose(table["area [mm^2]"], area, rtol=1e-9)
        np.testing.assert_allclose(table["mean [Pa]"], mean, rtol=1e-9)


def test_segments_share_the_force(tmp_path: Path) -> None:
    parts = flat(tmp_path, uniform(), segment=("near=x < 40", "far=x > 40")).table("segments")
    force = {name: group["normal [N]"].iloc[0] for name, group in parts.groupby("segment")}
    assert force == pytest.approx({"near": 6.0, "far": 6.0})


def test_a_segment_may_be_a_file_of_faces(tmp_path: Path) -> None:
    """The two faces of each square with x < 40 are the first 20."""
    faces = written(tmp_path / "near.txt", "\n".join(map(str, range(20))) + "\n")
    result = flat(tmp_path, uniform(), segment=(f"near={faces}", "far=x > 40"))
    assert [part.pressing[0] for part in result.segments.values()] == pytest.approx([6.0, 6.0])
    assert "`segment`" in {each["role"] for each in result.record.inputs}


def test_segments_that_leave_cells_out_are_told(tmp_path: Path) -> None:
    (line,) = (each for each in flat(tmp_path, uniform(), segment=("near=x < 40",)).warnings if "segment" in each)
    assert line == "6 cells are in no segment: segments do not add up to the whole"


def test_offset_and_drift_go_with_unloaded_frames(tmp_path: Path) -> None:
    time = 0.02 * np.arange(200)
    pressure = np.zeros((200, ROWS, COLS))
    pressure[60:140] = 20.0
    clean = flat(tmp_path, pressure).table()
    off = flat(tmp_path, pressure + 1.0 + 0.3 * time[:, None, None], unloaded=WINDOWS).table()
    np.testing.assert_allclose(off["normal [N]"], clean["normal [N]"], atol=1e-6)


@pytest.mark.parametrize("given", [(0.0, 0.5), [0.0, 0.5], ((0.0, 0.5),)])
def test_one_window_need_not_be_one_of_several(given: object) -> None:
    (unloaded,) = (one for one in declared(MatOptions) if one.name == "unloaded")
    assert [tuple(each) for each in unloaded.coerced(given)] == [(0.0, 0.5)]


def test_the_filter_takes_quick_noise_off(tmp_path: Path) -> None:
    pressure = np.maximum(20.0 + 5.0 * np.random.default_rng(0).standard_normal((200, ROWS, COLS)), 0.0)
    rough, smooth = (flat(tmp_path, pressure, cutoff=cutoff).table()["normal [N]"] for cutoff in (0.0, 6.0))
    assert smooth.iloc[20:-20].std() < 0.7 * rough.iloc[20:-20].std()
    assert smooth.mean() == pytest.approx(rough.mean(), rel=0.01)


def test_uncertainty_follows_what_is_stated(tmp_path: Path) -> None:
    result = flat(tmp_path, uniform(), accuracy=0.2, gain=0.05, registration=(0.0, np.radians(2.0)))
    sd = result.table("uncertainty").iloc[0]
    own = 0.2 * 10e3 * 1e-4 * np.sqrt(12)
    assert sd["sd_fz [N]"] == pytest.approx(np.hypot(own, 0.05 * 12.0), rel=1e-6)
    assert sd["sd_fx [N]"] == pytest.approx(np.radians(2.0) * 12.0, rel=1e-6)


def test_saturation_and_dead_cells_are_told(tmp_path: Path) -> None:
    result = flat(tmp_path, uniform(), layout=LAYOUT + "saturation_kPa = 10.0\ndead = [[0, 0]]\n")
    assert any("11 cells clip at 10 kPa" in line for line in result.warnings)
    assert result.table()["normal [N]"].iloc[0] == pytest.approx(11.0)


def test_a_mat_that_hangs_over_leaves_its_cells_out(tmp_path: Path) -> None:
    over = marks(tmp_path, "a,0,0,80,30,0", "b,1,0,90,30,0", "c,0,3,80,60,0", name="over.csv")
    result = flat(tmp_path, uniform(), landmarks=over)
    assert any("6 cells reach beyond the edge" in line for line in result.warnings)
    assert result.table()["normal [N]"].iloc[0] == pytest.approx(6.0)


def test_the_misses_of_the_landmarks_make_the_wrench_uncertain(tmp_path: Path) -> None:
    """Corners of the mat pulled apart by 1 mm along x: s^2 = 4/5 mm^2, s^2/4 of the shift, s^2/2500 of the turn."""
    apart = marks(tmp_path, "a,0,0,19,30,0", "b,4,0,61,30,0", "c,0,3,19,60,0", "d,4,3,61,60,0", name="apart.csv")
    result = flat(tmp_path, uniform(), landmarks=apart, point="40,45,0", accuracy=1e-5)
    place = result.record.results["uncertainty"]
    shift, turn = np.sqrt(0.8 / 4), np.sqrt(0.8 / 2500.0)
    assert place["place"] == "residual of the mat's landmarks" and place["degrees_of_freedom"] == 5.0
    assert place["sd_shift_mm"] == pytest.approx([shift, shift, 0.0], rel=1e-6, abs=1e-9)
    assert place["sd_turn_deg"] == pytest.approx([0.0, 0.0, np.degrees(turn)], rel=1e-6, abs=1e-9)
    sd = result.table("uncertainty").iloc[0]
    assert sd[["sd_mx [N m]", "sd_my [N m]"]].to_numpy(float) == pytest.approx([12.0 * shift * 1e-3] * 2, rel=1e-6)
    assert sd[["sd_fx [N]", "sd_fy [N]"]].abs().max() < 1e-9, "a flat mat turns about its force"


def test_an_offset_below_zero_is_taken_off_before_anything_is_cut_at_zero(tmp_path: Path) -> None:
    pressure = np.zeros((200, ROWS, COLS))
    pressure[60:140] = 20.0
    result = flat(tmp_path, pressure - 2.0, unloaded=WINDOWS)
    assert any("pressures of 'mat' below 0" in line for line in result.warnings)
    assert result.table()["normal [N]"].iloc[100] == pytest.approx(20e3 * 12e-4, rel=1e-6)


def test_noise_about_zero_does_not_become_force(tmp_path: Path) -> None:
    """An unloaded mat with 0.5 kPa of white noise reads nothing on average, not half of the noise of every cell."""
    noise = 1.0 + 0.5 * np.random.default_rng(8).standard_normal((400, ROWS, COLS))
    noise[100:300] += 5.0 * np.sin(np.pi * np.arange(200) / 200)[:, None, None]
    result = flat(tmp_path, noise, unloaded=((0.0, 1.9), (6.1, 7.9)))
    force = result.table()["normal [N]"].to_numpy()
    sd = 500.0 * 1e-4 * np.sqrt(12.0)
    assert abs(force[:95].mean()) < 4.0 * sd / np.sqrt(95.0)
    assert force[:95].std() == pytest.approx(sd, rel=0.3)
    loaded = 5e3 * 12e-4 * np.sin(np.pi * np.arange(200) / 200)
    assert abs((force[100:300] - loaded).mean()) < 4.0 * sd / np.sqrt(200.0)
    assert result.record.results["below_zero"]["lowest_Pa"] < -800.0
    assert not [line for line in result.warnings if "`gate`" in line]
    assert np.isfinite(result.table()["cop_x [mm]"].iloc[180:220]).all()


def test_an_offset_that_was_none_is_told(tmp_path: Path) -> None:
    """The window holds load, which is then missing from every frame."""
    pressure = np.zeros((200, ROWS, COLS))
    pressure[:60] = 20.0
    (line,) = flat(tmp_path, pressure, unloaded=((0.0, 0.5),)).warnings
    assert line == "cells that read below 0 sum to -24.0 N in one frame: check `unloaded` and the offset"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"touched": 0.0}, "`touched`: 0 kPa cannot be the pressure of a touch"),
        ({"accuracy": -0.1}, "`accuracy`: -10 % cannot be a share"),
        ({"gain": float("nan")}, "`gain`: nan is not a finite number"),
        ({"registration": (-1e-3, 0.0)}, "`registration`: -1 mm cannot be how far things are off"),
    ],
)
def test_numbers_that_cannot_be_are_refused_in_python_too(tmp_path: Path, options: dict, said: str) -> None:
    with refusal(said):
        flat(tmp_path, uniform(), **options)


def test_files_are_not_read_before_options_are_refused(tmp_path: Path) -> None:
    with refusal("`gate`: -1 N cannot be the force of a person"):
        called(tmp_path / "no.csv", surface=tmp_path / "no.stl", landmarks=tmp_path / "no_marks.csv", gate=-1.0)


def test_a_mat_that_is_far_larger_than_the_scan_is_refused(tmp_path: Path) -> None:
    with refusal("skin.obj: the scan spans 141.4 mm and the mat 500 mm; the file looks like cm"):
        flat(tmp_path, uniform(), LAYOUT.replace("10.0", "100.0"))


SHIPPED = {
    "thigh": ("mat_thigh_16x8", 0.006, 1.0),
    "torso": ("mat_torso_32x8", 0.006, 1.0),
    "shank": ("mat_shank_16x8", 0.012, 1.2),
    "upper_arm": ("mat_upper_arm_16x8", 0.023, 1.5),
}


@pytest.mark.parametrize("surface", SHIPPED)
def test_the_shipped_recordings_give_the_wrench_of_their_closed_forms(surface: str) -> None:
    """Share of the force and arm [mm]: shank and upper arm are so round that an evened-out mat lies 2 mm
    away from the ribs of the recording, and that the skin under a cell is 1 % larger than the cell."""
    folder, largest, arm = SHIPPED[surface]
    result, exactly = shipped(MESHES / folder, surface=MESHES / f"{surface}.stl"), truth(MESHES / folder)
    assert result.warnings == ()
    pressed = exactly["normal [N]"] > 0.25 * exactly["normal [N]"].max()
    ours, exactly = result.table()[pressed], exactly[pressed]

    def off(names: list[str]) -> np.ndarray:
        return np.linalg.norm(ours[names].to_numpy() - exactly[names].to_numpy(), axis=1)

    force = np.linalg.norm(exactly[FORCE], axis=1)
    assert (off(FORCE) / force).max() < largest
    assert off(CENTRE).max() < arm
    assert (off(MOMENT) < 1e-3 * arm * force).all()


@pytest.mark.parametrize(
    ("kind", "layout", "options", "off"),
    [("quantised", "layout", {}, 0.5), ("faulty", "layout_faulty", {"unloaded": ((0.0, 0.3), (2.8, 3.0))}, 5.0)],
)
def test_coarse_and_faulty_recordings_stay_near_the_truth(kind: str, layout: str, options: dict, off: float) -> None:
    """Offset, drift, clipping at 26 of 30 kPa and two dead cells under the load, of 79 N."""
    given = MESHES / "mat_thigh_16x8"
    result = shipped(frames=f"frames_{kind}", layout=given / f"{layout}.toml", **options)
    assert np.abs(result.table()["normal [N]"] - truth()["normal [N]"]).max() < off
    assert any("cells clip at 26 kPa" in line for line in result.warnings) == (kind == "faulty")


@pytest.mark.parametrize(
    ("unit", "kpa", "said"),
    [
        ("MPa", 21.0, "is 21 MPa, more than 2 MPa, implausible for skin under load; is the file in kPa?"),
        ("Pa", 21.0, "is 21 Pa, less than 100 Pa, implausible for skin under load; is the file in kPa?"),
        (
            "kPa",
            21e3,
            "is 2.1e+04 kPa, more than 2 MPa, implausible for skin under load; is the file in Pa?",
        ),
    ],
)
def test_pressures_that_no_skin_bears_name_the_unit_that_may_be_meant(
    tmp_path: Path, unit: str, kpa: float, said: str
) -> None:
    result = flat(tmp_path, uniform(kpa=kpa), layout=LAYOUT.replace('"kPa"', f'"{unit}"'))
    assert [line for line in result.warnings if "implausible for skin" in line and said in line], result.warnings


def test_pressures_of_a_body_are_not_doubted(tmp_path: Path) -> None:
    for kpa in (1.0, 1500.0):
        assert not any("implausible for skin" in line for line in flat(tmp_path, uniform(kpa=kpa)).warnings)
