"""The low-pass filters that the inputs of a case came through, read off their spectra.

Motion is slow; above its own frequencies a recording holds noise up to the corner of the filter and little beyond it.
The spectrum of every input is taken apart into movement, noise and a white rest (`gap/inputs/spectrum_components.py`),
with one f_c for all inputs that were filtered. Frequencies are in cycles per sample: 6 Hz of motion capture at 100 Hz
are 0.06. Corners far from the usual one are believed less: where the movement hides the noise, f_c stays near that.
Usually all inputs were filtered, or none; that some were and others not is believed least.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from geocontact.data.trial import Trial
from geocontact.gap.inputs.spectrum import spectrum
from geocontact.gap.inputs.spectrum_components import split
from geocontact.gap.levels import SURE
from geocontact.identify.signals.low_pass import BELOW_NYQUIST, LowPass

USUAL, USUALLY = 0.08, 0.9  # per sample, and the standard deviation of its logarithm: 6 Hz at 75 (Winter 2009)
CORNERS = 21  # that are compared, from one as far below the usual one as the highest that can be told is above it
UNFILTERED = 4.0  # nats that must speak for no filter of any input


def filters_of(trials: Sequence[Trial], inputs: Sequence[str]) -> Mapping[str, LowPass]:
    """The filter, if any, of each input that makes the spectra most likely; the usual one without spectra."""
    step = float(np.median(np.concatenate([np.diff(trial.time) for trial in trials])))
    highest = 0.5 * BELOW_NYQUIST
    corners = np.geomspace(USUAL**2 / highest, highest, CORNERS) / step
    found = {name: spectrum(trials, name, step) for name in inputs}
    seen = {name: each for name, each in found.items() if each is not None}
    if not seen:
        return dict.fromkeys(inputs, LowPass(USUAL / step, step))
    filters = [*(LowPass(f, step) for f in corners), LowPass.none(step)]
    costs = np.array([split(each, filters).unlikely for each in seen.values()])
    through, free = costs[:, :-1], costs[:, -1]
    far = 0.5 * (np.log(corners * step / USUAL) / USUALLY) ** 2
    everyone, each = far + through.sum(axis=0), far + np.minimum(through, free[:, None]).sum(axis=0) + 2.0 * SURE
    if free.sum() + UNFILTERED < min(everyone.min(), each.min()):
        return dict.fromkeys(inputs, LowPass.none(step))
    raw = (free < through[:, np.argmin(each)]) & (each.min() < everyone.min())
    differ = {name: LowPass.none(step) for name, own in zip(seen, raw, strict=True) if own}
    return dict.fromkeys(inputs, LowPass(_between(np.log(corners), far + through[~raw].sum(axis=0)), step)) | differ


def _between(at: Float[np.ndarray, " n"], costs: Float[np.ndarray, " n"]) -> float:
    """Where a parabola through the least value and its neighbours is least."""
    k = int(np.argmin(costs))
    if not 0 < k < len(costs) - 1:
        return float(np.exp(at[k]))
    left, middle, right = costs[k - 1 : k + 2]
    bend = left - 2.0 * middle + right
    return float(np.exp(at[k] + 0.5 * (left - right) / max(bend, 1e-12) * (at[k + 1] - at[k])))


def likely_noise(trials: Sequence[Trial], name: str, passed: LowPass) -> float:
    """Standard deviation of an input's noise by its spectrum, 0 where it has none."""
    seen = spectrum(trials, name, passed.step)
    return 0.0 if seen is None else float(split(seen, [passed]).noise[0])
