"""How a model with a motion of its own answers to noise of single samples of its inputs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.chain.differentiated_inputs import NEIGHBOURS
from geocontact.chain.system import FAR, System
from geocontact.data.trial import Trial
from geocontact.gap.levels import SLIGHT
from geocontact.identify.noise.covariance import BLOCK_ROWS
from geocontact.identify.noise.input_noise import Lasting
from geocontact.identify.noise.noise_spectrum import NoiseSpectrum

BUMP = 1e-3  # of an input's half-range
PLACES = (0.2, 0.35, 0.5, 0.65)  # of a trial, where it is seen how long a response lasts


def responses(system: System, trial: Trial, values: Mapping[str, float], spectra: tuple[NoiseSpectrum, ...]) -> Lasting:
    """Responses to a change of every sample of every input that the base uses, by differences.

    Samples that do not feel each other any more are changed at once, so that as many simulations are needed as a
    response has samples (Curtis, Powell & Reid 1974, J. Inst. Math. Appl. 13:117). That grows with the sampling rate:
    200 Hz over 20 s take seconds, 1 kHz over a minute minutes. A response ends with a block of the covariance.
    """
    count = len(trial)
    step = float(np.median(np.diff(trial.time))) if count > 1 else 1.0
    ahead = max(int(np.ceil(2.0 * system.motion.reach / step)), NEIGHBOURS) + _longest_gap(system, trial)
    plain = system.simulate(trial, values)
    most = min(int((1.0 - PLACES[-1]) * count), BLOCK_ROWS)
    faded = {name: min(max(_lasting(system, trial, values, name, plain), ahead), most) for name in system.driving}
    longest = ahead + max(faded.values(), default=0) + 1
    found = np.zeros((len(system.inputs), count, plain.shape[1], longest))
    for name, lasting in faded.items():
        width, j = ahead + lasting + 1, system.inputs.index(name)
        for phase in range(min(width, count)):
            changed = np.arange(phase, count, width)
            answer = _answer(system, trial, values, name, plain, changed)
            for i in map(int, changed):
                felt = np.arange(max(i - ahead, 0), min(i + lasting + 1, count))
                found[j, felt, :, felt - i + ahead] = answer[felt]
    return Lasting(trial.time, found, ahead, spectra)


def _longest_gap(system: System, trial: Trial) -> int:
    """Most samples in a row in which an input that drives the model was not measured: both sides fill them."""
    most = 0
    for name in system.driving:
        there = np.flatnonzero(np.isfinite(trial.column(name)))
        most = max(most, int(np.diff(there, prepend=-1, append=len(trial)).max()) - 1)
    return most


def _lasting(
    system: System, trial: Trial, values: Mapping[str, float], name: str, plain: Float[np.ndarray, "t c"]
) -> int:
    """Samples after which a response has faded, in the channel and at the place where it takes longest."""
    count, longest = len(trial), 0
    for place in PLACES:
        at = int(place * count)
        answer = np.abs(_answer(system, trial, values, name, plain, np.array([at])))
        large: Bool[np.ndarray, " t"] = (answer > SLIGHT * answer.max(axis=0)).any(axis=1) & (answer.max() > 0.0)
        last = int(np.flatnonzero(large)[-1]) if large.any() else at
        longest = max(longest, last - at)
    return longest


def _answer(
    system: System,
    trial: Trial,
    values: Mapping[str, float],
    name: str,
    plain: Float[np.ndarray, "t c"],
    changed: np.ndarray,
) -> Float[np.ndarray, "t c"]:
    """Change of the outputs per change of these samples of an input."""
    step = BUMP * system.scale.span.get(name, 1.0)
    moved = trial.signals.values.copy()
    moved[changed, trial.signals.channels.index(name)] += step
    other = replace(trial, signals=replace(trial.signals, values=moved))
    answer = system.simulate(other, values)
    if (answer == FAR).any() or (plain == FAR).any():
        return np.zeros_like(plain)  # nothing is known of it
    return np.asarray(np.nan_to_num((answer - plain) / step))
