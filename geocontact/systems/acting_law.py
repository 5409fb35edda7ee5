"""A force law that a simulator calls: effects on the law act inside of a simulator that is not ours.

The simulator gets a law beside its inputs and numbers, and adds what it gives where it belongs in its own equations.
Without effects the law is the springs and dampers that the base names, or nothing at all; with them it has friction,
play, stops, further damping, stiffening and whatever else `chain.interface_law` knows.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.interface_law import MEMORY, interface_force
from geocontact.chain.links import Law, LawParameters, Loads, Source, Values
from geocontact.chain.single_deflection import along
from geocontact.chain.system import NotConverged
from geocontact.data.simulator import SimulatorError

Track = Float[np.ndarray, " t"]


@dataclass(frozen=True, eq=False)
class ActingLaw:
    """The law along one run.

    Parameters
    ----------
    time
        [s].
    rate, acceleration
        Of the input that it acts on, differentiated as the base models' are.
    numbers
        Of the law, as `chain.interface_law` reads them.
    """

    time: Track
    rate: Track
    acceleration: Track
    numbers: Float[np.ndarray, " numbers"]

    def __call__(self, deflection: Track, rate: Track | None = None) -> Track:
        """Force along a deflection and its rate, by central differences by default, in the law's units.

        It remembers along the run: friction, creep and slip know what was before.
        """
        u = np.array(deflection, dtype=float)
        if u.shape != self.time.shape:
            raise ValueError(f"a deflection {u.shape} where {self.time.shape} is expected: one for each time")
        v = np.gradient(u, self.time) if rate is None else np.array(rate, dtype=float)
        return np.asarray(along(self.time, u, v, self.numbers))

    def stepper(self) -> Callable[[float, float, float], float]:
        """For simulators that go from step to step: (deflection, rate, time since the last accepted step) → force.

        Each call is an accepted step; the first has 0 seconds before it.
        """
        memory = [np.zeros(MEMORY), np.zeros(MEMORY)]

        def force(deflection: float, rate: float, since: float) -> float:
            old, new = memory
            found = float(interface_force(float(deflection), float(rate), float(since), self.numbers, old, new))
            memory.reverse()
            return found

        return force


RunWithLaw = Callable[[Track, Float[np.ndarray, "i t"], dict[str, float], ActingLaw], object]
"""Time [s], inputs (a row each, SI), numbers by name, the law → outputs (t, c), or (t,) of a single one."""


@dataclass(frozen=True, eq=False)
class SimulatedWithLaw:
    """Geometry link that asks a simulator which calls the law by itself.

    Parameters
    ----------
    ask
        (time, inputs, numbers, law) → outputs; SimulatorError where there are none.
    yields
        The input that the law acts on: its range and rate are what effects of the law are bounded by.
    """

    ask: Callable[[Track, Float[np.ndarray, "i t"], Mapping[str, float], ActingLaw], Float[np.ndarray, "t c"]]
    yields: str
    slots: LawParameters

    def having(self, sources: Mapping[str, Source]) -> SimulatedWithLaw:
        """The same link with more of its numbers coming from somewhere: it has none, ValueError."""
        return SimulatedWithLaw(self.ask, self.yields, self.slots.having(sources))

    def deflection(
        self, movement: DifferentiatedInputs, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """The input that the law acts on, and its rate."""
        row = movement.row(self.yields)
        return movement.position[row][:, None], movement.rate[row][:, None]

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Outputs of the simulator; NotConverged where it failed."""
        row = movement.row(self.yields)
        acting = ActingLaw(movement.time, movement.rate[row], movement.acceleration[row], law.slots.numbers(values))
        try:
            outputs = self.ask(movement.time, movement.position, dict(values), acting)
        except SimulatorError as error:
            raise NotConverged(str(error)) from error
        nothing = np.zeros_like(outputs)
        return Loads(outputs, nothing, nothing)
