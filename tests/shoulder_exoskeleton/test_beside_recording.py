"""Models beside a recording: errors that were put in, on clocks of their own, and what was recorded in part."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.shoulder_exoskeleton.beside_recording import ALL, FORCE, WORK, Channels, beside_recording

TIME = np.arange(401) * 0.01
PHASE = np.select([TIME < 1.0, TIME < 2.0, TIME < 3.0], ["rest", "lift", "screw-in"], "lower")
LINE = {"model": (FORCE, 5.0 * TIME)}


def recorded(time: np.ndarray) -> Channels:
    """2 N more than the model while screwing, 1 N less else, up to a corner between samples."""
    return Channels(time, {FORCE: 5.0 * time + np.where((time >= 2.0) & (time < 3.0), 2.0, -1.0)})


def test_errors_are_those_that_were_put_in() -> None:
    found = beside_recording(TIME, LINE | {"other": ("elevation", TIME)}, PHASE.tolist(), recorded(TIME))
    assert found.share == 1.0 and list(found.channels) == ["model"], "elevation was not recorded"
    errors = found.channels["model"].errors
    assert {name: each.bias for name, each in errors.items() if name not in (ALL, WORK)} == pytest.approx(
        {"lift": 1.0, "screw-in": -2.0, "lower": 1.0}
    )
    assert errors[WORK].mae == pytest.approx((100 + 2 * 100 + 101) / 301) and errors[ALL].samples == 401


def test_a_simulation_that_lacks_samples_is_compared_at_even_times() -> None:
    """Three rows cut out of a table: a line stays a line, and every phase its errors. It was a wrong shape before."""
    kept = np.delete(np.arange(401), [150, 250, 251])
    found = beside_recording(TIME[kept], {"model": (FORCE, 5.0 * TIME[kept])}, PHASE[kept].tolist(), recorded(TIME))
    one = found.channels["model"]
    np.testing.assert_allclose(one.time, TIME, atol=1e-12)
    assert one.errors["lift"].bias == pytest.approx(1.0) and one.errors["screw-in"].bias == pytest.approx(-2.0)
    assert one.errors["screw-in"].samples == 98 and np.isnan(one.model[250:252]).all(), "nothing is made up in a gap"


def test_what_was_recorded_in_part_is_compared_there() -> None:
    half = beside_recording(TIME, LINE, PHASE.tolist(), recorded(TIME[TIME >= 2.0]))
    assert half.share == pytest.approx(201 / 401)
    assert set(half.channels["model"].errors) == {ALL, WORK, "screw-in", "lower"}
    assert np.isnan(half.channels["model"].measured[:200]).all()
    later = beside_recording(TIME, LINE, PHASE.tolist(), recorded(TIME + 10.0))
    assert not later.channels and later.share == 0.0
