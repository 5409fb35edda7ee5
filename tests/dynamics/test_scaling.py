"""Models made to measure: what a static trial says of sizes, and what scaling does to bodies, joints and markers."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.dynamics.scaling import measured_factor, scaled
from tests import legs
from tests.dynamics.models import all_kinds

BY = np.array([1.2, 0.9, 1.1])


def test_a_scaled_subject_is_measured(tmp_path: Path) -> None:
    """Standing in another pose: pairs on one body tell its factor whatever the pose, a lost marker does not matter."""
    _, model, time, values = legs.planted(tmp_path)
    grown = scaled(model, {"tibia_r": 1.15 * np.ones(3)})
    places = grown.marker_places(values[:5])
    places[2, 8] = np.nan
    static = MarkerTrajectories(time[:5], places, tuple(m.name for m in model.markers))
    zero = np.zeros(len(model.coordinates))
    assert measured_factor(model, zero, static, [("tibia_r0", "tibia_r2"), ("tibia_r1", "tibia_r3")]) == pytest.approx(
        1.15
    )
    assert measured_factor(model, zero, static, [("femur_r0", "femur_r2")]) == pytest.approx(1.0)
    with pytest.raises(ValueError, match="the model has no marker heel"):
        measured_factor(model, zero, static, [("heel", "tibia_r0")])
    with pytest.raises(ValueError, match="the static trial has no marker foot_r3"):
        measured_factor(model, zero, replace(static, names=(*static.names[:-1], "toe")), [("foot_r3", "foot_r1")])


def test_one_factor_for_all_scales_every_length() -> None:
    """A model in which every body is 1.3 times as large has its markers 1.3 times as far from each other."""
    model = all_kinds()
    by = {body.name: 1.3 * np.ones(3) for body in model.bodies}
    q = np.random.default_rng(3).normal(size=(4, len(model.coordinates)))
    lengths = [c.name in ("free3", "free4", "free5", "s") for c in model.coordinates]
    base = replace(model, joints=(replace(model.joints[0], parent_offset=RigidTransform.identity()), *model.joints[1:]))
    grown_q = np.where(lengths, 1.3 * q, q)
    small, large = base.marker_places(q), scaled(base, by).marker_places(grown_q)
    apart = [np.linalg.norm(x[:, :, None] - x[:, None, :], axis=3) for x in (small, large)]
    np.testing.assert_allclose(apart[1], 1.3 * apart[0], rtol=1e-12, atol=1e-12)


def test_moments_of_inertia_are_those_of_the_scaled_points() -> None:
    """A body of point masses, scaled by three factors: exact."""
    rng = np.random.default_rng(2)
    points, masses = rng.normal(size=(9, 3)), rng.uniform(0.1, 1.0, 9)
    points -= masses @ points / masses.sum()

    def inertia(x: np.ndarray) -> np.ndarray:
        return np.einsum("i,ij,ij->", masses, x, x) * np.eye(3) - np.einsum("i,ij,ik->jk", masses, x, x)

    model = all_kinds()
    solid = replace(model.bodies[0], mass=float(masses.sum()), inertia=inertia(points))
    grown = scaled(replace(model, bodies=(solid, *model.bodies[1:])), {solid.name: BY}).bodies[0]
    np.testing.assert_allclose(grown.inertia, inertia(points * BY), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(grown.centre, solid.centre * BY)
    assert grown.mass == solid.mass


def test_mass_is_shared_as_before() -> None:
    model = all_kinds()
    heavy = scaled(model, {}, mass=90.0)
    assert sum(b.mass for b in heavy.bodies) == pytest.approx(90.0)
    ratios = [a.mass / b.mass for a, b in zip(heavy.bodies, model.bodies, strict=True)]
    np.testing.assert_allclose(ratios, ratios[0])
    np.testing.assert_allclose(heavy.bodies[1].inertia, ratios[0] * model.bodies[1].inertia)
    with pytest.raises(ValueError, match="there is no body arm"):
        scaled(model, {"arm": np.ones(3)})
