"""A case made ready: base model fitted, noise and trial-to-trial variation estimated, trials cut into blocks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import FAR, System
from geocontact.data.gap.case import GapCase
from geocontact.gap.case.placement import placement, varies_by
from geocontact.gap.case.quotient_noise import noise_spread
from geocontact.gap.case.refit import NO_VALUE, Measured, Refit, at, free, refit
from geocontact.gap.case.whitening import Share, Whitening, layouts_of, sensitivity, usual_levels
from geocontact.gap.inputs.denoise import Filters, Left, denoised, highest_noise, left, seen_noise, shaken
from geocontact.gap.inputs.filter_cutoff import filters_of, likely_noise
from geocontact.gap.inputs.quantisation import resolution
from geocontact.gap.inputs.spectrum import measured_inputs
from geocontact.identify.noise.covariance import Layout, Whitener
from geocontact.identify.noise.noise_levels import NoiseLevels, NoisePriors
from geocontact.identify.noise.noise_search import most_likely
from geocontact.identify.noise.trial_variation import Products, variation

REACHES = (14.0, 10.0, 7.0, 5.0, 3.5, 2.5)  # samples to either side, that rates may be smoothed over
STARTS = 4  # of the base fit, besides the case's own
USUALLY, BARELY = 4.0, 1.0  # trials that the usual variation of a parameter counts as; where the trials are to speak
MEMORY = 2.0  # times its usual correlation time that low noise may remember
TAKEN_OFF = 1.25  # times what is believed of an input's noise, that is taken off it at the most
SEED = 0  # of the noise that is added to inputs
MOST_VARIATION = 3.0  # times what is usual; a trial that deviates more misses something else


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
        What was believed of the noise levels.
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

    @property
    def calibration_layouts(self) -> tuple[Layout, ...]:
        """Of the trials that may be fitted."""
        return self.layouts[: len(self.calibration.trials)]

    @property
    def fitted(self) -> int:
        """How many free parameters the base model has: the first of every model."""
        return len(free(self.system))

    def varied(self, jacobian: Sequence[Float[np.ndarray, "_ c p"]]) -> list[Float[np.ndarray, "_ c q"]]:
        """Per trial, what a unit of everything that differs from trial to trial changes in a prediction."""
        return [
            np.concatenate([j[..., : self.fitted], other], axis=-1)
            for j, other in zip(jacobian, self.placement, strict=False)
        ]

    @property
    def floor_of_noise(self) -> Float[np.ndarray, " c"]:
        """Noise of each channel as it was believed beforehand: a scale, no estimate."""
        return self.beliefs.middle.sensors

    def weighed(self, model: Refit, before: Noise | None = None) -> Noise:
        """Noise levels and variation that make a model's residuals most likely, calibration trials only."""
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
            )
            sd = self._variation(model, levels)
        if levels is None:
            raise ValueError("noise was not estimated")
        return Noise(levels, sd, surprise, self._whiteners(levels))

    def with_lower_noise(self, noise: Noise) -> Noise:
        """The same noise as far as it is not higher than could be expected.

        Levels that were fitted to a model's residuals grow with what the model misses. Here outputs are no noisier than
        was told, and inputs of one unit no noisier than the best of them.
        """
        units = [self.system.units.get(name, name) for name in self.system.inputs]
        best = [min(v for v, u in zip(noise.levels.inputs, units, strict=True) if u == own) for own in units]
        usual = self.beliefs.middle
        levels = replace(
            noise.levels,
            white=np.minimum(noise.levels.white, usual.white),
            coloured=np.minimum(noise.levels.coloured, usual.coloured),
            memory=np.minimum(noise.levels.memory, MEMORY * usual.memory),
            inputs=np.minimum(np.array(best), usual.inputs),
        )
        x = self.beliefs.point(levels)
        return Noise(levels, np.minimum(noise.varies, self.usual), 0.5 * float(x @ x), self._whiteners(levels))

    def _whiteners(self, levels: NoiseLevels) -> tuple[Whitener, ...]:
        return tuple(layout.whitener(levels) for layout in self.layouts)

    def _variation(self, model: Refit, levels: NoiseLevels) -> Float[np.ndarray, " q"]:
        """Of parameters around their fitted values; of what is not fitted around its mean over the trials."""
        kinds = [self.fitted, len(self.usual) - self.fitted]
        weight, spent = np.repeat([USUALLY, BARELY], kinds), np.repeat([0.0, 1.0], kinds)
        found = variation(self._products(self.calibration_layouts, model, levels), self.usual, weight, spent)
        return np.asarray(np.minimum(found, MOST_VARIATION * self.usual))

    def _products(self, layouts: Sequence[Layout], model: Refit, levels: NoiseLevels) -> list[Products]:
        products = []
        for layout, residual, varied in zip(layouts, model.residuals, self.varied(model.jacobian), strict=False):
            whitener = layout.whitener(levels)
            products.append(Products.of(whitener(residual[..., None])[:, 0], whitener(varied)))
        return products

    def seen_variation(self, model: Refit, levels: NoiseLevels) -> Float[np.ndarray, " q"]:
        """How much all trials do differ, little believed beforehand, around parameters that were fitted to all."""
        found = variation(self._products(self.layouts, model, levels), self.usual, BARELY, spent=1.0)
        return np.asarray(np.minimum(found, MOST_VARIATION * self.usual))

    def fitting(self, noise: Noise, model: Refit) -> list[Whitening]:
        """Whitening of the calibration trials."""
        return self.whitenings(noise, model)[: len(self.calibration.trials)]

    def whitenings(self, noise: Noise, model: Refit) -> list[Whitening]:
        """Whitening of the trials that a model was evaluated on: all of them, or those of the calibration."""
        return [
            Whitening.of(whitener, varied * noise.varies)
            for whitener, varied in zip(noise.whiteners, self.varied(model.jacobian), strict=False)
        ]


@dataclass(frozen=True)
class Noise:
    """Levels of noise, standard deviation of what differs from trial to trial, and how surprising they are.

    `whiteners` are what these levels make of the layouts of all trials.
    """

    levels: NoiseLevels
    varies: Float[np.ndarray, " q"]
    surprise: float
    whiteners: tuple[Whitener, ...]


@dataclass(frozen=True)
class Plain:
    """Weighing by a standard deviation per channel only."""

    present: np.ndarray
    floor: Float[np.ndarray, " c"]
    log_scale: float = 0.0

    def __call__(self, values: Float[np.ndarray, "t c p"]) -> Float[np.ndarray, "n p"]:
        """Rows of measured samples, divided by the floor."""
        return np.asarray((values / self.floor[:, None]).reshape(-1, values.shape[-1])[self.present.ravel()])


def problem_of(case: GapCase, system: System) -> Problem:
    """A case made ready; the base model is fitted from several starts."""
    system = system.reaching(REACHES[-1] * typical_step(case))
    stated = with_rounding(case)
    rough = rough_noise(system, case)
    calibration = Measured.of(system, case.calibration, rough)
    evaluation = Measured.of(system, case.evaluation, rough)
    everything = replace(
        calibration,
        trials=calibration.trials + evaluation.trials,
        outputs=calibration.outputs + evaluation.outputs,
    )
    recorded = everything
    passed = filters_of(recorded.trials, system.inputs)
    noisy = measured_inputs(recorded.trials, system.inputs)
    shown = {name: stated.get(name) or seen_noise(calibration.trials, name, passed[name]) for name in noisy}
    seen = {name: level or likely_noise(recorded.trials, name, passed[name]) for name, level in shown.items()}
    most = {name: max(highest_noise(recorded.trials, name, passed[name]), seen[name]) for name in noisy}
    spread = noise_spread(system, recorded.outputs, rough)
    system = _rates(system, stated, calibration, rough, passed, seen, most)
    plain = _plain_fit(system, calibration, rough, base_starts(system), rounds=40)
    floor, more = rough, everything
    kept: dict[str, Left] = {}
    for last in (False, True):
        system = system.scaled(calibration.trials, plain.values)
        placed = placement(system, everything.trials, plain.values, noisy)
        own = [varies_by(system, p, plain.values[p.name]) for p in free(system)]
        usual = np.array([*own, *np.ones(placed[0].shape[-1])])
        beliefs = usual_levels(system, stated, rough, seen, most)
        heard = everything if last else calibration  # levels are those of calibration trials
        layouts = tuple(
            layouts_of(system, heard.trials, plain.values, heard.present, passed, kept, spread[: len(heard.trials)])
        )
        problem = Problem(
            system,
            calibration,
            evaluation,
            recorded,
            layouts,
            beliefs,
            usual,
            placed,
            plain,
            floor,
            passed,
            kept,
            more,
            (),
        )
        noise = problem.weighed(plain)
        if not last:
            low_noise = np.minimum(noise.levels.inputs, TAKEN_OFF * beliefs.middle.inputs)
            levels = dict(zip(system.inputs, map(float, low_noise), strict=True))
            sd = {name: shown[name] or levels[name] for name in noisy}
            calibration, evaluation = (_denoised(each, sd, passed) for each in (calibration, evaluation))
            rng = np.random.default_rng(SEED)
            more = replace(recorded, trials=tuple(shaken(trial, sd, passed, rng) for trial in recorded.trials))
            everything = replace(everything, trials=calibration.trials + evaluation.trials)
            kept = {n: one for n, q in sd.items() if (one := left(recorded.trials, n, q, passed[n])) is not None}
        floor = floor_of(problem, noise, plain)
        plain = _plain_fit(system, calibration, floor, [plain.values], rounds=20)
    passed_on = differences(more, system, plain.values, everything.residuals(system, plain.values))
    return replace(problem, plain=plain, floor=floor, passed_on=passed_on)


def _rates(
    system: System,
    stated: Mapping[str, float],
    measured: Measured,
    rough: Float[np.ndarray, " c"],
    passed: Filters,
    seen: Mapping[str, float],
    most: Mapping[str, float],
) -> System:
    """The system with the smoothing of rates that makes the base model's residuals most likely.

    That is a local best, searched from the middle of `REACHES` uphill. How far rates have to be smoothed depends on the
    noise of the inputs, which is not known. Where the base does not
    depend on rates, least is smoothed.
    """
    plain = _plain_fit(system, measured, rough, base_starts(system), rounds=40)
    system = system.scaled(measured.trials, plain.values)
    if not system.dynamic and not any(
        sensitivity(system, trial, plain.values, ()).to_rate.any() for trial in measured.trials
    ):
        return system
    beliefs = usual_levels(system, stated, rough, seen, most)
    usual = np.array([varies_by(system, p, plain.values[p.name]) for p in free(system)])

    def likelihood(reach: float) -> float:
        other = system.reaching(reach)
        model = _plain_fit(other, measured, rough, [plain.values], rounds=6)
        spread = noise_spread(other, measured.outputs, rough)
        layouts = layouts_of(other, measured.trials, model.values, measured.present, passed, {}, spread)
        varied = [j[..., : len(usual)] * usual for j in model.jacobian]
        return most_likely(layouts, model.residuals, varied, beliefs, beliefs.middle, rounds=15)[2]

    return system.reaching(best_of(likelihood, [each * system.scale.step for each in REACHES]))


def best_of(likelihood: Callable[[float], float], points: Sequence[float]) -> float:
    """Where a function with one peak is largest among ordered points, from the middle uphill."""
    at = len(points) // 2
    known = {at: likelihood(points[at]), at - 1: likelihood(points[at - 1])}
    step = -1 if known[at - 1] > known[at] else 1
    at = max(known, key=lambda k: known[k])
    while 0 <= at + step < len(points):
        known[at + step] = likelihood(points[at + step])
        if known[at + step] <= known[at]:
            break
        at += step
    return points[at]


def _denoised(measured: Measured, noise: Mapping[str, float], passed: Filters) -> Measured:
    return replace(measured, trials=tuple(denoised(trial, noise, passed) for trial in measured.trials))


def _plain_fit(
    system: System,
    measured: Measured,
    floor: Float[np.ndarray, " c"],
    starts: Sequence[Mapping[str, float]],
    rounds: int,
) -> Refit:
    return refit(system, measured, [Plain(there, floor) for there in measured.present], starts, rounds)


def base_starts(system: System) -> list[dict[str, float]]:
    """The parameters' own start, and points spread evenly over their bounds."""
    from scipy.stats import qmc

    parameters = [p for p in free(system) if np.isfinite(p.upper - p.lower)]
    spread = qmc.Sobol(len(parameters), seed=0).random(STARTS) if parameters else np.zeros((0, 0))
    return [
        {},
        *(
            {
                p.name: float(p.lower + (0.1 + 0.8 * u) * (p.upper - p.lower))
                for p, u in zip(parameters, row, strict=True)
            }
            for row in spread
        ),
    ]


def with_rounding(case: GapCase) -> dict[str, float]:
    """Noise that the case tells, by channel, with that of the recorder's steps: q²/12 of variance, and nothing more."""
    return {name: float(np.hypot(sd, rounding(case, name))) for name, sd in case.noise.items()}


def rounding(case: GapCase, name: str) -> float:
    """Standard deviation of the noise that rounding makes of a channel."""
    columns = [trial.column(name) for trial in (*case.calibration, *case.evaluation)]
    return resolution([x[np.isfinite(x)] for x in columns]) / float(np.sqrt(12.0))


def typical_step(case: GapCase) -> float:
    """Time between two samples of the calibration trials [s]."""
    return float(np.median(np.concatenate([np.diff(trial.time) for trial in case.calibration])))


def rough_noise(system: System, case: GapCase) -> Float[np.ndarray, " c"]:
    """Noise that the case tells, else what second differences of the measurement suggest; no less than its rounding."""
    stated = with_rounding(case)
    seen = (stated.get(name) or max(_jumpiness(case, name), rounding(case, name)) for name in system.outputs)
    return np.array(list(seen))


def _jumpiness(case: GapCase, name: str) -> float:
    steps = np.concatenate([np.diff(t.column(name)[np.isfinite(t.column(name))], 2) for t in case.calibration])
    spread = float(np.median(np.abs(steps))) / 0.6745 / np.sqrt(6.0) if len(steps) else 0.0
    most = max(float(np.nanmax(np.abs(t.column(name)), initial=0.0)) for t in case.calibration)
    return max(spread, 1e-4 * most, 1e-12)


def floor_of(problem: Problem, noise: Noise, model: Refit) -> Float[np.ndarray, " c"]:
    """Root mean square of what no model can predict, per channel: noise, noise of inputs, trial-to-trial variation."""
    squares, counts = np.zeros(len(problem.floor)), np.zeros(len(problem.floor))
    fitted = problem.varied(model.jacobian[: len(problem.calibration.trials)])
    for layout, varied, present in zip(problem.calibration_layouts, fitted, problem.calibration.present, strict=True):
        own = noise_variance(layout, noise.levels) + ((varied * noise.varies) ** 2).sum(axis=-1)
        squares += np.where(present, own, 0.0).sum(axis=0)
        counts += present.sum(axis=0)
    return np.sqrt(squares / np.maximum(counts, 1))


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
