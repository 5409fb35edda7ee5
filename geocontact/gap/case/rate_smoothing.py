"""Over how many samples the rates of inputs are smoothed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from geocontact.chain.system import System
from geocontact.gap.case.placement import varies_by
from geocontact.gap.case.plain_fit import plain_fit
from geocontact.gap.case.quotient_noise import noise_spread
from geocontact.gap.case.refit import ROUNDS, Measured, Refit, free
from geocontact.gap.case.signal_size import seen_growth, signal_size
from geocontact.gap.case.whitening import layouts_of, sensitivity, usual_levels
from geocontact.gap.inputs.denoise import Filters
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
    spread, signal = noise_spread(system, measured.outputs, rough), signal_size(measured.outputs)
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
