"""A simulator as a base model: asked for all outputs at once.

The chain is motion → simulator → sensor: effects on inputs, outputs, timing and data apply, and loads beside it.
Nothing inside of it can be replaced, unless it takes a force law as an argument (`acting_law`): then effects of the law
are offered too. Effects of a geometry are not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Balance, Law, LawParameters, Loads, Motion, Sensor, Source, Values
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.system import NotConverged, System
from geocontact.data.gap_case import GapCase
from geocontact.data.parameter import Parameter
from geocontact.data.simulator import Simulator, SimulatorError
from geocontact.systems.acting_law import ActingLaw, RunWithLaw, SimulatedWithLaw
from geocontact.systems.base import Base
from geocontact.systems.validate import refusal


def program_system(case: GapCase) -> System:
    """The base model; InputError when the case brings no simulator."""
    own = case.simulator
    if own is None:
        raise refusal(case, "has no simulator", 'give simulate = "prog {params} {trial} {out}"')
    trials = (*case.calibration, *case.evaluation)
    covariates = dict.fromkeys(name for trial in trials for name in trial.covariates)
    names = (*(p.name for p in case.parameters), *case.constants, *covariates)
    return simulated_system("command", own, tuple(dict.fromkeys(names)), case.parameters, case.constants)


Run = Callable[[Float[np.ndarray, " t"], Float[np.ndarray, "i t"], dict[str, float]], object]
"""Time [s], inputs (a row each, SI), numbers by name → outputs (t, c), or (t,) of a single one."""

NOTHING = LawParameters({})


@dataclass(frozen=True, eq=False)
class Simulated:
    """Geometry link that asks a simulator for all outputs at once.

    Parameters
    ----------
    names
        Names of the numbers that it is given; all there are where None.
    """

    simulator: Simulator
    names: tuple[str, ...] | None
    slots: LawParameters = NOTHING
    yields: str = ""

    def having(self, sources: Mapping[str, Source]) -> Simulated:
        """The same link with more of its numbers coming from somewhere: it has none, ValueError."""
        return replace(self, slots=self.slots.having(sources))

    def deflection(
        self, movement: DifferentiatedInputs, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """None that we know of."""
        nothing = np.zeros((len(movement.time), 1))
        return nothing, nothing

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Outputs of the simulator; NotConverged where it failed."""
        told = values if self.names is None else self.names
        numbers = {name: values[name] for name in told if name in values}
        try:
            outputs = self.simulator.run(movement.time, movement.position, numbers)
        except SimulatorError as error:
            raise NotConverged(str(error)) from error
        nothing = np.zeros_like(outputs)
        return Loads(outputs, nothing, nothing)


def all_outputs(loads: Loads) -> Float[np.ndarray, "t c"]:
    """Each load is an output."""
    return loads.normal.copy()


def simulated_system(
    name: str,
    simulator: Simulator,
    names: tuple[str, ...] | None,
    parameters: tuple[Parameter, ...],
    constants: Mapping[str, float],
    dynamic: bool = False,
) -> System:
    """The base model that a simulator is; `names` of the numbers that it is given, all where None.

    `dynamic`: whether its outputs feel what inputs did before, or differentiate them (`chain.system.System`).
    """
    return System(
        name=name,
        motion=Motion(simulator.inputs),
        geometry=Simulated(simulator, names),
        law=Law(NOTHING),
        balance=Balance(simulator.outputs, all_outputs),
        sensor=Sensor(simulator.outputs),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units=dict(simulator.units),
        dynamic=dynamic,
    )


@dataclass(frozen=True, eq=False)
class PythonSimulator:
    """A function as a simulator; whatever it raises, or an answer of another shape, is a run that failed.

    With `acts_on`, an input, it is one that takes a force law (`run_with`).
    """

    function: Run | RunWithLaw
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    units: Mapping[str, str]
    acts_on: str = ""

    def run(
        self, time: Float[np.ndarray, " t"], inputs: Float[np.ndarray, "i t"], numbers: Mapping[str, float]
    ) -> Float[np.ndarray, "t c"]:
        """Outputs at the times of the inputs; SimulatorError where there are none."""
        function = cast(Run, self.function)
        return self._answer(time, lambda: function(time.copy(), inputs.copy(), dict(numbers)))

    def run_with(
        self,
        time: Float[np.ndarray, " t"],
        inputs: Float[np.ndarray, "i t"],
        numbers: Mapping[str, float],
        law: ActingLaw,
    ) -> Float[np.ndarray, "t c"]:
        """The same of a function that takes a law."""
        function = cast(RunWithLaw, self.function)
        return self._answer(time, lambda: function(time.copy(), inputs.copy(), dict(numbers), law))

    def _answer(self, time: Float[np.ndarray, " t"], asked: Callable[[], object]) -> Float[np.ndarray, "t c"]:
        try:
            found = np.array(asked(), dtype=float)
        except Exception as error:  # the user's code may raise anything
            raise SimulatorError(f"{type(error).__name__}: {error}") from error
        if found.shape == time.shape and len(self.outputs) == 1:
            found = found[:, None]
        wanted = len(time), len(self.outputs)
        if found.shape != wanted:
            raise SimulatorError(f"gave an array {found.shape} where {wanted} is expected: a row per time")
        if not np.isfinite(found).all():
            raise SimulatorError("gave values that are not finite")
        return found


def simulator_base(
    name: str,
    inputs: Mapping[str, str],
    outputs: Mapping[str, str],
    run: Run | RunWithLaw,
    dynamic: bool = False,
    *,
    acts_on: str = "",
    law: Mapping[str, Source] | None = None,
    load: str = "",
) -> Base:
    """A function as a base model of one's own, for `system = "package.module:OBJECT"`.

    Parameters
    ----------
    name
        One that no listed system has.
    inputs, outputs
        SI unit of each channel by name, in the order in which `run` takes and gives them.
    run
        (time [s], inputs (a row each), numbers by name) → outputs (t, c), or (t,) of a single one. Numbers are
        parameters, constants and the trial's covariates, SI; others may be among them.
    dynamic
        Whether outputs feel what inputs did before (inertia, creep), or `run` differentiates its inputs. Noise of the
        inputs is then followed through `run` sample by sample, which takes some hundred runs per trial.
    acts_on
        Input that a force law acts on. `run` takes the law as a fourth argument then, an `ActingLaw`, and adds what it
        gives where it belongs; effects on the law are offered.
    law
        Numbers of the law that the base has already, by name: {"k": "stiffness"} takes its spring from the parameter
        stiffness. Nothing by default: a law without effects gives 0.
    load
        Unit of what the law gives; that of the first output in N or N m, else of the first, by default.

    ValueError where `acts_on` is no input, or `law` or `load` is given without it.

    Examples
    --------
    >>> import geocontact as gc
    >>> def run(time, inputs, numbers):
    ...     return numbers["k"] * inputs[0]
    >>> spring = gc.simulator_base("spring", {"angle": "rad"}, {"torque": "N m"}, run)
    >>> spring.name, spring.inputs, spring.outputs
    ('spring', ('angle',), ('torque',))
    """
    if acts_on and acts_on not in inputs:
        raise ValueError(f"acts_on names {acts_on!r}; inputs are {', '.join(inputs)}")
    if not acts_on and (law is not None or load):
        raise ValueError("a law without acts_on: name the input that it acts on")
    simulator = PythonSimulator(run, tuple(inputs), tuple(outputs), {**inputs, **outputs}, acts_on)
    unit = load or next((each for each in outputs.values() if each in ("N", "N m")), next(iter(outputs.values())))

    def build(parameters: tuple[Parameter, ...], constants: Mapping[str, float], _tables: object) -> System:
        made = simulated_system(name, simulator, None, parameters, constants, dynamic)
        if not acts_on:
            return made
        link = Law(INTERFACE_LAW, load=unit, deflection=inputs[acts_on]).having(dict(law or {}))
        return replace(made, geometry=SimulatedWithLaw(simulator.run_with, acts_on, NOTHING), law=link)

    return Base(name, simulator.inputs, simulator.outputs, build)
