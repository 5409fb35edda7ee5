"""What a base model says of itself before there is a case."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

import pandas as pd

from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.data.parameter import Parameter


@dataclass(frozen=True)
class CaseNeeds:
    """What a case of a base model has to give besides its channels, for whoever makes one.

    Parameters
    ----------
    words
        What the model is of, in a few words.
    units
        SI unit of each of its channels.
    numbers
        (channels of the trials, tables) → names of all numbers with their SI units; ValueError for a wrong table.
    tables
        Tables by name with their columns, all of them needed.
    per_trial
        Pure numbers that each trial has a value of its own of.
    """

    words: str
    units: Mapping[str, str]
    numbers: Callable[[Collection[str], Mapping[str, pd.DataFrame]], Mapping[str, str]]
    tables: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    per_trial: tuple[str, ...] = ()


@dataclass(frozen=True)
class Base:
    """Name of a base model, its channels, and how it is made from what a case says.

    Parameters
    ----------
    name
        As in case.toml; of an own model, one that no listed system has.
    inputs, outputs
        Channels that drive it and that it predicts.
    build
        (parameters, constants, tables) → system, its scale not set yet; (parameters, constants, tables, meshes) where
        `meshes` names some.
    meshes
        Names of the surfaces that it needs, `[mesh.<name>]` in case.toml.
    needs
        What else a case gives; None where the model does not declare it.

    Examples
    --------
    >>> import geocontact as gc
    >>> def run(time, inputs, numbers):
    ...     return numbers["k"] * inputs[0]
    >>> spring = gc.simulator_base("spring", {"angle": "rad"}, {"torque": "N m"}, run)
    >>> isinstance(spring, gc.Base), spring.outputs
    (True, ('torque',))
    """

    name: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    build: Callable[..., System]
    meshes: tuple[str, ...] = ()
    needs: CaseNeeds | None = None

    def made(self, case: GapCase) -> Any:
        """What build gives for a case, a System if it is right.

        ValueError when the case's meshes are not those that are needed; and whatever build raises.
        """
        for name in self.meshes:
            if name not in case.meshes:
                raise ValueError(f"{self.name}: the mesh {name} is missing; give its file and unit under [mesh.{name}]")
        for name in case.meshes:
            if name not in self.meshes:
                takes = f"it takes {', '.join(self.meshes)}" if self.meshes else "it takes none"
                raise ValueError(f"{self.name}: the mesh {name} is not used; {takes}")
        given = (case.parameters, case.constants, case.tables)
        return self.build(*given, case.meshes) if self.meshes else self.build(*given)


def require_numbers(
    system: str,
    needed: tuple[str, ...],
    parameters: tuple[Parameter, ...],
    constants: Mapping[str, float],
    *,
    positive: Collection[str] = (),
    not_negative: Collection[str] = (),
) -> None:
    """Check that every number of a base model is given once, and has a sign that it can have.

    Parameters
    ----------
    system
        Name of the model, for the message.
    needed
        Names of its numbers.
    parameters, constants
        What the case gives.
    positive, not_negative
        Names of those that are above 0, and of those that may be 0 as well: constants, and where parameters start.
        Bounds of a search may be anything.

    Raises
    ------
    ValueError
        A number is neither parameter nor constant, or both, not finite, or of a sign that it cannot have.

    Examples
    --------
    >>> import geocontact as gc
    >>> gc.require_numbers("orthosis", ("k",), [gc.Parameter("k", "N m/rad", 100.0)], {})
    """
    names = {p.name for p in parameters}
    for name in needed:
        if name not in names and name not in constants:
            raise ValueError(f"{system}: {name} is missing; give it as a parameter or as a constant")
        if name in names and name in constants:
            raise ValueError(f"{system}: {name} is both a parameter and a constant; keep one")
    stated = {**constants, **{p.name: p.start for p in parameters}}
    for name, value in stated.items():
        if not math.isfinite(value):
            raise ValueError(f"{system}: {name} is {value}; write a finite number")
        if name in positive and not value > 0.0:
            raise ValueError(f"{system}: {name} is {value:g} and must be positive; correct it")
        if name in not_negative and value < 0.0:
            raise ValueError(f"{system}: {name} is {value:g} and must not be negative; correct it")
