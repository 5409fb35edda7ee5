"""How much of an input's noise may be believed: no more than may be taken off without harm to the base model.

A spectrum alone does not tell noise from a movement that ends where a filter might. Noise that is taken off leaves the
base model's error as it is or smaller; movement that is taken off makes it larger.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import System
from geocontact.gap.case.plain_fit import plain_fit
from geocontact.gap.case.refit import Measured
from geocontact.gap.inputs.denoise import Filters, denoised

HARM = 0.02  # of the base model's squared error, that it may grow by
HALVINGS = 6  # of a level, before nothing is believed of it
ROUNDS = 4  # of a fit that sets out where the base model is


def tolerated(
    system: System,
    measured: Measured,
    floor: Float[np.ndarray, " c"],
    values: Mapping[str, float],
    levels: Mapping[str, float],
    passed: Filters,
) -> dict[str, float]:
    """The largest of each level, its half, its quarter and so on whose taking off does no harm; 0 where all do.

    Every input is tried alone. The error is that of the base model refitted to the calibration trials, every channel
    divided by its floor: held-out trials are not looked at.

    Parameters
    ----------
    values
        Of the base model where it was fitted to `measured`.
    levels
        Standard deviations of the noise of inputs, in their units.
    """

    def error(name: str, level: float) -> float:
        trials = tuple(denoised(trial, {name: level}, passed) for trial in measured.trials)
        return plain_fit(system, replace(measured, trials=trials), floor, [values], ROUNDS).cost

    found, without = {}, plain_fit(system, measured, floor, [values], ROUNDS).cost
    for name, level in levels.items():
        tried = (level * 0.5**k for k in range(HALVINGS))
        found[name] = next((own for own in tried if error(name, own) <= (1.0 + HARM) * without), 0.0)
    return found
