"""What an imitator leaves of the truth: first order is exact for a straight one; bounds hold back; a bent one bends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.chain.system import System
from geocontact.gap.case.refit import Measured, derivatives, free
from geocontact.gap.experiment.proposal import Hypothesis, Rows, SimulatedTrials, remaining_nats
from tests.systems.examples import example

SIGMA = 20.0  # N


def whiten(columns: np.ndarray) -> np.ndarray:
    return np.asarray(columns.reshape(-1, columns.shape[-1]) / SIGMA)


def wider(system: System, upper: float) -> System:
    """The same knee with another upper bound of its modulus."""
    return replace(system, parameters=tuple(replace(p, upper=upper) for p in system.parameters))


def truth(system: System, times: float) -> tuple[Measured, Measured]:
    """Two trials of a knee that is stiffer on one side, so many times; no modulus gives both sides."""
    _, trials = example("knee")
    rough = np.ones(2)
    both = [np.array([times, 1.1]) * system.simulate(trial, system.start) for trial in trials]
    first, second = (Measured((trial,), (made,), rough) for trial, made in zip(trials, both, strict=True))
    return first, second


def confounder(system: System, known: Measured) -> Hypothesis:
    values = dict(system.start)
    return Hypothesis("knee", system, values, known.residuals(system, values), derivatives(system, known, values))


def straight(one: Hypothesis, known: Measured) -> Rows:
    white = whiten(known.residuals(one.system, one.values)[0][..., None])[:, 0]
    return Rows(white, whiten(derivatives(one.system, known, one.values)[0]) * one.spread)


def test_a_straight_imitator_leaves_what_first_order_says() -> None:
    system = wider(example("knee")[0], 8e7)
    old, new = truth(system, 1.3)
    one = confounder(system, old)
    recordings = [SimulatedTrials(system, old, [whiten]), SimulatedTrials(system, new, [whiten], 3)]
    expected = straight(one, old).with_(straight(one, new), 3).nats
    assert remaining_nats(one, recordings) == pytest.approx(expected, rel=1e-3)
    assert remaining_nats(one, recordings[:1]) == pytest.approx(straight(one, old).nats, rel=1e-3)
    assert remaining_nats(one, recordings) > 2.0 * remaining_nats(one, recordings[:1])


def test_bounds_hold_an_imitator_back() -> None:
    system = example("knee")[0]
    held = wider(system, 1.02 * free(system)[0].start)
    old, _ = truth(system, 1.3)
    plenty = remaining_nats(confounder(wider(system, 8e7), old), [SimulatedTrials(system, old, [whiten])])
    assert remaining_nats(confounder(held, old), [SimulatedTrials(held, old, [whiten])]) > 2.0 * plenty


def test_a_bent_imitator_is_followed_beyond_its_first_step() -> None:
    """The arm of a strap and its stiffness multiply each other: one step overshoots, a refit finds them."""
    system, trials = example("sit_to_stand")
    known = {name: 1.6 * value for name, value in system.start.items()}
    measured = Measured(tuple(trials), tuple(system.simulate(t, known) for t in trials), np.ones(3))
    one = confounder(system, measured)
    first = sum(0.5 * float((whiten(r[..., None]) ** 2).sum()) for r in measured.residuals(system, one.values))
    left = remaining_nats(one, [SimulatedTrials(system, measured, [whiten] * len(trials))])
    believed = 0.5 * sum(
        ((known[p.name] - one.values[p.name]) / s) ** 2 for p, s in zip(free(system), one.spread, strict=True)
    )
    assert left < 1.01 * believed + 0.01
    assert first > 20.0 * left
