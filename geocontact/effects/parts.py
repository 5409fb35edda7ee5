"""Words that effects share: how parameters are named and links are replaced."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.links import Channels, Modifier, Source
from geocontact.chain.system import System


def load_channels(system: System) -> tuple[str, ...]:
    """Outputs that are forces or moments."""
    return tuple(name for name in system.outputs if system.role(name) == "load")


def largest_load(system: System) -> float:
    """Largest measured magnitude of what the law gives, 1 where nothing of its unit was measured."""
    return max((system.scale.of(name) for name in system.outputs if system.unit(name) == system.law.load), default=1.0)


def with_law(sources: Mapping[str, Source]) -> Callable[[System], System]:
    """Replaces the law by one that has a term more."""
    return lambda system: replace(system, law=system.law.having(sources))


def with_geometry(sources: Mapping[str, Source]) -> Callable[[System], System]:
    """Replaces the geometry by one that has a term more."""
    return lambda system: replace(system, geometry=system.geometry.having(sources))


def with_motion(one: Modifier[DifferentiatedInputs]) -> Callable[[System], System]:
    """Replaces the motion by one that is changed once more."""
    return lambda system: replace(system, motion=system.motion.having(one))


def with_balance(one: Modifier[Channels]) -> Callable[[System], System]:
    """Replaces the balance by one with a load more."""
    return lambda system: replace(system, balance=system.balance.having(one))


def with_sensor(one: Modifier[Channels]) -> Callable[[System], System]:
    """Replaces the sensor by one with a fault more."""
    return lambda system: replace(system, sensor=system.sensor.having(one))
