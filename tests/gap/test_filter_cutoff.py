"""Corner of the low-pass filter of measured inputs, read off their spectra. All recordings here are synthetic."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import butter, filtfilt

from geocontact.data.motion import Signals
from geocontact.data.trial import Trial
from geocontact.gap.inputs.spectrum_components import USUAL, filters_of, likely_noise
from geocontact.identify.signals.low_pass import LowPass

STEP = 0.005
NYQUIST = 0.5 / STEP
FAINT = 0.00008
"""rad, of some 1.3 that the input moves: less than one input by itself tells."""


def trials(corner: float, noise: float, count: int = 4, lost: float = 0.0, digits: int = 12) -> list[Trial]:
    """Strides of 0.8 s: harmonics of 1.2 Hz that fall off, noise through the filter, rows lost, values rounded."""
    rng = np.random.default_rng(int(corner * 10))
    made = []
    for k in range(count):
        time = STEP * np.arange(160)
        clean = sum(0.3**h * np.sin(2.0 * np.pi * 1.2 * (h + 1) * time + h + 0.1 * k) for h in range(4))
        raw = rng.standard_normal(len(time) + 400)
        if corner < NYQUIST:
            raw = filtfilt(*butter(2, corner, fs=1.0 / STEP), raw)
        raw = raw[200:-200]
        keep = rng.random(len(time)) >= lost
        values = np.round(clean + noise * raw / raw.std(), digits)
        made.append(Trial(f"t{k}", Signals(time[keep], values[keep, None], ("u",), ("rad",))))
    return made


@pytest.mark.parametrize("lost", [0.0, 0.03])
@pytest.mark.parametrize(("corner", "off"), [(6.0, 0.5), (10.0, 0.2), (20.0, 0.2)])
def test_a_corner_is_found_unless_the_movement_hides_it(corner: float, off: float, lost: float) -> None:
    assert filters_of(trials(corner, 0.003, lost=lost), ("u",))["u"].corner == pytest.approx(corner, rel=off)


@pytest.mark.parametrize("digits", [4, 5])
def test_rounding_is_not_taken_for_noise_of_a_high_corner(digits: int) -> None:
    assert filters_of(trials(6.0, 0.003, digits=digits), ("u",))["u"].corner == pytest.approx(6.0, rel=0.5)


@pytest.mark.parametrize("noise", [0.003, 0.02, 0.08])
def test_noise_that_nobody_filtered_is_not_taken_for_rounding(noise: float) -> None:
    made = trials(NYQUIST, noise)
    passed = filters_of(made, ("u",))["u"]
    assert passed.corner == pytest.approx(NYQUIST)
    assert likely_noise(made, "u", passed) == pytest.approx(noise, rel=0.2)


def test_one_recording_that_is_quicker_than_the_others_changes_nothing() -> None:
    """It has frequencies that they have not."""
    made, quick = trials(NYQUIST, 0.003), trials(NYQUIST, 0.003)[-1]
    time = quick.time / 1.2
    made[-1] = Trial(quick.name, Signals(time, quick.signals.values, ("u",), ("rad",)))
    assert filters_of(made, ("u",))["u"].corner == pytest.approx(NYQUIST)


def test_recordings_too_short_for_a_spectrum_beside_one_that_is_quicker_say_nothing() -> None:
    """All that the quick one shows lies beyond what the others could."""
    made = [Trial(t.name, Signals(t.time[:20], t.signals.values[:20], ("u",), ("rad",))) for t in trials(9.0, 0.003)]
    quick = Signals(
        0.1 * made[-1].time[0] + 0.0005 * np.arange(24), trials(9.0, 0.003)[0].signals.values[:24], ("u",), ("rad",)
    )
    made[-1] = Trial(made[-1].name, quick)
    passed = filters_of(made, ("u",))["u"]
    assert passed.corner == pytest.approx(USUAL / STEP) and likely_noise(made, "u", passed) == 0.0


def test_without_noise_none_is_made_up() -> None:
    made = trials(6.0, 0.0)
    assert likely_noise(made, "u", filters_of(made, ("u",))["u"]) < 1e-5


def beside(first: list[Trial], second: list[Trial]) -> list[Trial]:
    """Trials with the inputs u and v."""
    return [
        Trial(a.name, Signals(a.time, np.column_stack([a.column("u"), b.column("u")]), ("u", "v"), ("rad", "m")))
        for a, b in zip(first, second, strict=True)
    ]


def test_inputs_share_it() -> None:
    passed = filters_of(beside(trials(15.0, 0.003), trials(15.0, 1e-5)), ("u", "v"))
    assert passed["u"] == passed["v"] and passed["u"].corner == pytest.approx(15.0, rel=0.2)


@pytest.mark.parametrize("corner", [6.0, 15.0])
def test_an_input_that_nobody_filtered_stands_beside_one_that_was(corner: float) -> None:
    passed = filters_of(beside(trials(corner, 0.003), trials(NYQUIST, 0.003)), ("u", "v"))
    assert passed["v"] == LowPass.none(passed["v"].step)
    assert passed["u"].corner == pytest.approx(corner, rel=0.5)


@pytest.mark.parametrize("level", [0.3, 1.0])
def test_an_input_that_noise_drowns_is_no_witness(level: float) -> None:
    """Its noise up to the corner could be a quick movement: the others decide."""
    drowned = [
        Trial(t.name, Signals(t.time, t.signals.values - clean.signals.values, ("u",), ("rad",)))
        for t, clean in zip(trials(15.0, level), trials(15.0, 0.0), strict=True)
    ]
    passed = filters_of(beside(trials(15.0, 0.003), drowned), ("u", "v"))
    assert passed["u"].corner == pytest.approx(15.0, rel=0.2)


def test_together_inputs_tell_sooner_that_nobody_filtered_them() -> None:
    """Each alone is too faint a witness."""
    alone = filters_of(trials(NYQUIST, FAINT), ("u",))["u"]
    assert alone.corner < 2.0 * USUAL / STEP
    both = filters_of(beside(trials(NYQUIST, FAINT), trials(NYQUIST, FAINT)), ("u", "v"))
    assert both["u"] == both["v"] == LowPass.none(both["u"].step)


def test_an_input_that_goes_on_and_off_says_nothing() -> None:
    """A square wave has all frequencies."""
    flags = [
        Trial(t.name, Signals(t.time, (t.column("u")[:, None] > 0.0).astype(float), ("u",), ("-",)))
        for t in trials(6.0, 0.003)
    ]
    passed = filters_of(beside(trials(6.0, 0.003), flags), ("u", "v"))
    assert passed == filters_of(trials(6.0, 0.003), ("u",)) | {"v": passed["u"]}


@pytest.mark.parametrize("still", [0.0, 1.0])
def test_an_input_that_stands_still_or_is_too_short_says_nothing(still: float) -> None:
    quiet = [Trial(t.name, Signals(t.time, np.full((len(t), 1), still), ("u",), ("rad",))) for t in trials(9.0, 0.003)]
    assert filters_of(quiet, ("u",))["u"].corner == pytest.approx(USUAL / STEP)
    short = [Trial(t.name, Signals(t.time[:20], t.signals.values[:20], ("u",), ("rad",))) for t in trials(9.0, 0.003)]
    assert filters_of(short, ("u",))["u"].corner == pytest.approx(USUAL / STEP)


@pytest.mark.parametrize("noise", [0.003, 0.03])
def test_the_level_of_the_noise_is_read_off_too(noise: float) -> None:
    """The largest is fifteen times what is believed beforehand."""
    assert likely_noise(trials(9.0, noise), "u", LowPass(9.0, STEP)) == pytest.approx(noise, rel=0.35)


def test_an_input_that_stands_still_has_none() -> None:
    quiet = [Trial(t.name, Signals(t.time, np.full((len(t), 1), 2.0), ("u",), ("rad",))) for t in trials(9.0, 0.003)]
    assert likely_noise(quiet, "u", LowPass(9.0, STEP)) == 0.0
