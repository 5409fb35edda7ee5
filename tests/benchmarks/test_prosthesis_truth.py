"""Finer code for a prosthetic foot against itself and the package's keel, and a field fitted in the package's foot."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from benchmarks.prosthesis.refit import FullModel, foot_without, fulcrum, predicted
from benchmarks.prosthesis.truth import EVERY, FootPath, Measured, Truth, Withheld, given_way, measure
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot


@lru_cache(maxsize=1)
def fine() -> VariableStiffnessFoot:
    return vsf_foot(joints=24, finer=4)


def pressed(step: float = 5e-3) -> FootPath:
    """A foot that rolls from its heel to its toes and is pressed by 10 mm; invented."""
    time = np.arange(0.0, 0.6, step)
    share = time / 0.6
    pitch = 0.2 - 0.4 * share
    lowest = np.where(pitch > 0.0, 0.03, 0.03 + 0.22 * -np.sin(pitch))
    height = lowest + 0.003 - 0.013 * np.sin(np.pi * share) ** 2
    return FootPath(time, np.column_stack([0.1 * share, height, pitch]))


@pytest.mark.slow
def test_finer_code_converges_and_agrees_with_the_package() -> None:
    """Pieces of half the length, and the package's keel with 24 hinges and 96 spheres: other code, same foot."""
    path = pressed()
    load, across = Truth(fine(), fulcrum()).solve(path)
    assert load.max() > 400.0
    finer, _ = Truth(fine(), fulcrum(), pieces=36).solve(path)
    assert np.abs(finer - load).max() < 2e-3 * load.max()
    none = np.zeros(len(fine().sole.spheres))
    smooth = replace(fine(), law=replace(fine().law, static=none, kinetic=none))
    up, centre = predicted(smooth, path, fulcrum())
    on = load > 50.0
    assert np.sqrt(np.mean((up - load) ** 2)) < 0.02 * load.max()
    own = across * np.cos(path.pose[:, 2]) - path.pose[:, 1] * np.sin(path.pose[:, 2])
    assert np.sqrt(np.mean((centre - own)[on] ** 2)) < 2e-3


@pytest.mark.slow
def test_what_is_withheld_shows() -> None:
    """A keel that rubs carries more while it bends and less while it straightens; a socket hides its give."""
    path = pressed()
    load, _ = Truth(fine(), fulcrum()).solve(path)
    rubbing, _ = Truth(fine(), fulcrum(), Withheld(hysteresis=0.15)).solve(path)
    rising = np.gradient(load) > 0.0
    assert (rubbing - load)[rising].mean() > 1.0 > -1.0 > (rubbing - load)[~rising].mean()
    seen = measure(Truth(fine(), fulcrum(), Withheld(pistoning=True)), path, 1)
    expected = given_way(load, float(path.time[1]))[::EVERY]
    lower = path.pose[::EVERY, 1] - seen.path.pose[:, 1]
    assert expected.max() > 5e-3
    np.testing.assert_allclose(lower, expected, atol=1e-3)


@pytest.mark.parametrize(("load", "after", "given"), [(900.0, 0.5, 900.0 / 20e3 * (1.0 - np.exp(-1.0)))])
def test_a_socket_creeps_as_a_spring_beside_a_dashpot(load: float, after: float, given: float) -> None:
    """Closed form: k q + c q' = F, at rest before."""
    assert given_way(np.full(501, load), after / 500.0)[-1] == pytest.approx(given, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(("field", "value"), [("fulcrum", 0.09), ("hysteresis", 0.15)])
def test_a_planted_field_is_found_in_the_full_model(field: str, value: float) -> None:
    """The sole's numbers are held; the plate is the full model's own."""
    model, path, held = FullModel(foot_without(()), field), pressed(), np.zeros(10)
    up, centre = model.along(path, np.ones(10), np.array([value]))
    ground = path.pose[:, 0] + (centre + path.pose[:, 1] * np.sin(path.pose[:, 2])) / np.cos(path.pose[:, 2])
    made = {"t01": Measured(path, up, ground, np.column_stack([0.0 * up, up, ground]))}
    found = model.fitted(made, ("t01",), held)
    assert np.exp(found[10:]) == pytest.approx([value], rel=0.02)
