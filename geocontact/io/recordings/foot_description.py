"""Description of a prosthetic foot: its keel, its settings, its sole, and the compressions that its keel is identified
from.

    name = "laboratory foot"

    [keel]
    length = { value = 240, unit = "mm" }
    posterior = { value = 60, unit = "mm" }
    lowest = { value = 60, unit = "mm" }
    highest = { value = 150, unit = "mm" }
    width = { value = 60, unit = "mm" }
    thickness = { value = 8, unit = "mm" }
    density = { value = 1850, unit = "kg/m^3" }
    bending = { value = 21, unit = "N m^2" }

    [settings]
    soft = { value = 60, unit = "mm" }

    [sole]
    spheres = "spheres.csv"
    below = { value = 30, unit = "mm" }

    [sole.zones.heel]
    stiffness = { value = 15, unit = "N/mm" }

    [[compressions]]
    setting = "soft"
    curve = "soft.csv"

In place of [sole], [foam] is a sole of foam in zones. Places along the keel count from its posterior end. Files are
looked for beside the description.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from jaxtyping import Float
from pydantic import Field, model_validator

from geocontact.data.errors import InputError
from geocontact.data.parameter import SOURCES
from geocontact.data.plausible import M_PER_S, N_PER_MM, N_S_PER_M, PLAIN, Plausible, S
from geocontact.data.units import MPa, Unit, deg, mm
from geocontact.io.documents import Document, File, Listed, Rows, Word, doubled, read_document, refusal
from geocontact.io.recordings.shoulder_device import SourcedQuantity, StatedNumber
from geocontact.io.text.side_table import read_side_table

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


def _quantity(known: str | Plausible) -> FootQuantity:
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

Length = Annotated[StatedNumber, _quantity(PLACE)]
Keel = Annotated[StatedNumber, _quantity(Plausible("the length of a keel", mm, (50.0, 500.0)))]
Width = Annotated[StatedNumber, _quantity(Plausible("the width of a keel", mm, (5.0, 200.0), (20.0, 120.0)))]
Thickness = Annotated[StatedNumber, _quantity(THICKNESS)]
Density = Annotated[
    StatedNumber, _quantity(Plausible("the density of a keel", KG_PER_M3, (100.0, 2e4), (500.0, 9000.0)))
]
Bending = Annotated[StatedNumber, _quantity(Plausible("EI or GJ of a keel", N_M2, (0.1, 1e3), (1.0, 300.0)))]
Stiffness = Annotated[StatedNumber, _quantity(STIFFNESS)]
Modulus = Annotated[
    StatedNumber, _quantity(Plausible("a modulus of a keel's material", MPa, (10.0, 1e6), (500.0, 3e5)))
]
Retardation = Annotated[
    StatedNumber, _quantity(Plausible("the retardation of a keel's material", S, (0.0, 1.0), (1e-5, 0.1), or_zero=True))
]
Friction = Annotated[StatedNumber, _quantity(SOLE_FRICTION)]


class KeelSection(Document):
    """A stretch of the keel with a stiffness of its own.

    Parameters
    ----------
    to
        Where it ends; it begins where the one before ends.
    bending
        EI.
    thickness, width
        In place of EI, with `modulus` of the keel; its width by default.
    """

    to: Length
    bending: Bending | None = None
    thickness: Thickness | None = None
    width: Width | None = None


class KeelDescription(Document):
    """A keel.

    Parameters
    ----------
    length
        From its posterior end to its tip.
    posterior
        From its posterior end to the first joint.
    joints
        How many, evenly from the first to the tip.
    lowest, highest
        Range of the fulcrum.
    width, density
        Of the keel.
    thickness
        By default from EI, `modulus` and `width`.
    bending
        EI; by default from `modulus`, `width` and `thickness`, else identified.
    modulus, shear_modulus
        Of the material.
    torsional
        GJ; by default from EI as of a flat section.
    twists
        Whether it turns about its long axis, by GJ.
    retardation
        Damping over stiffness; 2 ms by default, invented.
    support
        How the posterior end is held.
    sections
        Stretches of different stiffness, in order; the last one ends at the tip.
    """

    length: Keel
    posterior: Length
    joints: Annotated[StatedNumber, FootQuantity(JOINTS, bare=True, sources=SOURCES)] = USUAL_JOINTS
    lowest: Length
    highest: Length
    width: Width
    density: Density
    thickness: Thickness | None = None
    bending: Bending | None = None
    modulus: Modulus | None = None
    shear_modulus: Modulus | None = None
    torsional: Bending | None = None
    twists: bool = False
    retardation: Retardation | None = None
    support: Literal["pinned", "clamped"] = "pinned"
    sections: Annotated[tuple[KeelSection, ...], Rows] = ()


class SoleZone(Document):
    """Law of the spheres of a zone.

    Parameters
    ----------
    stiffness, damping
        Of one sphere; stiffness is in N/m^n where the exponent n is not 1, written as N/m.
    static, kinetic
        Coefficients of friction.
    """

    stiffness: Stiffness
    damping: Annotated[StatedNumber, _quantity(SOLE_DAMPING)]
    static: Friction
    kinetic: Friction


class SoleDescription(Document):
    """Spheres under the keel and their law.

    Parameters
    ----------
    spheres
        Table `px [m], py [m], pz [m], radius [m], zone` of their centres: x forward from the keel's posterior end, y up
        from its axis, z to the right.
    source
        Where these places are from.
    below
        From the keel's axis to the lowest point of the sole.
    exponent
        Of the force over depth; 1 by default.
    full_depth
        Depth from which damping acts fully; 2 mm by default.
    threshold_speed
        Speed below which what sticks creeps; 10 mm/s by default.
    zones
        Law of each zone by its name.
    """

    spheres: File
    source: Literal["paper", "derived", "invented"] = "derived"
    below: Length
    exponent: Annotated[StatedNumber, _quantity(EXPONENT)] | None = None
    full_depth: Annotated[StatedNumber, _quantity(ABOVE_GROUND)] | None = None
    threshold_speed: Annotated[StatedNumber, _quantity(CREEP)] | None = None
    zones: dict[str, SoleZone]


class FoamZone(Document):
    """Foam of a zone.

    Parameters
    ----------
    to
        Where it ends; it begins where the one before ends.
    thickness
        Of the foam.
    modulus
        Pressure over strain, or at a strain of 1.
    retardation
        Damping over stiffness.
    static, kinetic
        Coefficients of friction.
    """

    to: Length
    thickness: Annotated[StatedNumber, _quantity(FOAM)]
    modulus: Annotated[StatedNumber, _quantity(FOAM_MODULUS)]
    retardation: Annotated[StatedNumber, _quantity(FOAM_RETARDATION)]
    static: Friction
    kinetic: Friction


class FoamDescription(Document):
    """A sole of foam in place of spheres: flat columns, none of which knows its neighbours.

    Parameters
    ----------
    below
        From the keel's axis to the flat sole.
    breadth
        Of the sole.
    column
        Breadth of a column along it, nearly; 4 mm by default.
    across
        Columns side by side; 2 by default.
    exponent
        Of pressure over strain; 1 by default.
    full_depth, threshold_speed
        As those of spheres.
    zones
        Foam of each zone by its name, from the heel.
    """

    below: Length
    breadth: Width
    column: Annotated[StatedNumber, _quantity(COLUMN)] | None = None
    across: Annotated[StatedNumber, FootQuantity(ACROSS, bare=True, sources=SOURCES)] | None = None
    exponent: Annotated[StatedNumber, _quantity(EXPONENT)] | None = None
    full_depth: Annotated[StatedNumber, _quantity(ABOVE_GROUND)] | None = None
    threshold_speed: Annotated[StatedNumber, _quantity(CREEP)] | None = None
    zones: dict[str, FoamZone]


class Compression(Document):
    """A static compression of the forefoot.

    Parameters
    ----------
    name
        Its own for each.
    setting, fulcrum
        Setting of the foot, or place of its fulcrum; one of both.
    sought
        Whether the fulcrum's place is identified with the keel.
    curve
        Table with `force [N]` and `deflection [mm]`.
    stiffness, sd
        In place of a curve: force over deflection, and its standard deviation.
    """

    name: Word
    setting: Word | None = None
    fulcrum: Length | None = None
    sought: bool = False
    curve: File | None = None
    stiffness: Stiffness | None = None
    sd: Annotated[StatedNumber, _quantity(SPREAD)] | None = None

    @model_validator(mode="after")
    def _require_one_of_each(self) -> Compression:
        if (self.setting is None) == (self.fulcrum is None):
            raise refusal("needs a setting or a fulcrum", "write one of both")
        if (self.curve is None) == (self.stiffness is None):
            raise refusal("needs a curve or a stiffness", 'write curve = "soft.csv", or stiffness and sd')
        if (self.stiffness is None) != (self.sd is None):
            raise refusal("needs sd beside stiffness", "it is the standard deviation of the stiffness, for both")
        return self


class Actuator(Document):
    """What moves the fulcrum of a semi-active foot.

    Parameters
    ----------
    speed
        Without load.
    """

    speed: Annotated[StatedNumber, _quantity(ACTUATOR)]


class Bench(Document):
    """How the compressions were done.

    Parameters
    ----------
    at
        Where the plate presses on the keel; its tip by default.
    noise
        Standard deviation of one measured deflection; 0.05 mm by default.
    series
        Stiffness of all that gives besides the keel, where it is known; identified by default.
    tilt
        Of the plate against the sole, toes first; 20 degrees by default.
    travel
        Of the sole when its numbers are fitted; 5 mm by default.
    """

    at: Length | None = None
    noise: Annotated[StatedNumber, _quantity(GAUGE)] | None = None
    series: Stiffness | None = None
    tilt: Annotated[StatedNumber, _quantity(TILTED)] | None = None
    travel: Annotated[StatedNumber, _quantity(PRESSED)] | None = None


class FootDescription(Document):
    """A prosthetic foot.

    Parameters
    ----------
    name
        As sentences have it; the file's name by default.
    keel
        The keel.
    settings
        Place of the fulcrum of each setting, by its name.
    sole
        Spheres and their law; by default those of the variable-stiffness foot, stretched to the keel's length.
    foam
        Foam in place of spheres.
    actuator
        What moves the fulcrum; not known by default.
    bench
        How the compressions were done.
    compressions
        Static compressions of the forefoot.
    """

    name: Word | None = None
    keel: KeelDescription
    settings: dict[str, Length] = Field(default_factory=dict)
    sole: SoleDescription | None = None
    foam: FoamDescription | None = None
    actuator: Actuator | None = None
    bench: Bench = Field(default_factory=Bench)
    compressions: Annotated[tuple[Compression, ...], Listed("compression_{number}", doubled), Rows] = ()

    @model_validator(mode="after")
    def _require_one_sole(self) -> FootDescription:
        if self.sole is not None and self.foam is not None:
            raise refusal("has [sole] and [foam]", "keep spheres or foam", at=("foam",))
        return self


def read_foot_description(path: Path) -> FootDescription:
    """The description; InputError for what is missing or cannot be."""
    return read_document(path, FootDescription)


@dataclass(frozen=True, eq=False)
class CompressionCurve:
    """A measured compression: force [N] and deflection [m], as recorded."""

    force: Float[np.ndarray, " n"]
    deflection: Float[np.ndarray, " n"]


FEWEST = 5
"""Rows of a curve."""
HIGHEST = 2e4, 0.1
"""Force [N] and deflection [m] of a foot, at most."""


def read_compression_curve(path: Path) -> CompressionCurve:
    """A table with `force [N]` and `deflection [mm]`, in any units of theirs; InputError for what is none."""
    wanted = ("force [N]", "deflection [m]")
    table = read_side_table(path, wanted)
    for name in wanted:
        if name not in table:
            what = f"no column for {name.split()[0]} with its unit; columns are: {', '.join(map(str, table.columns))}"
            raise InputError(path, "line 1", what, "write force [N], deflection [mm]")
    force, deflection = (table[name].to_numpy(float) for name in wanted)
    if len(force) < FEWEST:
        raise InputError(path, "", f"{len(force)} rows are no curve", f"give {FEWEST} or more")
    for name, values, most in zip(wanted, (force, deflection), HIGHEST, strict=True):
        if not np.isfinite(values).all():
            raise InputError(path, name, "has an empty cell or one that is no number", "fill it or take its row out")
        if np.abs(values).max() > most:
            what = f"goes up to {np.abs(values).max():.4g}; a foot has {most:g} at most"
            raise InputError(path, name, what, "check the unit of the column")
    if not np.ptp(deflection) > 0.0 or np.corrcoef(force, deflection)[0, 1] <= 0.0:
        remedy = "give a compression with both positive; is a sign turned?"
        raise InputError(path, "", "force does not rise with deflection", remedy)
    return CompressionCurve(force, deflection)
