"""Knee implant: medial and lateral force from the sides' contact areas, F = (4/3) E* a³/R, a = sqrt(area/π).

Inputs `flexion [rad]`, `adduction [rad]`, `area_medial [m^2]`, `area_lateral [m^2]`; the base uses the areas only.
Outputs `force_medial [N]`, `force_lateral [N]`. Parameter E_star [Pa], constant or fixed parameter R [m]. Only E*/R is
identifiable from areas and forces.

A side's area is taken for one circle, a = sqrt(area/π), so F = (4/3) E* a³/R (`contact.area_hertz.disc_force`). Here
a³/R [m²] is the deflection u and (4/3) E* [Pa] the stiffness, so that whatever acts on a deflection has its place.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.interface_law import INTERFACE_LAW
from geocontact.chain.links import Balance, Law, LawParameters, Loads, Motion, Sensor, Source, Values
from geocontact.chain.magnitudes import Magnitudes
from geocontact.chain.single_deflection import along, known_changes
from geocontact.chain.system import System
from geocontact.chain.traits import Migration, Traits
from geocontact.contact.area_hertz import disc_force
from geocontact.data.parameter import Parameter
from geocontact.systems.base import Base, CaseNeeds, require_numbers

AREAS = ("area_medial", "area_lateral")
KNEE_GEOMETRY = LawParameters(
    {
        "R": 1.0,
        "axis_migration.slope": 0.0,
        "axis_migration.curvature": 0.0,
        "axis_migration.centre": 0.0,
        "asymmetry.sides": 0.0,
    }
)
UNIT_FORCE = 0.75
"""Modulus at which `disc_force` is a³/R."""
LEAST_RADIUS = 1e-3
"""Least radius of R(φ) [m], which an unlucky search might make negative."""


@dataclass(frozen=True)
class KneeContact:
    """Geometry link of the knee: two areas, two deflections; R may change with flexion, the sides may differ."""

    slots: LawParameters = KNEE_GEOMETRY

    @property
    def yields(self) -> str:
        """Angle that the geometry may depend on; nothing here gives way to a spring in series."""
        return "flexion"

    def having(self, sources: Mapping[str, Source]) -> KneeContact:
        """The same link with more of its numbers coming from somewhere."""
        return replace(self, slots=self.slots.having(sources))

    def deflection(
        self, movement: DifferentiatedInputs, values: Values
    ) -> tuple[Float[np.ndarray, "t n"], Float[np.ndarray, "t n"]]:
        """a³/R of each side [m²] and its rate; with R = R0 + s φ + c φ², φ the flexion from the middle of its range.

        The medial side carries 1 + d times as much, the lateral 1 - d times, d the difference of the sides.
        """
        radius0, slope, bend, centre, sides = self.slots.numbers(values)
        row = movement.row("flexion")
        angle = movement.position[row] - centre
        free = radius0 + angle * (slope + bend * angle)
        radius = np.maximum(free, LEAST_RADIUS)
        turning = np.where(free > LEAST_RADIUS, movement.rate[row] * (slope + 2.0 * bend * angle), 0.0)
        columns, rates = [], []
        for name, share in zip(AREAS, (1.0 + sides, 1.0 - sides), strict=True):
            area = movement.position[movement.row(name)]
            u = share * disc_force(area, radius, UNIT_FORCE)
            growth = 1.5 * movement.rate[movement.row(name)] / np.where(area > 0.0, area, np.inf)
            columns.append(u)
            rates.append(u * (growth - turning / radius))
        return np.stack(columns, axis=1), np.stack(rates, axis=1)

    def loads(self, movement: DifferentiatedInputs, law: Law, values: Values) -> Loads:
        """Force of each side along a movement, each with a memory of its own."""
        u, rate = self.deflection(movement, values)
        numbers = law.slots.numbers(values)
        normal = np.stack([along(movement.time, u[:, i].copy(), rate[:, i].copy(), numbers) for i in (0, 1)], axis=1)
        return Loads(normal, np.zeros_like(normal), np.zeros_like(normal))

    def changes(
        self, movement: DifferentiatedInputs, law: Law, values: Values, others: Sequence[Values]
    ) -> tuple[Loads, list[Loads | None]] | None:
        """Forces along a movement, and how they change towards other values (`chain.system`)."""
        return known_changes(self, movement, law, values, others, by_slots=True)


INPUTS, OUTPUTS = ("flexion", "adduction", *AREAS), ("force_medial", "force_lateral")
UNITS = {"flexion": "rad", "adduction": "rad", **dict.fromkeys(AREAS, "m^2"), **dict.fromkeys(OUTPUTS, "N")}
STRAPS = (
    *("slip.mobility", "dead_zone.width", "stiffening.gain", "end_stop.upper.stiffness", "end_stop.lower.stiffness"),
    *("damping.b", "dry_friction.stroke.limit", "dry_friction.rate.limit", "preload.tension"),
    "contact_loss.opening",
)
"""Terms of the law that an implant does not have: they stay neutral and are not offered."""
TRAITS = Traits(plausible=dict.fromkeys(AREAS, 0.8), migration=Migration(2.0))
"""A radius changes by twice itself per radian at the most; an area is wrong by 0.8 of its half-range at the most."""


def stiffness(values: Values) -> float:
    """(4/3) E* [Pa]: force over a³/R."""
    return 4.0 / 3.0 * values["E_star"]


def measured_forces(loads: Loads) -> Float[np.ndarray, "t c"]:
    """Each side's load is an output."""
    return loads.normal.copy()


NUMBERS = {"R": "m", "E_star": "Pa"}
NEEDS = CaseNeeds("forces of an implant from areas", UNITS, lambda _channels, _tables: NUMBERS)


def build(
    parameters: tuple[Parameter, ...], constants: Mapping[str, float], tables: Mapping[str, pd.DataFrame]
) -> System:
    """The base model; ValueError when a number that it needs is neither parameter nor constant."""
    require_numbers("knee", tuple(NUMBERS), parameters, constants, positive=tuple(NUMBERS))
    return System(
        name="knee",
        motion=Motion(INPUTS),
        geometry=KneeContact().having({"R": "R"}),
        law=Law(INTERFACE_LAW, deflection="m^2").having({"k": stiffness}).lacking(*STRAPS),
        balance=Balance(OUTPUTS, measured_forces),
        sensor=Sensor(OUTPUTS),
        parameters=parameters,
        constants=dict(constants),
        scale=Magnitudes(),
        units=UNITS,
        spare=("flexion", "adduction"),
        lengths=tuple(name for name in ("R",) if name in constants),
        traits=TRAITS,
    )


KNEE = Base("knee", INPUTS, OUTPUTS, build, needs=NEEDS)
