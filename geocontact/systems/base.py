"""What a base model says of itself before there is a case."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import pandas as pd

from geocontact.chain.system import System
from geocontact.data.parameter import Parameter


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
        (parameters, constants, tables) → system, its scale not set yet.
    """

    name: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    build: Callable[[tuple[Parameter, ...], Mapping[str, float], Mapping[str, pd.DataFrame]], System]


def require_numbers(
    system: str, needed: tuple[str, ...], parameters: tuple[Parameter, ...], constants: Mapping[str, float]
) -> None:
    """Raise ValueError when a number is neither parameter nor constant, or both."""
    names = {p.name for p in parameters}
    for name in needed:
        if name not in names and name not in constants:
            raise ValueError(f"{system}: {name} is missing; give it as a parameter or as a constant")
        if name in names and name in constants:
            raise ValueError(f"{system}: {name} is both a parameter and a constant; keep one")
