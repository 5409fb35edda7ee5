"""From a case to its problem: base model fitted, noise of inputs estimated and taken off, rates smoothed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from geocontact.chain.system import System
from geocontact.data.gap.case import GapCase
from geocontact.data.trial import Trial
from geocontact.gap.case.placement import placement, varies_by
from geocontact.gap.case.plain_fit import base_starts, plain_fit
from geocontact.gap.case.problem import Noise, Problem, differences, floor_of
from geocontact.gap.case.quotient_noise import noise_spread
from geocontact.gap.case.rate_smoothing import REACHES, with_smoothed_rates
from geocontact.gap.case.refit import ROUNDS, Measured, Refit, free
from geocontact.gap.case.rough_noise import rough_noise, typical_step, with_rounding
from geocontact.gap.case.signal_size import seen_growth, signal_size
from geocontact.gap.case.tolerated_noise import tolerated
from geocontact.gap.case.whitening import SENSOR_LOUDER, layouts_of, usual_levels
from geocontact.gap.inputs.denoise import Filters, Left, denoised, highest_noise, left, seen_noise, shaken
from geocontact.gap.inputs.filter_cutoff import filters_of, likely_noise
from geocontact.gap.inputs.spectrum import measured_inputs


@dataclass(frozen=True)
class InputBeliefs:
    """What the spectra of the measured inputs say of their noise, standard deviations in the inputs' units.

    Parameters
    ----------
    passed
        The low-pass filter that each input came through.
    shown
        Noise that the case tells or a spectrum shows, None where the movement hides it.
    seen
        The same, with the likeliest where it is hidden.
    most
        What it cannot well exceed.
    """

    passed: Filters
    shown: dict[str, float | None]
    seen: dict[str, float]
    most: dict[str, float]

    @classmethod
    def of(
        cls, system: System, recorded: Measured, fitted: Sequence[Trial], stated: Mapping[str, float]
    ) -> InputBeliefs:
        """From all trials as they were recorded; noise that a spectrum shows is that of the `fitted` ones."""
        passed = filters_of(recorded.trials, system.inputs)
        noisy = measured_inputs(recorded.trials, system.inputs)
        shown = {name: stated.get(name) or seen_noise(fitted, name, passed[name]) for name in noisy}
        seen = {name: level or likely_noise(recorded.trials, name, passed[name]) for name, level in shown.items()}
        most = {name: max(highest_noise(recorded.trials, name, passed[name]), seen[name]) for name in noisy}
        return cls(passed, shown, seen, most)

    def tolerated(
        self, system: System, measured: Measured, held_out: Measured, plain: Refit, stated: Mapping[str, float]
    ) -> InputBeliefs:
        """The same without noise that could not be taken off without harm to the base model; what is told stays."""
        guessed = {name: level for name, level in self.seen.items() if name not in stated}
        borne = tolerated(system, measured, held_out, plain.values, guessed, self.passed)
        less = {name: level for name, level in borne.items() if level < guessed[name]}
        most = {name: min(level, less.get(name, level)) for name, level in self.most.items()}
        return InputBeliefs(self.passed, self.shown | dict.fromkeys(less), self.seen | less, most)


@dataclass(frozen=True)
class Denoised:
    """Trials with the noise of their inputs taken off, shares of it that are left, and trials with it again as left."""

    calibration: Measured
    evaluation: Measured
    left: dict[str, Left]
    shaken: Measured

    @classmethod
    def of(cls, calibration: Measured, evaluation: Measured, levels: Mapping[str, float], passed: Filters) -> Denoised:
        """Noise of these standard deviations taken off recordings."""
        recorded, rng = together(calibration, evaluation), np.random.default_rng(0)
        shaken_trials = tuple(shaken(trial, levels, passed, rng) for trial in recorded.trials)
        kept = {n: left(recorded.trials, n, sd, passed[n]) for n, sd in levels.items()}
        first, later = (
            replace(each, trials=tuple(denoised(trial, levels, passed) for trial in each.trials))
            for each in (calibration, evaluation)
        )
        return cls(first, later, {n: one for n, one in kept.items() if one}, replace(recorded, trials=shaken_trials))


def problem_of(case: GapCase, system: System) -> Problem:
    """A case made ready; the base model is fitted from several starts."""
    system = system.reaching(REACHES[-1] * typical_step(case))
    stated, rough = with_rounding(case), rough_noise(system, case)
    calibration, evaluation = (Measured.of(system, some, rough) for some in (case.calibration, case.evaluation))
    recorded = together(calibration, evaluation)
    plain = plain_fit(system, calibration, rough, base_starts(system), 2 * ROUNDS)
    inputs = InputBeliefs.of(system, recorded, calibration.trials, stated)
    inputs = inputs.tolerated(system, calibration, evaluation, plain, stated)
    system = with_smoothed_rates(system, stated, calibration, plain, inputs.passed, inputs.seen, inputs.most)
    plain = plain_fit(system, calibration, rough, base_starts(system), 2 * ROUNDS)
    as_came = Denoised(calibration, evaluation, {}, recorded)
    problem = _posed(system, stated, inputs, recorded, as_came, plain, calibration)
    noise = problem.weighed(plain)
    calm = Denoised.of(calibration, evaluation, _taken_off(problem, noise, inputs), inputs.passed)
    everything = together(calm.calibration, calm.evaluation)
    plain = plain_fit(problem.system, calm.calibration, floor_of(problem, noise, plain), [plain.values])
    problem = _posed(problem.system, stated, inputs, recorded, calm, plain, everything)
    noise = problem.weighed(plain, others=[noise])
    floor = floor_of(problem, noise, plain)
    plain = plain_fit(problem.system, calm.calibration, floor, [plain.values])
    residuals = everything.residuals(problem.system, plain.values)
    passed_on = differences(calm.shaken, problem.system, plain.values, residuals)
    return replace(problem, plain=plain, floor=floor, passed_on=passed_on, noise=noise)


def together(calibration: Measured, evaluation: Measured) -> Measured:
    """All trials, calibration first."""
    trials, outputs = calibration.trials + evaluation.trials, calibration.outputs + evaluation.outputs
    return replace(calibration, trials=trials, outputs=outputs)


def _posed(
    system: System,
    stated: Mapping[str, float],
    inputs: InputBeliefs,
    recorded: Measured,
    calm: Denoised,
    plain: Refit,
    heard: Measured,
) -> Problem:
    """The problem around a fitted base model, its scale taken there; layouts of the trials in `heard`."""
    system = system.scaled(calm.calibration.trials, plain.values)
    trials = together(calm.calibration, calm.evaluation).trials
    placed = placement(system, trials, plain.values, list(inputs.shown), recorded.rough)
    own = [varies_by(system, p, plain.values[p.name]) for p in free(system)]
    spread, signal = noise_spread(system, recorded.outputs, recorded.rough), signal_size(recorded.outputs)
    noisy = spread[: len(heard.trials)], signal[: len(heard.trials)]
    growth = seen_growth(recorded.outputs, spread)
    return Problem(
        system=system,
        calibration=calm.calibration,
        evaluation=calm.evaluation,
        recorded=recorded,
        layouts=tuple(layouts_of(system, heard.trials, plain.values, heard.present, inputs.passed, calm.left, *noisy)),
        beliefs=usual_levels(system, stated, recorded.rough, inputs.seen, inputs.most, growth),
        usual=np.array([*own, *np.ones(placed[0].shape[-1])]),
        placement=placed,
        plain=plain,
        floor=recorded.rough,
        passed=inputs.passed,
        left=calm.left,
        shaken=calm.shaken,
        passed_on=(),
    )


def _taken_off(problem: Problem, noise: Noise, inputs: InputBeliefs) -> dict[str, float]:
    """Standard deviation of the noise of each measured input that is taken off it."""
    low_noise = np.minimum(noise.levels.inputs, SENSOR_LOUDER * problem.beliefs.middle.inputs)
    levels = dict(zip(problem.system.inputs, map(float, low_noise), strict=True))
    return {name: shown or min(levels[name], inputs.most[name]) for name, shown in inputs.shown.items()}
