"""The strap, its place and the help that ask least of the strap while they take enough off the knee.

Sought are numbers d of the exoskeleton, each between what can be built; the person's movement follows them (`habit`),
so that the derivative of what is asked is that of the whole solution, by the optimality system of the movement. The
search is sequential quadratic programming (Kraft (1988), DFVLR-FB 88-28) on these exact slopes. The aim is a smooth
peak; the limit is one of the true peak: the knee's torque keeps to it at every place (`peaks.PLACES`) by itself.

At the best d the slope of the aim is held by that of the limit and by what can be built:
J_d + Σ λ_s c_s,d = 0 along every d that is on no bound, with a λ for each place and set of parameters s on the limit.
By the envelope theorem the least aim changes with any number y that is not sought as J_y + Σ λ_s c_s,y, and with the
limit as -Σ λ_s.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from geocontact.standing_up.assistance_room import ROOM
from geocontact.standing_up.assisted_model import EVERY_ASSISTED
from geocontact.standing_up.assisted_movement import MEASURES, ORDER, Movement, Movements, StoppedByHandError

Vector = Float[np.ndarray, " _"]
NAMES = tuple(each.name for each in EVERY_ASSISTED)
STRAP, KNEE = MEASURES.index("strap"), MEASURES.index("knee")
TOLERANCE = 1e-7
FIRST = 0.15
"""Share of the room: the longest first step."""
NEAR = 1e-3
"""Share of the room: a number that near to an end of it is on that end."""
STOPPED = "interrupted; the last iterate is saved"
MET = 1e-4
"""Share of the limit: so much more is let pass."""
AT_PEAK = 1e-6
"""Share of a set's true peak: places that near to it are at it."""


@dataclass(frozen=True)
class HelpTask:
    """What is sought, and under which limit.

    Parameters
    ----------
    vary
        Names of `ROOM`.
    aim
        One of the measures: energy, or the strap at the thigh (strap), shank or pelvis.
    knee
        True peak of the person's knee torque, both legs, at most [N m].
    """

    vary: tuple[str, ...]
    aim: str
    knee: float

    @property
    def index(self) -> list[int]:
        """Index of the parameters."""
        return [NAMES.index(ROOM[name][0]) for name in self.vary]

    @property
    def ends(self) -> tuple[Vector, Vector]:
        """What is searched at both ends of the room."""
        chosen = [(EVERY_ASSISTED[k], *ROOM[name][1:]) for k, name in zip(self.index, self.vary, strict=True)]
        low = np.array([each.searched(least) for each, least, _ in chosen])
        return low, np.array([each.searched(most) for each, _, most in chosen])


@dataclass(frozen=True, eq=False)
class HelpDesign:
    """The best that was found.

    Parameters
    ----------
    p
        What is searched of all parameters, one row for each set that was to be met.
    movements
        One for each of them.
    met
        Whether the search ended by itself, within the limit.
    stopped
        Whether Ctrl-C ended it, so that it is its last iterate.
    ending
        In words.
    price
        λ, the sum over places and sets: how much less the aim would be for 1 N m more at the knee.
    on_end
        Of what is sought: whether it is on an end of its room.
    slopes
        Of the least aim by what is searched of every parameter that is held [aim's unit].
    """

    task: HelpTask
    p: Float[np.ndarray, "s p"]
    movements: tuple[Movement, ...]
    met: bool
    ending: str
    price: float
    on_end: Bool[np.ndarray, " d"]
    slopes: Vector
    stopped: bool = False

    @property
    def value(self) -> float:
        """Value of the aim, the worst of the sets."""
        return max(each.asked.at(self.task.aim) for each in self.movements)


def designed(movements: Movements, sets: Float[np.ndarray, "s p"], task: HelpTask, iterations: int = 60) -> HelpDesign:
    """For all sets of parameters at once: the aim is the smooth worst of them, the limit holds for each.

    Where a movement of the best leaves too much of the balance its intervals are halved, and the search goes on from
    there. Ctrl-C keeps the last iterate.

    Parameters
    ----------
    sets
        What is searched of all parameters; the search starts at the first one's.

    ArithmeticError where no movement is found, StoppedByHandError where Ctrl-C came before the first one.
    """
    best = _on_one_mesh(movements, sets, task, iterations)
    while not best.stopped and movements.refine(best.movements):
        try:
            best = _on_one_mesh(movements, best.p, task, iterations)
        except StoppedByHandError:
            best = replace(best, met=False, stopped=True, ending=STOPPED)
    return best


def _on_one_mesh(movements: Movements, sets: Float[np.ndarray, "s p"], task: HelpTask, iterations: int) -> HelpDesign:
    """The best on the meshes that the movements have."""
    from scipy.optimize import minimize

    low, high = task.ends
    room, aim = high - low, task.aim
    known: dict[bytes, tuple[Movement, ...]] = {}

    def at(part: Vector) -> tuple[Movement, ...]:
        key = part.tobytes()
        if key not in known:
            rows = with_design(sets, task, low + room * part)
            known[key] = tuple(movements.at(row) for row in rows)
        return known[key]

    def worst(part: Vector, measure: str) -> tuple[float, Vector]:
        return _worst(at(part), measure)

    start = np.clip((sets[0, task.index] - low) / room, 0.0, 1.0)
    # the first step goes down the slope: not further than FIRST
    unit = max(float(np.abs(worst(start, aim)[1][task.index] * room).max()), 1e-9) / FIRST
    limit: Any = {
        "type": "ineq",
        "fun": lambda d: 1.0 - _knees(at(d))[0] / task.knee,
        "jac": lambda d: -_knees(at(d))[1][:, task.index] * room / task.knee,
    }
    done, message, best = False, STOPPED, start
    try:
        answer: Any = minimize(  # type: ignore[call-overload]
            lambda d: worst(d, aim)[0] / unit,
            start,
            jac=lambda d: worst(d, aim)[1][task.index] * room / unit,
            bounds=[(0.0, 1.0)] * len(room),
            constraints=limit,
            method="SLSQP",
            options={"maxiter": iterations, "ftol": TOLERANCE},
        )
        done, message, best = bool(answer.success), str(answer.message).lower(), np.asarray(answer.x)
    except StoppedByHandError:
        best = np.frombuffer(list(known)[-1])
    best = np.clip(best, 0.0, 1.0)
    at_end = (best <= NEAR) | (best >= 1.0 - NEAR)
    (_, of_aim), (knees, of_knees) = worst(best, aim), _knees(at(best))
    inside = np.array(task.index)[~at_end]
    prices = _prices(of_aim[inside], of_knees[:, inside], _on_limit(at(best), task.knee))
    met = bool(knees.max() <= task.knee * (1.0 + MET))
    stopped = message == STOPPED
    ending = "found" if done and met else message if stopped else f"not found: {message}"
    rows = with_design(sets, task, low + room * best)
    slopes, price = of_aim + prices @ of_knees, float(prices.sum())
    return HelpDesign(task, rows, at(best), met and done, ending, price, at_end, slopes, stopped)


def with_design(sets: Float[np.ndarray, "s p"], task: HelpTask, searched: Vector) -> Float[np.ndarray, "s p"]:
    """The sets with what is sought in place of their own."""
    rows = sets.copy()
    rows[:, task.index] = searched
    return rows


def _prices(of_aim: Vector, of_knees: Float[np.ndarray, "k d"], on_limit: Bool[np.ndarray, " k"]) -> Vector:
    """λ of J_d + Σ λ_s c_s,d = 0 by least squares, none negative; 0 off the limit or where nothing is free to move."""
    from scipy.optimize import nnls

    prices = np.zeros(len(of_knees))
    if on_limit.any() and len(of_aim):
        prices[on_limit] = nnls(of_knees[on_limit].T, -of_aim)[0]
    return prices


def _on_limit(movements: Sequence[Movement], limit: float) -> Bool[np.ndarray, " k"]:
    """A flag for every place of every set: whether the set's peak is there and on the limit."""
    sizes = [np.abs(one.asked.knee) for one in movements]
    return np.concatenate(
        [(each >= each.max() * (1.0 - AT_PEAK)) & (each.max() >= limit * (1.0 - MET)) for each in sizes]
    )


def _knees(movements: Sequence[Movement]) -> tuple[Vector, Float[np.ndarray, "k p"]]:
    """Size of the knee's torque at every place of every set, and its slopes."""
    torque = np.concatenate([one.asked.knee for one in movements])
    slopes = np.concatenate([one.asked.knee_slopes for one in movements])
    return np.abs(torque), np.sign(torque)[:, None] * slopes


def _each(movements: Sequence[Movement], measure: str) -> tuple[Vector, Float[np.ndarray, "s p"]]:
    """One measure of every set, and its slopes."""
    sizes = np.array([one.asked.at(measure) for one in movements])
    return sizes, np.stack([one.asked.slopes[one.asked.measures.index(measure)] for one in movements])


def _worst(each: Sequence[Movement], measure: str) -> tuple[float, Vector]:
    """Smooth maximum over the sets, and its slope."""
    values, slopes = _each(each, measure)
    most = float(values.max())
    norm = most * float(np.sum((values / most) ** ORDER)) ** (1.0 / ORDER)
    pull = (values / norm) ** (ORDER - 1)
    slope: Vector = pull @ slopes
    return norm, slope
