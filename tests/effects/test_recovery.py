"""Every candidate's parameters come back from its own noise-free output."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from tests.effects.runs import EXAMPLES, FITTED, in_units_of_scale, label, outputs, truth

ABSORBED = {"sensor_gain.force", "sensor_gain.forces", "sensor_gain.torque"}
"""Imitated exactly: every stiffness and damping scaled by the same number."""


def absorbed(name: str, one: Candidate) -> bool:
    """Of sites not: their dashpot is known, so a gain shows in what it adds; nor of the shoulder, by its angle."""
    return label(one) in ABSORBED and name not in ("sit_to_stand", "shoulder")


KINKED = {("shoulder", "dead_zone"), ("shoulder", "end_stop.upper")}
"""Met for moments only, between two samples: least squares find them from nearby alone, and not to the last digit."""
TWINS = {("shoulder", "gravity_load.exo")}
"""Two numbers of it and the base's mass make two of the motion's: W sin(e + φ) + m g l_c sin e."""


STEP = 1e-6
"""Of differences: with smaller ones the search would see where the march of the shoulder's arm stops iterating."""


def span(p: Parameter) -> float:
    return abs(p.start) if p.start else p.upper - p.lower


def recovered(
    system: System,
    trials: tuple[Trial, ...],
    target: np.ndarray,
    free: tuple[Parameter, ...],
    start: dict[str, float],
    held: dict[str, float],
) -> tuple[dict[str, float], float]:
    scale = np.array([span(p) for p in free])
    there = np.isfinite(target)

    def residual(u: np.ndarray) -> np.ndarray:
        values = {**held, **{p.name: float(v) for p, v in zip(free, u * scale, strict=True)}}
        got = outputs(system, trials, values)
        return np.where(there & np.isfinite(got), in_units_of_scale(system, got - np.nan_to_num(target)), 0.0).ravel()

    low, high = (np.array([getattr(p, side) for p in free]) / scale for side in ("lower", "upper"))
    first = np.clip([start[p.name] for p in free] / scale, low + 1e-9 * (high - low), high - 1e-9 * (high - low))
    limits = {"xtol": 1e-14, "ftol": 1e-14, "gtol": 1e-14, "max_nfev": 300}
    fit = least_squares(residual, first, bounds=(low, high), diff_step=STEP, **limits)
    return {p.name: float(v) for p, v in zip(free, fit.x * scale, strict=True)}, float(fit.cost)


@pytest.mark.parametrize(("name", "one"), FITTED, ids=label)
def test_comes_back_with_the_base_held(name: str, one: Candidate) -> None:
    system, trials = EXAMPLES[name]
    changed, exact = one.apply(system), truth(one)
    target = outputs(changed, trials, {**system.start, **exact})
    fits = [recovered(changed, trials, target, one.parameters, dict(s), system.start) for s in one.starts]
    found, cost = min(fits, key=lambda fit: fit[1])
    for p in one.parameters:
        assert found[p.name] == pytest.approx(exact[p.name], rel=1e-4, abs=1e-5 * span(p)), (found, exact, cost)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "one"), [f for f in FITTED if not absorbed(*f)], ids=label)
def test_comes_back_with_the_base_free(name: str, one: Candidate) -> None:
    system, trials = EXAMPLES[name]
    changed, exact = one.apply(system), truth(one)
    target = outputs(changed, trials, {**system.start, **exact})
    kinked = (name, one.label) in KINKED
    off = {p.name: p.start * (1.0 if kinked else 1.15) for p in system.parameters}
    fits = [recovered(changed, trials, target, changed.parameters, {**off, **s}, {}) for s in one.starts]
    found, cost = min(fits, key=lambda fit: fit[1])
    if (name, one.label) in TWINS:
        assert cost < 1e-18
        return
    for p in changed.parameters:
        want = {**system.start, **exact}[p.name]
        near = 2e-2 if kinked else 1e-3
        assert found[p.name] == pytest.approx(want, rel=near, abs=1e-4 * span(p)), (found, exact, cost)


@pytest.mark.parametrize(("name", "one"), [f for f in FITTED if absorbed(*f)], ids=label)
def test_what_the_base_imitates_leaves_no_gap_but_wrong_parameters(name: str, one: Candidate) -> None:
    system, trials = EXAMPLES[name]
    gain = truth(one)[one.parameters[0].name]
    target = outputs(one.apply(system), trials, {**system.start, **truth(one)})
    start = {p.name: 0.9 * p.start for p in system.parameters}
    found, cost = recovered(system, trials, target, system.parameters, start, {})
    assert cost < 1e-18
    stiffness = [p for p in system.parameters if p.name.startswith("k")]
    assert [found[p.name] / p.start for p in stiffness] == pytest.approx([1.0 + gain] * len(stiffness), rel=1e-6)
