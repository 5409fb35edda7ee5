"""From a case to its problem: base model fitted, noise of inputs estimated and taken off, rates smoothed.

A spectrum alone does not tell noise from a movement that ends where a filter might. Noise that is taken off leaves the
base model's error as it is or smaller; movement that is taken off makes it larger, in some channel if not in the sum:
one that hardly notices may have most of the error.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.gap.case.change_amplitude import amplitude
from geocontact.gap.case.noise_sources import (
    noise_spread,
    quotient_noise,
    rough_noise,
    seen_growth,
    signal_size,
    typical_step,
    with_rounding,
)
from geocontact.gap.case.placement import placement, varies_by
from geocontact.gap.case.plain_fit import base_starts, plain_fit
from geocontact.gap.case.problem import Noise, Problem, differences, floor_of
from geocontact.gap.case.refit import ROUNDS, Measured, Refit, free
from geocontact.gap.case.whitening import SENSOR_LOUDER, layouts_of, sensitivity, usual_levels
from geocontact.gap.inputs.denoise import Filters, Left, denoised, highest_noise, left, seen_noise, shaken
from geocontact.gap.inputs.spectrum import measured_inputs
from geocontact.gap.inputs.spectrum_components import filters_of, likely_noise
from geocontact.gap.levels import SLIGHT
from geocontact.identify.noise.noise_search import most_likely

REACHES = (14.0, 10.0, 7.0, 5.0, 3.5, 2.5)  # samples to either side, that rates may be smoothed over


def with_smoothed_rates(
    system: System,
    stated: Mapping[str, float],
    measured: Measured,
    plain: Refit,
    passed: Filters,
    seen: Mapping[str, float],
    most: Mapping[str, float],
) -> System:
    """The system with the smoothing of rates that makes the base model's residuals most likely; `plain` fits it.

    That is a local best, searched from the middle of `REACHES` uphill. How far rates have to be smoothed depends on the
    noise of the inputs, which is not known. Where the base does not depend on rates, least is smoothed.
    """
    rough = measured.rough
    system = system.scaled(measured.trials, plain.values)
    if not system.dynamic and not any(
        sensitivity(system, trial, plain.values, ()).to_rate.any() for trial in measured.trials
    ):
        return system
    shape = quotient_noise(system, measured.outputs, rough)
    spread, signal = noise_spread(system, measured.outputs, shape), signal_size(measured.outputs)
    beliefs = usual_levels(system, stated, rough, seen, most, seen_growth(measured.outputs, spread))
    usual = np.array([varies_by(system, p, plain.values[p.name]) for p in free(system)])

    def likelihood(reach: float) -> float:
        other = system.reaching(reach)
        model = plain_fit(other, measured, rough, [plain.values], ROUNDS // 2)
        layouts = layouts_of(other, measured.trials, model.values, measured.present, passed, {}, spread, signal)
        varied = [j[..., : len(usual)] * usual for j in model.jacobian]
        return most_likely(layouts, model.residuals, varied, beliefs, beliefs.middle, ROUNDS)[2]

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
        """The same without noise that could not be taken off without harm to the base model; what is stated stays."""
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
    shape = quotient_noise(system, recorded.outputs, recorded.rough)
    spread, signal = noise_spread(system, recorded.outputs, shape), signal_size(recorded.outputs)
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
