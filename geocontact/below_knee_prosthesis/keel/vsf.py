"""The variable-stiffness foot of the study: its numbers, and keel, sole and law fitted to the study's three tests.

The study of gait with a below-knee amputation and a semi-active variable-stiffness foot (VSF) gives length, range of
the fulcrum, first segment, count of joints, spheres and zones, and stiffnesses in compression at low, medium and high.
It does not say where medium is, nor any number of the keel's section or of the sole.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

from geocontact.below_knee_prosthesis.keel.compression import Compressed, CompressionFit, calibrated_on_sole, fitted
from geocontact.below_knee_prosthesis.keel.foam import FoamNumbers, foam_law, foam_numbers, foam_sole
from geocontact.below_knee_prosthesis.keel.foot import FootRecord, VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.keel import Keel, torsional_stiffness
from geocontact.below_knee_prosthesis.keel.sections import Support
from geocontact.below_knee_prosthesis.keel.sole import (
    COLUMNS,
    SHARED,
    ZONES,
    Foam,
    KeelSole,
    law_of,
    sole_of,
    sole_origin,
)
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.data.parameter import Number, Source
from geocontact.loads.sphere_set import SoleLaw

SETTINGS: Mapping[str, float] = {"low": 10e3, "medium": 19e3, "high": 32e3}
"""Stiffness in compression [N/m], table 2 of the study, rounded to 1 N/mm."""
ROWS: tuple[tuple[str, float, Source, str], ...] = (
    ("length", 0.229, "paper", "sec. 2.1"),
    ("posterior", 0.066, "paper", "sec. 2.1"),
    ("joints", 8.0, "paper", "sec. 2.1; the printed lengths fit no count of segments that has eight joints"),
    ("lowest", 0.066, "paper", "sec. 2.1"),
    ("highest", 0.151, "paper", "sec. 2.1"),
    ("low_stiffness", SETTINGS["low"], "paper", "table 2"),
    ("medium_stiffness", SETTINGS["medium"], "paper", "table 2; its fulcrum is not stated"),
    ("high_stiffness", SETTINGS["high"], "paper", "table 2"),
    ("modulus", 18.6e9, "invented", "flexural modulus, usual for G10/FR4"),
    ("shear_modulus", 7.0e9, "invented", "usual for G10/FR4"),
    ("density", 1850.0, "invented", "usual for G10/FR4"),
    ("width", 0.060, "invented", "within a shoe"),
    ("retardation", 2e-3, "invented", "a loss factor of 0.013 at 1 Hz"),
)


def numbers(support: Support = "pinned") -> dict[str, Number]:
    """All numbers of the keel by name, with those that follow from compression and section."""
    found = {name: Number(value, source, note) for name, value, source, note in ROWS}
    fit = compression(support)
    thickness = (12.0 * fit.bending / (found["modulus"].value * found["width"].value)) ** (1.0 / 3.0)
    medium = fit.fulcrum(SETTINGS["medium"], found["lowest"].value, found["highest"].value)
    torsional = torsional_stiffness(found["shear_modulus"].value, found["width"].value, thickness)
    note = f"beam theory with a {support} end through low and high"
    return found | {
        "bending": Number(fit.bending, "derived", note),
        "series": Number(fit.series, "derived", f"{note}: foam, pylon, fixture"),
        "medium": Number(medium, "derived", f"{note}: where 19 N/mm are reached"),
        "thickness": Number(thickness, "derived", "from EI, width and modulus"),
        "torsional": Number(torsional, "derived", "from the section, of invented modulus and width"),
    }


def compression(support: Support = "pinned") -> CompressionFit:
    """EI and series stiffness from the ends of the range."""
    value = {name: each for name, each, _, _ in ROWS}
    low = Compressed(value["lowest"], value["low_stiffness"])
    high = Compressed(value["highest"], value["high_stiffness"])
    return fitted(low, high, value["length"], support)


def vsf_keel(support: Support = "pinned", *, joints: int = 8) -> Keel:
    """With the numbers above, or more joints."""
    value = {name: number.value for name, number in numbers(support).items()}
    return Keel(
        length=value["length"],
        posterior=value["posterior"],
        joints=joints,
        bending=value["bending"],
        torsional=value["torsional"],
        retardation=value["retardation"],
        width=value["width"],
        thickness=value["thickness"],
        density=value["density"],
        support=support,
        range=(value["lowest"], value["highest"]),
    )


def fulcrum_of(setting: str, support: Support = "pinned") -> float:
    """Fulcrum of low, medium or high [m]; KeyError for another name."""
    name = {"low": "lowest", "medium": "medium", "high": "highest"}[setting]
    return numbers(support)[name].value


NAME = "the variable-stiffness foot"
KEEL = ("length", "posterior", "joints", "width", "density", "retardation")
COMPRESSED = "fitted to 10, 19 and 32 N/mm in compression of the sole"


def vsf_record(keel: Keel, sole: KeelSole, law: SoleLaw) -> FootRecord:
    """Name, settings, and where each number of a foot with this keel and sole is from."""
    own = numbers(keel.support)
    origin = {f"keel {name}": own[name] for name in (*KEEL, "lowest", "highest")}
    forefoot = "EI, with the forefoot's stiffness"
    origin["keel bending"] = Number(keel.bending, "derived", f"{forefoot} {COMPRESSED}; {keel.support} end")
    origin["keel thickness"] = Number(keel.thickness, "derived", "from width, modulus and EI as of beam theory")
    places = {"low": own["lowest"], "medium": own["medium"], "high": own["highest"]}
    origin |= {f"setting {setting}": place for setting, place in places.items()}
    settings = {setting: place.value for setting, place in places.items()}
    return FootRecord(NAME, sole_numbers()["below"].value, settings, origin | sole_origin(sole, law))


@lru_cache(maxsize=8)
def vsf_foot(
    support: Support = "pinned", *, joints: int = 8, finer: int = 1, columns: int = COLUMNS
) -> VariableStiffnessFoot:
    """EI and the forefoot's stiffness from low, medium and high; medium where beam theory puts it.

    A plate on the sole presses 8 mm behind the tip, so that EI is less than with the plate on the tip itself. Finer
    soles are fitted anew. `finer` and `columns` as for `sole_of`.
    """
    keel = vsf_keel(support, joints=joints)
    sole = sole_of(keel, finer=finer, columns=columns)
    measured = [Compressed(fulcrum_of(name, support), stiffness) for name, stiffness in SETTINGS.items()]
    bent, law = calibrated_on_sole(keel, sole, law_of(sole), measured)
    return VariableStiffnessFoot(bent, sole, law, vsf_record(bent, sole, law))


FOAM = 0.020
"""Thickness of the foam that stands in for the spheres [m], invented."""


@lru_cache(maxsize=8)
def vsf_on_foam(column: float = 4e-3, across: int = COLUMNS) -> VariableStiffnessFoot:
    """The same foot on columns of foam, each zone as stiff and damped as its spheres, fitted to the same compressions.

    `column` is the breadth of a column along the foot [m], `across` how many lie side by side.
    """
    keel = vsf_keel()
    usual, value = sole_of(keel), {name: number.value for name, number in sole_numbers().items()}
    given, zones = law_of(usual), usual.spheres.zones
    foam = Foam(value["breadth"], column, across, tuple((zone, stop) for zone, (_, stop, _) in ZONES.items()))
    own = {}
    for zone, of in zones.items():
        start, stop, _ = ZONES[zone]
        stiff, damped = float(given.stiffness[of].sum()), float(given.damping[of].sum())
        modulus = stiff * FOAM / (value["breadth"] * (stop - start))
        own[zone] = FoamNumbers(FOAM, modulus, damped / stiff, value["static"], value["kinetic"])
    sole = foam_sole(keel, foam, value["below"], dict.fromkeys(zones, FOAM))
    law = foam_law(sole, own, *(value[name] for name in SHARED))
    measured = [Compressed(fulcrum_of(name), stiffness) for name, stiffness in SETTINGS.items()]
    bent, law = calibrated_on_sole(keel, sole, law, measured)
    return VariableStiffnessFoot(bent, sole, law, replace(_foam_record(bent, sole, law), name=f"{NAME}, on foam"))


def _foam_record(keel: Keel, sole: KeelSole, law: SoleLaw) -> FootRecord:
    """Where its numbers are from: all of the foam are invented but what the compressions say."""
    record, zones = vsf_record(keel, sole_of(keel), law_of(sole_of(keel))), foam_numbers(sole, law)
    origin = {name: number for name, number in record.origin.items() if not name.startswith("sole ")}
    known, foam = sole_numbers(), sole.foam
    origin |= {f"sole {name}": known[name] for name in ("below", "breadth", *SHARED)}
    origin["sole column"] = Number(foam.column if foam else 0.0, "invented", "how finely the foam is cut")
    origin["sole across"] = Number(float(foam.across) if foam else 0.0, "invented", "how finely the foam is cut")
    for zone, own in zones.items():
        origin[f"sole {zone}_to"] = Number(ZONES[zone][1], "invented")
        for name, number in vars(own).items():
            origin[f"sole {zone}_{name}"] = Number(number, "invented")
        origin[f"sole {zone}_modulus"] = Number(own.modulus, "invented", "as stiff as the spheres of the zone")
    front = f"sole {sole.spheres.zone[-1]}_modulus"
    origin[front] = replace(origin[front], source="derived", note=f"with EI {COMPRESSED}")
    return replace(record, origin=origin)
