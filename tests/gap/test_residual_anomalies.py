"""Lines, bursts, held samples and coarse steps are seen; noise is none of them."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.motion import Signals
from geocontact.data.trial import Trial
from geocontact.gap.case.noise_sources import at_mains
from geocontact.gap.inputs.spectrum import switches
from geocontact.gap.levels import SURE
from geocontact.gap.selection.residual_anomalies import ResidualAnomaly, moving
from tests.elsewhere import Elsewhere
from tests.gap.cases import (
    Tremor,
    held,
    in_steps,
    knock,
    odd,
    ringing_by_windows,
    rung,
    share_of_line,
    share_of_wide_band,
    shares_of_line,
)


def test_noise_is_not_odd(elsewhere: Elsewhere) -> None:
    assert max(elsewhere(odd, None).values()) < 4.0


def test_a_tremor_is_a_line_at_its_frequency(elsewhere: Elsewhere) -> None:
    words, nats = max(elsewhere(odd, Tremor(0.25, 7.0)).items(), key=lambda each: each[1])
    assert nats > 20.0
    assert float(words.split()[3]) == pytest.approx(7.0, abs=0.3)


@pytest.mark.parametrize(("size", "low", "high"), [(0.25, 0.4, 0.6), (3.0, 0.98, 1.0)])
def test_a_line_makes_up_a_share_of_the_error(elsewhere: Elsewhere, size: float, low: float, high: float) -> None:
    """Of 0.17 N, root mean square, of everything else: half, or nearly all."""
    assert low < elsewhere(share_of_line, Tremor(size, 7.0)) < high


def test_what_makes_up_little_of_an_error_is_little_however_sure() -> None:
    assert ResidualAnomaly("a line", "force", 5000.0, 0.01).part == pytest.approx(0.01)
    half = ResidualAnomaly("a line", "force", SURE + float(np.log(2.0)), 0.8)
    assert half.part == pytest.approx(0.4)
    assert ResidualAnomaly("a line", "force", SURE - 1.0, 0.8).part == 0.0


def test_a_share_is_told_of_what_has_one() -> None:
    assert (
        ResidualAnomaly("a line at 7 Hz", "force", 9.0, 0.234).told
        == "a line at 7 Hz in force, 23 % of its squared error"
    )
    assert ResidualAnomaly("a burst", "force", 9.0).told == "a burst in force"


def test_of_the_base_models_error_what_an_effect_leaves_is_a_smaller_share(elsewhere: Elsewhere) -> None:
    """A ninth, where the base model leaves three times as much in every sample."""
    alone, beside = elsewhere(shares_of_line, Tremor(0.25, 7.0), 3.0)
    assert beside == pytest.approx(alone / 9.0, rel=1e-6)


def test_smooth_noise_in_the_band_of_an_oscillation_is_no_part_of_it(elsewhere: Elsewhere) -> None:
    assert elsewhere(share_of_wide_band, None) < 0.05
    assert elsewhere(share_of_wide_band, Tremor(0.25, 7.0)) > 0.3


def test_a_slow_tremor_is_a_line_too(elsewhere: Elsewhere) -> None:
    """Ten periods in a trial, whose neighbours in the spectrum reach to its beginning."""
    words, nats = max(elsewhere(odd, Tremor(0.6, 1.3), duration=8.0).items(), key=lambda each: each[1])
    assert nats > 10.0
    assert float(words.split()[3]) == pytest.approx(1.3, abs=0.15)


def test_what_a_model_misses_at_the_frequency_of_the_movement_is_no_line(elsewhere: Elsewhere) -> None:
    """The elbow goes to and fro 0.41 times a second."""
    seen = elsewhere(odd, Tremor(1.0, 0.41))
    assert max(nats for words, nats in seen.items() if "line" in words) < 5.0


def test_a_knock_in_one_trial_is_a_burst(elsewhere: Elsewhere) -> None:
    assert elsewhere(odd, knock)["a burst"] > 15.0


def test_samples_that_are_held(elsewhere: Elsewhere) -> None:
    seen = elsewhere(odd, None, held)
    assert any("repeat the last" in words and nats > 20.0 for words, nats in seen.items())


def test_coarse_steps(elsewhere: Elsewhere) -> None:
    assert any(words.startswith("it comes in steps of 0.2") for words in elsewhere(odd, None, in_steps))


def test_ringing_at_the_same_phase_of_every_trial(elsewhere: Elsewhere) -> None:
    seen = elsewhere(odd, rung)
    words, nats = max((each for each in seen.items() if "ringing" in each[0]), key=lambda each: each[1])
    assert nats > 15.0
    assert float(words.split()[2]) == pytest.approx(8.0, abs=1.6)


@pytest.mark.parametrize("cycles", [2, 8])
def test_windows_follow_from_the_periods_that_they_must_hold(elsewhere: Elsewhere, cycles: int) -> None:
    assert elsewhere(ringing_by_windows, cycles) > SURE


def test_hum_of_the_mains_is_of_the_recorder_where_sampling_folds_it_to(elsewhere: Elsewhere) -> None:
    """60 Hz, 25 times a second, is seen at 10 Hz; it is remarked upon, and no line."""
    seen = elsewhere(odd, Tremor(0.25, 10.0))
    assert max(nats for words, nats in seen.items() if "a line" in words) < 5.0
    words, nats = max((each for each in seen.items() if "hum" in each[0]), key=lambda each: each[1])
    assert nats > 20.0 and float(words.split()[5]) == pytest.approx(10.0, abs=0.3)


def test_frequencies_of_the_mains_are_few() -> None:
    """At 1000 samples a second 50 and 60 Hz themselves."""
    found = np.flatnonzero(at_mains(501, 1000, 1e-3))
    assert set(found) == {48, 49, 50, 51, 52, 58, 59, 60, 61, 62}


def test_what_only_goes_on_and_off_hides_no_line() -> None:
    """Its harmonics are everywhere; a smooth movement has few frequencies."""
    time = 0.02 * np.arange(400)
    values = np.column_stack([np.sin(2.0 * np.pi * 0.4 * time) > 0.0, np.sin(2.0 * np.pi * 0.4 * time)]).astype(float)
    trial = Trial("t", Signals(time, values, ("on", "angle"), ("", "rad")))
    assert moving(trial, ("on",), 201).mean() > 0.5
    assert 0 < moving(trial, ("angle",), 201).sum() < 20
    assert switches([trial], "on") and not switches([trial], "angle")
