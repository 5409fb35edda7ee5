"""A prosthetic foot as files: `foot.toml` with every number, its source and note; `spheres.csv` of one on spheres."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from geocontact.below_knee_prosthesis.foot_numbers import foot_numbers
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.sole import BY_ZONE, SHARED, Foam
from geocontact.data.parameter import SOURCES, Number

TOML, SPHERES = "foot.toml", "spheres.csv"
HEAD = "px [m],py [m],pz [m],radius [m],zone"
PLAIN = re.compile(r"[\w-]+", re.ASCII)
KEEL = {
    "length": "m",
    "posterior": "m",
    "joints": "-",
    "width": "m",
    "thickness": "m",
    "density": "kg/m^3",
    "bending": "N m^2",
    "retardation": "s",
}
ZONE = {"stiffness": "N/m", "damping": "N s/m", "static": "-", "kinetic": "-"}
FOAM = {"below": "m", "breadth": "m", "column": "m", "across": "-"}
FOAM_ZONE = {"to": "m", "thickness": "m", "modulus": "Pa", "retardation": "s", "static": "-", "kinetic": "-"}
SHARED_UNITS = {"exponent": "-", "full_depth": "m", "threshold_speed": "m/s"}


def write_foot(folder: Path, foot: VariableStiffnessFoot, compressions: Sequence[str] = ()) -> None:
    """`foot.toml` of a foot, and `spheres.csv` of one on spheres, which read back as the same.

    `compressions` are lines that follow, as the description of a foot has them.
    """
    folder.mkdir(parents=True, exist_ok=True)
    spheres = foot.sole.spheres
    rows = zip(spheres.centre.tolist(), spheres.radius.tolist(), spheres.zone, strict=True)
    table = [",".join([*map(repr, centre), repr(radius), zone]) for centre, radius, zone in rows]  # with every digit
    if foot.sole.foam is None:
        (folder / SPHERES).write_text("\n".join([HEAD, *table, ""]), encoding="utf-8", newline="\n")
    lines = [*_lines(foot), *compressions]
    (folder / TOML).write_text("\n".join(lines).strip() + "\n", encoding="utf-8", newline="\n")


def key(name: str) -> str:
    """A name as TOML has it on the left."""
    return name if PLAIN.fullmatch(name) else json.dumps(name, ensure_ascii=False)


def quantity(number: Number, unit: str) -> str:
    """`{ value, unit, source, note }` with every digit."""
    parts = [f"value = {float(number.value)!r}", f"unit = {json.dumps(unit)}"]
    if number.source in SOURCES:
        parts.append(f"source = {json.dumps(number.source)}")
    if number.note:
        parts.append(f"note = {json.dumps(number.note, ensure_ascii=False)}")
    return f"{{ {', '.join(parts)} }}"


def _lines(foot: VariableStiffnessFoot) -> Iterator[str]:
    """All tables but those of compressions."""
    keel, sections = foot.keel, foot.keel.sections
    numbers = foot_numbers(foot, keel.range[0])
    yield f"name = {json.dumps(foot.record.name, ensure_ascii=False)}"
    yield "\n[keel]"
    for name, unit in KEEL.items():
        if name != "bending" or sections.uniform:
            yield f"{name} = {quantity(numbers[f'keel {name}'], unit)}"
    gj = foot.record.origin.get("keel torsional", Number(0.0, "derived", "GJ, of a flat section"))
    yield f"torsional = {quantity(replace(gj, value=keel.torsional), 'N m^2')}"
    for name, end in zip(("lowest", "highest"), keel.range, strict=True):
        known = foot.record.origin.get(f"keel {name}", Number(end, "option"))
        yield f"{name} = {quantity(replace(known, value=end), 'm')}"
    yield f'support = "{keel.support}"'
    if keel.twists:
        yield "twists = true"
    for end, factor in zip((*sections.edges, keel.length), sections.factors, strict=True):
        if not sections.uniform:
            bending = Number(factor * keel.bending, "derived", numbers["keel bending"].note)
            yield f"\n[[keel.sections]]\nto = {quantity(Number(end, 'option'), 'm')}"
            yield f"bending = {quantity(bending, 'N m^2')}"
    yield "\n[settings]"
    for name, place in foot.record.settings.items():
        known = foot.record.origin.get(f"setting {name}", Number(place, "option"))
        yield f"{key(name)} = {quantity(replace(known, value=place), 'm')}"
    if foot.record.actuator is not None:
        known = foot.record.origin.get("actuator speed", Number(foot.record.actuator, "option"))
        yield f"\n[actuator]\nspeed = {quantity(replace(known, value=foot.record.actuator), 'm/s')}"
    yield from _spheres(foot, numbers) if foot.sole.foam is None else _foam(foot.sole.foam, numbers)


def _spheres(foot: VariableStiffnessFoot, numbers: Mapping[str, Number]) -> Iterator[str]:
    """Table of a sole of spheres."""
    places = foot.record.origin.get("sole places", Number(0.0, "derived"))
    source = places.source if places.source in SOURCES else "derived"
    yield f'\n[sole]\nspheres = "{SPHERES}"\nsource = "{source}"'
    yield f"below = {quantity(numbers['sole below'], 'm')}"
    for name in SHARED:
        yield f"{name} = {quantity(numbers[f'sole {name}'], SHARED_UNITS[name])}"
    for zone in foot.sole.spheres.zones:
        yield f"\n[sole.zones.{key(zone)}]"
        for kind in BY_ZONE:
            yield f"{kind} = {quantity(numbers[f'sole {zone}_{kind}'], ZONE[kind])}"


def _foam(foam: Foam, numbers: Mapping[str, Number]) -> Iterator[str]:
    """Table of a sole of foam."""
    yield "\n[foam]"
    for name, unit in (FOAM | SHARED_UNITS).items():
        yield f"{name} = {quantity(numbers[f'sole {name}'], unit)}"
    for zone, _ in foam.ends:
        yield f"\n[foam.zones.{key(zone)}]"
        for name, unit in FOAM_ZONE.items():
            yield f"{name} = {quantity(numbers[f'sole {zone}_{name}'], unit)}"
