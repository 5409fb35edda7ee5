"""Quick recordings are averaged over blocks where that loses nothing but noise, and stay as they are where it would."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

import geocontact as gc
from geocontact.analyses.gap.block_means import LONGEST, Evenness, averaged
from geocontact.analyses.gap.thinning import read_thinned, thinned_and_said
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.gap.diagnose import diagnose
from geocontact.io.cases.gap_case_writer import write_gap_case
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere

RATE = 1000.0  # samples per second
SIZE = 40  # samples in LONGEST
NOISE = 0.1
Column = np.ndarray
Change = Callable[[Column, Column], Column]


def quick_case(change: Change = lambda _, torque: torque, seed: int = 3, seconds: float = 6.0) -> GapCase:
    """A spring at 1000 samples per second; `change` of time and torque is what its sensor reads, noise and all."""
    rng, time, trials = np.random.default_rng(seed), np.arange(round(seconds * RATE)) / RATE, []
    for k in range(5):
        angle = 0.25 * np.sin((3.0 + 0.5 * k) * time + k) + 0.1 * np.sin(1.3 * time)
        torque = 31.0 * (angle - 0.05) + NOISE * rng.standard_normal(len(time))
        seen = angle + 2e-4 * rng.standard_normal(len(time))
        values = np.column_stack([seen, change(time, torque)])
        trials.append(Trial(f"t{k}", Signals(time, values, ("angle", "torque"), ("rad", "N m"))))
    parameters = (Parameter("k", "N m/rad", 20.0, 5.0, 80.0), Parameter("angle0", "rad", 0.0, -0.3, 0.3))
    joint = "geocontact.systems.elastic_joint:JOINT"
    return GapCase("case", joint, tuple(trials[:3]), tuple(trials[3:]), parameters, noise={"torque": NOISE})


def size_of(case: GapCase) -> int:
    """Samples in a block."""
    return averaged(case, ("torque",), ("angle",))[1]


def test_means_are_those_of_numpy_and_white_noise_shrinks_with_their_root() -> None:
    case = quick_case()
    fewer, size = averaged(case, ("torque",), ("angle",))
    assert size == SIZE == round(LONGEST * RATE)
    for before, after in zip(case.calibration, fewer.calibration, strict=True):
        by_hand = before.signals.values.reshape(-1, SIZE, 2).mean(axis=1)
        np.testing.assert_allclose(after.signals.values, by_hand, rtol=0, atol=1e-12)
        np.testing.assert_allclose(after.time, before.time.reshape(-1, SIZE).mean(axis=1), rtol=0, atol=1e-12)
    assert fewer.noise["torque"] == pytest.approx(NOISE / SIZE**0.5, rel=0.1)


def test_what_halves_of_blocks_differ_by_has_the_variance_of_white_noise() -> None:
    """Against s² (4 + 1/8)/k, and a straight line that leaves nothing."""
    time = np.arange(200_000) / RATE
    noise = np.random.default_rng(8).standard_normal(len(time))
    found = Evenness.of(time, noise + 50.0 * time, 1.0 / RATE, SIZE)
    assert found.bent.var() == pytest.approx(4.125 / SIZE, rel=0.05)
    np.testing.assert_allclose(found.noise, 1.0, atol=0.2)  # medians of 20 blocks
    assert found.noise.mean() == pytest.approx(1.0, abs=0.02)
    assert found.within == pytest.approx(1.0, rel=0.05)
    straight = Evenness.of(time, 50.0 * time, 1.0 / RATE, SIZE)
    assert np.abs(straight.bent).max() < 1e-8


def test_noise_that_remembers_shrinks_less() -> None:
    """An Ornstein-Uhlenbeck process of two samples' memory, against the variance of its mean in closed form."""
    kept = float(np.exp(-0.5))

    def remembering(time: Column, torque: Column) -> Column:
        drive = np.random.default_rng(len(time) + int(1e6 * abs(torque[0]))).standard_normal(len(time))
        noise = np.empty(len(time))
        noise[0] = drive[0]
        for i in range(1, len(time)):
            noise[i] = kept * noise[i - 1] + (1.0 - kept**2) ** 0.5 * drive[i]
        return torque + 5.0 * NOISE * noise

    case = replace(quick_case(remembering), noise={"torque": 5.0 * NOISE})
    fewer, size = averaged(case, ("torque",), ("angle",))
    lags = np.arange(1, size)
    share = (1.0 + 2.0 * float(((1.0 - lags / size) * kept**lags).sum())) / size
    assert size > 10
    assert fewer.noise["torque"] == pytest.approx(5.0 * NOISE * share**0.5, rel=0.15)


def slow(memory: float, sd: float, _: Column, torque: Column) -> Column:
    """Noise of an Ornstein-Uhlenbeck process with a memory of so many samples, added."""
    kept, rng = float(np.exp(-1.0 / memory)), np.random.default_rng(int(1e6 * abs(torque[0])))
    drive = (1.0 - kept**2) ** 0.5 * rng.standard_normal(len(torque))
    drive[0] = rng.standard_normal()
    return np.asarray(torque + sd * lfilter([1.0], [1.0, -kept], drive))


SLOW = 0.3  # of noise beside the white one, in N m


@pytest.mark.parametrize("memory", [100.0, 200.0, 1000.0])
def test_noise_slower_than_a_block_stays(memory: float) -> None:
    """Beside white noise, against the variance of the means of both in closed form."""
    case = replace(
        quick_case(partial(slow, memory, SLOW), seconds=20.0), noise={"torque": float(np.hypot(NOISE, SLOW))}
    )
    fewer, size = averaged(case, ("torque",), ("angle",))
    lags = np.arange(1, size)
    kept = (1.0 + 2.0 * float(((1.0 - lags / size) * np.exp(-lags / memory)).sum())) / size
    assert size >= 30
    assert fewer.noise["torque"] == pytest.approx((NOISE**2 / size + SLOW**2 * kept) ** 0.5, rel=0.03)


def test_a_right_model_fits_means_with_slow_noise(elsewhere: Elsewhere) -> None:
    """A spring as it is: what the means have beside it is the stated noise."""
    d = elsewhere(answered, partial(slow, 200.0, SLOW), float(np.hypot(NOISE, SLOW)))
    assert "blocks of 40" in d["said"][0]
    assert (d["verdict"], d["effects"]) == ("no_gap", []), d["remarks"]


def pulse(time: Column, torque: Column) -> Column:
    """An impact of 8 ms."""
    return torque + 6.0 * np.exp(-0.5 * ((time - 2.5) / 0.004) ** 2)


def step(time: Column, torque: Column) -> Column:
    """A clock that slips by 90 ms: the torque jumps."""
    return np.where(time < 3.0, torque, np.interp(time - 0.09, time, torque))


def clipped(_: Column, torque: Column) -> Column:
    """A sensor that ends at a level."""
    return np.minimum(torque, 6.0)


def held(_: Column, torque: Column) -> Column:
    """Every second sample repeats the one before."""
    return np.repeat(torque[::2], 2)


def coarse(_: Column, torque: Column) -> Column:
    """Steps of five times the noise."""
    return np.round(torque / (5.0 * NOISE)) * 5.0 * NOISE


def line(time: Column, torque: Column) -> Column:
    """A resonance at 90 Hz, smaller than the noise."""
    return torque + 0.4 * NOISE * np.sin(2.0 * np.pi * 90.0 * time)


@pytest.mark.parametrize("change", [pulse, step, clipped, held, coarse, line])
def test_what_blocks_would_hide_keeps_its_samples(change: Change) -> None:
    """Or blocks are so short that it is seen in their means: half an impact, half a period of a line."""
    longest = {pulse: 4, line: int(RATE / 90.0 / 2.0)}
    assert size_of(quick_case(change)) <= longest.get(change, 1)


def test_an_input_that_switches_keeps_its_samples() -> None:
    case = quick_case()
    for trial in (*case.calibration, *case.evaluation):
        trial.signals.values[:, 0] = (trial.time > 2.003).astype(float)
    assert size_of(case) == 1


def test_lost_rows_stay_lost_and_move_no_other() -> None:
    """Half a second of rows is missing; the others lie in the blocks that they lay in before."""
    case = quick_case()
    whole = averaged(case, ("torque",), ("angle",))[0].calibration[0]
    first = case.calibration[0]
    kept = (first.time < 2.0 - 1e-9) | (first.time > 2.5 - 1e-9)
    signals = replace(first.signals, time=first.time[kept], values=first.signals.values[kept])
    holed = replace(case, calibration=(replace(first, signals=signals), *case.calibration[1:]))
    fewer, size = averaged(holed, ("torque",), ("angle",))
    after = fewer.calibration[0]
    assert size == SIZE
    assert 0.4 < np.diff(after.time).max() < 0.6
    there = np.isin(np.round(after.time, 6), np.round(whole.time, 6))
    assert there.mean() > 0.98


def test_empty_cells_stay_empty() -> None:
    case = quick_case()
    for trial in case.calibration:
        trial.signals.values[1000:2000, 1] = np.nan
    fewer, size = averaged(case, ("torque",), ("angle",))
    assert size == SIZE
    empty = np.isnan(fewer.calibration[0].column("torque"))
    np.testing.assert_array_equal(np.flatnonzero(empty), np.arange(25, 50))
    assert np.isfinite(fewer.calibration[0].column("angle")).all()


def test_cells_that_are_missing_now_and_then_keep_the_rest() -> None:
    case = quick_case()
    for trial in (*case.calibration, *case.evaluation):
        trial.signals.values[::5, 1] = np.nan
    assert size_of(case) == 1


def test_it_is_said_and_no_short_recording_is_touched(tmp_path: Path) -> None:
    case = quick_case()
    write_gap_case(case, tmp_path / "case")
    with pytest.warns(gc.InputWarning, match=r"30000 samples .* averaged to 750, over blocks of 40 \(40 ms\)"):
        given = read_thinned(tmp_path / "case", False)
    assert len(given.thinned) == 1
    short = quick_case(seconds=1.0)
    assert thinned_and_said(short, system_of(short)) == (short, ())


def answered(change: Change, noise: float = NOISE) -> dict[str, object]:
    """Diagnosis of a quick recording as the command has it, with a stated noise."""
    case = replace(quick_case(change), noise={"torque": noise})
    case, said = thinned_and_said(case, system_of(case))
    return diagnose(case, system_of(case)).diagnosis.as_dict() | {"said": said}


def damped(time: Column, torque: Column) -> Column:
    """A damper of 1.5 N m s/rad beside the spring, by the slope of a smooth torque."""
    wide = np.ones(101) / 101.0
    smooth = np.convolve(np.pad(torque, 50, mode="reflect", reflect_type="odd"), wide, mode="valid")
    return torque + 1.5 / 31.0 * np.gradient(smooth, time)


@pytest.mark.slow
def test_a_damper_is_named_at_its_size_from_means(elsewhere: Elsewhere) -> None:
    d = elsewhere(answered, damped)
    assert "blocks of 40" in d["said"][0]
    assert d["effects"] == ["damping"], d["remarks"]
    assert d["parameters"]["damping.b"]["value"] == pytest.approx(1.5, rel=0.1)
