"""Calibration and prediction without their searches: which phases there are, what B holds of A, what C is given."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from geocontact.dynamics.collocation.solve import SolverOptions
from geocontact.standing_up import calibration, prediction
from geocontact.standing_up.calibrated_phase import PhaseSearch
from geocontact.standing_up.calibration import calibrated_phases
from geocontact.standing_up.chain import EVERY_PLANTED, FOOT_PARAMETERS, SOUGHT, SOUGHT_WORN, Subject
from geocontact.standing_up.exoskeleton import STRAP_PLANTED, strapped
from geocontact.standing_up.phases import TRACKS, TRACKS_B
from geocontact.standing_up.prediction import contact_parameters, predicted_trial
from geocontact.standing_up.selection import SelectedParameter
from geocontact.standing_up.strap_sites import STRAP_SITES, THIGH_STRAP, ContactParameter, deviations
from geocontact.standing_up.trials import StandingNoise, StandingTrial, StandingUpTrials, rising
from tests.unchecked import unchecked

SUBJECT, OPTIONS = Subject(), SolverOptions("radau", 4, 1, 1e-7)
FEET = np.array([each.searched(each.usual) for each in FOOT_PARAMETERS]) + 1e-3


@pytest.fixture(autouse=True)
def stand_ins() -> Iterator[None]:
    """Types are not checked: what is known stands in for searches."""
    with unchecked():
        yield


def trials(*, worn: bool) -> StandingUpTrials:
    """One smooth rise; forces do not matter."""
    time = np.linspace(0.0, 1.5, 76)
    q = rising(1.5)(time)
    if worn:
        q = np.hstack([q, q[:, 3:]])
    none = np.zeros(len(time))
    force, torque = np.tile([0.0, 700.0], (len(time), 1)), np.zeros((len(time), q.shape[1] - 3))
    trial = StandingTrial(time, q, 0.0 * q, force, none, "T1", torque, none if worn else None)
    sought, tracks = (SOUGHT_WORN, TRACKS_B) if worn else (SOUGHT, TRACKS)
    return StandingUpTrials(SUBJECT, StandingNoise(), (trial,), worn, sought, tracks)


@dataclass(frozen=True)
class StandIn:
    """Of an answer."""

    name: str
    found: SimpleNamespace
    phase: SimpleNamespace
    numbers: None = None
    selection: tuple[SelectedParameter, ...] = ()
    unselected: str = ""


@pytest.mark.parametrize(("worn", "solved", "names"), [(False, True, "A"), (True, True, "AB"), (True, False, "A")])
def test_b_follows_where_a_was_solved_and_holds_its_feet(
    monkeypatch: pytest.MonkeyPatch, worn: bool, solved: bool, names: str
) -> None:
    given, bounds, told = trials(worn=worn), {}, list[tuple[object, ...]]()

    def searched(name, model, each, noise, build, search, progress, held):  # type: ignore[no-untyped-def]
        bounds[name] = build(each, None).control.p
        progress(3, 2.0, 1.0)
        found = SimpleNamespace(solved=solved, ending="", p=np.r_[FEET, np.zeros(len(model.parameters) - len(FEET))])
        return StandIn(name, found, SimpleNamespace(parameters=model.parameters))

    monkeypatch.setattr(calibration, "calibrated_phase", searched)
    monkeypatch.setattr(calibration, "held_covariance", lambda numbers, parameters: np.zeros((len(parameters),) * 2))
    monkeypatch.setattr(calibration, "selection_among", lambda one, whole: ((), "not asked"))
    found = calibrated_phases(given, PhaseSearch(OPTIONS), lambda *words: told.append(words))
    assert "".join(phase.name for phase in found) == names  # type: ignore[misc]
    assert told == [(name, 3, 2.0, 1.0) for name in names]
    low, high = bounds["A"]
    free = [each.name for each, lo, hi in zip(FOOT_PARAMETERS, low, high, strict=False) if lo < hi]
    assert free == [each.name for each in FOOT_PARAMETERS if each.name in given.free]
    if "B" in bounds:
        low, high = bounds["B"]
        np.testing.assert_array_equal(low[: len(FEET)], FEET)
        np.testing.assert_array_equal(high[: len(FEET)], FEET)
        assert (low[len(FEET) :] < high[len(FEET) :]).all(), "all of the strap's are sought"


TOE = (SelectedParameter("toe", 40.0, 40.0, "identified", 1), SelectedParameter("heel", 1.0, 1.0, "not identified", 0))
FULL = PhaseSearch(OPTIONS, starts=2, resamples=3, profiles=4, select=True)
BRIEF = replace(FULL, starts=0, resamples=0, profiles=0)


@pytest.mark.parametrize(
    ("search", "solves", "selection", "runs", "why"),
    [
        (FULL, (True, True), (TOE, ""), [(BRIEF, SOUGHT), (FULL, ("toe",))], ""),
        (FULL, (True, True), (TOE[1:], ""), [(BRIEF, SOUGHT), (FULL, SOUGHT)], ""),
        (FULL, (True, True), ((), "it is singular"), [(BRIEF, SOUGHT), (FULL, SOUGHT)], "it is singular"),
        (FULL, (False, True), (TOE, ""), [(BRIEF, SOUGHT), (FULL, SOUGHT), (FULL, ("toe",))], ""),
        (FULL, (False, False), (TOE, ""), [(BRIEF, SOUGHT), (FULL, SOUGHT)], "the search did not converge"),
        (BRIEF, (True,), (TOE[1:], ""), [(BRIEF, SOUGHT)], ""),
        (replace(FULL, select=False), (True,), (TOE, ""), [(replace(FULL, select=False), SOUGHT)], ""),
    ],
)
def test_a_selection_that_fails_drops_nothing_that_was_asked(
    monkeypatch: pytest.MonkeyPatch,
    search: PhaseSearch,
    solves: tuple[bool, ...],
    selection: tuple[tuple[SelectedParameter, ...], str],
    runs: list[tuple[PhaseSearch, tuple[str, ...]]],
    why: str,
) -> None:
    """Starts, resamples and profiles follow with what was selected, or with the usual ones and the reason."""
    ran: list[tuple[PhaseSearch, tuple[str, ...]]] = []

    def searched(name, model, each, noise, build, how, progress, held):  # type: ignore[no-untyped-def]
        ran.append((how, tuple(build(each, None).free)))
        found = SimpleNamespace(solved=solves[min(len(ran), len(solves)) - 1], ending="", p=FEET)
        return StandIn(name, found, SimpleNamespace(parameters=model.parameters))

    monkeypatch.setattr(calibration, "calibrated_phase", searched)
    monkeypatch.setattr(calibration, "selection_among", lambda one, whole: selection)
    (one,) = calibrated_phases(trials(worn=False), search)
    assert ran == runs and one.unselected == why
    assert one.selection == (() if why else selection[0])


def test_parameters_stand_as_the_model_has_them() -> None:
    for sites in ((THIGH_STRAP,), STRAP_SITES):
        names = [each.name for each in contact_parameters(sites)]
        assert names == [each.name for each in strapped(SUBJECT, sites).parameters]


def test_deviations_are_a_part_of_the_interval_s_width() -> None:
    """A length as it is, a stiffness as a logarithm, 1.95996 to either side at 95 %; nothing without an interval."""
    place, stiff = (
        ContactParameter("place", "m", 0.2, 0.1, 0.0, 1.0),
        ContactParameter("k", "N/m", 3e3, 1.0, 1.0, 1e5, True),
    )
    found = deviations([place, stiff, place], {"place": (0.1, 0.3), "k": (1e3, 9e3)}, 0.95)
    assert found == pytest.approx([0.1 / 1.95996, np.log(3.0) / 1.95996, 0.1 / 1.95996], rel=1e-5)
    assert deviations([stiff], {}, 0.95) == pytest.approx([0.0])


@pytest.mark.parametrize("solved", [True, False])
def test_a_prediction_is_phase_c_on_the_mesh_that_was_asked_for(monkeypatch: pytest.MonkeyPatch, solved: bool) -> None:
    """15 intervals a second over 1.5 s, what is given and nothing else; certified only where the search was solved."""
    given, model = trials(worn=True), strapped(SUBJECT, (THIGH_STRAP,))
    (trial,), p, seen = given.trials, np.r_[EVERY_PLANTED, STRAP_PLANTED], dict[str, object]()
    n = model.count

    def course(time: np.ndarray) -> np.ndarray:
        q = rising(1.5)(time)
        return np.hstack([q, q[:, 3:], np.zeros((len(time), 2 * n))])

    motion = SimpleNamespace(
        state=course, control=lambda time: np.zeros((len(time), 2 * n - 3)), held_times=trial.time[:9]
    )
    found = SimpleNamespace(
        motions=(motion,), p=p, objective=2.0, solved=solved, ending="solved", iterations=7, seconds=0.5
    )

    def solve(control, options, *, meshes, progress):  # type: ignore[no-untyped-def]
        seen["mesh"] = len(meshes[0]) - 1
        return "coarse"

    def refined(control, coarse, options, turning, *, progress):  # type: ignore[no-untyped-def]
        assert coarse == "coarse"
        return found

    def judged(equations, controlled, turning, phase, each, *, certify):  # type: ignore[no-untyped-def]
        seen.update(certify=certify, terms=set(phase.terms), held=phase.control.p)
        passed = SimpleNamespace(converged=True) if certify else None
        return (SimpleNamespace(certificate=passed, time=trial.time),)

    for each in (solve, refined, judged):
        monkeypatch.setattr(prediction, each.__name__, each)
    one = predicted_trial("w", model, SUBJECT, trial, given.noise, p, OPTIONS, nodes=15.0, tracks=("torque",))
    assert seen["mesh"] == round(15.0 * 1.5) and seen["terms"] == {"torque", "energy", "jerk"}
    assert seen["certify"] is solved and one.certified is solved and one.solved is solved
    np.testing.assert_array_equal(seen["held"], (p, p))  # type: ignore[arg-type]
    np.testing.assert_allclose(one.trial.model.q, trial.q, atol=1e-12)
    assert one.trial.points.q.shape == (9, n) and (one.name, one.iterations, one.objective) == ("w", 7, 2.0)
