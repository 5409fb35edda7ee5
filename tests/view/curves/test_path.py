"""Paths of contact points, read back from what is drawn."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.text import Annotation

from geocontact.view.curves.path import contact_path
from geocontact.view.curves.quantity import CYCLE

TIME = np.linspace(0.0, 2.0, 41)
CIRCLE = 0.01 * np.c_[np.cos(TIME * 3.0), np.sin(TIME * 3.0)]


def pieces(figure: Figure) -> LineCollection:
    return next(c for c in figure.axes[0].collections if isinstance(c, LineCollection))


def test_segments_join_successive_samples_in_millimetres_with_time_as_colour() -> None:
    figure = contact_path(TIME, {"contact": CIRCLE})
    drawn = np.array(pieces(figure).get_segments())
    np.testing.assert_allclose(drawn, 1e3 * np.stack([CIRCLE[:-1], CIRCLE[1:]], axis=1), rtol=1e-14)
    np.testing.assert_allclose(pieces(figure).get_array(), (TIME[1:] + TIME[:-1]) / 2.0, rtol=1e-14)
    assert (pieces(figure).norm.vmin, pieces(figure).norm.vmax) == (0.0, 2.0)
    assert figure.axes[1].get_ylabel() == "time [s]", "the colour bar"


def test_gated_samples_are_not_bridged_and_lone_ones_are_dots() -> None:
    gated = CIRCLE.copy()
    gated[:3] = np.nan
    gated[10:20] = np.nan
    gated[15] = CIRCLE[15]
    gated[30, 1] = np.nan
    figure = contact_path(TIME, {"contact": gated})
    there = np.isfinite(gated).all(axis=1)
    both = there[:-1] & there[1:]
    expected = np.stack([gated[:-1], gated[1:]], axis=1)[both]
    np.testing.assert_allclose(pieces(figure).get_segments(), 1e3 * expected, rtol=1e-14)
    np.testing.assert_allclose(pieces(figure).get_array(), ((TIME[1:] + TIME[:-1]) / 2.0)[both], rtol=1e-14)
    dots = next(c for c in figure.axes[0].collections if not isinstance(c, LineCollection))
    np.testing.assert_allclose(dots.get_offsets(), 1e3 * CIRCLE[15:16], rtol=1e-14)
    np.testing.assert_allclose(figure.axes[0].lines[0].get_xydata(), 1e3 * CIRCLE[3:4], rtol=1e-14)


def test_start_is_marked_and_arrows_point_along_the_way() -> None:
    axes = contact_path(TIME, {"contact": CIRCLE}).axes[0]
    np.testing.assert_allclose(axes.lines[0].get_xydata(), 1e3 * CIRCLE[:1], rtol=1e-14)
    arrows = [text for text in axes.texts if isinstance(text, Annotation)]
    assert len(arrows) == 3
    for arrow in arrows:
        tail, head = np.array(arrow.xyann), np.array(arrow.xy)
        along = np.array([-tail[1], tail[0]])  # counter-clockwise
        turn = along @ (head - tail) / np.linalg.norm(along) / np.linalg.norm(head - tail)
        assert turn > 0.99


def test_a_point_that_does_not_move_has_no_direction() -> None:
    axes = contact_path(TIME, {"contact": np.zeros((41, 2))}).axes[0]
    assert not axes.texts
    alone = np.full((41, 2), np.nan)
    alone[7] = 0.01
    assert not contact_path(TIME, {"contact": alone}).axes[0].texts


def test_it_is_to_scale() -> None:
    for stretch in ([1.0, 9.0], [9.0, 1.0], [0.0, 1.0], [1.0, 0.0]):
        figure = contact_path(TIME, {"contact": CIRCLE * stretch}, outline=2.0 * CIRCLE * stretch)
        FigureCanvasAgg(figure).draw()
        x, y = figure.axes[0].transData.transform([[1.0, 0.0], [0.0, 1.0]]) - figure.axes[0].transData.transform([0, 0])
        assert x[0] == pytest.approx(y[1], rel=1e-6)
        low, high = figure.axes[0].viewLim.min, figure.axes[0].viewLim.max
        shown = 2e3 * CIRCLE * stretch
        assert (shown >= low).all() and (shown <= high).all(), "the outline is in view"


def test_paths_share_one_scale_and_differ_in_marker() -> None:
    paths = {"medial": CIRCLE, "lateral": CIRCLE + 0.03}
    figure = contact_path(TIME * 50.0, paths, plane=("lateral", "anterior"), along=CYCLE)
    assert len(figure.axes) == 2, "one colour bar"
    assert figure.axes[1].get_ylabel() == "cycle [%]"
    assert len({line.get_marker() for line in figure.axes[0].lines}) == 2
    assert (figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()) == ("lateral [mm]", "anterior [mm]")
    legend = figure.axes[0].get_legend()
    assert legend is not None and [t.get_text() for t in legend.get_texts()] == ["medial, start", "lateral, start"]


def test_colours_get_steadily_lighter_in_grey() -> None:
    colours = pieces(contact_path(TIME, {"contact": CIRCLE})).cmap(np.linspace(0.0, 1.0, 256))[:, :3]
    grey = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4) @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(grey) > -1e-4).all() and grey[-1] < 0.65


@pytest.mark.usefixtures("unchecked")
@pytest.mark.parametrize(
    ("paths", "outline", "said"),
    [
        ({"a": np.zeros((41, 3))}, None, r"path 'a': shape \(41, 3\), expected \(41, 2\)"),
        ({"a": np.zeros((40, 2))}, None, r"path 'a': shape \(40, 2\), expected \(41, 2\)"),
        ({"a": np.full((41, 2), np.nan)}, None, "path 'a': every sample is NaN"),
        ({"a": CIRCLE}, np.zeros((5, 3)), r"outline: shape \(5, 3\), expected \(m, 2\)"),
        ({}, None, "path: nothing to draw"),
    ],
)
def test_what_cannot_be_drawn_is_refused(paths: dict[str, np.ndarray], outline: np.ndarray | None, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        contact_path(TIME, paths, outline=outline)
