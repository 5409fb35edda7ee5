"""What the pages and figures of an elbow answer first, and what they draw."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.pages import Drawings
from geocontact.analyses.misalignment.identify.curves import (
    Boxes,
    condition_curves,
    direction_bars,
    identified_curves,
    residual_curves,
)
from geocontact.analyses.misalignment.identify.show import arm_drawing
from geocontact.analyses.misalignment.population import show as population_page
from geocontact.analyses.misalignment.simulate import show as simulate_page
from geocontact.analyses.misalignment.simulate.show import surface_figure
from geocontact.analyses.misalignment.simulate.trials import surfaces
from geocontact.axis_misalignment.compensation import BinMeans, RecordedStroke
from geocontact.axis_misalignment.uncertainty import Direction
from geocontact.identify.intervals.profile_likelihood import Profile
from geocontact.view.page.content import Curves, Intervals, Page, Picture
from tests.analyses.misalignment.test_population import described, population
from tests.analyses.misalignment.trials import KNOWN, PAPER, QUICK, STROKE, changed, locked, quietly


def test_surfaces_stand_in_space_and_say_which_offset_is_0() -> None:
    figure = surface_figure(surfaces(0.169, 0.127))
    spaces = [axes for axes in figure.axes if axes.name == "3d"]
    assert [axes.get_title()[:5] for axes in spaces] == ["y = 0", "x = 0"]
    assert [axes.get_ylabel() for axes in spaces] == ["offset x [mm]", "offset y [mm]"]


@pytest.mark.drawn
def test_a_page_with_surfaces_is_below_2_mb(tmp_path: Path) -> None:
    """The page holds the picture twice, for light and dark; colours that run into each other had made it 2.9 MB."""
    gc.misalignment.simulate(**QUICK).write(tmp_path / "out")
    sizes = {each.name: each.stat().st_size for each in (tmp_path / "out").iterdir()}
    assert 0.2e6 < sizes["surfaces.svg"] < 0.5e6 and sizes["report.html"] < 2e6, sizes


def test_spreads_of_both_conditions_share_an_axis() -> None:
    """Quantiles 0 … 4 N locked and 5 … 9 N free at the same three angles."""
    beta = np.radians([15.0, 25.0, 35.0])
    rows = np.array([[0.0, 1.0, 2.0, 3.0, 4.0]] * 3)
    curve = BinMeans(beta, np.array([1.0, 2.0, 3.0]), np.zeros(3))
    recorded = RecordedStroke(curve, (), 0.0, 1.0, np.ones(3, bool))
    both = [Boxes(beta, rows + shift, np.radians(10.0)) for shift in (0.0, 5.0)]
    spread = condition_curves(curve, recorded, *both).panels[2]
    assert [each.name for each in spread.curves] == ["joint locked", "joint free"]
    assert spread.over is not None
    np.testing.assert_allclose(spread.over.values, [15.0, 25.0, 35.0])
    for shift, each in zip((0.0, 5.0), spread.curves, strict=True):
        np.testing.assert_allclose([each.lower, each.values, each.upper], [[shift + q] * 3 for q in (0.0, 2.0, 4.0)])


def test_profiles_are_drawn_over_the_best_value() -> None:
    line = np.tile(np.linspace(100.0, 400.0, 41)[:, None], 8)
    values = np.array([-0.4, 0.0, 0.4])
    profile = Profile("x", 0.2, ((-0.4, -0.1), (0.1, 0.4)), False, False, values, np.array([1.0, 3.0, 1.0]))
    along, shape = identified_curves(line, np.ones(41), -np.ones(41), {"x/l": profile}).panels
    assert along.over is not None and along.over.values[[0, -1]].tolist() == [100.0, 400.0]
    assert min(along.curves[1].values) == -0.5  # R² far below 0 would flatten the other
    assert [(each.name, each.time.tolist()) for each in shape.points] == [("x/l", [-2.0, 2.0])]
    assert [limit.value for limit in shape.limits] == [1.0]


def test_the_direction_that_is_identified_least_has_a_bar_for_each_number() -> None:
    bars = direction_bars(Direction(("k", "l"), np.array([1.0, 1e-12]), np.array([-0.7, 0.7])))
    assert bars.bars and [(one.name, one.value) for one in bars.intervals] == [("k", -0.7), ("l", 0.7)]
    assert "1e-12 of the largest" in bars.words


def test_residuals_are_drawn_over_the_angle_as_a_density_and_by_quantiles() -> None:
    """The density of 200 values is 1 in all; the line of the quantiles is their mean and SD."""
    rng = np.random.default_rng(3)
    beta, residual = np.linspace(0.1, 1.0, 200), rng.normal(size=200)
    over, density, quantiles = residual_curves(beta, residual, residual / 2.0, "p = 0.5").panels
    np.testing.assert_allclose(over.points[0].values, residual)
    assert density.over is not None
    for curve in density.curves:
        assert np.trapezoid(curve.values, density.over.values) == pytest.approx(1.0, abs=0.02)
    (line,) = quantiles.curves
    slope, mean = np.polyfit(quantiles.over.values, line.values, 1)
    assert (slope, mean) == pytest.approx((np.std(residual / 2.0, ddof=1), np.mean(residual / 2.0)))


def test_all_curves_of_a_fit_are_the_pages_own(made: Path) -> None:
    result = quietly(gc.misalignment.identify, *locked(made), **KNOWN)
    sections = page_of(result).sections
    assert not any(isinstance(each, Picture) for each in sections)
    titles = [each.title for each in sections if isinstance(each, Curves)]
    assert titles == [panel.title for sheet in result.curves().values() for panel in sheet.panels]


DESIGN = {"k": 222.43, "l": gc.mm(169), "z": gc.mm(127), "range": gc.deg(0, 120), "offset": gc.mm(48, 59)}


def page_of(result: gc.Result) -> Page:
    """The page of a result before it becomes a file."""
    (page,) = result.pages(Drawings(result.figures)).values()
    assert isinstance(page, Page)
    return page


def test_the_arm_is_drawn_to_scale(made: Path) -> None:
    """Lengths in the drawing are those that were identified, and each says how well it is known."""
    fit = quietly(gc.misalignment.identify, *locked(made), **KNOWN).fit
    plan = arm_drawing(fit, np.radians([20.0, 50.0, 80.0]))
    drawn = {each.name: float(np.subtract(each.end, each.start) @ np.subtract(each.end, each.start)) ** 0.5
             for each in plan.lengths}  # fmt: skip
    assert drawn == pytest.approx({"x": PAPER["x"] * 1e3, "y": PAPER["y"] * 1e3, "l": 169.0, "z": 127.0}, rel=0.1)
    told = {each.name: each.told for each in plan.lengths}
    assert "(95 % " in told["x"] and told["l"] == "169 mm (given)"
    at = {mark.name: np.array(mark.point) for mark in plan.marks}
    way = plan.tracks[0].points - at["exoskeleton's axis"]
    np.testing.assert_allclose(np.linalg.norm(way, axis=1), 169.0, rtol=1e-6)
    np.testing.assert_allclose(np.degrees(np.arctan2(way[:, 1], way[:, 0])), [20.0, 50.0, 80.0], atol=1e-6)


def test_without_a_scale_the_link_is_the_unit(made: Path) -> None:
    plan = arm_drawing(quietly(gc.misalignment.identify, *locked(made), bootstrap=0).fit, np.radians([20.0, 80.0]))
    link = next(each for each in plan.lengths if each.name == "l")
    assert plan.unit == "l" and np.hypot(*np.subtract(link.end, link.start)) == pytest.approx(1.0)
    assert link.told == "1, the unit"


def test_both_shares_stand_side_by_side(tmp_path: Path) -> None:
    people = described(tmp_path, k='unit = "N/m"\nuniform = { lower = 150, upper = 250 }')
    d = population(people).drawn
    assert d.indices is not None
    assert population_page.answer(d)[0].startswith(f"In {d.beyond.value:.2%} of 5000 synthetic people")
    (shares,) = (each for each in population_page._shares(d) if isinstance(each, Intervals))
    assert shares.bars and [(one.name, one.kind) for one in shares.intervals] == [
        (name, kind) for name in ("offset along the upper arm (y)", "stiffness of cuff and fixation (k)")
        for kind in ("total", "first-order")
    ]  # fmt: skip
    assert all(one.lower <= one.value <= one.upper for one in shares.intervals)


@pytest.mark.parametrize(("limit", "verb", "lines"), [(5.0, "exceeds", 2), (9.0, "keeps", 2), (90.0, "keeps", 0)])
def test_a_design_opens_with_the_map_and_draws_the_limit(limit: float, verb: str, lines: int) -> None:
    """A limit that is far from the force would flatten its curve."""
    options = DESIGN | {"stroke": gc.mm(0, 60), "limit": limit, "map": gc.mm(20)}
    result = quietly(lambda _, **given: gc.misalignment.design(**given), **options)
    page = page_of(result)
    assert f"the force reaches 8.64 N and {verb} the limit of {limit:g} N" in page.headline[0]
    assert page.leads and isinstance(page.sections[page.leads[0]], Picture)
    force = next(each for each in page.sections if isinstance(each, Curves))
    assert [each.value for each in force.limits] == [limit, -limit][:lines]


def test_errors_are_the_answer_of_a_comparison(tmp_path: Path, made: Path) -> None:
    """The worst trial is drawn, and both errors of every trial as bars."""
    off = changed(locked(made)[1], tmp_path, force=lambda t: t["force [N]"] + 3.0)
    result = quietly(gc.misalignment.compare, locked(made)[0], off, simulated=locked(made)[:2])
    page = page_of(result)
    first, worst = (p.trial for p in result.pairs)
    assert page.headline[0].startswith(f"The model misses the constraint force by 0 N root mean square in {first}")
    assert f"and by 3 N in {worst}" in page.headline[0]
    assert isinstance(page.sections[0], Curves) and page.sections[0].title.endswith(worst)
    bars = next(each for each in page.sections if isinstance(each, Intervals))
    assert [one.value for one in bars.intervals] == pytest.approx([0.0, 0.0, 3.0, 3.0])


def test_a_simulation_tells_what_it_made() -> None:
    result = gc.misalignment.simulate(**QUICK, stroke=STROKE)
    first, second, third = simulate_page.answer(result.trials, result.numbers)
    assert first.startswith("3 synthetic trials with a locked joint") and "free joint" in second
    assert "x = 48 mm, y = 59 mm" in third
