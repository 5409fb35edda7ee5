"""Designs one after the other on movements that are lines: shares and gains in closed form, and where none is found."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace

import numpy as np
import pytest

from geocontact.dynamics.collocation.solve import SolverOptions
from geocontact.standing_up.assistance_design import KNEE, NAMES, STRAP, HelpDesign
from geocontact.standing_up.assisted_movement import Asked, Movement, Movements, StoppedByHandError
from geocontact.standing_up.chain import EVERY_PLANTED, Subject
from geocontact.standing_up.exoskeleton import STRAP_PLANTED
from geocontact.standing_up.help_search import (
    BEST,
    WORN,
    CertifiedDesign,
    DrawnGain,
    HelpSearch,
    HelpSettings,
    NoMovementError,
    gain_interval,
)
from tests.unchecked import unchecked

P, SHARE = np.r_[EVERY_PLANTED, STRAP_PLANTED, 0.3, 0.25], NAMES.index("share")
SD = np.where(np.arange(len(P)) == 0, 1.0, 0.0)


@pytest.fixture(autouse=True)
def stand_ins() -> Iterator[None]:
    """Types are not checked: lines stand in for movements."""
    with unchecked():
        yield


class Lines(Movements):
    """The knee asks for 100 (1 - share) N m, the strap for 10 + 50 share + p0 N; none beyond a share of `most`."""

    def __init__(self, most: float = np.inf, stop_after: int = 10**9) -> None:
        self.solved, self.most, self.stop_after = 0, most, stop_after

    def refine(self, movements: object) -> bool:
        return False

    def at(self, p: np.ndarray, *, slopes: bool = True) -> Movement:
        self.solved += 1
        if self.solved > self.stop_after:
            raise StoppedByHandError("interrupted")
        if p[SHARE] > self.most:
            raise ArithmeticError("the search has no answer")
        by, of = np.zeros((1, len(p))), np.zeros((4, len(p)))
        of[STRAP, SHARE], of[KNEE, SHARE], by[:, SHARE] = 50.0, -100.0, -100.0
        knee = np.array([100.0 * (1.0 - p[SHARE])])
        sizes = np.array([10.0 + 50.0 * p[SHARE] + p[0] - P[0], knee[0], 1.0, 1.0])[np.argsort([STRAP, KNEE, 2, 3])]
        asked = Asked(sizes, of, 1.1 * sizes, 1.1 * knee, 1.1 * by, 24, 9)
        return Movement(None, SimpleNamespace(p=p), asked, None)  # type: ignore[arg-type]


class OnLines(HelpSearch):
    """Without certificates: no motion is behind the lines."""

    def _certified(self, name: str, limit: float, found: HelpDesign | None, movement: Movement) -> CertifiedDesign:
        return CertifiedDesign(name, limit, found, movement, ())


def searching(lines: Lines, draws: int = 0) -> OnLines:
    settings = HelpSettings(("share",), knee=0.8, draws=draws, seed=3)
    found = OnLines(Subject(), (), P, SD, settings, SolverOptions("radau", 3, 1, 1e-8))
    found.movements = lines
    return found


def test_shares_and_gains_are_those_of_the_lines() -> None:
    """80 % of the knee is a share of 0.2, 90 % one of 0.1; the strap has 20 N in place of 10, each draw its number."""
    search = searching(Lines(), draws=3)
    worn = search.worn()
    (best,) = search.chosen(worn)
    (front,) = search.front(worn, best, 2)[1:]
    assert (worn.name, best.name, front.name) == (WORN, BEST, "knee at 0.9")
    shares = [one.movement.found.p[SHARE] for one in (worn, front, best)]
    assert shares == pytest.approx([0.0, 0.1, 0.2], abs=1e-4)
    drawn = search.drawn([worn, best])
    numbers = np.random.default_rng(3).normal(size=(3, len(P)))[:, 0]
    assert [each.reference for each in drawn] == pytest.approx(10.0 + numbers)
    assert [each.chosen for each in drawn] == pytest.approx(20.0 + numbers, abs=0.01)
    assert drawn[0].largest_knee == pytest.approx(1.1 * 80.0, abs=0.01)
    assert drawn[0].gain == pytest.approx(1.0 - (20.0 + numbers[0]) / (10.0 + numbers[0]), abs=2e-3)


def test_what_nobody_stands_up_with_is_named() -> None:
    with pytest.raises(NoMovementError, match="no answer") as error:
        searching(Lines(most=-1.0)).worn()
    assert error.value.design == WORN
    search = searching(Lines(most=0.01))
    worn = search.worn()
    with pytest.raises(NoMovementError) as error:
        search.chosen(worn)
    assert error.value.design == BEST


def test_stopped_by_hand_before_anything_was_chosen() -> None:
    with pytest.raises(StoppedByHandError):
        searching(Lines(stop_after=0)).worn()
    search = searching(Lines(stop_after=1), draws=2)
    worn = search.worn()
    with pytest.raises(StoppedByHandError):
        search.chosen(worn)
    assert search.stop and search.drawn([worn]) == () and search.front(worn, worn, 2) == ()


def test_interval_of_the_next_gain_is_student_s() -> None:
    """Gains of 0.2 and 0.4: 0.3 and 12.706 standard deviations of 0.1414 times the root of 1.5."""
    draws = [DrawnGain(10.0, 10.0 * (1.0 - gain), 1.0, 1.0, 1.0, 1.0) for gain in (0.2, 0.4)]
    reach = 12.7062 * np.sqrt(0.02) * np.sqrt(1.5)
    assert gain_interval(draws) == pytest.approx((0.3 - reach, 0.3 + reach), rel=1e-4)
    assert np.isnan(gain_interval(draws[:1])).all()
