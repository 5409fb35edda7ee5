"""Recordings that end at a level are seen; tops of movements, held samples and rests are not."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.gap.levels import SURE
from geocontact.gap.selection.residual_anomalies import pile
from tests.elsewhere import Elsewhere
from tests.gap.cases import Clip, diagnosis, flat, held

LEVEL = 14.9  # N, that noise passes at the highest tops only


def test_values_at_the_end_of_a_range_are_counted() -> None:
    x = np.sin(np.linspace(0.0, 20.0, 500))
    assert pile(np.minimum(x, 0.99), 0.0)[:2] == (0.99, int((x >= 0.99).sum()))
    assert pile(np.minimum(x, 0.99), 0.0)[2] > 20.0
    assert pile(x, 0.0)[2] < SURE


@pytest.mark.parametrize("step", [0.02, 0.05, 0.1])
def test_the_top_of_a_movement_in_steps_is_not_flat(step: float) -> None:
    """The last step below a parabola's top holds up to 2.4 times what the one below it does."""
    for top in np.linspace(1.0, 1.0 + step, 7):
        x = np.floor(top * np.sin(np.linspace(0.0, 20.0, 500)) / step) * step
        assert pile(x, step)[2] < SURE


@pytest.mark.slow
def test_a_clipped_recording_has_a_flat_top(elsewhere: Elsewhere) -> None:
    (top,) = elsewhere(flat, Clip(LEVEL))
    assert (top.channel, top.level) == ("force", LEVEL)
    assert top.count > 8
    (coarse,) = elsewhere(flat, Clip(13.5, 0.05))
    assert coarse.level == pytest.approx(13.5)


@pytest.mark.slow
def test_noise_steps_and_held_samples_are_no_flat_top(elsewhere: Elsewhere) -> None:
    for recorded in (None, held, Clip(1e3, 0.05)):
        assert elsewhere(flat, recorded) == ()


@pytest.mark.slow
def test_what_clips_little_is_remarked_upon_and_is_no_gap(elsewhere: Elsewhere) -> None:
    """Held-out trials are predicted no better with it: a dozen samples at the same extreme are no gap."""
    said = elsewhere(diagnosis, seed=7, recorded=Clip(LEVEL))
    assert (said.verdict, said.effects) == ("no_gap", ())
    assert any("lie at the same extreme" in words for words in said.remarks)
