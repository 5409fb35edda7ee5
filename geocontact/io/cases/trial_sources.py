"""`[from.<trial>]` of gather.toml: the files that the channels of one trial come from."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.io.cases.storage_trial import is_storage

EXAMPLE = '[from.t01] with inputs = "t01.csv" and outputs = "t01_measured.csv" or SITE = "results/t01_site"'
GOES_WITH = {"plate": "plates", "belt": "plates", "areas": "forces", "threshold": "areas", "force_unit": "forces"}
"""A key that says nothing without another."""
NUMBERS = ("belt", "threshold")
WORDS = ("inputs", "outputs", "plates", "plate", "areas", "forces", "force_unit")


@dataclass(frozen=True)
class PlateSource:
    """What a foot stands on: a file of force plates, which of them, and how fast its ground runs backwards [m/s]."""

    file: Path
    plate: str | None
    belt: float


@dataclass(frozen=True)
class SidesSource:
    """What loads a knee: area.csv and its threshold [m], forces by side and their unit; None where there is one only.

    Without a file of areas they are among the inputs.
    """

    areas: Path | None
    threshold: float | None
    forces: Path
    unit: str | None


@dataclass(frozen=True)
class Source:
    """Where one trial comes from: the file of its inputs, and what is measured beside them.

    `outputs` is a .mot or .sto file, or a .csv table with units like that of a trial.
    """

    inputs: Path
    outputs: Path | None
    mats: Mapping[str, Path]
    plate: PlateSource | None
    sides: SidesSource | None


def source_of(path: Path, trial: str, given: Any) -> Source:
    """Source of a trial from its table in the file `path`; paths in it are meant from the folder of that file."""
    place = f"[from.{trial}]"
    if not isinstance(given, dict) or "inputs" not in given or len(given) < 2:
        raise InputError(path, place, "names no inputs and no mat, plates, forces or outputs", f"write {EXAMPLE}")
    for key, value in given.items():
        _check(path, f"{place} {key}", key, value)
    for key, other in GOES_WITH.items():
        if key in given and other not in given:
            raise InputError(path, f"{place} {key}", f"says nothing without {other}", f"name the file of {other}")
    sites = {key: path.parent / value for key, value in given.items() if key not in (*NUMBERS, *WORDS)}
    plate = sides = None
    if "plates" in given:
        plate = PlateSource(path.parent / given["plates"], given.get("plate"), float(given.get("belt", 0.0)))
    if "forces" in given:
        areas = path.parent / given["areas"] if "areas" in given else None
        sides = SidesSource(areas, given.get("threshold"), path.parent / given["forces"], given.get("force_unit"))
    outputs = path.parent / given["outputs"] if "outputs" in given else None
    if outputs is not None and not is_storage(outputs) and outputs.suffix.lower() != ".csv":
        remedy = "give a .mot, .sto or .csv file"
        raise InputError(path, f"{place} outputs", f"'{outputs.suffix}' is not read here", remedy)
    return Source(path.parent / given["inputs"], outputs, sites, plate, sides)


def _check(path: Path, place: str, key: str, value: Any) -> None:
    if key in NUMBERS:
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise InputError(path, place, f"is {value!r:.60}", "write a number in SI units")
        return
    if not isinstance(value, str) or not value.strip():
        raise InputError(path, place, f"is {value!r:.60}", "write a path in quotes")
    if not key.isidentifier():
        raise InputError(path, place, "is no name of a site", "letters, digits and _")
