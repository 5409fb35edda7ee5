"""With resamples, tables and motions have the same parameters: whatever is held, on a bound, or would leave it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, TypeVar

import numpy as np
import pytest

from geocontact.dynamics.collocation.solve import CollocationResult, SolverOptions
from geocontact.standing_up import calibrated_phase as module
from geocontact.standing_up import contact_numbers as numbers_module
from geocontact.standing_up.assumed_shares import AssumedShares
from geocontact.standing_up.calibrated_phase import CalibratedPhase, PhaseSearch, calibrated_phase
from geocontact.standing_up.contact_numbers import Resampled
from geocontact.standing_up.phase import PhaseProblem
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import ContactParameter
from geocontact.standing_up.trials import StandingNoise

T = TypeVar("T")
PARAMETERS = (
    ContactParameter("inside", "m", 0.5, 0.2, 0.0, 1.0),
    ContactParameter("on its bound", "m", 1.0, 0.2, 0.0, 1.0),
    ContactParameter("leaves it", "m", 0.02, 0.2, 0.0, 1.0),
    ContactParameter("held", "m", 0.3, 0.2, 0.0, 1.0),
    ContactParameter("logarithm", "Pa", 2.0, 0.2, 1.0, 4.0, logarithm=True),
)
LOW, HIGH = np.array([0.0, 0.0, 0.0, 0.3, -np.log(2.0)]), np.array([1.0, 1.0, 1.0, 0.3, np.log(2.0)])
FOUND = np.array([0.5, 1.0, 0.02, 0.3, 0.2])
BIAS = np.array([0.1, 0.2, 0.05, 0.04, -0.1])
CORRECTED = np.array([0.4, 1.0, 0.0, 0.3, 0.3])
"""By hand: less the bias, not below the bound of 0; on the bound and held as they were."""


def made(kind: type[T], **values: Any) -> T:
    """One of a kind with these values only."""
    one = kind.__new__(kind)
    for name, value in values.items():
        object.__setattr__(one, name, value)
    return one


def calibrated(monkeypatch: pytest.MonkeyPatch, *, curved: bool = True) -> CalibratedPhase:
    """A phase whose search, resamples and curvature are given."""
    control: Any = SimpleNamespace(p=(LOW, HIGH), guess_p=FOUND)
    phase = made(PhaseProblem, control=control, parameters=PARAMETERS, terms={"force": None})

    def solved(control: Any, *_: object, **__: object) -> CollocationResult:
        low, high = control.p
        p = FOUND if (low < high).any() else low
        return made(CollocationResult, p=p, solved=True, objective=1.0, meshes=(), motions=(), ending="")

    def hessian(*_: object) -> np.ndarray:
        if not curved:
            raise ValueError("no curvature")
        return np.diag(np.full(5, 1e-4))

    given: dict[str, Any] = {
        "solve": solved,
        "refined": lambda control, found, *_, **__: found,
        "resampled": lambda *_: Resampled(np.array([BIAS - 0.01, BIAS + 0.01])),
        "judged": lambda *_, **__: (),
        "cost_shares": lambda *_: {},
        "misfit": lambda *_: 0.8,
        "replace": lambda of, **changed: made(type(of), **(vars(of) | changed)),
    }
    for name, value in given.items():
        monkeypatch.setattr(module, name, value)
    monkeypatch.setattr(numbers_module, "inverse_reduced_hessian", hessian)
    none = AssumedShares(np.zeros((5, 5)), np.zeros((5, 1)), np.zeros((5, 5)))
    monkeypatch.setattr(numbers_module, "assumed_shares", lambda *_: none)
    for name in ("joints", "turning"):
        monkeypatch.setattr(StandingModel, name, ())
    model = made(StandingModel, equations=None, stepper=None)
    search = PhaseSearch(SolverOptions("radau", 4, 20, 1e-7), resamples=2)
    return calibrated_phase("A", model, (), StandingNoise(), lambda trials, start: phase, search)


def test_tables_and_motions_have_the_same_parameters(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before, the motion of a parameter on its bound was that of it off the bound, the table's left its bounds."""
    found = calibrated(monkeypatch)
    np.testing.assert_allclose(found.found.p, CORRECTED, atol=1e-12)
    values = [each.searched(number.value) for each, number in zip(PARAMETERS, found.numbers.numbers, strict=True)]
    np.testing.assert_allclose(values, found.found.p, atol=1e-12)
    assert [each.verdict for each in found.numbers.numbers][1:4:2] == ["on its bound", "held"]


def test_without_intervals_nothing_is_corrected(monkeypatch: pytest.MonkeyPatch) -> None:
    found = calibrated(monkeypatch, curved=False)
    assert found.doubt == "no curvature"
    np.testing.assert_allclose(found.found.p, FOUND)
    values = [each.searched(number.value) for each, number in zip(PARAMETERS, found.numbers.numbers, strict=True)]
    np.testing.assert_allclose(values, found.found.p, atol=1e-12)
