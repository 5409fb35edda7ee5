"""What speaks against a recording beside a simulated arm: a sign, a unit, another arm, a clock that is off."""

from __future__ import annotations

import numpy as np

from geocontact.identify.goodness_of_fit import Doubt
from geocontact.identify.signals.agreement import clock_off, clock_words, likely_cause
from geocontact.shoulder_exoskeleton.beside_recording import ALL, ComparedChannel


def recording_doubts(one: ComparedChannel, delay: float | None = None) -> list[Doubt]:
    """R² below 0, with what is likely, and a clock that is off; `delay` [s] is what it was set right by.

    None where there is no `delay` to be given.
    """
    both = np.isfinite(one.model) & np.isfinite(one.measured)
    model, measured = one.model[both], one.measured[both]
    found = []
    r2 = one.errors[ALL].r2
    if r2 < 0.0:
        what = f"{one.channel}: R² is {r2:.2g}, a constant would fit better{likely_cause(model, measured)}"
        found.append(Doubt(what, True, -r2))
    if clock := _clock(one, delay):
        found.append(Doubt(f"{one.channel}: {clock}", False))
    return found


def _clock(one: ComparedChannel, delay: float | None) -> str:
    lag = clock_off(one.model, one.measured, float(one.time[1] - one.time[0]))
    if lag == 0.0:
        return ""
    return clock_words(lag) if delay is None else f"{clock_words(lag)} give `delay` {delay - lag:.2f}s"
