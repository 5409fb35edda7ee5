"""Every term of the movement with help, of the first fit and of the synthetic trials, beside plain numbers."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import casadi
import numpy as np
import pytest

import geocontact.standing_up.trials as trials_module
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.dynamics.collocation.problem import ControlledSystem, ControlProblem
from geocontact.standing_up.assisted_model import assisted_model, habit
from geocontact.standing_up.chain import EVERY_PLANTED, SOUGHT
from geocontact.standing_up.exoskeleton import STRAP_PLANTED, with_exoskeleton
from geocontact.standing_up.first_fit import first_fit
from geocontact.standing_up.phase import smooth_coordinates
from geocontact.standing_up.strap_sites import usual
from geocontact.standing_up.trials import StandingUpTrials
from tests.cli.calls import MESHES

P = np.r_[EVERY_PLANTED, STRAP_PLANTED, 0.3, 0.25]


@pytest.fixture(scope="module")
def given() -> StandingUpTrials:
    return standing_trials(Path(MESHES) / "standing_up_held_out" / "study.toml", "study")


def cost_at(system: ControlledSystem, seed: int) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
    """At states, controls and data of which no two are alike."""
    rng = np.random.default_rng(seed)
    x, u, w = (rng.normal(size=each.numel()) for each in (system.x, system.u, system.w))
    at = casadi.Function("cost", [system.x, system.u, system.w, system.p], [system.cost])
    return float(at(x, u, w, P[: system.p.numel()])), x, u, w


def test_habit_by_hand(given: StandingUpTrials) -> None:
    """Deviations in parts of 1 cm and 2°, the lean in parts of 5°, jerk of nine coordinates, four torques."""
    system = habit(assisted_model(given.subject), given.subject, given.trials, P).system
    found, x, u, w = cost_at(system, 1)
    q, jerk, torque, wanted = x[:9], u[:9], u[9:], w[1:]
    assert len(torque) == 4 and len(wanted) == 6
    sizes = [0.01, 0.01, *[np.radians(2.0)] * 4]
    terms = [sum(((q[k] - wanted[k]) / sizes[k]) ** 2 for k in range(6))]
    terms.append(((sum(q[6:9]) - sum(q[3:6])) / np.radians(5.0)) ** 2)
    terms.append(1e-5 * sum(each**2 for each in jerk))
    terms.append(1e-6 * sum(each**2 for each in torque))
    assert found == pytest.approx(sum(terms), rel=1e-12)


def test_synthetic_trials_by_hand(given: StandingUpTrials, monkeypatch: pytest.MonkeyPatch) -> None:
    """With an exoskeleton whose torques are to be a part of the person's."""
    problems = []

    def caught(problem: ControlProblem, *_: object) -> None:
        problems.append(problem)
        raise InterruptedError

    monkeypatch.setattr(trials_module, "solve", caught)
    monkeypatch.setattr(trials_module, "UNPOWERED", 0.7)
    model = with_exoskeleton(given.subject)
    with pytest.raises(InterruptedError):
        trials_module.standing_up(model, given.subject, planted=P[:-2], assistance=0.3)
    found, x, u, w = cost_at(problems[0].system, 2)
    sizes = [0.01, 0.01, *[np.radians(2.0)] * 7]
    terms = [sum(((x[k] - w[k]) / sizes[k]) ** 2 for k in range(9)), 1e-5 * sum(u[:9] ** 2), 1e-6 * sum(u[9:] ** 2)]
    terms.append(0.7 * sum((u[12 + k] - 0.3 * u[9 + k]) ** 2 for k in range(3)))
    assert found == pytest.approx(sum(terms), rel=1e-12)


def test_first_fit_by_hand(given: StandingUpTrials, monkeypatch: pytest.MonkeyPatch) -> None:
    """Beliefs, then force in parts of 20 N and centre in parts of 5 mm, each sample by its part of the trial."""
    asked: list[object] = []

    def caught(off: object, start: np.ndarray, **_: object) -> SimpleNamespace:
        asked.append(off)
        return SimpleNamespace(x=start)

    monkeypatch.setattr("scipy.optimize.least_squares", caught)
    model, trials = with_exoskeleton(given.subject), given.trials
    smooth = [smooth_coordinates(trial) for trial in trials]
    first_fit(model, trials, smooth, SOUGHT, ("force", "centre"))
    names = [each.name for each in model.parameters]
    places = [names.index(name) for name in SOUGHT if name in names]
    p, middle = P[:-2].copy(), usual(model.parameters)
    p[[k for k in range(len(p)) if k not in places]] = middle[[k for k in range(len(p)) if k not in places]]
    (off,) = asked
    found = off(p[sorted(places)])  # type: ignore[operator]
    total = sum(((p[k] - middle[k]) / model.parameters[k].sd) ** 2 for k in places)
    plate = casadi.Function(
        "plate", [model.equations.q, model.equations.u, model.equations.p], [model.force, model.centre]
    )
    for trial, course in zip(trials, smooth, strict=True):
        for k, at in enumerate(trial.time - trial.time[0]):
            q, before, after = (course(np.array([at + by]))[0] for by in (0.0, -1e-3, 1e-3))
            force, centre = (each.full().ravel() for each in plate(q, (after - before) / 2e-3, p))
            of = sum(((force[axis] - trial.force[k, axis]) / 20.0) ** 2 for axis in (0, 1))
            total += (of + ((centre[0] - trial.centre[k]) / 5e-3) ** 2) / len(trial.time)
    assert float(found @ found) == pytest.approx(total, rel=1e-9)
