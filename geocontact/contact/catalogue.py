"""Every force law with numbers of a size that occurs, so that tests and tables run through all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from geocontact.contact.area_hertz import cap_force, disc_force, discs_force, strip_force, threshold_force
from geocontact.contact.elastic_foundation import (
    linear_pair_pressure,
    linear_pressure,
    logarithmic_pair_pressure,
    logarithmic_pressure,
)
from geocontact.contact.hertz_ellipse import ellipse_force
from geocontact.contact.hertz_line import line_load
from geocontact.contact.hertz_point import point_force


@dataclass(frozen=True)
class Law:
    """A law of one running variable.

    Parameters
    ----------
    function
        Takes the variable first, then its numbers.
    variable, unit
        What runs, its unit.
    typical
        A value of the variable that occurs in the contact of an implant.
    numbers
        Numbers that occur with it, SI units.
    """

    function: Callable[..., Any]
    variable: str
    unit: str
    typical: float
    numbers: tuple[float, ...]

    @property
    def name(self) -> str:
        """Name of the function."""
        return self.function.__name__


LAWS: tuple[Law, ...] = (
    Law(point_force, "depth", "m", 2e-4, (37e-3, 1e9)),
    Law(line_load, "half width", "m", 3e-3, (37e-3, 1e9)),
    Law(ellipse_force, "depth", "m", 2e-4, (5.0, 1e9, 2.0, 0.7)),
    Law(disc_force, "area", "m^2", 1.1e-3, (37e-3, 6.8e6)),
    Law(discs_force, "area", "m^2", 1.1e-3, (37e-3, 6.8e6)),
    Law(strip_force, "area", "m^2", 1.1e-3, (37e-3, 6.8e6, 60e-3)),
    Law(cap_force, "area", "m^2", 1.1e-3, (37e-3, 6.8e6)),
    Law(threshold_force, "area", "m^2", 1.1e-3, (37e-3, 3e8, 4e-3)),
    Law(linear_pressure, "depth", "m", 2e-4, (8e-3, 1e9)),
    Law(logarithmic_pressure, "depth", "m", 2e-4, (8e-3, 1e9)),
    Law(linear_pair_pressure, "depth", "m", 2e-4, (8e-3, 1e9, 2e-3, 5e6)),
    Law(logarithmic_pair_pressure, "depth", "m", 2e-4, (8e-3, 1e9, 2e-3, 5e6)),
)
