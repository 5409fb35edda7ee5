"""Skeletons in the browser, measured: where points are, and that they move, hide and are named."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.view.page.content import Curve, Curves, Page, Scale, Scene
from tests.view.page.conftest import Open, set_range
from tests.view.page.pictures import pixels
from tests.view.page.test_linkage import pendulum

pytestmark = pytest.mark.slow

BONE = np.array([0x4A, 0x55, 0x60])


def swinging() -> Page:
    time = np.linspace(0.0, 1.0, 11)
    scene = Scene(
        directions={"right (+z)": (0.0, 0.0, 1.0), "front (+x)": (1.0, 0.0, 0.0)},
        view=(0.0, 0.0, 1.0),
        linkages=[pendulum()],
    )
    moment = Curves("knee", "N m", [Curve("knee_r", 70.0 * time)], beside=Scale("N m/kg", 1.0 / 70.0))
    return Page("Swing", "", time, "time [s]", sections=[scene, moment])


def columns_drawn(picture: np.ndarray) -> np.ndarray:
    """Columns of the picture that hold the skeleton's colour, in light or shade."""
    shade = picture.astype(float) @ BONE / (BONE @ BONE)
    near = np.abs(picture - shade[..., None] * BONE).sum(axis=2) < 25
    return np.nonzero((near & (shade < 1.3)).any(axis=0))[0]


def test_a_skeleton_swings_and_hides(opened: Open) -> None:
    """From 0.8 sin(-0.5) m on the left to as much on the right of the pivot."""
    here = opened(swinging())
    assert here.text("#legend") == "pendulum" and not here.complaints
    bar = here.tab.locator("#scale i").bounding_box()
    assert bar
    size = float(here.text("#scale span").split()[0]) / bar["width"]
    reach = []
    for frame in (0, 10):
        set_range(here, "#slider", frame)
        drawn = columns_drawn(pixels(here.picture()))
        reach.append((drawn.max() - drawn.min()) * size)
    wide = 1e3 * (0.8 * np.sin(0.5) + 0.02)
    assert reach == pytest.approx([wide, wide + 100.0], abs=12.0), "the loose point is 0.1 m ahead of the end"
    assert here.text(".chart svg[role=img]").count("N m/kg") == 1
    here.tab.get_by_role("checkbox", name="pendulum").uncheck()
    assert not len(columns_drawn(pixels(here.picture())))
