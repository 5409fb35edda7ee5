"""How near a calibrated foot comes to its stance, and what speaks against the fit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration
from geocontact.below_knee_prosthesis.calibration.fit import (
    doubts_of_fit,
    fore_aft_error,
    known_of,
    residual_over_noise,
    residuals_by_channel,
    stance_fit,
)
from geocontact.below_knee_prosthesis.calibration.known_numbers import knowledge
from geocontact.below_knee_prosthesis.calibration.sole_residuals import SoleResiduals
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.below_knee_prosthesis.calibration.stances import recorded


def usual_calibration() -> SoleCalibration:
    """Of a tenth of a second: the usual numbers, and the foot as it stood."""
    whole, few = recorded(), slice(20, 40)
    names = ("time", "poses", "rate", "force", "centre")
    stance = replace(whole, **{name: getattr(whole, name)[few] for name in names})
    residuals, z = SoleResiduals.of([stance], vsf_foot()), np.zeros(17)
    return SoleCalibration(residuals, vsf_foot().law, z[:15], z, 0.0, (), True, knowledge(residuals, z))


def test_a_fit_is_what_the_residuals_are_made_of() -> None:
    """At the usual numbers, the foot as it stood: errors by sums over the samples, in body weights."""
    usual = usual_calibration()
    residuals, z = usual.residuals, usual.at
    stance = residuals.stances[0]
    found = stance_fit(usual)
    off = (found.predicted - stance.measured) / stance.weight
    assert found.vertical.rmsd == pytest.approx(np.sqrt(np.mean(off[:, 1] ** 2)), rel=1e-12)
    known = np.isfinite(stance.centre)
    off_centre = (found.predicted[:, 3] - stance.centre)[known]
    assert found.centre.rmsd == pytest.approx(np.sqrt(np.mean(off_centre**2)), rel=1e-12)
    assert fore_aft_error(found.predicted, stance) == pytest.approx(np.sqrt(np.mean(off[:, 0] ** 2)), rel=1e-12)
    assert residual_over_noise(usual) == pytest.approx(np.sqrt(np.mean(residuals.of_data(z) ** 2)), rel=1e-12)
    assert np.abs(found.slip).max() > 0.0 and not found.sunk
    assert [each.name for each in known_of(usual)][-2:] == ["foot.height", "foot.pitch"]


def test_residuals_are_those_of_their_own_channel() -> None:
    """Two stances, the second of a fifth of the first's time and without a centre: by their places, one by one."""
    whole, one = recorded(), usual_calibration()
    names = ("time", "poses", "rate", "force", "centre")
    long, short = (
        replace(whole, **{name: getattr(whole, name)[on] for name in names}) for on in (slice(20, 40), slice(24, 28))
    )
    short = replace(short, centre=np.full_like(short.centre, np.nan))
    residuals = SoleResiduals.of([long, short], vsf_foot())
    z = np.zeros(len(residuals.sd))
    parts = residuals_by_channel(replace(one, residuals=residuals, at=z))
    assert [len(own) for own in parts] == [6, 6]
    assert [len(each) for each in parts[1]] == [4, 4, 4, 0, 4, 4]
    off, start = residuals.of_data(z), 0
    for place, own in enumerate(parts):
        there = np.isfinite(residuals.measured(place))
        table = np.full(there.shape, np.nan)
        table[there] = off[start : start + there.sum()]
        start += int(there.sum())
        for column, found in zip(table.T, own, strict=True):
            np.testing.assert_array_equal(found, column[np.isfinite(column)])


@pytest.mark.parametrize(
    ("height", "pitch", "residual", "vertical", "words"),
    [
        (0.5, -1.2, 0.3, 0.01, []),
        (-2.5, 0.0, 0.3, 0.01, ["did the foot stand flat"]),
        (0.0, 2.1, 0.3, 0.01, ["did the foot stand flat"]),
        (0.0, 0.0, 0.4, 0.053, ["missed by 5.3% of body weight, the residual is 0.4 times its noise"]),
        (0.0, 0.0, 2.5, 0.02, ["missed by 2.0% of body weight, the residual is 2.5 times its noise"]),
        (0.0, -3.0, 0.4, 0.2, ["did the foot stand flat", "missed by 20.0% of body weight"]),
    ],
)
def test_a_foot_out_of_flat_and_a_stance_that_is_missed_are_said(
    height: float, pitch: float, residual: float, vertical: float, words: list[str]
) -> None:
    found = doubts_of_fit(height, pitch, residual, vertical)
    assert len(found) == len(words)
    assert all(each in doubt.what for each, doubt in zip(words, found, strict=True))
    assert any(doubt.contradicts for doubt in found) == (vertical > 0.12)
