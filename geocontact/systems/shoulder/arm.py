"""Geometry link of a shoulder exoskeleton: the recorded arm drives the exoskeleton's through the interface."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.implicit import require_convergence
from geocontact.chain.law_parameters import LawParameters, Source
from geocontact.chain.links import Law, Loads, Values
from geocontact.systems.shoulder.equation_of_motion import HINGED_ARM, LONGEST, swing

REMEMBERED = 256
"""Motions of a trial, 25 kB each."""
_SEEN: OrderedDict[tuple[float | bytes, ...], tuple[np.ndarray, int]] = OrderedDict()


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
        found, _ = self._swung(movement, self.base, values)
        return found[2][:, None].copy(), found[3][:, None].copy()

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Force along a movement, and the angle that the exoskeleton's arm takes."""
        found, unsolved = self._swung(movement, law, values)
        require_convergence(unsolved, len(movement.time), self.slots.numbers(values)[11])
        force = found[1][:, None]
        nothing = np.zeros_like(force)
        return Loads(force, nothing, nothing, found[0][:, None])

    def _swung(
        self, movement: DifferentiatedInputs, law: Law, values: Values
    ) -> tuple[Float[np.ndarray, "four t"], int]:
        """Motion of the exoskeleton's arm; what a sensor adds does not change it, so the last ones are remembered."""
        row = movement.row("arm")
        arrays = (movement.time, movement.position[row], movement.rate[row])
        numbers = (self.slots.numbers(values), self.table, law.slots.numbers(values))
        key = (self.longest, *(each.tobytes() for each in (*arrays, *numbers)))
        found = _SEEN.get(key)
        if found is None:
            found = _SEEN[key] = swing(*arrays, self.longest, *numbers)
            while len(_SEEN) > REMEMBERED:
                _SEEN.popitem(last=False)
        return found
