"""The page of a contact-area analysis says what the table says."""

from dataclasses import replace

import numpy as np
import pytest

from geocontact.analyses.area import page as contact_page
from geocontact.analyses.area.page import thinned_page
from geocontact.analyses.frame import pages as finished_page
from geocontact.analyses.frame.record import Record
from geocontact.analyses.frame.words import NOT_A_DEVICE
from geocontact.geometry.contact_area.area import AS_GIVEN, Refinement
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.view.page.content import Curves, Readout, Scene, Strip, Table, Words
from geocontact.view.page.tables import inputs_table
from geocontact.view.page.write import page_html
from geocontact.view.surfaces.camera import camera_directions
from meshes.simple_shapes import sphere
from tests.analyses.area.ball_on_plate import MM, WIDE, R, T, analysed, moved, page, section, swept, told


def test_where_how_much_and_when_are_said_at_the_top():
    found, evolution = page()
    said = dict(found.facts)
    largest = evolution.fixed.area[2, 1] * 1e6
    assert found.opening == 2
    assert said["Largest contact area on the fixed body"] == f"{largest:.0f} mm² at 0.2 s"
    assert said["Range over the motion"].startswith(f"0 … {largest:.0f} mm²")
    assert said["Smallest distance"] == f"{evolution.min_distance[2] * 1e3:.2f} mm at 0.2 s"
    assert "50% medial, 50% lateral" in said["Centre of the patch, at 0.2 s"]


def test_overlap_is_called_overlap():
    found, _ = page((20.5, 19.5))
    assert dict(found.facts)["Deepest overlap"] == "0.50 mm at 0.1 s"


def test_no_contact_at_all_has_no_place():
    found, _ = page((30.0, 31.0))
    assert not any(label.startswith("Where") for label, _ in found.facts)
    assert found.headline[0].startswith("plate never comes within 4 mm of ball: at its nearest it is 10 mm away")
    assert section(found, Readout).rows[-1].texts == ["–", "–"]


def test_numbers_under_the_cursor_are_those_of_the_table():
    found, evolution = page()
    table = evolution.table().query("`threshold [mm]` == 4").reset_index(drop=True)
    rows = {row.label: row for row in section(found, Readout).rows}
    for label, column, digits in (
        ("contact area on the fixed body", "area_fixed [mm^2]", 2),
        ("upper bound (these meshes)", "area_fixed_upper [mm^2]", 2),
        ("medial part", "area_fixed_medial [mm^2]", 2),
        ("contact area on the moving body", "area_moving [mm^2]", 2),
        ("smallest distance", "min_distance [mm]", 3),
        ("centroid y", "centroid_y [mm]", 2),
    ):
        expected = ["–" if np.isnan(x) else f"{x:.{digits}f}" for x in table[column]]
        assert list(rows[label].texts) == expected, label
    assert rows["contact area on the fixed body"].unit == "mm²" and rows["smallest distance"].unit == "mm"


def test_curves_are_the_areas_with_their_bounds():
    found, evolution = page()
    areas, distance = (section(found, Curves, n) for n in range(2))
    names = [curve.name for curve in areas.curves]
    assert names == ["fixed body, 4 mm", "medial, 4 mm", "lateral, 4 mm", "fixed body, 1 mm"]
    np.testing.assert_allclose(areas.curves[0].values, evolution.fixed.area[:, 1] * 1e6)
    np.testing.assert_allclose(areas.curves[0].upper, evolution.fixed.upper[:, 1] * 1e6)
    np.testing.assert_allclose(areas.curves[1].values + areas.curves[2].values, areas.curves[0].values)
    np.testing.assert_allclose(areas.curves[3].lower, evolution.fixed.lower[:, 0] * 1e6)
    np.testing.assert_allclose(distance.curves[0].values, evolution.min_distance * 1e3)


def test_strip_meets_the_area_at_the_threshold():
    found, evolution = page()
    strip = section(found, Strip)
    assert strip.current == 4.0
    at = int(np.flatnonzero(np.isclose(strip.thresholds, 4.0))[0])
    np.testing.assert_allclose(strip.values[:, at], evolution.fixed.area[:, 1] * 1e6, rtol=1e-9)
    assert (np.diff(strip.values, axis=1) >= 0).all()


def test_scene_holds_both_bodies_and_their_maps():
    found, _ = page()
    scene = section(found, Scene)
    ground, ball = scene.bodies
    assert (ground.name, ball.name) == ("plate", "ball")
    assert ground.poses is None and len(ball.poses) == 4
    assert ball.poses[1].apply([0, 0, 0]) == pytest.approx([0, 21.0 * MM, 0])
    assert ball.distance[2].min() == pytest.approx(0.5 * MM, abs=1e-5)
    assert scene.thresholds == (1 * MM, T * MM)
    assert scene.span[1] == pytest.approx(6 * MM)


def test_words_hold_what_a_reviewer_looks_for():
    found, evolution = page()
    words = {s.title: " ".join(s.paragraphs) for s in found.sections if isinstance(s, Words)}
    assert "not a clinical device" in words["Context of use"] and NOT_A_DEVICE in words["Context of use"]
    assert "plate (fixed) lies within 4 mm of ball" in words["Question"]
    width = ((evolution.fixed.upper - evolution.fixed.lower)[:, 1] * 1e6).max()
    assert f"{width:.1f} mm² apart at most" in words["Numerical error"]


def test_mesh_statistics():
    found, _ = page()
    table = section(found, Table)
    ball = dict(zip(table.header, table.rows[0], strict=True))
    v, f = sphere(R, 8)
    assert (ball["vertices"], ball["faces"], ball["closed"]) == (str(len(v)), str(len(f)), "yes")
    assert ball["size [mm]"] == "40.0 × 40.0 × 40.0"


def test_long_motions_are_thinned_and_keep_the_frames_that_answer(monkeypatch):
    """Most contact and smallest distance are in frame 4 of 9, which no stride would show."""
    monkeypatch.setattr(contact_page, "FRAMES", 3)
    here = analysed((22.0, 24.0, 23.0, 20.5, 26.0, 20.8, 22.0, 23.0, 30.0), every=2)
    thinned = thinned_page(*here)
    found = thinned.of(thinned.most)
    frames = [k - 1 for k in found.numbers]
    assert 3 in frames and len(frames) <= 4 and found.total == 9 and frames[found.opening] == 3
    assert list(found.time) == pytest.approx([0.1 * k for k in frames])
    table = here[-2].table().query("`threshold [mm]` == 4")["area_fixed [mm^2]"].to_numpy()
    rows = {row.label: row for row in section(found, Readout).rows}
    assert list(rows["contact area on the fixed body"].texts) == [f"{table[k]:.2f}" for k in frames]
    ground, ball = section(found, Scene).bodies
    heights = here[2].poses.translation[frames, 1]
    assert ball.poses.translation[:, 1] == pytest.approx(heights)
    places = [here[-1].frames.index(k) for k in frames]
    np.testing.assert_array_equal(ground.distance, here[-1].fixed[places])
    np.testing.assert_array_equal(ball.distance, here[-1].moving[places])
    words = [p for s in found.sections if isinstance(s, Words) for p in s.paragraphs]
    assert any(f"{len(frames)} of 9 frames" in p for p in words)


def test_a_page_that_would_be_too_large_is_thinned_until_it_fits(tmp_path, monkeypatch):
    sizes = []
    monkeypatch.setattr(finished_page, "LARGEST_FILE", 1000)
    monkeypatch.setattr(finished_page, "write_page", lambda p, path: sizes.append(200 * len(p.time)) or sizes[-1])
    page = replace(thinned_page(*analysed(tuple(np.linspace(20.5, 24.0, 12)))), fewest=2)
    finished_page.write_finished(page, tmp_path / "r.html", Record("area", {}), "", ())
    assert sizes[0] == 2400 and sizes == sorted(sizes, reverse=True) and sizes[-1] <= 1000


def test_without_maps_there_is_no_page():
    *known, _ = analysed()
    with pytest.raises(ValueError, match=r"each=maps\.add"):
        thinned_page(*known, DistanceMaps(*known[:2]))


def test_maps_keep_every_so_many_frames_and_those_that_answer():
    heights = (22.0, 21.0, 24.0, 20.5, 30.0, 26.0, 30.0)
    ball, ground, *_, every = analysed(heights)
    maps = analysed(heights, every=2)[-1]
    assert maps.frames == [0, 2, 3, 4, 6] and maps.largest == maps.nearest == 3
    np.testing.assert_array_equal(maps.fixed, every.fixed[maps.frames])
    np.testing.assert_array_equal(maps.moving, every.moving[maps.frames])
    np.testing.assert_array_equal(maps.fixed_at_largest, every.fixed[3])
    assert maps.fixed.shape == (5, len(ground.vertices)) and maps.moving.shape == (5, len(ball.vertices))
    none = analysed(every=0)[-1]
    assert none.frames == [2] and none.largest == 2 and np.isfinite(none.fixed_at_largest).any()


@pytest.mark.parametrize("sign", [-1, 1])
def test_only_the_side_that_was_told_has_an_anatomical_name(sign):
    """On an insert y looks up and on a foot's scan it may not: nothing is superior, let alone plantar, by itself."""
    named = camera_directions(np.array([0.0, 0.0, sign]))
    medial, lateral = ("+z", "−z") if sign > 0 else ("−z", "+z")
    assert list(named) == [f"medial ({medial})", f"lateral ({lateral})", "+x", "−x", "+y", "−y"]
    assert named[f"medial ({medial})"] == (0, 0, sign) and named["−y"] == (0, -1, 0)


@pytest.mark.parametrize("medial", [(-1.0, 0.0, 0.0), (0.6, 0.8, 0.0)])
def test_a_side_across_any_axis_is_named(medial):
    named = camera_directions(np.array(medial))
    assert named[next(iter(named))] == medial and next(iter(named)).startswith("medial (")
    assert all(np.linalg.norm(way) == pytest.approx(1.0) for way in named.values())


def test_without_a_side_the_axes_are_named():
    assert list(camera_directions(np.zeros(3))) == ["+x", "−x", "+y", "−y", "+z", "−z"]


def test_inputs_are_listed_with_their_hashes():
    table = inputs_table([{"role": "moving", "file": "a/b.stl", "sha256": "00ff", "unit": "mm"}])
    assert table.rows == [("moving", "b.stl", "mm", "00ff")]


def test_colours_end_at_a_round_number_below_the_deepest_overlap():
    found, evolution = page((20.5, 18.7))
    lowest = section(found, Scene).span[0]
    assert lowest == pytest.approx(-1.5 * MM) and lowest <= evolution.min_distance.min() == pytest.approx(-1.3 * MM)


def test_a_sweep_runs_along_its_angle():
    found, _ = page(motion=swept([0.0, 45.0, 90.0]))
    assert found.time_label == "flexion [deg]" and list(found.time) == pytest.approx([0.0, 45.0, 90.0])
    assert dict(found.facts)["Largest contact area on the fixed body"].endswith("at flexion 0 deg")


def test_a_normalised_cycle_is_said():
    found, _ = page(motion=replace(moved((22.0, 20.5)), time_unit="%"))
    assert found.time_label == "cycle [%]"
    assert "at cycle 0.1 %" in dict(found.facts)["Largest contact area on the fixed body"]


def test_strip_holds_the_refined_area_where_it_has_one():
    settings = Settings((T * MM,), refinement=Refinement(), sensitivity=WIDE)
    found, evolution = page((20.5, 21.0), settings=settings)
    at = int(np.flatnonzero(np.isclose(section(found, Strip).thresholds, 4.0))[0])
    np.testing.assert_array_equal(section(found, Strip).values[:, at], evolution.fixed.area[:, 0] * 1e6)
    assert (evolution.sensitivity[:, at] != evolution.fixed.area[:, 0]).all()


@pytest.mark.parametrize(
    ("signed", "bodies"), [("none", [0, 0]), ("fixed", [1, 0]), ("moving", [0, 1]), ("both", [1, 1])]
)
def test_each_body_says_whether_its_distances_carry_a_sign(signed, bodies):
    here = told((20.5,))
    here = replace(here, evolution=replace(here.evolution, signed=signed))
    scene = section(contact_page.contact_page(here, ""), Scene)
    assert [body.signed for body in scene.bodies] == [bool(b) for b in bodies]
    assert (scene.span[0] == 0.0) == (signed == "none")
    assert scene.value_name == ("distance" if signed == "none" else "signed distance") + " to the other body"


def test_a_threshold_of_zero_has_a_page():
    settings = Settings((0.0,), refinement=AS_GIVEN, sensitivity=(0.0, 5e-4, 1e-3))
    found, _ = page((19.5, 22.0), settings=settings)
    assert section(found, Scene).span[0] < 0.0 < section(found, Scene).span[1]
    assert len(page_html(thinned_page(*analysed((19.5, 22.0), settings=settings)).of(201))) > 1000
    unsigned = told((22.0,), settings=settings)
    unsigned = replace(unsigned, evolution=replace(unsigned.evolution, signed="none"))
    assert contact_page.contact_page(unsigned, "").total == 1


def test_a_crude_rule_is_named_and_not_called_certified():
    settings = Settings((T * MM,), rule="any-vertex", sensitivity=WIDE)
    found, evolution = page((20.5,), settings=settings)
    words = {s.title: " ".join(s.paragraphs) for s in found.sections if isinstance(s, Words)}
    assert "(any-vertex)" in found.subtitle
    assert "rule any-vertex" in words["Numerical error"] and "outside the bounds" in words["Numerical error"]
    assert "estimated error" not in words["Numerical error"]
    assert "contact area on the fixed body, any-vertex" in [row.label for row in section(found, Readout).rows]
    np.testing.assert_array_equal(section(found, Strip).values, evolution.sensitivity * 1e6)


def test_only_the_region_is_coloured_and_it_is_said():
    _, ground, *_ = analysed()
    upper = ground.face_normal[:, 1] > 0.5
    settings = Settings((T * MM,), refinement=AS_GIVEN, fixed_faces=upper)
    found, _ = page((20.5,), settings=settings)
    shown = section(found, Scene).bodies[0].distance[0]
    outside = np.ones(len(ground.vertices), bool)
    outside[ground.faces[upper]] = False
    assert np.isposinf(shown[outside]).all() and np.isfinite(shown[~outside]).any()
    words = {s.title: " ".join(s.paragraphs) for s in found.sections if isinstance(s, Words)}
    assert f"Of plate only {upper.sum()} of {len(upper)} faces count" in words["Question"]
    assert "region" in found.subtitle
