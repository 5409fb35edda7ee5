"""Points and lines over time: what is packed is what comes back, and a scene may hold nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.view.page.content import Linkage, Page, Scene
from geocontact.view.page.pack import GRID
from geocontact.view.page.payload import payload
from geocontact.view.page.scene import MISSING


def pendulum(frames: int = 11) -> Linkage:
    """A rod that swings about the origin, and a loose point that is not seen in the third frame."""
    angle = np.linspace(-0.5, 0.5, frames)
    end = 0.8 * np.column_stack([np.sin(angle), -np.cos(angle), 0.0 * angle])
    points = np.stack([0.0 * end, end, end + np.array([0.1, 0.0, 0.2])], axis=1)
    points[2, 2] = np.nan
    return Linkage("pendulum", points, np.array([[0, 1]]), "bone", 0.01, 0.02)


def test_places_come_back_to_a_step_of_the_grid() -> None:
    one = pendulum()
    words = one.words().reshape(one.points.shape)
    assert (words[2, 2] == MISSING).all() and (words[one.known] < MISSING).all()
    found = one.grid.corner + words[one.known] * (one.grid.size / GRID)
    assert np.abs(found - one.places).max() <= 1.001 * one.grid.size.max() / GRID, (
        "at the upper end a step, else half of one"
    )


def test_a_scene_of_linkages_needs_no_body() -> None:
    page = Page(
        "swing",
        "",
        np.arange(11.0),
        "time [s]",
        sections=[Scene(directions={"+z": (0.0, 0.0, 1.0)}, linkages=[pendulum()])],
    )
    data = payload(page).data["scene"]
    assert data["bodies"] == [] and data["linkages"][0]["lines"] == [[0, 1]]
    with pytest.raises(ValueError, match="points of pendulum: 11 frames, expected the 5"):
        Page("swing", "", np.arange(5.0), "time [s]", sections=[Scene(linkages=[pendulum()])])
    with pytest.raises(ValueError, match="a body or a linkage"):
        Scene()
    with pytest.raises(ValueError, match="names a point that is not there"):
        Linkage("rod", np.zeros((1, 2, 3)), np.array([[0, 2]]), "bone", 0.0, 0.01)
    with pytest.raises(ValueError, match="no point is known"):
        Linkage("rod", np.full((1, 2, 3), np.nan), np.array([[0, 1]]), "bone", 0.0, 0.01)
