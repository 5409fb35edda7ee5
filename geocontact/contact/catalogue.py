"""Every force law with numbers of a size that occurs, so that tests and tables run through all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from geocontact.contact.adhesion import dmt_force, jkr_force
from geocontact.contact.area_hertz import cap_force, disc_force, discs_force, strip_force, threshold_force
from geocontact.contact.bristle_friction import bristle_force, deflection_rate
from geocontact.contact.bushing import bushing_force
from geocontact.contact.elastic_foundation import (
    linear_pair_pressure,
    linear_pressure,
    logarithmic_pair_pressure,
    logarithmic_pressure,
)
from geocontact.contact.hertz import ellipse_force, line_load, point_force
from geocontact.contact.smooth_half_space import half_space_coefficient, half_space_force
from geocontact.contact.smooth_hunt_crossley import smoothed_sphere_force, stribeck_coefficient
from geocontact.contact.sphere_foot import friction_coefficient, normal_force


@dataclass(frozen=True)
class Variable:
    """What runs along a motion.

    Parameters
    ----------
    name, unit
        In words, and its SI unit.
    typical
        A value that occurs, away from the kinks of the law.
    """

    name: str
    unit: str
    typical: float


@dataclass(frozen=True)
class ForceLaw:
    """A law of one running variable or more.

    Parameters
    ----------
    function
        Takes the variables first, then its numbers.
    variables
        What runs, in the order of the function's arguments.
    numbers
        Numbers that occur with the typical values, SI units.
    """

    function: Callable[..., Any]
    variables: tuple[Variable, ...]
    numbers: tuple[float, ...]

    @property
    def name(self) -> str:
        """Name of the function."""
        return self.function.__name__


DEPTH, AREA = Variable("depth", "m", 2e-4), Variable("area", "m^2", 1.1e-3)

PRESSING: tuple[ForceLaw, ...] = (
    ForceLaw(point_force, (DEPTH,), (37e-3, 1e9)),
    ForceLaw(line_load, (Variable("half width", "m", 3e-3),), (37e-3, 1e9)),
    ForceLaw(ellipse_force, (DEPTH,), (5.0, 1e9, 2.0, 0.7)),
    ForceLaw(disc_force, (AREA,), (37e-3, 6.8e6)),
    ForceLaw(discs_force, (AREA,), (37e-3, 6.8e6)),
    ForceLaw(strip_force, (AREA,), (37e-3, 6.8e6, 60e-3)),
    ForceLaw(cap_force, (AREA,), (37e-3, 6.8e6)),
    ForceLaw(threshold_force, (AREA,), (37e-3, 3e8, 4e-3)),
    ForceLaw(linear_pressure, (DEPTH,), (8e-3, 1e9)),
    ForceLaw(logarithmic_pressure, (DEPTH,), (8e-3, 1e9)),
    ForceLaw(linear_pair_pressure, (DEPTH,), (8e-3, 1e9, 2e-3, 5e6)),
    ForceLaw(logarithmic_pair_pressure, (DEPTH,), (8e-3, 1e9, 2e-3, 5e6)),
    ForceLaw(normal_force, (Variable("depth", "m", 1.5e-3), Variable("rate", "m/s", 0.3)), (6e4, 1.5, 300.0, 2e-3)),
)
"""How bodies press: 0 unless the first variable is positive, never negative."""

ADHERING: tuple[ForceLaw, ...] = tuple(
    ForceLaw(law, (Variable("radius of the patch", "m", 3e-3),), (37e-3, 5e6, 0.05)) for law in (dmt_force, jkr_force)
)
"""How bodies press that stick: 0 unless the first variable is positive, negative where it is small."""

INDENTATION = (Variable("depth", "m", 4e-3), Variable("rate", "m/s", 0.1))

SMOOTHED: tuple[ForceLaw, ...] = (
    ForceLaw(smoothed_sphere_force, INDENTATION, (1e6, 0.035, 1.5, 1e-3, 300.0, 50.0, 0.5)),
    ForceLaw(half_space_force, INDENTATION, (1e6, 0.035, 1.5, 300.0, 50.0, 1e-5)),
)
"""How they press in a solver that needs derivatives: small, not 0, where the first variable is negative."""

FRICTION: tuple[ForceLaw, ...] = (
    ForceLaw(friction_coefficient, (Variable("speed", "m/s", 0.3),), (0.25, 0.9, 0.7)),
    ForceLaw(stribeck_coefficient, (Variable("speed", "m/s", 0.3),), (0.2, 0.9, 0.7, 0.4)),
    ForceLaw(half_space_coefficient, (Variable("speed", "m/s", 0.3),), (0.2, 0.9, 0.7, 0.4)),
    ForceLaw(
        deflection_rate,
        (Variable("deflection", "m", 3e-5), Variable("speed", "m/s", 2e-3)),
        (4e-5, 0.6),
    ),
    ForceLaw(
        bristle_force,
        (Variable("deflection", "m", 3e-5), Variable("rate", "m/s", 2e-3)),
        (1e5, 30.0),
    ),
)
"""How they resist sliding: odd in all variables together."""

HOLDING: tuple[ForceLaw, ...] = (
    ForceLaw(bushing_force, (Variable("displacement", "m", 5e-3), Variable("rate", "m/s", 0.05)), (20e3, 10e3)),
)
"""How they hold what is displaced: odd in all variables together."""

LAWS = PRESSING + ADHERING + SMOOTHED + FRICTION + HOLDING
