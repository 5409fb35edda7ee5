"""What speaks against a recording beside a simulated arm: a sign, a unit, another arm, a clock that is off."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.identify.goodness_of_fit import Doubt
from geocontact.identify.signals.agreement import clock_off, clock_words, likely_cause
from geocontact.shoulder_exoskeleton.beside_recording import ALL, ELEVATION, FORCE, ComparedChannel

ZERO, STEADY = np.radians(10.0), 0.3
"""rad, by which the zero of an angle is off at least, and the standard deviation of the difference in parts of that."""
EXACTLY, FEWEST = 1e-9, 20
"""Relative difference of a copy, and samples of one."""


def recording_doubts(one: ComparedChannel, delay: float | None = None) -> list[Doubt]:
    """R² below 0, with what is likely, a copy, a zero or a clock that is off; `delay` [s] is what it was set right by.

    None where there is no `delay` to be given.
    """
    both = np.isfinite(one.model) & np.isfinite(one.measured)
    model, measured = one.model[both], one.measured[both]
    found = []
    r2 = one.errors[ALL].r2
    if r2 < 0.0:
        what = f"{one.channel}: R² is {r2:.2g}, a constant would fit better{likely_cause(model, measured)}"
        found.append(Doubt(what, True, -r2))
    if (
        one.channel in (ELEVATION, FORCE)
        and len(model) >= FEWEST
        and np.ptp(model) > 0.0
        and np.allclose(model, measured, rtol=EXACTLY, atol=0.0)
    ):
        found.append(Doubt(f"{one.channel}: the recording is the simulation, sample by sample: is it a copy?", False))
    elif one.channel == ELEVATION:
        found += _zero(model, measured)
    if clock := _clock(one, delay):
        found.append(Doubt(f"{one.channel}: {clock}", False))
    return found


def _zero(model: Float[np.ndarray, " t"], measured: Float[np.ndarray, " t"]) -> list[Doubt]:
    """A doubt for a recorded angle that is off by one and the same angle nearly all the time."""
    off = measured - model
    if len(off) < FEWEST or abs(off.mean()) < ZERO or np.std(off) > STEADY * abs(off.mean()):
        return []
    higher = "higher" if off.mean() > 0.0 else "lower"
    what = f"{ELEVATION}: recorded angles are {np.degrees(abs(off.mean())):.0f} degrees {higher} throughout"
    return [Doubt(f"{what}: is the sensor's zero that of an arm that hangs down?", False)]


def _clock(one: ComparedChannel, delay: float | None) -> str:
    lag = clock_off(one.model, one.measured, float(one.time[1] - one.time[0]))
    if lag == 0.0:
        return ""
    return clock_words(lag) if delay is None else f"{clock_words(lag)} give `delay` {delay - lag:.2f}s"
