"""How much of an input's noise may be believed: no more than may be taken off without harm to the base model.

A spectrum alone does not tell noise from a movement that ends where a filter might. Noise that is taken off leaves the
base model's error as it is or smaller; movement that is taken off makes it larger, in some channel if not in the sum:
one that hardly notices may have most of the error.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import System
from geocontact.gap.case.change_amplitude import amplitude
from geocontact.gap.case.plain_fit import plain_fit
from geocontact.gap.case.refit import ROUNDS, Measured
from geocontact.gap.inputs.denoise import Filters, denoised
from geocontact.gap.levels import SLIGHT


def tolerated(
    system: System,
    measured: Measured,
    held_out: Measured,
    values: Mapping[str, float],
    levels: Mapping[str, float],
    passed: Filters,
) -> dict[str, float]:
    """The largest of each level, its half, its quarter and so on whose taking off does no harm; 0 where all do.

    Levels below `SLIGHT` of what they were are not tried.

    Every input is tried alone. The base model is refitted to the calibration trials, every channel divided by its rough
    noise. The error there may not grow in the sum, nor surely in any channel of the held-out trials.

    Parameters
    ----------
    measured, held_out
        Calibration trials, and those that nothing is fitted to.
    values
        Of the base model where it was fitted to `measured`.
    levels
        Standard deviations of the noise of inputs, in their units.
    """

    def without(noise: Mapping[str, float]) -> tuple[float, list[Float[np.ndarray, "_ c"]]]:
        first, later = (
            replace(some, trials=tuple(denoised(trial, noise, passed) for trial in some.trials))
            for some in (measured, held_out)
        )
        fitted = plain_fit(system, first, measured.rough, [values], ROUNDS // 2)
        return fitted.cost, later.residuals(system, fitted.values)

    def harmless(name: str, level: float) -> bool:
        cost, after = without({name: level})
        return cost <= (1.0 + SLIGHT) * whole and not worse_somewhere(before, after)

    (whole, before), found = without({}), {}
    for name, level in levels.items():
        tried = (level * 0.5**k for k in range(int(np.log2(1.0 / SLIGHT)) + 1))
        found[name] = next((own for own in tried if harmless(name, own)), 0.0)
    return found


def worse_somewhere(before: Sequence[Float[np.ndarray, "_ c"]], after: Sequence[Float[np.ndarray, "_ c"]]) -> bool:
    """Whether the error of some channel surely grows."""
    change = [b - a for b, a in zip(before, after, strict=True)]
    channels = (slice(c, c + 1) for c in range(before[0].shape[1]))
    each = (amplitude([b[:, own] for b in before], [m[:, own] for m in change]) for own in channels)
    return any(one is not None and one.worse for one in each)
