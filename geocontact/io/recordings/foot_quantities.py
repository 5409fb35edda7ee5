"""Numbers of a prosthetic foot: what they can be, where they are from."""

from __future__ import annotations

from typing import Annotated, Any

from geocontact.data.parameter import SOURCES
from geocontact.data.plausible import M_PER_S, N_PER_MM, N_S_PER_M, PLAIN, Plausible, S
from geocontact.data.units import MPa, Unit, deg, mm
from geocontact.io.recordings.shoulder_device import SourcedQuantity, StatedNumber

HERE = "as the foot's file states it"
"""Note of a number that has none of its own."""


class FootQuantity(SourcedQuantity):
    """A number of a foot; one that does not say where it is from is the user's."""

    def sourced(self, stated: Any) -> StatedNumber:
        """The value in SI with what is said of it."""
        if not isinstance(stated, dict):
            return StatedNumber(self.read(stated), "option", HERE)
        found = super().sourced(stated)
        if "source" in stated:
            return found
        return StatedNumber(found.value, "option", found.note or HERE)


def quantity(known: str | Plausible) -> FootQuantity:
    """How a number of this kind is written and what it can be."""
    return FootQuantity(known, sources=SOURCES)


MM_PER_S = Unit("mm/s", "m/s", 1e-3)
N_M2, KG_PER_M3 = Unit("N m^2", "N m^2", 1.0), Unit("kg/m^3", "kg/m^3", 1.0)
PLACE = Plausible("a place along a keel", mm, (0.0, 500.0))
THICKNESS = Plausible("the thickness of a keel", mm, (0.3, 40.0), (2.0, 15.0), why="leaves of carbon and glass fibre")
JOINTS = Plausible("the number of a keel's joints", PLAIN, (1.0, 64.0), (2.0, 64.0))
USUAL_JOINTS = StatedNumber(8.0, "option", "joints that stand for the beam")
STIFFNESS = Plausible("the stiffness of a foot or of a sphere under it", N_PER_MM, (0.1, 1e4), (1.0, 2000.0))
FEET = "prosthetic feet"
SOLE_DAMPING = Plausible(
    "the damping of a sphere under a foot", N_S_PER_M, (0.0, 1e6), (1.0, 1e4), or_zero=True, why=FEET
)
SOLE_FRICTION = Plausible("a coefficient of friction of a sole", PLAIN, (0.0, 10.0), (0.1, 2.0), why=FEET)
EXPONENT = Plausible("the exponent of the force of a sole over its depth", PLAIN, (0.3, 5.0), (0.8, 2.5))
ABOVE_GROUND = Plausible("a depth of a sole", mm, (1e-4, 500.0), (0.05, 20.0))
CREEP = Plausible("the speed below which a sole sticks", M_PER_S, (1e-6, 10.0), (1e-4, 0.2))
FOAM = Plausible("the thickness of foam under a keel", mm, (0.5, 200.0), (3.0, 60.0))
FOAM_MODULUS = Plausible("the modulus of foam", MPa, (1e-3, 1e3), (0.02, 20.0), why="soft open cells to dense EVA")
FOAM_RETARDATION = Plausible(
    "the retardation of foam", S, (0.0, 10.0), (1e-4, 0.2), or_zero=True, why="a loss factor of 0.001 to 1 at 1 Hz"
)
COLUMN = Plausible("the breadth of a column of foam", mm, (0.2, 50.0), (0.5, 10.0))
ACROSS = Plausible("columns of foam side by side", PLAIN, (1.0, 40.0))
GAUGE = Plausible("the standard deviation of a measured deflection", mm, (0.0, 500.0), (1e-3, 1.0), or_zero=True)
PRESSED = Plausible("how far a sole is compressed", mm, (0.0, 500.0), (0.5, 30.0))
ACTUATOR = Plausible("the speed of a fulcrum's actuator", MM_PER_S, (0.1, 5000.0), (5.0, 1000.0))
TILTED = Plausible("the tilt of a plate against a sole", deg, (-90.0, 90.0), (0.0, 45.0))
SPREAD = Plausible("the standard deviation of a foot's stiffness", N_PER_MM, (0.0, 1e4), (0.001, 50.0))

Length = Annotated[StatedNumber, quantity(PLACE)]
Keel = Annotated[StatedNumber, quantity(Plausible("the length of a keel", mm, (50.0, 500.0)))]
Width = Annotated[StatedNumber, quantity(Plausible("the width of a keel", mm, (5.0, 200.0), (20.0, 120.0)))]
Thickness = Annotated[StatedNumber, quantity(THICKNESS)]
Density = Annotated[
    StatedNumber, quantity(Plausible("the density of a keel", KG_PER_M3, (100.0, 2e4), (500.0, 9000.0)))
]
Bending = Annotated[StatedNumber, quantity(Plausible("EI or GJ of a keel", N_M2, (0.1, 1e3), (1.0, 300.0)))]
Stiffness = Annotated[StatedNumber, quantity(STIFFNESS)]
Modulus = Annotated[StatedNumber, quantity(Plausible("a modulus of a keel's material", MPa, (10.0, 1e6), (500.0, 3e5)))]
Retardation = Annotated[
    StatedNumber, quantity(Plausible("the retardation of a keel's material", S, (0.0, 1.0), (1e-5, 0.1), or_zero=True))
]
Friction = Annotated[StatedNumber, quantity(SOLE_FRICTION)]
