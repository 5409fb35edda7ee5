"""A simulator that is not ours as a base model: `system = "command"`.

The chain is motion → simulator → sensor: effects on inputs, outputs, timing and data apply, and loads beside it.
Nothing inside the simulator can be replaced, so that effects of a law or a geometry are not offered.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.implicit import NotConverged
from geocontact.chain.links import Balance, Law, Loads, Motion, Sensor, Values
from geocontact.chain.movement import Movement
from geocontact.chain.scale import Scale
from geocontact.chain.slots import Slots, Source
from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.simulator import Simulator, SimulatorError
from geocontact.systems.tried import refusal

NOTHING = Slots({})


@dataclass(frozen=True, eq=False)
class Simulated:
    """Geometry link that asks a simulator for all outputs at once.

    Parameters
    ----------
    names
        Of the numbers that it is told.
    """

    simulator: Simulator
    names: tuple[str, ...]
    slots: Slots = NOTHING
    yields: str = ""

    def having(self, sources: Mapping[str, Source]) -> Simulated:
        """The same link with more of its numbers coming from somewhere: it has none, ValueError."""
        return replace(self, slots=self.slots.having(sources))

    def deflection(
        self, movement: Movement, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """None that we know of."""
        nothing = np.zeros((len(movement.time), 1))
        return nothing, nothing

    def loads(self, movement: Movement, law: Law, values: Values) -> Loads:
        """Outputs of the simulator; NotConverged where it failed."""
        numbers = {name: values[name] for name in self.names if name in values}
        try:
            outputs = self.simulator.run(movement.time, movement.position, numbers)
        except SimulatorError as error:
            raise NotConverged(str(error)) from error
        nothing = np.zeros_like(outputs)
        return Loads(outputs, nothing, nothing)


def all_outputs(loads: Loads) -> Float[np.ndarray, "t c"]:
    """Each load is an output."""
    return loads.normal.copy()


def command_system(case: GapCase) -> System:
    """The base model; InputError when the case brings no simulator."""
    own = case.simulator
    if own is None:
        raise refusal(case, "has no simulator", 'give simulate = "prog {params} {trial} {out}"')
    trials = (*case.calibration, *case.evaluation)
    covariates = dict.fromkeys(name for trial in trials for name in trial.covariates)
    names = (*(p.name for p in case.parameters), *case.constants, *covariates)
    return System(
        name="command",
        motion=Motion(own.inputs),
        geometry=Simulated(own, tuple(dict.fromkeys(names))),
        law=Law(NOTHING),
        balance=Balance(own.outputs, all_outputs),
        sensor=Sensor(own.outputs),
        parameters=case.parameters,
        constants=dict(case.constants),
        scale=Scale(),
        units=dict(own.units),
    )
