"""Long recordings on a page: as many samples as it has room for, every peak among them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.view.extremes import FRAMES, thinned_line, with_extremes
from geocontact.view.page.content import (
    Choices,
    Curve,
    Curves,
    Page,
    PageChoice,
    Plan,
    Points,
    Readout,
    Row,
    Scene,
    SceneBody,
    Strip,
    Track,
    Words,
)
from geocontact.view.page.write import SPARE, bounded, write_page

COUNT = 100_000


def spiky(seed: int) -> np.ndarray:
    """Noise with 40 spikes of one sample up and 40 down, each of its own height, 1250 samples apart at least."""
    rng = np.random.default_rng(seed)
    values = rng.normal(0.0, 1.0, COUNT)
    for stretch in range(40):
        up, down = COUNT // 40 * stretch + rng.permutation(COUNT // 80)[:2]
        values[up], values[down] = 100.0 + stretch, -100.0 - stretch
    return values


def test_every_spike_of_three_curves_survives() -> None:
    curves = [spiky(k) for k in range(3)]
    kept = with_extremes(COUNT, curves)
    assert len(kept) <= FRAMES and (np.diff(kept) > 0).all() and kept[0] == 0 and kept[-1] == COUNT - 1
    for curve in curves:
        assert set(curve[np.abs(curve) >= 100.0]) <= set(curve[kept])


def test_many_curves_keep_their_own_extremes_and_the_first_those_of_each_stretch() -> None:
    curves = [spiky(k) for k in range(40)]
    kept = with_extremes(COUNT, curves)
    assert len(kept) <= FRAMES
    for curve in curves:
        assert {curve.min(), curve.max()} <= set(curve[kept])
    assert set(curves[0][np.abs(curves[0]) >= 100.0]) <= set(curves[0][kept])


@pytest.mark.parametrize("count", [1, 2, 1000, FRAMES])
def test_short_recordings_stay_whole(count: int) -> None:
    assert with_extremes(count, [np.arange(float(count))]).tolist() == list(range(count))


def test_what_is_not_known_is_passed_over_and_asked_for_samples_are_kept() -> None:
    curve = np.full(COUNT, np.nan)
    curve[5000:5010] = [0, 3, 1, np.inf, 2, 2, 2, -7, 2, 2]
    kept = with_extremes(COUNT, [np.full(COUNT, np.nan), curve], always=[77])
    assert {77, 5001, 5007} <= set(kept.tolist()) and 50 < len(kept) <= FRAMES
    assert len(with_extremes(COUNT, [])) <= FRAMES


def test_a_line_of_a_figure_keeps_its_envelope_and_its_gap() -> None:
    x, y = np.arange(float(COUNT)), spiky(0)
    y[40_000:45_000] = np.nan
    short_x, short_y = thinned_line(x, y)
    assert len(short_x) <= 2 * FRAMES and np.nanmax(short_y) == np.nanmax(y) and np.nanmin(short_y) == np.nanmin(y)
    assert np.isnan(short_y[(short_x >= 40_000) & (short_x < 45_000)]).all()
    assert ((short_x >= 40_000) & (short_x < 45_000)).any()


def long_page() -> Page:
    """Of everything that runs along time, the sample number in each, so that a wrong one shows."""
    number = np.arange(float(COUNT))
    curve = spiky(1)
    still = SceneBody("moves", np.eye(3), np.array([[0, 1, 2]]))
    poses = RigidTransform.from_components(np.column_stack([number, 0 * number, 0 * number]), Rotation.identity(COUNT))
    scene = Scene((replace(still, poses=poses),), (1e-3,), (0.0, 2e-3))
    force = Curves("force", "N", [Curve("a", curve, curve - 1.0, curve + 1.0)], [Points("seen", number, -curve)])
    return Page(
        "title",
        "subtitle",
        number,
        "time [s]",
        start_frame=12_345,
        sections=(
            scene,
            force,
            Strip("strip", np.array([1.0, 2.0]), np.column_stack([number, number]), "mm²", 1.0),
            Plan(
                "plan",
                "m",
                "x",
                "y",
                tracks=[Track("track", np.column_stack([number, number]), [str(n) for n in number])],
            ),
            Readout([Row("row", "N", [f"{n:.0f}" for n in number])]),
            Words("words", ["stay"]),
        ),
        choices=Choices("in", "N", [PageChoice("kN", (), (), {1: replace(force, curves=[Curve("a", 1e-3 * curve)])})]),
    )


def test_all_that_runs_along_time_is_thinned_out_alike() -> None:
    whole, page = long_page(), bounded(long_page())
    kept = page.time.astype(int)
    assert 500 < len(kept) <= FRAMES and kept[page.opening] == 12_345
    assert page.total == COUNT and page.numbers is not None and page.numbers.tolist() == (kept + 1).tolist()
    assert page.reservations == (f"the page shows {len(kept)} of {COUNT} samples; the tables have all",)
    scene, force, strip, plan, readout, words = page.sections
    assert isinstance(scene, Scene) and isinstance(force, Curves) and isinstance(strip, Strip)
    assert isinstance(plan, Plan) and isinstance(readout, Readout) and words is not None
    (body,), (curve,), (track,) = scene.bodies, force.curves, plan.tracks
    assert body.poses is not None and body.poses.translation[:, 0].tolist() == kept.tolist()
    own = whole.sections[1]
    assert isinstance(own, Curves)
    np.testing.assert_array_equal(curve.values, own.curves[0].values[kept])
    assert curve.lower is not None and curve.upper is not None
    np.testing.assert_array_equal(
        curve.upper - curve.lower, (own.curves[0].values + 1 - (own.curves[0].values - 1))[kept]
    )
    assert set(own.curves[0].values[np.abs(own.curves[0].values) >= 100.0]) <= set(curve.values)
    assert len(force.points[0].time) <= FRAMES and force.points[0].values.max() == -own.curves[0].values.min()
    assert strip.values[:, 0].tolist() == kept.tolist() == track.points[:, 0].tolist()
    assert [float(text) for text in track.told] == kept.tolist() == [float(text) for text in readout.rows[0].texts]
    assert page.choices is not None
    other = page.choices.others[0].instead[1]
    assert isinstance(other, Curves)
    np.testing.assert_array_equal(other.curves[0].values, 1e-3 * own.curves[0].values[kept])


def test_a_page_of_ordinary_length_is_left_alone() -> None:
    time = np.linspace(0.0, 1.0, int(SPARE * FRAMES))
    page = Page("t", "s", time, "time [s]", sections=(Curves("c", "N", [Curve("a", time)]),))
    assert bounded(page) is page


def test_a_written_page_is_bounded(tmp_path: Path) -> None:
    assert write_page(long_page(), tmp_path / "report.html") < 1_000_000
