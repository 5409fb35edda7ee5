"""The head of the page: the answer in sentences, for every threshold, beside measured areas; colours of the figure."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.area import page as contact_page
from geocontact.analyses.area.figure import area_figure, colour_span
from geocontact.geometry.contact_area.area import AS_GIVEN
from geocontact.geometry.contact_area.comparison import Compared, compared
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.view.page.content import Curves, Readout, Scene, Words
from tests.analyses.area.ball_on_plate import MM, T, analysed, moved, page, section, told


def test_the_answer_is_one_sentence():
    found, evolution = page()
    largest, least = (f(evolution.fixed.area[:, 1]) * 1e6 for f in (np.max, np.min))
    assert found.headline == [
        f"Up to {largest:.4g} mm² of plate lie within 4 mm of ball, at 0.2 s; the least is {least:.4g} mm²."
    ]


def test_every_threshold_can_be_chosen():
    found, evolution = page()
    assert found.choices.own == "4 mm"
    (other,) = found.choices.others
    assert other.name == "1 mm" and other.threshold == 1 * MM and "within 1 mm of ball" in other.headline[0]
    assert dict(other.facts)["Largest contact area on the fixed body"].startswith(
        f"{evolution.fixed.area[:, 0].max() * 1e6:.0f} mm²"
    )
    words = [each.title for each in other.instead.values() if isinstance(each, Words)]
    assert words == ["Question", "Numerical error"], "what does not depend on the threshold stands once"
    changed = {type(found.sections[place]) for place in other.instead}
    assert changed == {Readout, Curves, Words}, "scene, distance and tables are the same for every threshold"
    numbers = next(each for each in other.instead.values() if isinstance(each, Readout))
    assert numbers.rows[0].texts == [f"{a:.2f}" for a in evolution.fixed.area[:, 0] * 1e6]


def test_measured_areas_stand_in_headline_and_curve():
    here = told((22.0, 21.0, 20.5, 21.0), settings=Settings((T * MM,), refinement=AS_GIVEN))
    ours = here.evolution.table()
    reference = pd.DataFrame({"time [s]": [0.05, 0.2], "area_fixed [mm^2]": [100.0, 110.0]})
    rows = compared(ours, reference, Path("measured.csv"))
    found = contact_page.contact_page(replace(here, compared=Compared(rows, 0.02)), "")
    worst = rows["relative [-]"].abs().max()
    said = f"Against 2 measured areas the largest difference is {worst:.1%}, beyond the tolerance of 2.0%."
    assert found.headline[1] == said
    (points,) = section(found, Curves).points
    assert points.name == "measured, fixed body"
    assert list(points.time) == pytest.approx([0.05, 0.2]) and list(points.values) == [100.0, 110.0]


def test_figure_and_page_have_the_same_colour_limits():
    found, evolution = page((20.5, 18.7))
    *_, maps = analysed((20.5, 18.7))
    plate = analysed((20.5, 18.7))[1]
    course = moved((20.5, 18.7)).course
    span = colour_span(evolution)
    figure = area_figure(evolution, plate.vertices, plate.faces, maps.fixed_at_largest, maps.largest, "t", course, span)
    drawn = [each for axes in figure.axes for each in axes.collections if each.get_array() is not None]
    limits = [each.get_clim() for each in drawn if each.get_clim() != (0.0, 1.0)]
    assert section(found, Scene).span == span
    assert tuple(1e-3 * np.array(limits[0])) == pytest.approx(span)
