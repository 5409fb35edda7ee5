"""Figures of the elbow: what is drawn beside what, and over which offset."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.misalignment.identify.show import Boxes, conditions_figure, told_figure
from geocontact.analyses.misalignment.simulate.show import surface_figure
from geocontact.analyses.misalignment.simulate.trials import surfaces
from geocontact.axis_misalignment.end_stop import BinMeans, RecordedStroke
from geocontact.axis_misalignment.uncertainty import Direction
from geocontact.identify.intervals.profile_likelihood import Profile


def test_surfaces_stand_in_space_and_say_which_offset_is_0() -> None:
    figure = surface_figure(surfaces(0.169, 0.127))
    spaces = [axes for axes in figure.axes if axes.name == "3d"]
    assert [axes.get_title()[:5] for axes in spaces] == ["y = 0", "x = 0"]
    assert [axes.get_ylabel() for axes in spaces] == ["offset x [mm]", "offset y [mm]"]


def test_boxes_of_both_conditions_share_an_axis() -> None:
    beta = np.radians([15.0, 25.0, 35.0])
    rows = np.array([[0.0, 1.0, 2.0, 3.0, 4.0]] * 3)
    curve = BinMeans(beta, np.array([1.0, 2.0, 3.0]), np.zeros(3))
    stroke = RecordedStroke(curve, (), 0.0, 1.0, np.ones(3, bool))
    both = [Boxes(beta, rows + shift, np.radians(10.0)) for shift in (0.0, 5.0)]
    spread = conditions_figure(curve, stroke, *both).axes[2]
    boxes = [line.get_xydata() for line in spread.get_lines() if len(line.get_xydata()) == 5]
    assert len(boxes) == 6
    middles = np.array([0.5 * (box[:, 0].min() + box[:, 0].max()) for box in boxes])
    np.testing.assert_allclose(middles[3:] - middles[:3], 4.0)
    assert [box[:, 1].min() for box in boxes] == [1.0] * 3 + [6.0] * 3


def test_profiles_are_drawn_over_the_best_value_and_k_has_three_ticks() -> None:
    told = Direction(("k", "l"), np.array([1.0, 1e-12]), np.array([-0.7, 0.7]))
    line = np.tile(np.linspace(100.0, 400.0, 41)[:, None], 8)
    values = np.array([-0.4, 0.0, 0.4])
    profile = Profile("x", 0.2, ((-0.4, -0.1), (0.1, 0.4)), False, False, values, np.array([1.0, 3.0, 1.0]))
    _, along, shape = told_figure(told, line, np.ones(41), np.ones(41), {"x/l": profile}).axes[:3]
    assert [tick.get_text() for tick in along.get_xticklabels()] == ["100", "250", "400"]
    assert not along.get_xticklabels(minor=True)
    np.testing.assert_allclose(shape.get_lines()[0].get_xdata(), [-2.0, 0.0, 2.0])
    assert [text.get_text() for text in shape.get_legend().get_texts()] == ["x/l"]
