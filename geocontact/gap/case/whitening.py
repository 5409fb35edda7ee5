"""What a residual weighs: noise, trial-to-trial variation and noise of the inputs, as a whitening per trial."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs, rate_of_waves
from geocontact.chain.links import LAST, Modifier
from geocontact.chain.system import System
from geocontact.data.trial import Trial
from geocontact.gap.inputs.denoise import BUMP, responses
from geocontact.gap.inputs.spectrum_components import USUAL
from geocontact.gap.levels import INPUT_NOISE, TWOFOLD
from geocontact.identify.noise.covariance import Layout
from geocontact.identify.noise.input_noise import InputNoise, Instant, NoiseSpectrum
from geocontact.identify.noise.noise_levels import NoiseLevels, NoisePriors
from geocontact.identify.signals.low_pass import LowPass

SENSOR_LOUDER = 1.2  # times the stated noise of a sensor
QUIETEST = 0.1  # of `INPUT_NOISE`, that an input's limit is at the least: resolution, slow errors
Share = Callable[[Float[np.ndarray, " f"]], Float[np.ndarray, " f"]]
"""Shares of power that is left, by frequency [Hz]."""

SLOW = 30.0  # samples, that slow noise usually remembers
QUICK = 2.0  # samples, that quick noise usually remembers
SLOW_SHARE = 0.3  # of the quick noise, that it usually is
SLOW_LEVEL = 0.8  # standard deviation of the logarithm of that
GROWN = 0.2  # of its noise, that grows to the largest signal, at the least


@runtime_checkable
class Weighing(Protocol):
    """What weighs the columns of a trial, and half the logarithm of the determinant of the covariance behind it."""

    @property
    def log_scale(self) -> float:
        """Sum of the logarithms of what rows are divided by."""

    def __call__(self, values: Float[np.ndarray, "t c p"]) -> Float[np.ndarray, "n p"]:
        """Rows of measured samples, weighed."""


@dataclass(frozen=True)
class Whitening:
    """Whitening of one trial: v → (I + B Q Bᵀ)^(-1/2) W v.

    Parameters
    ----------
    whitener
        W, of sensor noise and input noise.
    directions, gains
        Left singular vectors of B Q^(1/2), and 1 - 1/sqrt(1 + s²) of each.
    log_scale
        Half the logarithm of the determinant of the whole covariance.
    """

    whitener: Weighing
    directions: Float[np.ndarray, "n q"]
    gains: Float[np.ndarray, " q"]
    log_scale: float

    @classmethod
    def of(cls, whitener: Weighing, varied: Float[np.ndarray, "t c q"]) -> Whitening:
        """From the whitener and derivatives with respect to what varies, times its standard deviation."""
        white = whitener(varied)
        if white.shape[1] == 0:
            return cls(whitener, white, np.zeros(0), whitener.log_scale)
        directions, singular, _ = np.linalg.svd(white, full_matrices=False)
        grown = np.sqrt(1.0 + singular**2)
        return cls(whitener, directions, 1.0 - 1.0 / grown, whitener.log_scale + float(np.log(grown).sum()))

    def __call__(self, values: Float[np.ndarray, "t c p"]) -> Float[np.ndarray, "n p"]:
        """Whitened columns."""
        return self.without_variation(self.whitener(values))

    def without_variation(self, white: Float[np.ndarray, "n p"]) -> Float[np.ndarray, "n p"]:
        """What W made of columns, whitened as well of what varies from trial to trial."""
        return np.asarray(white - self.directions @ (self.gains[:, None] * (self.directions.T @ white)))


def propagated_input_noise(
    system: System, trial: Trial, values: Mapping[str, float], passed: Mapping[str, LowPass], left: Mapping[str, Share]
) -> InputNoise:
    """What noise of a trial's inputs makes of the outputs that a model predicts.

    That of each input came through its filter in `passed`; `left` says by frequency what was left of some since.
    """
    return _felt(system, trial, values, spectra_of(system, passed, left))


def spectra_of(system: System, passed: Mapping[str, LowPass], left: Mapping[str, Share]) -> tuple[NoiseSpectrum, ...]:
    """Spectrum of each input's noise; inputs of one filter of which nothing was taken off share theirs."""

    @cache
    def spectrum(through: LowPass, name: str) -> NoiseSpectrum:
        rates = partial(rate_of_waves, step=through.step, reach=system.motion.reach)
        return NoiseSpectrum.after(through, rates, left.get(name, np.ones_like))

    return tuple(spectrum(passed[name], name if name in left else "") for name in system.inputs)


def _felt(system: System, trial: Trial, values: Mapping[str, float], spectra: tuple[NoiseSpectrum, ...]) -> InputNoise:
    return (responses if system.dynamic else sensitivity)(system, trial, values, spectra)


def sensitivity(
    system: System, trial: Trial, values: Mapping[str, float], spectra: tuple[NoiseSpectrum, ...]
) -> Instant:
    """How the outputs answer to each input's value and rate, sample by sample, by central differences."""
    answers = []
    for kind, per_second in (("position", 1.0), ("rate", USUAL / system.scale.step)):
        columns = []
        for row, name in enumerate(system.inputs):
            step = BUMP * per_second * system.scale.span.get(name, 1.0)
            above, below = (_bumped(system, kind, row, sign * step).simulate(trial, values) for sign in (1.0, -1.0))
            columns.append(np.nan_to_num((above - below) / (2.0 * step)))
        answers.append(np.stack(columns, axis=-1))
    return Instant(trial.time, answers[0], answers[1], spectra)


def _bumped(system: System, kind: str, row: int, by: float) -> System:
    def change(
        movement: DifferentiatedInputs, _: DifferentiatedInputs, __: Mapping[str, float]
    ) -> DifferentiatedInputs:
        moved = getattr(movement, kind).copy()
        moved[row] += by
        return replace(movement, **{kind: moved})

    return replace(system, motion=system.motion.having(Modifier("bump", LAST, change)))


def usual_levels(
    system: System,
    stated: Mapping[str, float],
    rough: Float[np.ndarray, " c"],
    seen: Mapping[str, float],
    most: Mapping[str, float],
    growth: Float[np.ndarray, " c"],
) -> NoisePriors:
    """Prior of the noise, before the residuals are looked at.

    The noise that a case tells is split evenly between white and quick coloured noise; where it tells none, `rough`
    stands in, with twice the spread. All is known to a factor of two. Quick noise remembers a few samples, slow
    noise some tens. What grows with the signal is as much as the recording shows (`growth`, per unit of it), and
    little at the least. Inputs are known as well as their spectra show (`seen`), 0.2 % of their half-range at the least
    unless `most` is less, and those of one unit about equally well, since they come from the same markers; what is
    stated of one is taken. A sensor is hardly noisier than `SENSOR_LOUDER` times what was stated, an input than
    twice its prior, or than `most` (a tenth of the 0.2 % at the least); nothing more is assumed of it
    than that.
    """
    known = np.array([name in stated for name in system.outputs])
    sd = np.array([stated.get(name, each) for name, each in zip(system.outputs, rough, strict=True)]) / np.sqrt(2.0)
    units = [system.units.get(name, name) for name in system.inputs]
    alike = np.array([[a == b for b in units] for a in units])
    own = np.array([max(INPUT_NOISE * system.scale.span.get(name, 1.0), seen.get(name, 0.0)) for name in system.inputs])
    inputs = np.exp(alike @ np.log(own) / alike.sum(axis=1))
    inputs = np.array([stated.get(name, level) for name, level in zip(system.inputs, inputs, strict=True)])
    covariance = TWOFOLD**2 * alike + 0.5**2 * np.eye(len(units))
    white, sure = np.where(known, 0.5, 1.0), np.ones(len(sd))
    levels = [white, 2.0 * TWOFOLD * white, SLOW_LEVEL * sure]
    widths = np.concatenate([*levels, sure, TWOFOLD * sure, 0.5 * TWOFOLD * sure])
    largest = np.array([system.scale.of(name) for name in system.outputs])
    factor = np.zeros((len(widths) + len(units),) * 2)
    factor[: len(widths), : len(widths)] = np.diag(widths)
    factor[len(widths) :, len(widths) :] = np.linalg.cholesky(covariance)
    memory = system.scale.step * np.array([QUICK * sure, SLOW * sure])
    sensors = SENSOR_LOUDER * np.array([stated.get(name, np.inf) for name in system.outputs])
    highest_noise = np.minimum(
        np.exp(TWOFOLD) * np.maximum(inputs, own), [most.get(name, np.inf) for name in system.inputs]
    )
    highest_noise = np.maximum(
        highest_noise, [QUIETEST * INPUT_NOISE * system.scale.span.get(name, 1.0) for name in system.inputs]
    )
    limits = zip(system.inputs, highest_noise, strict=True)
    highest_noise = np.array([SENSOR_LOUDER * stated[n] if n in stated else limit for n, limit in limits])
    inputs = np.minimum(inputs, highest_noise)
    growing = np.maximum(growth, GROWN * np.sqrt(2.0) * sd / largest)
    usual = NoiseLevels(sd, np.array([sd, SLOW_SHARE * sd]), memory, growing, inputs)
    return NoisePriors(usual, factor, sensors, highest_noise)


def layouts_of(
    system: System,
    trials: Sequence[Trial],
    values: Mapping[str, float],
    present: Sequence[np.ndarray],
    passed: Mapping[str, LowPass],
    left: Mapping[str, Share],
    spread: Sequence[Float[np.ndarray, "_ c"]],
    signal: Sequence[Float[np.ndarray, "_ c"]],
) -> list[Layout]:
    """One per trial, inputs' noise (see `propagated_input_noise`) seen through the model at `values`."""
    spectra = spectra_of(system, passed, left)  # their tables are the same in all trials
    return [
        Layout.of(t.time, there, _felt(system, t, values, spectra), own, size, t.runs)
        for t, there, own, size in zip(trials, present, spread, signal, strict=True)
    ]
