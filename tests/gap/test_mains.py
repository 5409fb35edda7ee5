"""Hum of the mains as part of the noise of outputs."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.diagnosis import Diagnosis
from geocontact.gap.case.noise_sources import HUM, MAINS, hum, wave_count
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.diagnose import diagnose
from geocontact.gap.selection.model_comparison import base_contender
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import NOISE, elbow_case

LOUD = 0.9
"""Hum, root mean square in noise levels."""


def test_waves_of_usual_size_and_of_any_phase() -> None:
    """Weights of unit variance make hum of HUM noise levels, whatever the phase that a recording begins at."""
    time, rng = 3.0 + 0.004 * np.arange(500), np.random.default_rng(0)
    waves, count = hum(time, np.array([2.0, 0.1])), wave_count(1)
    assert waves.shape == (500, 2, 2 * count)
    for c, level in enumerate((2.0, 0.1)):
        own = waves[:, c, c * count : (c + 1) * count]
        assert not waves[:, c, np.delete(np.arange(2 * count), np.arange(c * count, (c + 1) * count))].any()
        made = own @ rng.standard_normal((count, 2000))
        assert np.sqrt((made**2).mean()) == pytest.approx(HUM * level * np.sqrt(len(MAINS)), rel=0.05)
        wave = np.sin(2.0 * np.pi * 60.0 * time + rng.uniform(0.0, 6.0))
        left = wave - own @ np.linalg.lstsq(own, wave, rcond=None)[0]
        assert float(left @ left) < 1e-9 * float(wave @ wave)


def test_hum_is_seen_where_sampling_folds_it_to() -> None:
    """60 Hz at 25 samples a second is 10 Hz; an uneven clock knows no such line."""
    even = 0.04 * np.arange(200)
    folded = np.cos(2.0 * np.pi * 10.0 * even)
    columns = hum(even, np.ones(1))[:, 0]
    assert np.abs(columns[:, 1] / HUM - folded).max() < 1e-9
    assert np.abs(columns[:, [0, 2]]).max() < 1e-9, "50 Hz are a constant, which a zero of the output is already"
    uneven = even + 0.012 * np.sin(np.arange(200.0))
    own = hum(uneven, np.ones(1))[:, 0]
    left = folded - own @ np.linalg.lstsq(own, folded, rcond=None)[0]
    assert float(left @ left) > 0.5 * float(folded @ folded)


def humming() -> tuple[Diagnosis, float, float]:
    """An elbow that lacks nothing, its force with hum of 60 Hz; the size of it that was estimated, and of the noise."""
    case, rng = elbow_case(seed=6), np.random.default_rng(9)
    for trial in (*case.calibration, *case.evaluation):
        phase = rng.uniform(0.0, 2.0 * np.pi)
        trial.signals.values[:, 1] += LOUD * NOISE * np.sqrt(2.0) * np.sin(2.0 * np.pi * 60.0 * trial.time + phase)
    system = system_of(case)
    found = diagnose(case, system).diagnosis
    problem = problem_of(case, system)
    noise = base_contender(problem).judged.noise
    waves = problem.placement[0][:, 0, -1 - wave_count(1) : -1] * noise.varies[-1 - wave_count(1) : -1]
    return found, float(np.sqrt((waves**2).sum(axis=1).mean())), float(noise.levels.sensors[0])


@pytest.mark.slow
def test_what_hums_lacks_nothing_and_its_noise_is_told_apart(elsewhere: Elsewhere) -> None:
    found, hum_level, noise = elsewhere(humming)
    assert (found.verdict, found.effects) == ("no_gap", ())
    assert hum_level == pytest.approx(LOUD * NOISE, rel=0.35)
    assert noise == pytest.approx(NOISE, rel=0.25), "the hum is no part of the other noise"
    assert any("hum of the mains" in remark for remark in found.remarks)
