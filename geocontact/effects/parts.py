"""Words that effects share: how parameters are named and links are replaced."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from geocontact.chain.links import Channels, Modifier
from geocontact.chain.movement import Movement
from geocontact.chain.system import System

FORCES = ("force", "force_x", "force_y")
"""Outputs that are forces."""
UNITS = {"force": "N", "force_x": "N", "force_y": "N", "cop_x": "m", "beta": "rad", "x": "m", "y": "m", "pitch": "rad"}
"""Unit of every channel."""


def with_law(sources: Mapping[str, str | float]) -> Callable[[System], System]:
    """Replaces the law by one that has a term more."""
    return lambda system: replace(system, law=system.law.having(sources))


def with_geometry(sources: Mapping[str, str | float]) -> Callable[[System], System]:
    """Replaces the geometry by one that has a term more."""
    return lambda system: replace(system, geometry=system.geometry.having(sources))


def with_motion(one: Modifier[Movement]) -> Callable[[System], System]:
    """Replaces the motion by one that is changed once more."""
    return lambda system: replace(system, motion=system.motion.having(one))


def with_balance(one: Modifier[Channels]) -> Callable[[System], System]:
    """Replaces the balance by one with a load more."""
    return lambda system: replace(system, balance=system.balance.having(one))


def with_sensor(one: Modifier[Channels]) -> Callable[[System], System]:
    """Replaces the sensor by one with a fault more."""
    return lambda system: replace(system, sensor=system.sensor.having(one))
