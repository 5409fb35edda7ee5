"""A case made ready: base model fitted, noise and trial-to-trial variation estimated, trials cut into blocks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from jaxtyping import Float, Int

from geocontact.chain.system import FAR, System
from geocontact.gap.case.refit import Measured, Refit, at, free
from geocontact.gap.case.whitening import Share, Whitening
from geocontact.gap.inputs.denoise import Filters
from geocontact.gap.levels import DEVIATIONS, TWOFOLD
from geocontact.identify.noise.covariance import Layout, Whitener
from geocontact.identify.noise.noise_levels import NoiseLevels, NoisePriors
from geocontact.identify.noise.noise_search import most_likely
from geocontact.identify.noise.trial_variation import Products, variation
from geocontact.identify.optimise.least_squares import NO_VALUE

USUALLY = 4.0  # trials that the usual variation of a parameter counts as; one where the trials are to speak


@dataclass(frozen=True)
class Problem:
    """What every model of a case is judged on.

    Parameters
    ----------
    system
        Base model, its scale taken at the fitted values.
    calibration, evaluation
        Trials that may be fitted, and those held out, the noise of their inputs taken off.
    recorded
        All trials as they were measured, in the same order.
    layouts
        Of the calibration trials, then of the evaluation trials.
    beliefs
        Prior of the noise levels.
    usual
        Usual standard deviation, from trial to trial, of each free base parameter, then of each column of `placement`.
    placement
        What else differs from trial to trial (`gap.case.placement`), in all trials.
    plain
        Base model fitted by least squares, every channel divided by `floor`.
    floor
        Noise plus trial-to-trial variation of each channel.
    passed
        The low-pass filter that each input came through.
    left
        Of the power of each input's noise, what its taking off left, by frequency.
    shaken
        Calibration trials, then held-out ones, with noise again in their inputs as its taking off leaves it.
    passed_on
        What that noise does to the prediction of the base model, per trial.
    noise
        Levels that suit the base model, where somebody estimated them before: its search sets out there.
    """

    system: System
    calibration: Measured
    evaluation: Measured
    recorded: Measured
    layouts: tuple[Layout, ...]
    beliefs: NoisePriors
    usual: Float[np.ndarray, " q"]
    placement: tuple[Float[np.ndarray, "_ c k"], ...]
    plain: Refit
    floor: Float[np.ndarray, " c"]
    passed: Filters
    left: Mapping[str, Share]
    shaken: Measured
    passed_on: tuple[Float[np.ndarray, "_ c"], ...]
    noise: Noise | None = None

    @property
    def calibration_layouts(self) -> tuple[Layout, ...]:
        """Layouts of the trials that may be fitted."""
        return self.layouts[: len(self.calibration.trials)]

    @property
    def fitted(self) -> int:
        """How many free parameters the base model has: the first of every model."""
        return len(free(self.system))

    @cached_property
    def samples(self) -> tuple[Int[np.ndarray, " k"], ...]:
        """Samples of each trial in which some output was measured, calibration first: few of a thinned trial's."""
        present = (*self.calibration.present, *self.evaluation.present)
        return tuple(np.flatnonzero(there.any(axis=1)) for there in present)

    def varied(self, jacobian: Sequence[Float[np.ndarray, "_ c p"]]) -> list[Float[np.ndarray, "_ c q"]]:
        """Per trial, what a unit of everything that differs from trial to trial changes in a prediction."""
        return [
            np.concatenate([j[..., : self.fitted], other], axis=-1)
            for j, other in zip(jacobian, self.placement, strict=False)
        ]

    @property
    def floor_of_noise(self) -> Float[np.ndarray, " c"]:
        """Prior noise of each channel: a scale, no estimate."""
        return self.beliefs.middle.sensors

    def weighed(self, model: Refit, before: Noise | None = None, others: Sequence[Noise] = ()) -> Noise:
        """Noise levels and variation that make a model's residuals most likely, calibration trials only.

        The search sets out from those of `before`, or of `others` where the residuals are more likely with these.
        """
        fitted = len(self.calibration.trials)
        varied = self.varied(model.jacobian[:fitted])
        sd = self.usual if before is None else before.varies
        levels, surprise = None if before is None else before.levels, 0.0
        for _ in range(2 if before is None else 1):
            levels, surprise, _ = most_likely(
                self.calibration_layouts,
                model.residuals[:fitted],
                [each * sd for each in varied],
                self.beliefs,
                self.beliefs.middle if levels is None else levels,
                others=[each.levels for each in others],
            )
            whiteners = tuple(layout.whitener(levels) for layout in self.calibration_layouts)
            sd = self._variation(model, whiteners)
        if levels is None:
            raise ValueError("noise was not estimated")
        later = tuple(layout.whitener(levels) for layout in self.layouts[fitted:])
        return Noise(levels, sd, surprise, whiteners + later)

    def with_lower_noise(self, noise: Noise) -> Noise:
        """The same noise as far as it is not higher than could be expected.

        Levels that were fitted to a model's residuals grow with what the model misses. Here outputs are no noisier than
        was stated, and inputs of one unit no noisier than the best of them.
        """
        units = [self.system.units.get(name, name) for name in self.system.inputs]
        best = [min(v for v, u in zip(noise.levels.inputs, units, strict=True) if u == own) for own in units]
        usual = self.beliefs.middle
        levels = replace(
            noise.levels,
            white=np.minimum(noise.levels.white, usual.white),
            coloured=np.minimum(noise.levels.coloured, usual.coloured),
            memory=np.minimum(noise.levels.memory, np.exp(TWOFOLD) * usual.memory),
            growing=np.minimum(noise.levels.growing, usual.growing),
            inputs=np.minimum(np.array(best), usual.inputs),
        )
        x = self.beliefs.point(levels)
        return Noise(levels, np.minimum(noise.varies, self.usual), 0.5 * float(x @ x), self._whiteners(levels))

    def _whiteners(self, levels: NoiseLevels) -> tuple[Whitener, ...]:
        return tuple(layout.whitener(levels) for layout in self.layouts)

    def _variation(self, model: Refit, whiteners: Sequence[Whitener]) -> Float[np.ndarray, " q"]:
        """Variation of parameters around their fitted values; of what is not fitted around its mean over the trials."""
        kinds = [self.fitted, len(self.usual) - self.fitted]
        weight, spent = np.repeat([USUALLY, 1.0], kinds), np.repeat([0.0, 1.0], kinds)
        found = variation(self._products(whiteners, model), self.usual, weight, spent)
        return np.asarray(np.minimum(found, DEVIATIONS * self.usual))

    def _products(self, whiteners: Sequence[Whitener], model: Refit) -> list[Products]:
        return [
            Products.of(whitener(residual[..., None])[:, 0], whitener(varied))
            for whitener, residual, varied in zip(whiteners, model.residuals, self.varied(model.jacobian), strict=False)
        ]

    def seen_variation(self, model: Refit, levels: NoiseLevels) -> Float[np.ndarray, " q"]:
        """How much all trials differ, with a wide prior, around parameters that were fitted to all."""
        found = variation(self._products(self._whiteners(levels), model), self.usual, 1.0, spent=1.0)
        return np.asarray(np.minimum(found, DEVIATIONS * self.usual))

    def fitting(self, noise: Noise, model: Refit) -> list[Whitening]:
        """Whitening of the calibration trials."""
        return self.whitenings(noise, replace(model, jacobian=model.jacobian[: len(self.calibration.trials)]))

    def whitenings(self, noise: Noise, model: Refit) -> list[Whitening]:
        """Whitening of the trials that a model was evaluated on: all of them, or those of the calibration."""
        return [
            Whitening.of(whitener, varied * noise.varies)
            for whitener, varied in zip(noise.whiteners, self.varied(model.jacobian), strict=False)
        ]

    def whitenings_of_samples(self, noise: Noise, model: Refit) -> list[Whitening]:
        """The same for values of `samples` alone: what many columns are made for."""
        whole = zip(self.whitenings(noise, model), noise.whiteners, self.samples, strict=False)
        return [replace(each, whitener=own.among(rows, len(self.floor))) for each, own, rows in whole]


@dataclass(frozen=True)
class Noise:
    """Levels of noise, standard deviation of what differs from trial to trial, and how surprising they are.

    `whiteners` are what these levels make of the layouts of all trials.
    """

    levels: NoiseLevels
    varies: Float[np.ndarray, " q"]
    surprise: float
    whiteners: tuple[Whitener, ...]


def filled(part: Float[np.ndarray, "k ..."], samples: Int[np.ndarray, " k"], count: int) -> Float[np.ndarray, "t ..."]:
    """What is known of some of `count` samples, 0 in the others."""
    if len(samples) == count:
        return part
    out = np.zeros((count, *part.shape[1:]))
    out[samples] = part
    return out


def floor_of(problem: Problem, noise: Noise, model: Refit) -> Float[np.ndarray, " c"]:
    """Root mean square of what no model can predict, per channel: noise, noise of inputs, trial-to-trial variation.

    Never more than what the model misses on the calibration trials, which holds all of it: variation is assumed to be
    as large as is usual while few trials tell, and may be hundreds of newtons where a millimetre is that stiff.
    """
    squares, missed, counts = np.zeros_like(problem.floor), np.zeros_like(problem.floor), np.zeros_like(problem.floor)
    fitted = problem.varied(model.jacobian[: len(problem.calibration.trials)])
    each = zip(
        problem.calibration_layouts, fitted, problem.calibration.present, model.residuals[: len(fitted)], strict=True
    )
    for layout, varied, present, residual in each:
        own = noise_variance(layout, noise.levels) + ((varied * noise.varies) ** 2).sum(axis=-1)
        squares += np.where(present, own, 0.0).sum(axis=0)
        missed += np.where(present, residual**2, 0.0).sum(axis=0)
        counts += present.sum(axis=0)
    least = np.where(missed > 0.0, np.minimum(squares, missed), squares)
    return np.asarray(np.sqrt(least / np.maximum(counts, 1)))


def noise_variance(layout: Layout, levels: NoiseLevels) -> Float[np.ndarray, "t c"]:
    """Variance of sensor noise and input noise at every sample; 0 where nothing was measured."""
    total = np.zeros(layout.shape[0] * layout.shape[1])
    for block in layout.blocks:
        total[block.rows] = np.diag(block.covariance(levels)) * block.spread**2
    return total.reshape(layout.shape)


def evaluated(problem: Problem, model: Refit) -> Refit:
    """A fitted model at its values on all trials, nothing fitted to the held-out ones, nothing whitened."""
    held_out = at(model.system, problem.evaluation, None, model.values)
    residuals, jacobian = model.residuals + held_out.residuals, model.jacobian + held_out.jacobian
    passed_on = differences(problem.shaken, model.system, model.values, residuals)
    return replace(Refit.bare(model.system, model.values, residuals, jacobian), passed_on=passed_on)


def differences(
    shaken: Measured, system: System, values: Mapping[str, float], residuals: Sequence[Float[np.ndarray, "_ c"]]
) -> tuple[Float[np.ndarray, "_ c"], ...]:
    """What noise in the inputs does to a prediction whose residuals are given, per trial.

    0 where the model has no value, with it or without; NaN throughout a trial in which a simulation fails.
    """
    found = []
    for before, after in zip(residuals, shaken.residuals(system, values), strict=True):
        silent = (before == NO_VALUE * shaken.rough) | (after == NO_VALUE * shaken.rough)
        failed = max(np.abs(before).max(), np.abs(after).max()) > 0.5 * FAR
        found.append(np.full(before.shape, np.nan) if failed else np.where(silent, 0.0, before - after))
    return tuple(found)
