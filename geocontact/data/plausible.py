"""Which values a quantity can have and which it usually has: a unit that was mixed up shows.

What is possible is generous, so that nobody is kept from work; it finds metres taken for millimetres, N/mm for N/m and
degrees for radians. What is usual is what recordings of people, implants and exoskeletons hold.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from numbers import Real

from geocontact.data.errors import InputError
from geocontact.data.units import UNITS, MPa, Unit, deg, kPa, m, mm, mmHg, percent

PLAIN = Unit("", "1", 1.0)
N, HZ, S, KG = Unit("N", "N", 1.0), Unit("Hz", "Hz", 1.0), Unit("s", "s", 1.0), Unit("kg", "kg", 1.0)
RAD, PA, M_PER_S = Unit("rad", "rad", 1.0), Unit("Pa", "Pa", 1.0), Unit("m/s", "m/s", 1.0)
N_PER_M, N_PER_MM = Unit("N/m", "N/m", 1.0), Unit("N/mm", "N/m", 1e3)
N_M, N_MM, N_M_PER_DEG = Unit("N m", "N m", 1.0), Unit("N mm", "N m", 1e-3), Unit("N m/deg", "N m/rad", math.degrees(1))
AMPERE, MILLIAMPERE = Unit("A", "A", 1.0), Unit("mA", "A", 1e-3)
N_S_PER_M, N_S_PER_MM = Unit("N s/m", "N s/m", 1.0), Unit("N s/mm", "N s/m", 1e3)
N_M_S = Unit("N m s/rad", "N m s/rad", 1.0)
KG_M, KG_M2 = Unit("kg m", "kg m", 1.0), Unit("kg m^2", "kg m^2", 1.0)
N_MM_S = Unit("N mm s/rad", "N m s/rad", 1e-3)
J_PER_M2 = Unit("J/m^2", "J/m^2", 1.0)
MM3_PER_N_M = Unit("mm^3/(N m)", "m^2/N", 1e-9)
KHZ, G, TONNE = Unit("kHz", "Hz", 1e3), Unit("g", "kg", 1e-3), Unit("t", "kg", 1e3)
YEARS = Unit("years", "years", 1.0)
OF_SI = (N, HZ, S, KG, RAD, PA, M_PER_S, N_PER_M, N_S_PER_M, J_PER_M2, PLAIN)
KNOWN: tuple[Unit, ...] = (*UNITS, *OF_SI, N_PER_MM, N_S_PER_MM, N_M, N_MM, N_MM_S, AMPERE, MILLIAMPERE, KHZ, G, TONNE)
"""Units that a number may have been meant in."""

ROUNDING = 1e-9
"""Rounding of an end of a range; 45 deg is not exactly pi / 4."""

LEAST_NUMBER = 0.1
"""Smallest value in SI that may be a number of another unit: 4 m that was to be 4 mm, but not 0.04 m for 0.04 mm."""


LARGEST_MEANT = 1e20
"""Beyond what is written anywhere, 64-bit clocks that count nanoseconds from 1970 (2e18) included."""
TOO_LARGE = "is implausibly large"


@dataclass(frozen=True)
class Plausible:
    """The values of a quantity.

    Parameters
    ----------
    what
        The quantity, in words after "for": "a threshold of contact".
    unit
        Unit that people read it in; the ranges are in it.
    possible
        Smallest and largest value; what is outside is refused.
    usual
        What is outside is used with a warning; as `possible` by default.
    or_zero
        0 is as good as what is usual: it stands for none.
    why
        What has the usual sizes, from the smallest to the largest.
    least
        What is nearer to 0 is unusual, on either side of it, but for 0 itself.
    """

    what: str
    unit: Unit
    possible: tuple[float, float]
    usual: tuple[float, float] | None = None
    or_zero: bool = False
    why: str = ""
    least: float = 0.0

    def refusal(self, value: float, written: float | None = None) -> tuple[str, str] | None:
        """What is wrong with a value [SI], and what to do about it; None when it is possible.

        `written` is the number that stands in a file, where its unit stands beside it.
        """
        if not math.isfinite(value):
            return f"{value} is not a finite number", "give a number"
        if self._holds(value, self.possible):
            return None
        low, high = self.possible
        what = f"{self.shown(value)} cannot be {self.what}: that is {low:g} to {self.shown(high * self.unit.factor)}"
        return what, self._question(value, written) or "check the value and its unit"

    def doubt(self, value: float, written: float | None = None) -> str | None:
        """Why a value [SI] that is possible is not likely; None when it is usual. `written` as for `refusal`."""
        if self.usual is None or self._is_usual(value):
            return None
        low, high = self.usual
        if self._holds(value, self.usual):
            low = self.least
        usual = f"{low:g} to {self.shown(high * self.unit.factor)}{self.why and f' ({self.why})'}"
        line = f"{self.shown(value)} is unusual for {self.what}, which mostly is {usual}"
        question = self._question(value, written)
        return f"{line}; {question}" if question else line

    def usually(self, lower: float, upper: float) -> bool:
        """Whether an interval [SI] reaches what is usual."""
        low, high = (end * self.unit.factor for end in self.usual or self.possible)
        return (self.or_zero and lower <= 0.0 <= upper) or (upper >= low and lower <= high)

    def require(self, value: float, name: str) -> None:
        """InputError for a value [SI] that cannot be; `name` is the place it is said in."""
        refusal = self.refusal(value)
        if refusal is not None:
            raise InputError("", name, *refusal)

    def shown(self, value: float) -> str:
        """A value [SI] with the unit that people read."""
        return f"{value / self.unit.factor:.6g} {self.unit.name}".strip()

    def _is_usual(self, value: float) -> bool:
        near = 0.0 < abs(value) < self.least * self.unit.factor * (1.0 - ROUNDING)
        return self._holds(value, self.usual or self.possible) and not near

    def _holds(self, value: float, ends: tuple[float, float]) -> bool:
        if self.or_zero and value == 0.0:
            return True
        low, high = (end * self.unit.factor for end in ends)
        return bool(low - ROUNDING * abs(low) <= value <= high + ROUNDING * abs(high))

    def _question(self, value: float, written: float | None = None) -> str:
        """Whether the number that was written was meant in another unit, in which it would be usual."""
        units = [self.unit, *(unit for unit in KNOWN if unit.si == self.unit.si and unit.name != self.unit.name)]
        read = value / self.unit.factor
        numbers = (value, read) if abs(value) >= LEAST_NUMBER else (read,)
        for number in filter(_may_be_written, numbers if written is None else (written,)):
            for unit in units:
                meant = number * unit.factor
                if meant != value and self._is_usual(meant):
                    return f"is {number:.6g} {unit.name} meant?"
        return ""


@dataclass(frozen=True)
class ByPlace:
    """Values of several quantities one after the other; None for what has no range."""

    ranges: tuple[Range | None, ...]


@dataclass(frozen=True)
class ByName:
    """Values of several quantities by name."""

    ranges: tuple[tuple[str, Range], ...]


Range = Plausible | ByPlace | ByName
"""What the values of an option can be."""


def numbers_in(known: Range | None, value: object, name: str = "") -> Iterator[tuple[str, Plausible, float]]:
    """Every number in a value with its range, and the name it has there ("k"), empty for the value itself."""
    match known:
        case ByName():
            ranges = dict(known.ranges)
            for key, one in value.items() if isinstance(value, Mapping) else ():
                yield from numbers_in(ranges.get(str(key)), one, str(key))
        case ByPlace():
            for one, each in zip(known.ranges, _listed(value), strict=False):
                yield from numbers_in(one, each, name)
        case Plausible():
            if isinstance(value, Real) and not isinstance(value, bool):
                yield name, known, float(value)
            for each in value.values() if isinstance(value, Mapping) else _listed(value):
                yield from numbers_in(known, each, name)


def _listed(value: object) -> Sequence[object]:
    return value if isinstance(value, (tuple, list)) else ()


def _may_be_written(number: float) -> bool:
    """Whether somebody may have written a number: it is not 0 and has few digits."""
    return number != 0.0 and math.isclose(float(f"{number:.6g}"), number, rel_tol=1e-12)


THRESHOLD = Plausible("a threshold of contact", mm, (0.0, 200.0), (0.01, 20.0), or_zero=True)
LAYER = Plausible("the thickness of a layer", mm, (0.01, 1000.0), (0.2, 100.0))
PIECE = Plausible("the edge of a piece of a surface", mm, (1e-3, 100.0), (0.02, 10.0))
FITTED = Plausible("the radius within which curvatures are fitted", mm, (0.05, 200.0), (0.5, 20.0))
RADIUS = Plausible("the radius of a contact", mm, (0.1, 10_000.0), (1.0, 1000.0))
STRIP = Plausible("the length of a contact", mm, (0.1, 10_000.0), (1.0, 1000.0))
MERGED = Plausible("the distance within which vertices are merged", mm, (1e-9, 5.0), (1e-7, 0.2))
BORDER = Plausible("the border of a mat", mm, (0.0, 500.0), (0.0, 100.0))
DEPTH = Plausible("a depth of contact", mm, (1e-3, 200.0), (0.05, 30.0))
SHIFT = Plausible("how far things are off", mm, (0.0, 500.0), (0.0, 50.0))

YOUNG = Plausible("Young's modulus", MPa, (1e-3, 2e6), (5e-3, 5e5), why="gels to ceramics")
SOFTER = Plausible("Young's modulus", MPa, (1e-3, 2e6), (5e-3, 5e4), why="gels to cortical bone")
"""Bone has 20 GPa; metal and ceramics, of which the harder body is, 100 and more."""
WEAR = Plausible("a wear factor", MM3_PER_N_M, (0.0, 1.0), (1e-10, 1e-5), or_zero=True, why="ceramics to worn plastics")
CYCLES = Plausible("how often a motion repeats", PLAIN, (1.0, 1e10), (1e3, 1e8))
ADHESION = Plausible("the work of adhesion", J_PER_M2, (1e-6, 1e3), (1e-3, 1.0))
CONTACT = Plausible("a modulus of contact", MPa, (1e-3, 1e6), (5e-3, 3e5), why="gels to ceramic on ceramic")
BEARING = Plausible("a pressure in a bearing", MPa, (0.0, 1e4), (1e-3, 60.0), why="soft layers; polyethylene to 50 MPa")
ROUNDED = Plausible("the radius of a part of a body", mm, (1e-3, 1e4), (0.5, 180.0), why="small implants to a torso")
TOUCH = Plausible("the pressure of a touch", kPa, (1e-3, 1e4), (0.05, 100.0))
CUFF = Plausible("the pressure of a cuff", mmHg, (1.0, 2000.0), (5.0, 300.0), or_zero=True)
LAYER_RATIO = Plausible("Poisson's ratio of a layer, below 0.5", PLAIN, (0.0, 0.4999))
POISSON = Plausible("Poisson's ratio", PLAIN, (-0.9999, 0.5), (0.02, 0.5), or_zero=True, why="cartilage to rubber")

TURN = Plausible("a small turn", deg, (-45.0, 45.0))
TILT = Plausible("how far an angle is off", deg, (0.0, 90.0), (0.0, 20.0))
JOINT_ANGLE = Plausible("an angle of a joint", deg, (-720.0, 720.0))
BIN = Plausible("a width of bins", deg, (0.1, 30.0))

FORCE = Plausible("the force of a person", N, (0.0, 1e5), (0.1, 1e4), or_zero=True)
ALONG_AXIS = Plausible("a force along an axis", N, (-1e5, 1e5), (-1e4, 1e4), least=0.1)
PLACE_ON_BODY = Plausible("a coordinate of a point of a body", mm, (-1e4, 1e4), (-500.0, 500.0))
HELD_PLACE = Plausible("the stiffness of a spring", N_PER_MM, (1e-6, 1e6), (0.01, 1e4))
HELD_TURN = Plausible("the stiffness of a spring that turns", N_M_PER_DEG, (1e-9, 1e4), (1e-4, 100.0))
LIMIT = Plausible("the largest force on a limb", N, (1e-6, 1e5), (0.05, 2000.0))
NOISE = Plausible("the noise of a force", N, (0.0, 1e4), (0.0, 100.0))
ATTACHMENT = Plausible("the stiffness of an attachment", N_PER_M, (1.0, 1e7), (10.0, 1e5))
DAMPING = Plausible("a damping", N_S_PER_M, (0.0, 1e6), (1.0, 1e4), or_zero=True)
SPEED = Plausible("a speed of sliding", M_PER_S, (1e-6, 20.0), (1e-4, 2.0))
FRICTION = Plausible("a coefficient of friction", PLAIN, (0.0, 10.0), (0.0, 2.0))
MASS = Plausible("the mass of a person", KG, (0.1, 1000.0), (3.0, 300.0))
PERSON = Plausible("the mass of a person", KG, (10.0, 300.0))
"""From 6 years on; what is usual depends on the age, which is confronted where both are known."""
TALL = Plausible("the height of a person", m, (0.8, 2.5), (0.8, 2.05), why="999 of 1000 Dutch men")
"""Dutch men of 21 years are 1.838 m, SD 0.071 (Schönbeck et al., Pediatr. Res. 73, 2013); 2.05 m is 3 SD above."""
AGE = Plausible("the age of a person whose segments are known", YEARS, (6.0, 110.0))

DEVICE = "hinges and parts of worn devices"
VISCOUS = Plausible("the viscous friction of a hinge of a device", N_M_S, (0.0, 500.0), (0.01, 50.0), why=DEVICE)
COULOMB = Plausible("the Coulomb friction of a hinge of a device", N_M, (0.0, 500.0), (0.01, 50.0), why=DEVICE)
FIRST_MOMENT = Plausible("the first moment of a part of a device", KG_M, (-50.0, 50.0), (-10.0, 10.0), why=DEVICE)
INERTIA = Plausible("the moment of inertia of a part of a device", KG_M2, (0.0, 50.0), (1e-3, 5.0), why=DEVICE)
PART = Plausible("the mass of a part of a device", KG, (0.0, 100.0), (0.05, 20.0), why=DEVICE)
MOTOR = Plausible("the largest torque of a motor that is worn", N_M, (0.0, 1e6), (0.01, 500.0), or_zero=True)
TOOL = Plausible("the largest current of a hand tool", AMPERE, (0.0, 1e6), (0.02, 100.0), or_zero=True)

CUTOFF = Plausible("a cut-off frequency", HZ, (0.0, 2000.0), (1.0, 100.0), or_zero=True)
BAND = Plausible("a frequency of movement", HZ, (1e-6, 1000.0), (1e-3, 20.0))
RATE = Plausible("a sampling rate", HZ, (5.0, 1e4))
FRAME_RATE = Plausible("a frame rate", HZ, (1e-3, 1e5), (0.5, 5000.0))
CLOCK = Plausible("a time of a recording", S, (-1e6, 1e10))  # clocks that count from 1970 included
TRIAL_LIMIT = Plausible("the time for a trial", S, (1.0, 1e7), (1.0, 1e6))
SEARCH = Plausible("the time of a search", S, (1e-3, 1e7), (1.0, 1e5))
DELAY = Plausible("a lag of clocks", S, (-3600.0, 3600.0), (-60.0, 60.0))
GAP = Plausible("a gap in a recording", S, (0.0, 60.0), (0.0, 2.0))
LENGTH_OF_TRIAL = Plausible("the length of a trial", S, (1.0, 3600.0))
MEMORY = Plausible("a correlation time", S, (0.0, 600.0), (0.0, 30.0))

SHARE = Plausible("a share", percent, (1e-10, 100.0))
MOST_OF = Plausible("a share that most is to be of", percent, (0.0, 1e4), (20.0, 100.0), or_zero=True)
LEFT = Plausible("a share that is left as a margin", percent, (0.0, 1e4), (1.0, 60.0), or_zero=True)
DIFFERENCE = Plausible("a relative difference", percent, (1e-7, 1e5))

DISPLACEMENT = ByPlace((SHIFT, TILT))
SD_OF_PLACE = Plausible("the standard deviation of a place", mm, (0.0, 500.0), (1e-3, 20.0), or_zero=True)
SD_OF_TURN = Plausible("the standard deviation of a turn", deg, (0.0, 90.0), (1e-3, 20.0), or_zero=True)
POSE = ByPlace((SD_OF_PLACE,) * 3 + (SD_OF_TURN,) * 3)
SPRING = Plausible("the stiffness of a knee", N_PER_MM, (0.0, 1e6), (0.1, 2000.0), or_zero=True)
TURNED_SPRING = Plausible("the stiffness of a knee that turns", N_M_PER_DEG, (0.0, 1e4), (1e-3, 50.0), or_zero=True)
"""Simulators of knee wear have tens of N/mm and tenths of N m/deg (ISO 14243-1)."""
EXPONENT = Plausible("the exponent of a force over depth", PLAIN, (0.1, 10.0), (0.8, 3.0))
SPHERE = Plausible("the stiffness k of a sphere, in N/m^n", PLAIN, (1.0, 1e9), (1e3, 1e7))
FOOT_LAW = ByName(
    (
        ("k", SPHERE),
        ("b", DAMPING),
        ("n", EXPONENT),
        ("delta_full", DEPTH),
        ("mu_s", FRICTION),
        ("mu_k", FRICTION),
        ("v_th", SPEED),
    )
)
"""What the numbers of the force law of a foot on spheres can be, wherever they come from."""
