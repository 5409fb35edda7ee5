"""What E* depends on, and the force of a trial that was not used: on areas and forces made by one law."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from geocontact.data.parameter import Parameter
from geocontact.elastic_modulus.area_force import MODULUS, THRESHOLD, ThresholdAreas
from geocontact.elastic_modulus.identify import Identification, identify
from geocontact.elastic_modulus.prediction import Prediction, predicted_force, shared_frames
from geocontact.elastic_modulus.sensitivity import confounded, constant, sensitivity
from tests.identify.synthetic_contact import RADIUS, THRESHOLDS, TRUE, synthetic_areas, synthetic_model


@cache
def disc() -> Identification:
    model = synthetic_model("disc", frames=31)
    return identify(model, model.force({MODULUS: TRUE}), replicates=0)


def test_another_threshold_asks_for_the_modulus_that_carries_the_same_force() -> None:
    """By hand: F = 4/3 E* a^3 / R with a^2 = A / pi, so least squares of E* over the wrong area's unit force."""
    rows = {(row.reading, row.threshold): row for row in sensitivity({"total": disc()})}
    assert {threshold for _, threshold in rows} == set(THRESHOLDS)
    assert rows["disc", 4e-3].modulus == pytest.approx(TRUE, rel=1e-6)
    assert rows["disc", 4e-3].r2 == pytest.approx(1.0)
    unit = 4.0 / 3.0 * (disc().model.evolution.area[:, 1] / np.pi) ** 1.5 / RADIUS
    by_hand = float(unit @ disc().measured / (unit @ unit))
    off = disc().measured - by_hand * unit
    assert rows["disc", 2e-3].modulus == pytest.approx(by_hand, rel=1e-6)
    assert rows["disc", 2e-3].rmse == pytest.approx(float(np.sqrt(np.mean(off**2))), rel=1e-5)


def test_a_strip_of_unknown_length_is_left_out() -> None:
    model = synthetic_model("disc", frames=31)
    without = replace(disc(), model=replace(model, evolution=replace(model.evolution, length=np.nan)))
    assert "strip" in {row.reading for row in sensitivity({"total": disc()})}
    assert "strip" not in {row.reading for row in sensitivity({"total": without})}


def test_a_threshold_that_only_scales_the_areas_is_one_number_with_the_modulus() -> None:
    model = synthetic_model("disc", frames=31)
    shape = model.evolution.area[:, 3:4]
    scaled = replace(model, evolution=replace(model.evolution, area=shape * (0.6 + 100.0 * THRESHOLDS)))
    free = (Parameter(THRESHOLD, "m", 4e-3, 1e-3, 5e-3),)
    found = identify(scaled, scaled.force({MODULUS: TRUE}), free, replicates=0, starts=1)
    assert confounded(found) == [THRESHOLD] and not constant(found)
    assert confounded(disc()) == []


def test_an_area_that_does_not_change_makes_a_force_that_does_not() -> None:
    model = synthetic_model("disc", frames=31)
    still = replace(model, evolution=replace(model.evolution, area=np.full_like(model.evolution.area, 1e-4)))
    assert constant(identify(still, still.force({MODULUS: TRUE}), replicates=0))


def test_another_trial_is_carried_by_the_same_law() -> None:
    time = np.linspace(0.0, 0.8, 17)
    areas = ThresholdAreas(time, THRESHOLDS, synthetic_areas(time, 0.5), np.full(17, RADIUS), np.nan)
    force = predicted_force(areas, disc(), 3e-3)
    np.testing.assert_allclose(force, 4.0 / 3.0 * TRUE * (areas.area[:, 2] / np.pi) ** 1.5 / RADIUS, rtol=1e-6)
    measured = np.where(np.arange(17) < 2, np.nan, force + 3.0)
    assert Prediction("total", time, force, measured).rmse == pytest.approx(3.0)
    assert np.isnan(Prediction("total", time, force, None).r2)


def test_frames_are_shared_at_every_lag_that_is_allowed_and_not_in_a_gap() -> None:
    time = 0.1 * np.arange(11)
    clock = np.concatenate([np.arange(0.3, 0.601, 0.01), np.arange(0.9, 1.201, 0.01)])
    found = shared_frames(time, clock, 0.1, (0.0, 0.15))
    assert time[found].round(1).tolist() == [0.2, 0.3, 0.4, 0.5, 0.8, 0.9]
