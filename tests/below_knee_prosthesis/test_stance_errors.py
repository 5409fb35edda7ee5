"""A simulated stance beside a plate: both filtered alike, and only what was simulated is compared."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from geocontact.below_knee_prosthesis.evaluation import AS_STUDY, PlateStance, judged, stance_errors
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.outliers import reasons
from tests.below_knee_prosthesis.stances import a_stance

WEIGHT = 77.3 * GRAVITY
START, STOP = 0.1, 0.8


def walked(time: np.ndarray) -> np.ndarray:
    """A force with two humps and a heel's blow of 8 ms, which 40 Hz do not pass [N]."""
    share = np.clip((time - START) / (STOP - START), 0.0, 1.0)
    up = WEIGHT * np.sin(np.pi * share) * (1.0 + 0.4 * np.cos(4.0 * np.pi * share) ** 2)
    up = up + 0.8 * WEIGHT * np.exp(-(((time - START - 0.02) / 0.004) ** 2)) * (share > 0.0)
    return np.column_stack([0.15 * WEIGHT * -np.sin(2.0 * np.pi * share), up, 0.05 * up])


def plate_of(time: np.ndarray) -> PlateStance:
    along = np.column_stack([0.05 + 0.2 * (time - START), 0.0 * time, 0.0 * time])
    return PlateStance(time, walked(time), np.where(walked(time)[:, 1:2] > 20.0, along, np.nan))


@pytest.mark.parametrize("rate", [500.0, 1000.0])
def test_a_perfect_model_has_no_error(rate: float) -> None:
    """2.2 % of body weight where only the simulation is filtered."""
    own, seen = np.arange(0.0, 0.95, 0.002), np.arange(-0.2, 1.2, 1.0 / rate)
    found = stance_errors(a_stance(own, walked(own)), plate_of(seen))
    for name in ("resultant", "vertical", "fore_aft", "medio_lateral"):
        assert found.table[name][1] < (1e-4 if rate == 500.0 else 3e-3), name
    assert found.simulated == 1.0


@pytest.mark.parametrize(("rate", "cutoff"), [(500.0, 40.0), (60.0, 24.0)])
def test_both_pass_one_filter(rate: float, cutoff: float) -> None:
    """By hand: second order both ways, with the corner that leaves half of the power at 40 Hz, or what a plate has."""

    def by_hand(time: np.ndarray) -> np.ndarray:
        step = time[1] - time[0]
        corner = np.arctan(np.tan(np.pi * cutoff * step) / (2.0**0.5 - 1.0) ** 0.25) / (np.pi * step)
        sections = butter(2, corner, fs=1.0 / step, output="sos")
        return np.asarray(np.interp(places, time, sosfiltfilt(sections, walked(time)[:, 1]) / WEIGHT))

    own, seen = np.arange(0.0, 0.95, 0.002), np.arange(0.0, 0.95, 1.0 / rate)
    found = stance_errors(a_stance(own, walked(own)), plate_of(seen))
    places = found.start + found.share * found.stance[1]
    model, measured = found.curves["vertical"]
    np.testing.assert_allclose(model, by_hand(own), atol=1e-9)
    np.testing.assert_allclose(measured, by_hand(seen), atol=1e-9)


def test_what_was_not_simulated_is_not_compared() -> None:
    """The simulation ends at 0.66 s, at 80 % of the stance; it is right up to there."""
    own, seen = np.arange(0.0, 0.662, 0.002), np.arange(-0.2, 1.2, 0.002)
    stance, plate = a_stance(own, walked(own)), plate_of(seen)
    found = stance_errors(stance, plate)
    late = found.start + found.share * found.stance[1] > own[-1]
    assert late.sum() > 15
    for name, (model, measured) in found.curves.items():
        assert np.isnan(model[late]).all(), name
        assert np.isfinite(measured[late & (found.share < 0.99)]).all() or name.startswith("cop")
    assert found.simulated == pytest.approx(0.80, abs=0.02)
    assert np.isnan(found.stance[0])
    assert found.table["resultant"][1] < 0.01  # 0.20 with the last sample held up to the stance's end
    assert found.table["impulse"][1] < 0.002
    one = judged("cut", "P", "low", stance, plate)
    assert np.isnan(one.simulated("ankle_moment")[late]).all()
    assert "its simulation ended before toe-off" in reasons(one)


def test_a_simulation_that_begins_late_is_compared_from_there() -> None:
    own, seen = np.arange(0.2, 0.95, 0.002), np.arange(-0.2, 1.2, 0.002)
    found = stance_errors(replace(a_stance(own, walked(own))), plate_of(seen))
    model, measured = found.curves["impulse"]
    first = int(np.argmax(np.isfinite(model)))
    assert model[first] == measured[first] == 0.0
    assert found.table["impulse"][1] < 0.002


def test_scored_as_the_study_by_hand() -> None:
    """A force that is a tenth too large, with 0.25 s of swing: by hand, and less than over the stance."""
    own, seen = np.arange(-0.2, 1.1, 0.002), np.arange(-0.3, 1.3, 0.002)
    stance, plate = a_stance(own, 1.1 * walked(own)), plate_of(seen)
    alone, padded = stance_errors(stance, plate), stance_errors(stance, plate, AS_STUDY)
    start, lasting = padded.start, padded.stance[1]
    times = start + padded.share * lasting
    assert times[[0, -1]] == pytest.approx([start - 0.25, start + lasting + 0.25])
    inside = (padded.share > 0.0) & (padded.share < 1.0)
    assert inside.mean() == pytest.approx(lasting / (lasting + 0.5), abs=0.02)
    model, measured = padded.curves["vertical"]
    known = np.isfinite(model)
    off = np.sqrt(np.mean((model - measured)[known] ** 2))
    assert padded.table["vertical"][1] == pytest.approx(off, rel=1e-12)
    assert padded.table["vertical"][1] < 0.9 * alone.table["vertical"][1]
    assert np.abs(measured[~inside]).max() < 0.02
    assert padded.simulated == 1.0


def test_both_centres_pass_six_hertz_over_the_stance() -> None:
    """A centre that jumps every 20 ms by a tenth of the foot: filtered, it is on its course."""
    own, seen = np.arange(0.0, 0.95, 0.002), np.arange(-0.2, 1.2, 0.002)
    plate = plate_of(seen)
    jumping = plate.centre + 0.02 * np.sign(np.sin(2.0 * np.pi * 25.0 * seen))[:, None] * [1.0, 0.0, 0.0]
    rough = replace(plate, centre=jumping)
    found = {
        name: stance_errors(a_stance(own, walked(own)), one, AS_STUDY) for name, one in (("a", plate), ("b", rough))
    }
    raw = stance_errors(a_stance(own, walked(own)), rough)
    smooth, course = (found[name].curves["cop_ground"][1] for name in "ba")
    both = np.isfinite(smooth) & np.isfinite(course)
    inner = both & (found["a"].share > 0.1) & (found["a"].share < 0.9)
    assert np.abs(smooth - course)[inner].max() < 0.01  # 0.087 of the foot before the filter
    assert np.nanmax(np.abs(np.diff(raw.curves["cop_ground"][1]))) > 0.1
    assert not both[(found["a"].share < 0.0) | (found["a"].share > 1.0)].any()
