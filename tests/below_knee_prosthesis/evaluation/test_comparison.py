"""Stances of a study together: beside predictors without a model, by setting, mean and spread."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.analyses.prosthesis.compare.show import comparison_curves
from geocontact.below_knee_prosthesis.comparison import (
    against_predictors,
    by_setting,
    by_setting_and_calibrated,
    curves_of,
    ensembles,
    odd_stances,
    plain_curves,
)
from geocontact.below_knee_prosthesis.evaluation import (
    ANOTHER,
    AS_STUDY,
    MEAN,
    OVER_STANCE,
    QUANTITIES,
    JudgedStance,
    PlateStance,
    Scoring,
    judged,
)
from tests.below_knee_prosthesis.stances import a_stance
from tests.below_knee_prosthesis.test_stance_errors import plate_of, walked

TIME = np.arange(0.0, 0.95, 0.002)


def a_study(*rows: tuple[str, str, str, float, float]) -> list[JudgedStance]:
    """Stances by name, person and setting, with factors on the simulated and on the measured force."""
    found = []
    for name, person, setting, own, seen in rows:
        plate = plate_of(TIME)
        plate = replace(plate, force=seen * plate.force)
        found.append(judged(name, person, setting, a_stance(TIME, own * walked(TIME)), plate))
    return found


@pytest.fixture(scope="module")
def study() -> list[JudgedStance]:
    return a_study(("a", "P", "low", 1.0, 1.0), ("b", "P", "low", 1.1, 1.0), ("c", "P", "high", 1.2, 1.2))


def test_predictors_know_the_other_trials_only(study: list[JudgedStance]) -> None:
    plain = plain_curves(study, "vertical")
    _, b, c = (one.measured("vertical") for one in study)
    np.testing.assert_allclose(plain["a"][MEAN], 0.5 * (b + c), rtol=1e-12)
    np.testing.assert_allclose(plain["a"][ANOTHER], c, rtol=1e-12)
    assert len(curves_of(plain, study, MEAN, study[0])) == 3
    alone = plain_curves(study[:2], "vertical")
    assert curves_of(alone, study[:2], ANOTHER, study[0]) == []  # nobody walked on another setting


def test_the_model_is_better_where_it_is_nearer_than_every_predictor(study: list[JudgedStance]) -> None:
    errors = {(each.stance.name, each.quantity): each for each in against_predictors(study)}
    assert len(errors) == 3 * len(QUANTITIES)
    size = np.sqrt(np.mean(study[0].measured("vertical") ** 2))
    a, b = errors["a", "vertical"], errors["b", "vertical"]
    assert a.rmse < 1e-3 * size and a.better
    seen = [one.measured("vertical") for one in study]
    off = [np.sqrt(np.mean((each - seen[0]) ** 2)) for each in (0.5 * (seen[1] + seen[2]), seen[2])]
    assert (a.plain[MEAN].rmsd, a.plain[ANOTHER].rmsd) == pytest.approx(tuple(off), rel=1e-9)
    assert b.rmse == pytest.approx(0.1 * size, rel=1e-2)
    (only,) = (each for each in against_predictors(study[:1]) if each.quantity == "vertical")
    assert only.plain == {} and only.better is None


def test_what_a_sole_was_fitted_to_is_apart(study: list[JudgedStance]) -> None:
    fitted = [replace(study[0], calibrated=True), *study[1:]]
    assert {name: [one.name for one in own] for name, own in by_setting(fitted).items()} == {
        "low": ["b"],
        "high": ["c"],
    }
    assert list(by_setting([fitted[0]])) == ["low"]
    shown = by_setting_and_calibrated(fitted)
    assert [(name, [one.name for one in own]) for name, own in shown.items()][-1] == ("calibrated", ["a"])
    assert "calibrated" not in by_setting_and_calibrated(study)
    own = {one.label: one for one in ensembles(fitted)["calibrated"]}
    np.testing.assert_allclose(own["vertical"].mean, study[0].simulated("vertical"), rtol=1e-12)
    panels = comparison_curves(fitted).panels[:3]
    assert panels[2].title.endswith("calibrated, 1 stance")
    assert list(odd_stances(fitted)) == ["b", "c"]


def test_ensembles_are_means_over_a_setting(study: list[JudgedStance]) -> None:
    low = {one.label: one for one in ensembles(study)["low"]}
    own, seen = (
        [each(one, "vertical") for one in study[:2]] for each in (JudgedStance.simulated, JudgedStance.measured)
    )
    np.testing.assert_allclose(low["vertical"].mean, 0.5 * (own[0] + own[1]), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(low["vertical"].sd, 0.5 * np.abs(own[0] - own[1]), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(low["vertical measured"].mean, seen[0], atol=1e-12)
    assert low["vertical another setting"].quantity == "vertical"


def of_length(name: str, lasting: float, scoring: Scoring) -> JudgedStance:
    """A stance of one shape over its own length from 0.3 s on, half a wave squared, simulated as on the plate."""
    time = np.arange(0.0, 1.6, 0.002)
    share = (time - 0.3) / lasting
    up = 800.0 * np.sin(np.pi * np.clip(share, 0.0, 1.0)) ** 2
    force = up[:, None] * np.array([0.1, 1.0, 0.05])
    centre = np.where(up[:, None] > 20.0, np.column_stack([0.2 * share, 0.0 * time, 0.0 * time]), np.nan)
    return judged(name, "P", "low", a_stance(time, force), PlateStance(time, force, centre), scoring=scoring)


@pytest.mark.parametrize("scoring", [OVER_STANCE, AS_STUDY])
def test_stances_of_one_shape_and_other_lengths_are_one_curve(scoring: Scoring) -> None:
    """3 to 9.5 % of body weight off where curves with as much swing on both sides met sample by sample."""
    same = [of_length(f"{lasting:g}", lasting, scoring) for lasting in (0.60, 0.64, 0.68, 0.72)]
    for each in against_predictors(same):
        if each.quantity in ("resultant", "vertical"):
            assert each.plain[MEAN].rmsd < 2e-3, each.stance.name
    for one in ensembles(same)["low"]:
        if one.label.startswith("vertical"):
            assert one.sd.max() < 5e-3, one.label
    gate = np.arcsin(np.sqrt(20.0 / 800.0)) / np.pi  # where 20 N begin
    at = np.clip(gate + (1.0 - 2.0 * gate) * same[0].errors.share, 0.0, 1.0)
    (mean,) = (one.mean for one in ensembles(same)["low"] if one.label == "vertical measured")
    np.testing.assert_allclose(mean, 800.0 / (77.3 * 9.80665) * np.sin(np.pi * at) ** 2, atol=0.02)
    drawn = {each.name: each for each in comparison_curves(same).panels[0].curves}
    np.testing.assert_allclose(drawn["plate"].values, mean, rtol=1e-12, atol=1e-12)
