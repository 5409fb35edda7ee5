"""Description of a prosthetic foot: its keel, its settings, its sole, and its compressions on a bench.

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

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from geocontact.data.parameter import SOURCES
from geocontact.io.document_errors import refusal
from geocontact.io.documents import Document, File, Listed, Rows, Word, doubled, read_document
from geocontact.io.recordings.foot_bench import Bench, Compression
from geocontact.io.recordings.foot_quantities import (
    ABOVE_GROUND,
    ACROSS,
    ACTUATOR,
    COLUMN,
    CREEP,
    EXPONENT,
    FOAM,
    FOAM_MODULUS,
    FOAM_RETARDATION,
    JOINTS,
    SOLE_DAMPING,
    USUAL_JOINTS,
    Bending,
    Density,
    FootQuantity,
    Friction,
    Keel,
    Length,
    Modulus,
    Retardation,
    Stiffness,
    Thickness,
    Width,
    quantity,
)
from geocontact.io.recordings.shoulder_device import StatedNumber


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
    damping: Annotated[StatedNumber, quantity(SOLE_DAMPING)]
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
    exponent: Annotated[StatedNumber, quantity(EXPONENT)] | None = None
    full_depth: Annotated[StatedNumber, quantity(ABOVE_GROUND)] | None = None
    threshold_speed: Annotated[StatedNumber, quantity(CREEP)] | None = None
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
    thickness: Annotated[StatedNumber, quantity(FOAM)]
    modulus: Annotated[StatedNumber, quantity(FOAM_MODULUS)]
    retardation: Annotated[StatedNumber, quantity(FOAM_RETARDATION)]
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
    column: Annotated[StatedNumber, quantity(COLUMN)] | None = None
    across: Annotated[StatedNumber, FootQuantity(ACROSS, bare=True, sources=SOURCES)] | None = None
    exponent: Annotated[StatedNumber, quantity(EXPONENT)] | None = None
    full_depth: Annotated[StatedNumber, quantity(ABOVE_GROUND)] | None = None
    threshold_speed: Annotated[StatedNumber, quantity(CREEP)] | None = None
    zones: dict[str, FoamZone]


class Actuator(Document):
    """What moves the fulcrum of a semi-active foot.

    Parameters
    ----------
    speed
        Without load.
    """

    speed: Annotated[StatedNumber, quantity(ACTUATOR)]


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
