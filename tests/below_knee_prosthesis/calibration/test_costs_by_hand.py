"""Every term of what a sole's calibration makes least, beside loops over plain numbers, no two sizes alike."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.calibration.calibrate import bounded_fit, linear_rows
from geocontact.below_knee_prosthesis.calibration.recorded_stance import Errors, RecordedStance
from geocontact.below_knee_prosthesis.calibration.sole_residuals import NO_BALANCE, SoleResiduals
from geocontact.below_knee_prosthesis.calibration.whole_model import WholeResiduals
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from tests.below_knee_prosthesis.calibration.stances import recorded

SD = {"stiffness": np.log(3.0), "damping": np.log(10.0), "friction": np.log(2.0)}
NO_VALUE = 3.0
Z = np.linspace(-0.12, 0.16, 15)


def part_of_stance(first: int, count: int) -> RecordedStance:
    stance, few = recorded(), slice(first, first + count)
    names = ("time", "poses", "rate", "force", "centre")
    return replace(stance, **{name: getattr(stance, name)[few] for name in names})


def uneven(shape: tuple[int, ...], seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(0.5, 20.0, shape)


def beliefs(z: np.ndarray) -> float:
    kinds = [kind for kind in ("stiffness", "damping", "friction") for _ in range(5)]
    return sum((value / SD[kind]) ** 2 for value, kind in zip(z, kinds, strict=True))


def test_sole_by_hand() -> None:
    """Two stances; force and centre, then the slip, each sample in its own size; a sample that was not measured."""
    stances = [part_of_stance(10, 7), part_of_stance(60, 5)]
    stances[1].centre[2] = np.nan
    residuals = SoleResiduals.of(stances, vsf_foot())
    residuals.noise = [uneven((len(each.time), 6), k) for k, each in enumerate(stances)]
    found, total = residuals(Z), beliefs(Z)
    for k, (stance, noise) in enumerate(zip(stances, residuals.noise, strict=True)):
        motion, slip = residuals.motion(Z, k)
        shown = stance.predicted(residuals.keel(Z, stance), motion)
        for t in range(len(stance.time)):
            for c in range(6):
                wanted = [*stance.force[t], stance.centre[t], 0.0, 0.0][c]
                model = [*shown[t], *slip[t]][c]
                if np.isfinite(wanted):
                    total += NO_VALUE**2 if np.isnan(model) else ((model - wanted) / noise[t, c]) ** 2
    assert float(found @ found) == pytest.approx(total, rel=1e-10)
    assert len(found) == 6 * 12 - int(np.isnan(stances[0].centre).sum()) - int(np.isnan(stances[1].centre).sum()) + 15


def test_whole_by_hand(monkeypatch: pytest.MonkeyPatch) -> None:
    """Channels that a simulation shows, and one stance that falls over."""
    residuals = WholeResiduals([], vsf_foot(), np.zeros(15), machine_code=False)
    rng = np.random.default_rng(4)

    class Whole:
        def __init__(self, count: int) -> None:
            self.shown = rng.normal(size=(count, 4))
            measured = rng.normal(size=(count, 4))
            measured[1, 3] = np.nan
            fields = {"measured": measured, "standing": "", "errors": Errors()}
            self.stance = type("S", (), {"recorded": object.__new__(type("R", (RecordedStance,), fields))})

        def channels(self, shown: np.ndarray) -> np.ndarray:
            return shown

    wholes = [Whole(5), Whole(3)]
    residuals.wholes = wholes  # type: ignore[assignment]
    residuals.noise = [uneven((5, 4), 1), uneven((3, 4), 2)]
    monkeypatch.setattr(WholeResiduals, "shown", lambda *_: [wholes[0].shown, None])
    found, total = residuals(Z), beliefs(Z) + 11 * NO_BALANCE**2
    measured = wholes[0].stance.recorded.measured
    for t in range(5):
        for c in range(4):
            if np.isfinite(measured[t, c]):
                total += ((wholes[0].shown[t, c] - measured[t, c]) / residuals.noise[0][t, c]) ** 2
    assert float(found @ found) == pytest.approx(total, rel=1e-12)


def test_linear_turn_by_hand() -> None:
    """Forces and the moment about the measured centre, row by row, sphere by sphere."""
    foot, stance = vsf_foot(), part_of_stance(40, 6)
    keel = foot.at(stance.fulcrum)
    motion, noise = stance.solved(keel), uneven((6, 4), 3)
    zones = ZoneParameters(foot.sole, foot.law)
    values = uneven((10,), 5) * zones.values_of(foot.law)[:10]
    matrix, target = linear_rows(stance, keel, motion, noise)
    off = matrix @ values - target
    total, members = 0.0, list(foot.sole.spheres.zones.values())
    law, (depth, rate) = foot.law, (motion.loads.depth, motion.rate)
    for t in range(6):
        sums, moment = np.zeros(3), 0.0
        for s in range(len(foot.sole.spheres)):
            zone = next(k for k, of in enumerate(members) if of[s])
            share = min(max(depth[t, s] / law.full_depth, 0.0), 1.0)
            pushed = values[zone] * max(depth[t, s], 0.0) ** law.exponent
            pushed += values[5 + zone] * max(rate[t, s], 0.0) * share**2 * (3.0 - 2.0 * share)
            own = motion.loads.pressing[t, s]
            if own > 0.0:
                sums += pushed * motion.loads.force[t, s] / own
                along = stance.poses[t].inv().apply(motion.loads.point[t, s])[0] / foot.keel.length
                if np.isfinite(stance.centre[t]):
                    moment += pushed * (along - stance.centre[t]) / stance.force[t, 1]
        total += sum(((sums[axis] - stance.force[t, axis]) / noise[t, axis]) ** 2 for axis in range(3))
        total += (moment / noise[t, 3]) ** 2
    assert float(off @ off) == pytest.approx(total, rel=1e-6)


def test_bounded_fit_by_hand() -> None:
    """Where no bound holds, the normal equations of Σ (row x - wanted)² + Σ ((x/now - 1)/sd)²."""
    rng = np.random.default_rng(6)
    matrix = rng.normal(size=(9, 4))
    wanted = matrix @ [2.0, 2.5, 0.3, 9.0] + rng.normal(size=9)
    now, sd = np.array([1.0, 3.0, 0.2, 7.0]), np.array([0.4, 2.0, 0.1, 0.8])
    found = bounded_fit(matrix, wanted, now, sd, now, np.full(4, np.log(1e3)))
    left, right = matrix.T @ matrix, matrix.T @ wanted
    for k in range(4):
        left[k, k] += 1.0 / (now[k] * sd[k]) ** 2
        right[k] += 1.0 / (now[k] * sd[k] ** 2)
    best = np.linalg.solve(left, right)
    assert (best > 1e-3 * now).all(), "numbers that no bound holds"
    np.testing.assert_allclose(found, best, rtol=1e-6)
