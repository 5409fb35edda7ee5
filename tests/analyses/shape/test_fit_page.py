"""The page of a fit: the shape is drawn where it is, colours are its distances, nothing is named that is not known."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.analyses.shape.show import drawn, fit_figure, fit_page, profile_curves
from geocontact.geometry.fit.catalogue import SHAPES
from geocontact.geometry.fit.patch import Fitting, Patch
from geocontact.geometry.fit.profile import SagittalProfile
from geocontact.view.page.content import Scene
from meshes.simple_shapes import block, cylinder, sphere
from tests.geometry.bodies import moved, surface, turned

BODIES = {"cylinder": cylinder(15.0, 40.0, 8), "sphere": sphere(20.0, 8), "plane": block(60.0, 60.0, 12.0, 4)}


@pytest.mark.parametrize("shape", SHAPES)
def test_shape_is_drawn_where_it_is_and_colours_are_distances(shape: str) -> None:
    body = surface(moved(BODIES[shape], turned(20, -35, 50), [3.0, -2.0, 5.0]), "body")
    chosen = np.arange(len(body.faces)) % 3 > 0
    counted = np.zeros(len(body.vertices), bool)
    counted[body.faces[chosen]] = True
    fit = SHAPES[shape](body.vertices[counted], True)
    told = Fitting(Patch(body, chosen, True, None, -1), fit, {}, {})
    vertices, faces = drawn(told)
    np.testing.assert_allclose(fit.distance(vertices), 0.0, atol=1e-12)
    assert faces.max() < len(vertices) and (np.ptp(vertices, axis=0) > 0.01).any()
    page = fit_page(told, {}, "title")
    scene = next(section for section in page.sections if isinstance(section, Scene))
    shown = scene.bodies[0].distance[0]
    np.testing.assert_allclose(shown[counted], fit.distance(body.vertices)[counted])
    assert scene.sides and scene.span[0] == -scene.span[1]
    assert sorted(scene.thresholds) == [-scene.threshold, scene.threshold]
    assert np.isinf(shown[~counted]).all()
    assert set(scene.directions) == {"+x", "−x", "+y", "−y", "+z", "−z"}
    assert ("Radius" in dict(page.facts)) == (shape != "plane")
    figure = fit_figure(fit, body.vertices[counted], "title")
    dots = [each for axes in figure.axes for each in axes.collections if each.get_cmap().name == "RdBu_r"]
    limits = 1e3 * scene.span[1]
    assert all(each.get_clim() == pytest.approx((-limits, limits)) for each in dots), "figure and page alike"
    assert dots


def test_colours_tell_a_bump_from_a_dent() -> None:
    """A sphere of 20 mm with a corner 1 mm farther out and one 1 mm farther in: the page has both signs."""
    corners, faces = sphere(20.0, 8)
    outward = corners / np.linalg.norm(corners, axis=1, keepdims=True)
    far, near = int(np.argmax(corners[:, 0])), int(np.argmin(corners[:, 0]))
    corners = corners.copy()
    corners[far] += outward[far] * np.linalg.norm(corners[far]) / 20.0
    corners[near] -= outward[near] * np.linalg.norm(corners[near]) / 20.0
    body = surface((corners, faces), "body")
    fit = SHAPES["sphere"](body.vertices, True)
    page = fit_page(Fitting(Patch(body, np.ones(len(faces), bool), True, None, -1), fit, {}, {}), {}, "title")
    scene = next(section for section in page.sections if isinstance(section, Scene))
    shown = scene.bodies[0].distance[0]
    assert shown[far] == pytest.approx(1e-3, rel=0.02) and shown[near] == pytest.approx(-1e-3, rel=0.02)
    assert "above 0 outside" in scene.value_name


def test_profiles_are_drawn_where_they_are_known() -> None:
    angle, one = np.radians([0.0, 30.0, 60.0]), np.ones(3)
    radius = np.array([0.024, np.nan, 0.020])
    profile = SagittalProfile(angle, np.zeros((3, 3)), radius, 1e-3 * one, one, np.zeros((3, 3)), angle)
    (panel,) = profile_curves({"medial": profile}, SHAPES["sphere"](BODIES["sphere"][0], True)).panels
    (curve,) = panel.curves
    assert panel.over is not None and panel.over.values == pytest.approx([0.0, 30.0, 60.0])
    np.testing.assert_allclose(curve.values, [24.0, np.nan, 20.0])
    np.testing.assert_allclose(curve.upper, [25.0, np.nan, 21.0])
