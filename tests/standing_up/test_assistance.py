"""Movements with help: derivatives of what they ask, and of the least of it, against problems that are solved again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from casadi import Function

from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.dynamics.collocation.solve import SolverOptions
from geocontact.standing_up.assistance_design import KNEE, NAMES, STRAP, HelpTask, designed
from geocontact.standing_up.assisted_model import SHARE, assisted_model
from geocontact.standing_up.assisted_movement import ORDER, PLACES, Asked, Movement, Movements
from geocontact.standing_up.chain import EVERY_PLANTED
from geocontact.standing_up.exoskeleton import STRAP_PLANTED
from tests.cli.calls import MESHES

P = np.r_[EVERY_PLANTED, STRAP_PLANTED, 0.3, 0.25]
WITHIN = 0.01
"""Of a derivative."""
PARTS = np.array([0.5, -1.0, 0.7])
"""Of a knee's peak, at three places."""


@pytest.fixture(scope="module")
def movements() -> Movements:
    given = standing_trials(Path(MESHES) / "standing_up_held_out" / "study.toml", "study")
    options = SolverOptions("radau", 3, 1, 1e-9)
    return Movements(assisted_model(given.subject), given.subject, given.trials, options, 8.0)


def test_every_set_of_parameters_has_its_own_limit() -> None:
    """Four sets that are nearly one: the knee of the worst is on the limit, and the price is that of this set.

    The knee peaks at the second of three places. Its smooth peak, which is told too low here, limits nothing.

    A smooth worst of them would be up to 4^(1/24), 6 %, below it. The strap is least with no share, the knee asks for
    one: 100 (1 - share) + 0.1 k, and the strap rises by 50 N a share.
    """
    share = NAMES.index("share")

    class Line(Movement):
        def __init__(self, sizes: np.ndarray, slopes: np.ndarray, knee: np.ndarray, by: np.ndarray) -> None:
            of = Asked(sizes, slopes, sizes, knee, by, ORDER, PLACES)
            object.__setattr__(self, "asked", of)

    class Lines(Movements):
        def __init__(self) -> None: ...

        def refine(self, movements: object) -> bool:
            return False  # no motion is behind these lines, and no mesh

        def at(self, p: np.ndarray, *, slopes: bool = True) -> Movement:
            of = np.zeros((4, len(p)))
            of[STRAP, share], of[KNEE, share] = 50.0, -100.0
            knee, by = (100.0 * (1.0 - p[share]) + 0.1 * p[0]) * PARTS, np.zeros((3, len(p)))
            by[:, share] = -100.0 * PARTS
            return Line(np.array([10.0 + 50.0 * p[share], -0.9 * knee[1], 1.0, 1.0]), of, knee, by)

    sets = np.zeros((4, len(P)))
    sets[:, 0], sets[:, share] = np.arange(4.0), 0.5
    best = designed(Lines(), sets, HelpTask(("share",), "strap", 80.0))
    knees = [np.abs(each.asked.knee).max() for each in best.movements]
    assert best.met and max(knees) == pytest.approx(80.0, abs=0.02)
    np.testing.assert_allclose(best.p[:, share], 0.203, atol=2e-4)
    assert best.price == pytest.approx(0.5, rel=0.1)


def test_intervals_that_leave_too_much_are_halved_down_to_a_sixteenth(movements: Movements) -> None:
    """Three intervals a second of two points each: the balance by NumPy on even places says which; the others stay."""
    options = SolverOptions("radau", 2, 1, 1e-9)
    coarse = Movements(movements.model, movements.subject, movements.trials, options, 3.0)
    first, even = coarse.at(P, slopes=False), coarse.meshes[0]
    (motion,) = first.found.motions
    at = motion.sampled(51)
    e, n = movements.model.standing.equations, 9
    balance = Function("balance", [e.q, e.u, e.a, e.w, e.p], [e.balance])
    part = (at.time - at.time[0]) / np.ptp(at.time)
    given = np.column_stack([part, at.control[:, n:]])
    left = np.zeros((len(at.time), n))
    for a in (at.state[:, 2 * n :], at.rate[:, n : 2 * n]):
        of = [balance(x[:n], x[n : 2 * n], b, w, P).full().ravel() for x, b, w in zip(at.state, a, given, strict=True)]
        left = np.maximum(left, np.abs(of))
    over = (left > np.r_[5.0, 5.0, np.ones(7)]).any(axis=1).reshape(len(even) - 1, 51).any(axis=1)
    assert over.any()
    assert coarse.refine([first])
    middle = 0.5 * (even[:-1] + even[1:])
    np.testing.assert_allclose(coarse.meshes[0], np.sort(np.r_[even, middle[over]]), rtol=1e-14)
    found = coarse.finely_at(P)
    shortest = np.diff(coarse.meshes[0]).min() * (len(even) - 1)
    assert 1.0 / 16.0 - 1e-12 <= shortest < 0.3
    np.testing.assert_array_equal(found.found.meshes[0], coarse.meshes[0])
    coarse.shortest = (float(np.diff(coarse.meshes[0]).max()),)
    assert not coarse.refine([first])  # of its own, coarse mesh: all are as short as they may be


@pytest.mark.slow
def test_slopes_of_a_movement_are_those_of_movements_solved_again(movements: Movements) -> None:
    """Peaks, energy and shear by a length of the feet, a stiffness, and the help."""
    slopes = movements.at(P).asked.slopes
    for name, step in (("toe", 1e-4), ("strap turning", 1e-3), ("share", 1e-3)):
        k, sides = NAMES.index(name), []
        for sign in (1.0, -1.0):
            p = P.copy()
            p[k] += sign * step
            sides.append(movements.at(p, slopes=False).asked.sizes)
        np.testing.assert_allclose(slopes[:, k], (sides[0] - sides[1]) / (2.0 * step), rtol=WITHIN)


@pytest.mark.slow
@pytest.mark.parametrize("by_what", ["limit", pytest.param("number", marks=pytest.mark.long)])
def test_least_force_changes_as_the_optimality_system_says(movements: Movements, by_what: str) -> None:
    """By the limit of the knee, and by a number that is held, everything sought again."""
    without = P.copy()
    without[SHARE] = 0.0
    knee = 0.8 * float(movements.at(without).asked.largest[KNEE])
    best = designed(movements, P[None], HelpTask(("share", "timing"), "strap", knee))
    assert best.met and best.price > 0.0 and not best.on_end.any()
    assert best.movements[0].asked.sizes[STRAP] == pytest.approx(best.value)
    if by_what == "limit":
        limits = [designed(movements, best.p, HelpTask(("share", "timing"), "strap", knee + by)) for by in (0.2, -0.2)]
        assert (limits[1].value - limits[0].value) / 0.4 == pytest.approx(best.price, rel=WITHIN)
        return
    held = NAMES.index("toe")
    sides = []
    for by in (5e-4, -5e-4):
        p = best.p.copy()
        p[:, held] += by
        sides.append(designed(movements, p, best.task).value)
    assert (sides[0] - sides[1]) / 1e-3 == pytest.approx(best.slopes[held], rel=WITHIN)


@pytest.mark.slow
def test_true_peaks_are_those_of_the_motions_polynomials(movements: Movements) -> None:
    """Lagrange's polynomials by hand at 41 places an interval; slopes of the places by movements solved again."""
    seen = movements.at(P)
    (motion,), n = seen.found.motions, movements.model.standing.count
    points, peak = motion.scheme.points, 0.0
    for torque in motion.controls[:, :, n + 1]:
        for at in np.linspace(0.0, 1.0, 41):
            parts = [np.prod([(at - b) / (a - b) for b in points if b != a]) for a in points]
            peak = max(peak, abs(float(torque @ parts)))
    assert seen.asked.largest[KNEE] == pytest.approx(peak, rel=1e-3)
    # its places are among these 41, and polynomials here are added up in another order
    assert seen.asked.largest[KNEE] <= peak + 2.0 * np.spacing(peak)
    assert peak > 1.02 * seen.asked.sizes[KNEE]
    place = int(np.abs(seen.asked.knee).argmax())
    k, step, sides = NAMES.index("share"), 1e-3, []
    for sign in (1.0, -1.0):
        p = P.copy()
        p[k] += sign * step
        sides.append(movements.at(p, slopes=False).asked.knee[place])
    assert (sides[0] - sides[1]) / (2.0 * step) == pytest.approx(seen.asked.knee_slopes[place, k], rel=WITHIN)
