"""The discrepancy of an effect beside loops over plain numbers: two channels, two effects, one of them a mistake."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt
from typing import Any

import numpy as np

from geocontact.chain.differentiated_inputs import recorded
from geocontact.chain.system import System
from geocontact.effects.catalogue import candidates
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import Measured, Refit
from geocontact.gap.selection.model_comparison import discrepancy_basis
from geocontact.systems.catalogue import system_of
from tests.gap.cases import elbow_case

SHARE = 0.15
"""Root mean square of the bending over the effect's own."""
FLOOR = np.array([0.4, 2.5])
BASE = 3
RNG = np.random.default_rng(9)


class TwoChannels(Measured):
    """Trials whose residuals are drawn beforehand, by how many effects a system has."""

    drawn: dict[int, list[np.ndarray]]

    def residuals(self, system: System, values: Any) -> list[np.ndarray]:
        return self.drawn[len(system.effects)]


def measured(trials: tuple[Any, ...], effects: int) -> TwoChannels:
    one = TwoChannels(trials, tuple(np.zeros((len(t), 2)) for t in trials), FLOOR)
    drawn = {count: [RNG.normal(size=(len(t), 2)) for t in trials] for count in range(effects + 1)}
    object.__setattr__(one, "drawn", drawn)
    return one


def bare(kind: type, **fields: Any) -> Any:
    """An object of which only these fields are asked for."""
    one = object.__new__(kind)
    for name, value in fields.items():
        object.__setattr__(one, name, value)
    return one


def within(values: list[np.ndarray]) -> list[list[float]]:
    """-1 … 1 between the values below which 1 % and 99 % are, linear between neighbours in order."""
    ordered = sorted(float(v) for each in values for v in each)

    def at(share: float) -> float:
        place = share * (len(ordered) - 1)
        low = int(place)
        return ordered[low] + (place - low) * (ordered[min(low + 1, len(ordered) - 1)] - ordered[low])

    low, high = at(0.01), at(0.99)
    return [[min(1.0, max(-1.0, 2.0 * (float(v) - low) / (high - low) - 1.0)) for v in each] for each in values]


def monomials_by_hand(trials: list[Any], system: System) -> list[list[float]]:
    """Of each sample: 1; p, p², v, v², p v of every input; five powers of the time within the trial."""
    movements = [recorded(t.signals, system.inputs, system.motion.reach) for t in trials]
    rows: list[list[float]] = [[1.0] for t in trials for _ in range(len(t))]
    for k in range(len(system.inputs)):
        places = [p for each in within([m.position[k] for m in movements]) for p in each]
        rates = [v for each in within([m.rate[k] for m in movements]) for v in each]
        for row, p, v in zip(rows, places, rates, strict=True):
            row += [p, p * p, v, v * v, p * v]
    phases = [2.0 * (now - t.time[0]) / (t.time[-1] - t.time[0]) - 1.0 for t in trials for now in t.time]
    for row, phase in zip(rows, phases, strict=True):
        row += [phase, phase**2, phase**3, phase**4, phase**5]
    return rows


def spread_by_hand(before: np.ndarray, after: np.ndarray, slopes: np.ndarray, rows: list[list[float]]) -> np.ndarray:
    """Σ over the weights of column times column: what the weights spread the prediction by, (sample, channel) twice."""
    added = ((before - after) / FLOOR).ravel()
    own = (slopes / FLOOR[:, None]).reshape(-1, BASE)
    net = added - own @ np.linalg.inv(own.T @ own) @ (own.T @ added)
    columns = []
    for channel in range(2):
        for monomial in range(len(rows[0])):
            column = np.zeros((len(rows), 2))
            for sample, row in enumerate(rows):
                column[sample, channel] = net.reshape(-1, 2)[sample, channel] * row[monomial]
            columns.append(column.ravel())
    apart: list[np.ndarray] = []  # Gram and Schmidt, twice
    for column in columns:
        left = column
        for _ in range(2):
            for each in apart:
                left = left - (each @ left) * each
        apart.append(left / sqrt(left @ left))
    weight = SHARE**2 * float(net @ net) / len(apart)
    out = sum(weight * np.outer(each, each) for each in apart)
    scale = np.tile(FLOOR, len(rows))
    return np.asarray(out * np.outer(scale, scale))


def test_columns_of_two_effects_by_hand() -> None:
    case = elbow_case(duration=1.2)
    system = system_of(case)
    offered = {one.label: one for one in candidates(system)}
    effect, mistake = offered["dry_friction.rate"], offered["sign_flip.beta"]
    used = effect, mistake, replace(effect, name="again", parameters=(), link=lambda s: s)
    calibration, evaluation = measured(case.calibration, 3), measured(case.evaluation, 3)
    trials = [*case.calibration, *case.evaluation]
    jacobian = [RNG.normal(size=(len(t), 2, BASE + 1)) for t in trials]
    problem = bare(Problem, system=system, calibration=calibration, evaluation=evaluation, floor=FLOOR)
    assert problem.fitted == BASE
    found = discrepancy_basis(problem, used, bare(Refit, values={}, jacobian=jacobian))
    rows = monomials_by_hand(trials, system)
    slopes = np.concatenate(jacobian)[..., :BASE]
    wanted = np.zeros((2 * len(rows), 2 * len(rows)))
    for first in (0, 2):  # the second is a mistake in the data, which is not bent
        before, after = (np.concatenate([*calibration.drawn[k], *evaluation.drawn[k]]) for k in (first, first + 1))
        wanted += spread_by_hand(before, after, slopes, rows)
    assert [len(b) for b in found] == [len(t) for t in trials]
    flat = np.concatenate(found).reshape(2 * len(rows), -1)
    assert flat.shape[1] == 2 * 2 * len(rows[0])
    np.testing.assert_allclose(flat @ flat.T, wanted, atol=1e-9 * np.abs(wanted).max())
