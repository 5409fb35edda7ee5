"""What speaks against a recording beside a simulated arm: a sign, a unit, another arm, a clock that is off."""

from __future__ import annotations

import numpy as np

from geocontact.identify.goodness_of_fit import Doubt
from geocontact.identify.signals.agreement import clock_off, clock_words
from geocontact.shoulder_exoskeleton.beside_recording import ALL, ComparedChannel

SIZES = 0.02
"""Sizes of the curves that differ by more than this, or its inverse, are of two units: cN, mN and kN beside N."""


def recording_doubts(one: ComparedChannel, delay: float | None = None) -> list[Doubt]:
    """R² below 0, with what is likely, and a clock that is off; `delay` [s] is what it was set right by.

    None where there is no `delay` to be given.
    """
    both = np.isfinite(one.model) & np.isfinite(one.measured)
    model, measured = one.model[both], one.measured[both]
    found = []
    r2 = one.errors[ALL].r2
    if r2 < 0.0:
        what = f"{one.channel}: R² is {r2:.2g}, a constant would fit better{_likely(model, measured)}"
        found.append(Doubt(what, True, -r2))
    if clock := _clock(one, delay):
        found.append(Doubt(f"{one.channel}: {clock}", False))
    return found


def _likely(model: np.ndarray, measured: np.ndarray) -> str:
    size = float(np.sqrt(np.mean(measured**2) / np.mean(model**2))) if model.any() else float("nan")
    if size < SIZES or size > 1.0 / SIZES:
        return f"; recorded values are {size:.2g} times the simulated ones: is the unit right?"
    if np.std(model) > 0.0 and np.std(measured) > 0.0 and np.corrcoef(model, measured)[0, 1] < 0.0:
        return ": is a sign turned?"
    return ""


def _clock(one: ComparedChannel, delay: float | None) -> str:
    lag = clock_off(one.model, one.measured, float(one.time[1] - one.time[0]))
    if lag == 0.0:
        return ""
    return clock_words(lag) if delay is None else f"{clock_words(lag)} give `delay` {delay - lag:.2f}s"
