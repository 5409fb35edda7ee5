"""Curves are declared once: what the page draws and what the static figure draws are the same lines."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from geocontact.data.motion import Course
from geocontact.view.curves import drawn as module
from geocontact.view.curves.declared import (
    INK,
    Curve,
    Curves,
    CurveSheet,
    Limit,
    Points,
    Scale,
    Shade,
    mean_curve,
    stroke,
)
from geocontact.view.curves.drawn import draw_on, drawn
from geocontact.view.curves.style import panels
from geocontact.view.extremes import FRAMES
from geocontact.view.page.content import Page
from geocontact.view.page.payload import payload
from geocontact.view.page.write import bounded

FRONT = Path(module.__file__).parents[1] / "page" / "front" / "src"
TIME = Course("time", "s", np.linspace(0.0, 2.0, 21))
SINE, RAMP = np.sin(TIME.values), 3.0 * TIME.values


def force() -> Curves:
    return Curves(
        "Force on the body",
        "N",
        [Curve("recorded", SINE, stroke=INK), Curve("model", RAMP, RAMP - 1.0, RAMP + 1.0, stroke=1)],
        points=[Points("by hand", np.array([0.5]), np.array([1.5]))],
        limits=[Limit("limit 4 N", 4.0)],
        spans=[Shade("tool runs", 0.5, 1.0), Shade("present", 1.5, 1.5)],
    )


def over_cycle() -> Curves:
    percent = np.linspace(0.0, 100.0, 101)
    one = Curve("cycle 1", np.cos(percent), thin=True)
    return Curves("Moment", "N m", [Curve("mean", np.sin(percent)), one], over=Course("cycle", "%", percent))


def lines(axes: Axes) -> dict[str, np.ndarray]:
    """Drawn lines by what the legend says of them."""
    handles, names = axes.get_legend_handles_labels()
    legend = axes.get_legend()
    handles = legend.legend_handles if legend else handles
    names = [text.get_text() for text in legend.get_texts()] if legend else names
    return dict(zip(names, handles, strict=True))


def of_values(axes: Axes, values: np.ndarray) -> list[object]:
    return [line for line in axes.lines if np.array_equal(np.asarray(line.get_ydata()), values)]


def test_every_curve_of_a_declaration_is_drawn_where_it_is_declared() -> None:
    (axes,) = drawn(CurveSheet([force()], TIME)).axes
    for values in (SINE, RAMP):
        (line,) = of_values(axes, values)
        assert np.array_equal(line.get_xdata(), TIME.values)  # type: ignore[attr-defined]
    assert list(lines(axes)) == ["recorded", "model", "by hand", "limit 4 N", "tool runs", "present"]
    assert axes.get_xlabel() == "time [s]" and axes.get_ylabel() == "[N]"
    assert any(np.array_equal(line.get_ydata(), [4.0, 4.0]) for line in axes.lines)
    (band,) = list(axes.collections)
    low, high = band.get_paths()[0].get_extents().get_points()[:, 1]
    assert (low, high) == pytest.approx((-1.0, 7.0))


def test_a_panel_with_an_axis_of_its_own_is_drawn_over_it() -> None:
    _, own = drawn(CurveSheet([force(), over_cycle()], TIME)).axes
    assert own.get_xlabel() == "cycle [%]" and own.get_xlim() == (0.0, 100.0)
    thin = of_values(own, over_cycle().curves[1].values)[0]
    assert thin.get_linewidth() < 1.0  # type: ignore[attr-defined]


def test_values_over_another_count_of_places_are_refused() -> None:
    with pytest.raises(ValueError, match=r"curve mean: 3 values over 21 of time"):
        Curves("Moment", "N m", [Curve("mean", np.zeros(3))], over=TIME)
    with pytest.raises(ValueError, match="along what"):
        drawn(CurveSheet([force()]))
    with pytest.raises(ValueError, match="no curves"):
        drawn(CurveSheet([]))


def test_one_legend_says_what_is_in_panels_that_are_alike() -> None:
    pair = [Curves(title, "N", [Curve("model", SINE), Curve("plate", RAMP)]) for title in ("Force x", "Force y")]
    figure = drawn(CurveSheet(pair, TIME))
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["model", "plate"]
    assert not any(axes.get_legend() for axes in figure.axes)


def test_a_second_scale_and_a_logarithm_reach_the_axes() -> None:
    panel = Curves("Moment", "N m", [Curve("hip", RAMP + 1.0)], beside=Scale("N m/kg", 0.5), log=True)
    (axes,) = drawn(CurveSheet([panel], TIME)).axes
    assert axes.get_yscale() == "log"
    (other,) = axes.child_axes
    other.figure.draw_without_rendering()  # type: ignore[union-attr]
    assert np.array(other.get_ylim()) == pytest.approx(0.5 * np.array(axes.get_ylim()))
    assert other.get_ylabel() == "[N m/kg]"


def test_axes_of_a_composed_figure_take_a_panel() -> None:
    figure, (left, _) = panels(1, 2)
    draw_on(left, force(), TIME)
    assert isinstance(figure, Figure) and "model" in lines(left)


@pytest.mark.parametrize(("colour", "dashes"), [(0, 0), (4, 0), (1, 1), (3, 7), (2, 5)])
def test_a_stroke_has_the_colour_and_the_dashes_it_was_made_of(colour: int, dashes: int) -> None:
    assert (stroke(colour, dashes) % 5, stroke(colour, dashes) % 8) == (colour, dashes)


def test_colours_dashes_and_marks_are_those_of_the_page() -> None:
    script = (FRONT / "strokes.js").read_text(encoding="utf-8")
    dashes = json.loads(re.search(r"DASHES = (\[.*?\]);", script)[1])  # type: ignore[index]
    assert [tuple(0.5 * float(part) for part in one.split()) for one in dashes] == list(module.LINES)
    assert f"COLOURS = {len(module.HUES)};" in script
    style = (FRONT / "style.css").read_text(encoding="utf-8")
    page = [re.search(rf"--c{k}: (#\w+);", style)[1] for k in range(5)]  # type: ignore[index]
    own = [to_hex(each) for each in module.HUES]
    assert page[:2] == own[:2] and page[4] == "#000" and own[4] == "#000000"
    assert page[2:4] == ["#00805e", "#b3568c"]  # darker than in print: type and dots of them are on a screen
    assert len(re.findall(r'"M[^"]+"', re.search(r"MARKS = (\[.*?\]);", (FRONT / "charts.js").read_text())[1])) == len(  # type: ignore[index]
        module.MARKS
    )


def test_the_page_gets_spans_strokes_and_its_own_axis() -> None:
    page = Page("t", "", TIME.values, "time [s]", sections=[force(), over_cycle()])
    first, second = payload(page).data["parts"]  # type: ignore[misc]
    assert first["spans"] == [
        {"name": "tool runs", "start": 0.5, "end": 1.0},
        {"name": "present", "start": 1.5, "end": 1.5},
    ]
    assert [curve["stroke"] for curve in first["curves"]] == [INK, 1] and first["over"] is None
    assert second["over"]["label"] == "cycle [%]" and len(second["over"]["values"]) == 101
    assert [curve["thin"] for curve in second["curves"]] == [False, True]


def test_some_frames_are_taken_of_what_runs_along_the_page_alone() -> None:
    kept = np.array([0, 10, 20])
    along, own = CurveSheet([force(), over_cycle()]).at(kept)
    model = along.curves[1]
    assert np.array_equal(model.values, RAMP[kept]) and np.array_equal(model.lower, RAMP[kept] - 1.0)
    assert len(own.curves[0].values) == 101


def test_a_long_axis_of_its_own_keeps_its_peaks() -> None:
    values = np.zeros(50_000)
    values[12_345] = 7.0
    long = Course("sample", "–", np.arange(50_000.0))
    page = Page("t", "", np.zeros(1), "", sections=[Curves("Long", "N", [Curve("a", values)], over=long)])
    (panel,) = bounded(page).sections
    assert isinstance(panel, Curves) and panel.over is not None
    assert len(panel.over.values) <= 1.2 * FRAMES and panel.curves[0].values.max() == 7.0


def test_mean_and_band_of_trials_count_what_is_there() -> None:
    trials = np.array([[1.0, 2.0, 3.0], [3.0, 6.0, np.nan], [5.0, 4.0, 6.0]])
    curve = mean_curve("walk", trials, factor=10.0)
    assert curve.name == "walk, mean ± SD (n = 2–3)"
    assert curve.values == pytest.approx([30.0, 40.0, 45.0])
    assert curve.upper - curve.values == pytest.approx([20.0, 20.0, 10.0 * np.std([3.0, 6.0], ddof=1)])  # type: ignore[operator]
    single = mean_curve("one", trials[:1])
    assert single.name == "one (n = 1)" and single.lower is None
    with pytest.raises(ValueError, match="every sample is NaN"):
        mean_curve("none", np.full((2, 3), np.nan))
