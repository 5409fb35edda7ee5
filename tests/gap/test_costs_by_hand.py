"""Every term of what is made least when a case's model is fitted again, beside loops over plain numbers."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import geocontact.gap_benchmark.synthetic.visibility as base_fit
from geocontact.chain.system import System
from geocontact.data.trial import Trial
from geocontact.gap.case.plain_fit import Plain
from geocontact.gap.case.refit import Measured, RefitSearch, derivatives, free, magnitude
from geocontact.gap.experiment.proposal import Hypothesis, SimulatedTrials, remaining_nats
from geocontact.identify.optimise.least_squares import NO_VALUE
from tests.systems.examples import example

FLOOR = np.array([0.3, 7.0, 40.0])


def case() -> tuple[System, Measured, dict[str, float]]:
    """Three channels that are wrong by parts, of trials of two lengths, one sample not measured."""
    system, trials = example("sit_to_stand")
    rng = np.random.default_rng(3)
    short = cut(trials[0], 0.6)
    some = (*trials[:1], short)
    outputs = [system.simulate(t, system.start) * rng.uniform(0.8, 1.2, 3) for t in some]
    outputs[1][4, 1] = np.nan
    measured = Measured(some, tuple(outputs), FLOOR)
    values = {p.name: p.start * rng.uniform(1.01, 1.1) for p in free(system)}
    return system, measured, values


def cut(trial: Trial, share: float) -> Trial:
    kept = round(share * len(trial.time))
    signals = trial.signals
    return replace(trial, signals=replace(signals, time=signals.time[:kept], values=signals.values[:kept]))


def squares(system: System, measured: Measured, values: dict[str, float]) -> float:
    total = 0.0
    for trial, outputs in zip(measured.trials, measured.outputs, strict=True):
        shown = system.simulate(trial, values)
        for t in range(len(outputs)):
            for c in range(3):
                if np.isfinite(outputs[t, c]):
                    off = NO_VALUE * FLOOR[c] if np.isnan(shown[t, c]) else outputs[t, c] - shown[t, c]
                    total += (off / FLOOR[c]) ** 2
    return total


def test_a_refit_by_hand() -> None:
    system, measured, values = case()
    search = RefitSearch(system, measured, [Plain(there, FLOOR) for there in measured.present])
    found = search.from_start(values, 1)
    assert found.cost == pytest.approx(0.5 * squares(system, measured, values), rel=1e-10)


def test_nats_that_remain_by_hand(monkeypatch: pytest.MonkeyPatch) -> None:
    """Trials that count thrice, and what is believed of each parameter in parts of its spread."""
    asked: list[tuple[object, np.ndarray]] = []

    def caught(residual: object, start: np.ndarray, *_: object, **__: object) -> SimpleNamespace:
        asked.append((residual, start))
        return SimpleNamespace(cost=0.0)

    monkeypatch.setattr("scipy.optimize.least_squares", caught)
    system, measured, values = case()
    known = dict(system.start)
    off = measured.residuals(system, known)
    one = Hypothesis("one", system, known, off, derivatives(system, measured, known, off))
    plain = [Plain(there, FLOOR) for there in measured.present]
    remaining_nats(one, [SimulatedTrials(system, measured, plain), SimulatedTrials(system, measured, plain, 3)])
    ((residual, _),) = asked
    at = np.array([values[p.name] / magnitude(p) for p in free(system)])
    found = residual(at)  # type: ignore[operator]
    total = 4.0 * squares(system, measured, values)
    for p, spread in zip(free(system), one.spread, strict=True):
        total += ((values[p.name] - known[p.name]) / spread) ** 2
    assert float(found @ found) == pytest.approx(total, rel=1e-10)


def test_the_benchmark_s_base_model_by_hand(monkeypatch: pytest.MonkeyPatch) -> None:
    """Channels in rows here; derivatives by each parameter."""
    asked: list[tuple[object, object]] = []

    def caught(residual: object, start: np.ndarray, *, jac: object, **_: object) -> SimpleNamespace:
        asked.append((residual, jac))
        return SimpleNamespace(cost=0.0, x=start)

    monkeypatch.setattr(base_fit, "least_squares", caught)
    rng = np.random.default_rng(5)
    maps = [rng.normal(size=(3, count, 2)) for count in (5, 8)]
    measured = [rng.normal(size=(3, count)) for count in (5, 8)]
    measured[1][2, 3] = np.nan
    scene = SimpleNamespace(parameters=[SimpleNamespace(lower=-9.0, upper=9.0, start=1.0)] * 2)
    models = [lambda theta, of=of: of @ theta**2 for of in maps]
    bare = getattr(base_fit.refit, "__wrapped__", base_fit.refit)
    theta = np.array([1.3, -0.7])
    bare(scene, models, measured, FLOOR, [theta])
    ((residual, slope),) = asked
    found, total, gradient = residual(theta), 0.0, np.zeros(2)  # type: ignore[operator]
    for of, wanted in zip(maps, measured, strict=True):
        for c in range(3):
            for t in range(wanted.shape[1]):
                if np.isfinite(wanted[c, t]):
                    off = (of[c, t] @ theta**2 - wanted[c, t]) / FLOOR[c]
                    total += off**2
                    gradient += off * of[c, t] * 2.0 * theta / FLOOR[c]
    assert float(found @ found) == pytest.approx(total, rel=1e-12)
    np.testing.assert_allclose(slope(theta).T @ found, gradient, rtol=1e-6)  # type: ignore[operator]
