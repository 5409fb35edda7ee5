"""What a support profile must keep, as rows of A x <= b: in the cases as the model has them, and in most draws of it.

At every moment the torque on the arm stays below what the shoulder needs, less a reserve. What the model does not know
of a person enters by draws of it: a share of them must keep the arm from being pushed up, and the draws in which a
profile does worst are set aside (sampling and discarding; Campi & Garatti 2011, A sampling-and-discarding approach to
chance-constrained optimization, J Optim Theory Appl 148:257-280). A draw is one of a person: it is kept in all of that
person's cases or in none.

Support is linear in its factors: the cylinder's force is proportional to its pressure, and the pressure follows the
factor of the phase with a lag of first order, p' = (factor - p) / lag. So the torque is A x, x the factors and column k
of A the full torque times what the lag makes of "phase k". What reaches the arm has another part that no factor
changes, the device's own weight above all: the torque on the arm is own + A x.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import ceil, exp
from typing import Literal

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.kernels.compile import kernel
from geocontact.shoulder_exoskeleton.support.phase_machine import SUPPORTED
from geocontact.shoulder_exoskeleton.work_phases import PHASES

Hand = Literal["dominant", "other"]


@dataclass(frozen=True)
class FactorKey:
    """Which factor of a support profile: the structure of the paper's table 3."""

    task: str
    hand: Hand
    phase: str


@dataclass(frozen=True, eq=False)
class SupportCase:
    """One arm in one trial.

    Parameters
    ----------
    time
        [s], increasing.
    phase
        As the controller detects it.
    needed
        Torque of the shoulder without support [N m].
    full
        Torque of the device on the arm at factor 1 and the elevation of each moment [N m].
    lag
        Time constant of the pressure [s].
    lever
        Middle of the cuff from the axis of elevation [m]: the interface carries the support torque over it.
    own
        Torque on the arm that no factor changes [N m]; 0 where the cylinder's torque counts alone.
    own_force
        The same of the force at the interface [N].
    """

    name: str
    person: str
    task: str
    hand: Hand
    time: Float[np.ndarray, " t"]
    phase: Int[np.ndarray, " t"]
    needed: Float[np.ndarray, " t"]
    full: Float[np.ndarray, " t"]
    lag: float
    lever: float
    own: Float[np.ndarray, " t"] | float = 0.0
    own_force: Float[np.ndarray, " t"] | float = 0.0

    @property
    def keys(self) -> tuple[FactorKey, ...]:
        """Keys of the factors that act in this case, one for each supported phase."""
        return tuple(FactorKey(self.task, self.hand, PHASES[k]) for k in SUPPORTED)

    @cached_property
    def per_factor(self) -> Float[np.ndarray, "t k"]:
        """A: support torque for each factor being 1 while its phase lasts [N m]."""
        pressures = np.column_stack([lagged(self.time, 1.0 * (self.phase == k), self.lag) for k in SUPPORTED])
        return np.asarray(pressures * self.full[:, None])

    def given(self, factors: Mapping[FactorKey, float]) -> Float[np.ndarray, " t"]:
        """The part of the torque on the arm that a profile gives, A x [N m]."""
        return np.asarray(self.per_factor @ [factors[key] for key in self.keys])

    def support(self, factors: Mapping[FactorKey, float]) -> Float[np.ndarray, " t"]:
        """Torque on the arm under a profile [N m]."""
        return np.asarray(self.own + self.given(factors))

    def force(self, factors: Mapping[FactorKey, float]) -> Float[np.ndarray, " t"]:
        """Force at the interface under a profile [N]."""
        return np.asarray(np.abs(self.own_force + self.given(factors) / self.lever))


@kernel
def lagged(time: Float[np.ndarray, " t"], wanted: Float[np.ndarray, " t"], lag: float) -> Float[np.ndarray, " t"]:
    """p of p' = (wanted - p) / lag from 0, exact for values that are constant between samples."""
    found = np.zeros(time.size)
    for k in range(1, time.size):
        decay = exp(-(time[k] - time[k - 1]) / lag)
        found[k] = wanted[k - 1] + (found[k - 1] - wanted[k - 1]) * decay
    return found


ACTS = 0.02
"""N m at factor 1 below which support does not count: what the lag leaves long after a phase."""
Keys = tuple[FactorKey, ...]
Rows = tuple[Float[np.ndarray, "_ _"], Float[np.ndarray, " _"]]
"""A and b of A x <= b, a row for each bound; x are the factors by their keys."""


@dataclass(frozen=True)
class Limits:
    """What a profile must keep.

    Parameters
    ----------
    force
        Largest force at the interface [N]; infinite for none.
    rate
        Largest rate of the support torque, up or down, of the part that follows the factors [N m/s]; infinite for none.
    reserve
        Share of the needed torque that is left to the shoulder at every moment.
    certainty
        Share of the draws of the model's errors in which no arm is pushed up; 0 leaves them out.
    margin
        By how much the torque stays below its bounds besides [N m].
    caps
        Largest values of some of the profile's factors.
    """

    force: float = np.inf
    rate: float = np.inf
    reserve: float = 0.0
    certainty: float = 0.0
    margin: float = 0.0
    caps: Mapping[FactorKey, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not (self.force > 0.0 and self.rate > 0.0 and 0.0 <= self.reserve < 1.0):
            raise ValueError("limits of force and rate must be positive, the reserve from 0 to below 1")
        if not 0.0 <= self.certainty <= 1.0:
            raise ValueError(f"a certainty of {self.certainty:g} is not between 0 and 1")


Drawn = Mapping[str, Sequence[Sequence[SupportCase]]]
"""By person the draws of the model's errors, each with all of the person's cases."""


@dataclass(frozen=True, eq=False)
class Among:
    """For whom a profile is made.

    Parameters
    ----------
    cases
        As the model has them.
    drawn
        The same with its errors.
    scales
        By person what the profile's factors are multiplied by; 1 where a person is not named.
    """

    cases: Sequence[SupportCase]
    drawn: Drawn = field(default_factory=dict)
    scales: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def keys(self) -> Keys:
        """Keys of all factors that act in a case."""
        return tuple(dict.fromkeys(key for case in self.cases for key in case.keys))

    def columns(self, case: SupportCase, values: Float[np.ndarray, "m three"]) -> Float[np.ndarray, "m k"]:
        """What holds for the case's own factors as columns of all factors of the profile, which is scaled."""
        found = np.zeros((len(values), len(self.keys)))
        found[:, [self.keys.index(key) for key in case.keys]] = self.scales.get(case.person, 1.0) * values
        return found

    def highest(self, caps: Mapping[FactorKey, float]) -> Float[np.ndarray, " k"]:
        """Values that the factors may have below these caps: nobody's own one is above 1."""
        largest = max(self.scales.get(case.person, 1.0) for case in self.cases)
        return np.array([min(1.0 / largest, caps.get(key, 1.0)) for key in self.keys])

    @cached_property
    def never_pushed_up(self) -> dict[str, list[Rows]]:
        """By person and draw."""
        found: dict[str, list[Rows]] = {}
        for person, draws in self.drawn.items():
            for draw in draws:
                parts = [(case, *_below_need(case, reserve=0.0)) for case in draw]
                rows = np.concatenate([self.columns(case, own) for case, own, _ in parts])
                found.setdefault(person, []).append((rows, np.concatenate([most for _, _, most in parts])))
        return found


def nominal_rows(among: Among, limits: Limits) -> Rows:
    """Needed torque less the reserve, force and rate in the cases as the model has them."""
    rows, bounds = [], []
    for case in among.cases:
        own, most = _below_need(case, limits.reserve, limits.margin)
        if np.isfinite(limits.force):
            acts = _acts(case)
            room = limits.force * case.lever - np.broadcast_to(case.own_force * case.lever, case.time.shape)
            own, most = _reached(
                np.concatenate((own, case.per_factor[acts])), np.concatenate((most, np.maximum(room[acts], 0.0)))
            )
        rows.append(among.columns(case, own))
        bounds.append(most)
        if np.isfinite(limits.rate):
            change = among.columns(case, np.diff(case.per_factor, axis=0))
            rows += [change, -change]
            bounds.append(limits.rate * np.tile(np.diff(case.time), 2))
    return np.concatenate(rows), np.concatenate(bounds)


def excess(rows: Rows, factors: Float[np.ndarray, " k"]) -> float:
    """By how much the worst bound is passed; negative where all are kept [N m]."""
    return float(np.max(rows[0] @ factors - rows[1], initial=-np.inf))


def count_of(draws: Sequence[Rows], certainty: float) -> int:
    """Number of the draws that the certainty asks for."""
    return ceil(certainty * len(draws) - 1e-9)


def mildest(draws: Sequence[Rows], factors: Float[np.ndarray, " k"], certainty: float) -> list[int]:
    """The draws in which these factors do least harm."""
    worst = np.array([excess(rows, factors) for rows in draws])
    return sorted(np.argsort(worst, kind="stable")[: count_of(draws, certainty)].tolist())


def joined(parts: Sequence[Rows]) -> Rows:
    """All of them, without those that no factors reach before another one."""
    return _reached(np.concatenate([rows for rows, _ in parts]), np.concatenate([bounds for _, bounds in parts]))


def _acts(case: SupportCase) -> Int[np.ndarray, " a"]:
    return np.flatnonzero(np.abs(case.per_factor).max(axis=1) > ACTS)


def _below_need(case: SupportCase, reserve: float, margin: float = 0.0) -> Rows:
    """Rows of the case's own factors; where the arm is pushed up without them they must be 0."""
    acts = _acts(case)
    most = (1.0 - reserve) * np.maximum(case.needed, 0.0) - case.own - margin
    return _reached(case.per_factor[acts], np.maximum(most[acts], 0.0))


def _reached(rows: Float[np.ndarray, "m k"], most: Float[np.ndarray, " m"]) -> Rows:
    """Those whose bound can be reached: of a x <= b with a >= 0, none has larger a / b along every factor.

    Rows without a positive entry are never reached. Where a is negative beside a positive one, every row counts.
    """
    rising = np.any(rows > 0.0, axis=1) | (most < 0.0)
    rows, most = rows[rising], most[rising]
    if np.any(rows < 0.0):
        return rows, most
    with np.errstate(divide="ignore", invalid="ignore"):
        steep = np.nan_to_num(rows / most[:, None], nan=0.0, posinf=np.inf)
    place = _steepest(steep, np.argsort(-steep.sum(axis=1), kind="stable"))
    return rows[place], most[place]


@kernel
def _steepest(steep: Float[np.ndarray, "m k"], order: Int[np.ndarray, " m"]) -> Int[np.ndarray, " b"]:
    """Rows beside which no other is at least as large in every column; of equal ones the first."""
    kept = np.empty(len(order), np.int64)
    count, last = 0, 0  # what the row before was beside is asked first
    for row in order:
        new = count == 0 or not _beside(steep, kept[last], row)
        if new:
            for place in range(count):
                if _beside(steep, kept[place], row):
                    new, last = False, place
                    break
        if new:
            kept[count] = row
            count += 1
    return kept[:count]


@kernel
def _beside(steep: Float[np.ndarray, "m k"], one: int, other: int) -> bool:
    """Whether a row is at least as large as another in every column."""
    for column in range(steep.shape[1]):  # noqa: SIM110 - compiled code has no `all` of a generator
        if steep[other, column] > steep[one, column]:
            return False
    return True
