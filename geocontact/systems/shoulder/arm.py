"""Geometry link of a shoulder exoskeleton: the recorded arm drives the exoskeleton's through the interface."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.implicit import require_convergence
from geocontact.chain.interface_slopes import UNKNOWN
from geocontact.chain.law_parameters import LawParameters, Source
from geocontact.chain.links import Law, Loads, Values
from geocontact.chain.tangents import towards
from geocontact.systems.shoulder.equation_of_motion import HINGED_ARM, LONGEST, swing
from geocontact.systems.shoulder.swing_slopes import swing_slopes

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
        """Force and angle along a movement, and how they change towards other values (`chain.tangents`)."""
        own, numbers = self.slots.numbers(values), law.slots.numbers(values)
        if own[COMPLIANCE] != 0.0 or numbers[UNKNOWN[0]] != 0.0:
            return None
        motion, unsolved, path = self._swung(movement, law, values, along=True)
        if unsolved or path is None:
            return None
        dn, dlaw = towards(self.slots, values, others), towards(law.slots, values, others)
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
