"""Shoulder exoskeleton driven by recorded human motion, in the plane of elevation.

Inputs `arm [rad]` (human upper arm) and `event [-]` (1 while the tool runs; the base does not use it), outputs
`exo [rad]` (exoskeleton's arm) and `force [N]` (on the human arm, positive where it supports). Angles are counted from
hanging down, upward. Parameters k_t, b_t, m; constants L_h, o_x, o_y, I, c, l_c; covariate `level` (0 … 1) of a trial;
table `support` (`angle [rad]`, `torque [N m]`), linear between its rows and constant beyond them.

Human shoulder at the origin, hinge at (o_x, o_y), interface sphere at p = L_h (sin a, -cos a), w = p - hinge:
s = w·(sin e, -cos e) along the tube, r = w·(cos e, sin e) off its axis, N = k_t r + b_t r', force = -N,
I e'' + c e' = level τ(e) - m g l_c sin e + N s. A trial starts at rest in equilibrium.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.interface_slopes import UNKNOWN
from geocontact.chain.links import Balance, Law, LawParameters, Loads, Motion, Sensor, Source, Values
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.system import System, require_convergence
from geocontact.chain.traits import Mass, Migration, Traits, Way
from geocontact.data.parameter import Parameter
from geocontact.systems.base import Base, CaseNeeds, require_numbers
from geocontact.systems.shoulder_motion import HINGED_ARM, LONGEST, swing
from geocontact.systems.shoulder_slopes import swing_slopes

COMPLIANCE = 11
"""Place among the arm's numbers of a spring in series, behind which derivatives are not known."""
REMEMBERED, RECENT = 256, 32
"""Motions of a trial, 25 kB each, and their steps, some 300 kB each."""
_SEEN: OrderedDict[tuple[float | bytes, ...], tuple[np.ndarray, int]] = OrderedDict()
_STEPS: OrderedDict[tuple[float | bytes, ...], np.ndarray] = OrderedDict()


@dataclass(frozen=True)
class ShoulderArm:
    """One deflection u = -r [m], which the motion of the exoskeleton's arm makes as well as that of the human one.

    Parameters
    ----------
    table
        Angles [rad], increasing, and torques of full support [N m].
    base
        The law without effects, for scales.
    longest
        Step of the integration [s].
    """

    table: Float[np.ndarray, "two k"]
    base: Law
    longest: float = LONGEST
    slots: LawParameters = HINGED_ARM

    @property
    def yields(self) -> str:
        """Angle that the geometry may depend on; what gives way to a spring in series is the deflection."""
        return "arm"

    def having(self, sources: Mapping[str, Source]) -> ShoulderArm:
        """The same link with more of its numbers coming from somewhere."""
        return replace(self, slots=self.slots.having(sources))

    def deflection(
        self, movement: DifferentiatedInputs, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """Deflection [m] and rate [m/s] under the law without effects."""
        found, _, _ = self._swung(movement, self.base, values)
        return found[2][:, None].copy(), found[3][:, None].copy()

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Force along a movement, and the angle that the exoskeleton's arm takes."""
        found, unsolved, _ = self._swung(movement, law, values)
        require_convergence(unsolved, len(movement.time), self.slots.numbers(values)[COMPLIANCE])
        force = found[1][:, None]
        nothing = np.zeros_like(force)
        return Loads(force, nothing, nothing, found[0][:, None])

    def changes(
        self, movement: DifferentiatedInputs, law: Law, values: Values, others: Sequence[Values]
    ) -> tuple[Loads, list[Loads | None]] | None:
        """Force and angle along a movement, and how they change towards other values (`chain.system`)."""
        own, numbers = self.slots.numbers(values), law.slots.numbers(values)
        if own[COMPLIANCE] != 0.0 or numbers[UNKNOWN[0]] != 0.0:
            return None
        motion, unsolved, path = self._swung(movement, law, values, along=True)
        if unsolved or path is None:
            return None
        dn, dlaw = self.slots.towards(values, others), law.slots.towards(values, others)
        known = ~((dn[:, COMPLIANCE] != 0.0) | dlaw[:, UNKNOWN].any(axis=1))
        moving = known & (dn.any(axis=1) | dlaw.any(axis=1))
        nothing = np.zeros((len(movement.time), 1))
        found = np.zeros((len(others), 2, len(movement.time), 1))
        if moving.any():
            ways = [np.concatenate([d[moving], np.zeros((1, d.shape[1]))]) for d in (dn, dlaw)]
            found[moving, ..., 0] = swing_slopes(path, len(movement.time), own, self.table, numbers, *ways).transpose(
                2, 0, 1
            )
        more = [
            Loads(force, nothing, nothing, angle) if there else None
            for (angle, force), there in zip(found, known, strict=True)
        ]
        return Loads(motion[1][:, None], nothing, nothing, motion[0][:, None]), more

    def _swung(
        self, movement: DifferentiatedInputs, law: Law, values: Values, *, along: bool = False
    ) -> tuple[Float[np.ndarray, "four t"], int, Float[np.ndarray, "rows nineteen"] | None]:
        """Motion of the exoskeleton's arm; its steps, if anything goes `along` with them or they are still there.

        What a sensor adds does not change it, so the last ones are remembered.
        """
        row = movement.row("arm")
        arrays = (movement.time, movement.position[row], movement.rate[row])
        numbers = (self.slots.numbers(values), self.table, law.slots.numbers(values))
        key = (self.longest, *(each.tobytes() for each in (*arrays, *numbers)))
        found, path = _SEEN.get(key), _STEPS.get(key)
        if found is None or (along and path is None):
            motion, unsolved, path = swing(*arrays, self.longest, *numbers)
            found, _STEPS[key] = (motion, unsolved), path
            _SEEN[key] = found
            for kept, most in ((_SEEN, REMEMBERED), (_STEPS, RECENT)):
                while len(kept) > most:
                    kept.popitem(last=False)
        return *found, path


INPUTS, OUTPUTS = ("arm", "event"), ("exo", "force")
UNITS = {"arm": "rad", "event": "-", "exo": "rad", "force": "N"}
LENGTHS = ("L_h", "o_x", "o_y", "l_c")
NUMBERS = {"L_h": "m", "o_x": "m", "o_y": "m", "I": "kg m^2", "c": "N m s/rad", "l_c": "m", "m": "kg"}
LAW = {"k_t": "N/m", "b_t": "N s/m"}
POSITIVE, NOT_NEGATIVE = ("L_h", "k_t"), ("c", "m", "b_t")
"""Beside I, whose bounds are to be positive as well: the arm is integrated with it."""
COLUMNS = ("angle [rad]", "torque [N m]")
TRAITS = Traits(
    way=Way(3.0, "deflection"),
    migration=Migration(0.2, centre=0.0),
    masses=(Mass("cuff", ("arm",), "L_h"),),
)
"""o_x is known from the arm that hangs down, so that its migration is counted from there."""


def angle_and_force(loads: Loads) -> Float[np.ndarray, "t c"]:
    """Angle of the exoskeleton's arm and force on the human one."""
    return np.column_stack((loads.moved, loads.normal))


def support_table(tables: Mapping[str, pd.DataFrame]) -> Float[np.ndarray, "two k"]:
    """Angles [rad] and torques [N m]; ValueError when there is no such table, or when it is none."""
    if "support" not in tables:
        raise ValueError(
            'shoulder: the table of support torques is missing; name it in case.toml, support = "support.csv"'
        )
    table = tables["support"]
    for column in COLUMNS:
        if column not in table.columns:
            has = ", ".join(map(str, table))
            raise ValueError(f"shoulder: the support torques have no column {column!r}; they have {has}")
    angle, torque = (np.ascontiguousarray(table[column], float) for column in COLUMNS)
    if not len(angle) or any(b <= a for a, b in pairwise(angle)):
        raise ValueError("shoulder: the angles of the support torques do not increase; sort the rows, each angle once")
    return np.array([angle, torque])


def build(
    parameters: tuple[Parameter, ...], constants: Mapping[str, float], tables: Mapping[str, pd.DataFrame]
) -> System:
    """The base model; ValueError when a table, column or number that it needs is missing."""
    table = support_table(tables)
    needed = (*NUMBERS, *LAW)
    require_numbers("shoulder", needed, parameters, constants, positive=POSITIVE, not_negative=NOT_NEGATIVE)
    inertia = {**constants, **{p.name: p.start if p.fixed else p.lower for p in parameters}}["I"]
    if not inertia > 0.0:
        raise ValueError(f"shoulder: the moment of inertia I = {inertia:g} kg m^2 is not positive")
    law = Law(INTERFACE_LAW).having({"k": "k_t", "b": "b_t"}).lacking("asymmetry.excess")
    return System(
        name="shoulder",
        motion=Motion(INPUTS),
        geometry=ShoulderArm(table, law).having({name: name for name in (*NUMBERS, "level")}),
        law=law,
        balance=Balance(OUTPUTS, angle_and_force),
        sensor=Sensor(OUTPUTS),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units=UNITS,
        spare=("event",),
        lengths=tuple(name for name in LENGTHS if name in constants),
        dynamic=True,
        traits=TRAITS,
    )


def numbers_of(_channels: Collection[str], tables: Mapping[str, pd.DataFrame]) -> dict[str, str]:
    """All numbers with SI units; ValueError for a wrong table."""
    support_table(tables)
    return NUMBERS | LAW


NEEDS = CaseNeeds("exoskeleton that supports a raised arm", UNITS, numbers_of, {"support": COLUMNS}, ("level",))
SHOULDER = Base("shoulder", INPUTS, OUTPUTS, build, needs=NEEDS)
