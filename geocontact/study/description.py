"""The description of a study: an analysis, its options, and what the trials differ in.

    analysis = "area"
    files = "data/{subject}/{condition}_{trial}.csv"
    table = "subjects.csv"

    [options]
    moving = "data/{subject}/femur.stl"
    fixed = "data/{subject}/tibia.stl"
    unit = "mm"
    side = "{side}"
    motion = "{file}"

    [vary]
    condition = ["slow", "fast"]

    [sweep]
    threshold = [1, 4]

    [[leave_out]]
    subject = "P3"
    condition = "fast"

Options have the names that they have in run.json or in Python, and values as on the command line. Paths are told from
the folder of the description. `{name}` stands for what a trial has under that name: from `files` (one trial for each
file that fits the pattern, `{file}` is its path), from the columns of `table`, from `[vary]` (all combinations).
`[sweep]` names options and gives their values, all combinations. What several of them name must agree. Trials that need
options of their own are listed one by one:

    [[trials]]
    subject = "P1"
    options = { motion = "P1.sto", map = "rz=knee_flexion,ty=knee_ty", angles = "rad" }
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.io.text.toml_text import numbers_in, toml_of
from geocontact.io.text.units import LENGTH

SUMMARY_KEYS = ("table", "columns", "over", "where", "subject", "condition")
SURFACE_KEYS = ("particles", "unit", "body", "at")
BODIES = ("fixed", "moving")
LARGEST = 4_000_000
"""Bytes of a description."""
RESERVED = ("name", "file", "state", "folder", "words")
"""Names of columns that every study has, and of what a pattern of files gives."""
OWN = "options"
"""Key of one of [[trials]] under which it has options of its own."""
KEYS = ("analysis", "title", "files", "table", "trials", "options", "vary", "sweep", "leave_out", "summary", "surface")
Value = str | int | float | bool


@dataclass(frozen=True)
class SummarySettings:
    """Which curves are compared, and between whom.

    Parameters
    ----------
    table
        Name of the table; the first one over time unless given.
    columns
        Of numbers, with their units; the first few unless given.
    over
        Column that a curve is over; its span is 0 to 100 % of the curve.
    where
        Values of columns that choose the rows of a curve, such as one threshold of several; the first unless given.
    subject
        Name under which a trial has its subject: trials of one are averaged before subjects are compared.
    condition
        Name under which a trial has what is compared.
    """

    table: str = ""
    columns: tuple[str, ...] = ()
    over: str = "time [s]"
    where: Mapping[str, float | str] = field(default_factory=dict)
    subject: str = "subject"
    condition: str = "condition"


def summary_of(path: Path, told: Mapping[str, Any]) -> SummarySettings:
    """From [summary] of a study's description."""
    odd = [key for key in told if key not in SUMMARY_KEYS]
    if odd:
        raise InputError(path, f"[summary] {odd[0]}", "is not known here", f"write {', '.join(SUMMARY_KEYS)}")
    texts = {key: told[key] for key in ("table", "over", "subject", "condition") if key in told}
    for key, value in texts.items():
        if not isinstance(value, str):
            raise InputError(path, f"[summary] {key}", f"{value!r} is no text", "write it in quotes")
    columns, where = told.get("columns", []), told.get("where", {})
    if not isinstance(columns, list) or not all(isinstance(each, str) for each in columns):
        raise InputError(path, "[summary] columns", "is no list of names", 'write columns = ["area_fixed [mm^2]"]')
    if not isinstance(where, dict) or not all(isinstance(each, (str, int, float)) for each in where.values()):
        raise InputError(path, "[summary] where", "is no table", 'write where = { "threshold [mm]" = 4 }')
    return SummarySettings(columns=tuple(columns), where=where, **texts)


@dataclass(frozen=True)
class SurfaceSettings:
    """What [surface] of a study says.

    Parameters
    ----------
    particles
        Path of a trial's .particles, from the study's folder; may hold `{name}`.
    unit
        Of these files.
    body
        On which they lie: fixed or moving.
    at
        Places on the curve [%]; distances are interpolated linearly between frames.
    """

    particles: str
    unit: str
    body: str = "fixed"
    at: tuple[float, ...] = (0.0, 25.0, 50.0, 75.0, 100.0)


def surface_of(
    path: Path, told: Mapping[str, Any], analysis: str, options: Mapping[str, Any]
) -> SurfaceSettings | None:
    """From [surface] of a study's description; None where there is none."""
    if not told:
        return None
    odd = next((key for key in told if key not in SURFACE_KEYS), None)
    if odd is not None:
        raise InputError(path, f"[surface] {odd}", "is not known here", f"write {', '.join(SURFACE_KEYS)}")
    if analysis != "area" or not options.get("save_map"):
        remedy = 'write analysis = "area", and save_map = true in [options]'
        raise InputError(path, "[surface]", "needs the distances of every vertex", remedy)
    particles, unit, body = told.get("particles"), told.get("unit"), told.get("body", "fixed")
    if not isinstance(particles, str) or not particles:
        raise InputError(path, "[surface]", "no `particles`", 'write particles = "{subject}/talus.particles"')
    if unit not in LENGTH:
        raise InputError(path, "[surface] unit", f"{unit!r} is none of length", f"write one of {', '.join(LENGTH)}")
    if body not in BODIES:
        raise InputError(path, "[surface] body", f"{body!r} is no body", f"write {' or '.join(BODIES)}")
    return SurfaceSettings(particles, str(unit), str(body), _places(path, told.get("at", list(SurfaceSettings.at))))


def _places(path: Path, given: Any) -> tuple[float, ...]:
    numbers = isinstance(given, list) and all(isinstance(x, int | float) and not isinstance(x, bool) for x in given)
    if not numbers or not given or not all(0.0 <= x <= 100.0 for x in given) or len(set(given)) < len(given):
        raise InputError(path, "[surface] at", f"{given!r} are no places from 0 to 100 %", "write at = [0, 50, 100]")
    return tuple(float(x) for x in given)


@dataclass(frozen=True)
class StudyFile:
    """What is written there.

    Parameters
    ----------
    path
        Of the file.
    analysis
        As its command is typed.
    options
        By name; texts may hold `{name}`.
    files
        Pattern of paths, "" where there is none.
    table
        File with a row for each trial or subject, "" where there is none.
    trials
        Those that are listed one by one: values by name, and options of their own under `options`.
    vary, sweep
        Values by name: of what trials differ in, and of options.
    leave_out
        Values by name, of trials that are not evaluated.
    summary
        What the page and the statistics are about.
    surface
        Points that correspond from subject to subject, None where there are none.
    """

    path: Path
    analysis: str
    title: str
    options: Mapping[str, Any]
    files: str = ""
    table: str = ""
    trials: tuple[Mapping[str, Any], ...] = ()
    vary: Mapping[str, tuple[Value, ...]] = field(default_factory=dict)
    sweep: Mapping[str, tuple[Value, ...]] = field(default_factory=dict)
    leave_out: tuple[Mapping[str, Value], ...] = ()
    summary: SummarySettings = field(default_factory=SummarySettings)
    surface: SurfaceSettings | None = None

    @property
    def home(self) -> Path:
        """Folder that paths in it start from."""
        return self.path.resolve().parent


def read_study_file(path: Path) -> StudyFile:
    """The description; InputError for what is missing or cannot be."""
    content = toml_of(path, LARGEST)
    odd = [key for key in content if key not in KEYS]
    if odd:
        raise InputError(path, f"`{odd[0]}`", "is not known here", f"write {', '.join(KEYS)}")
    for place, value in numbers_in(content):
        if not math.isfinite(value):
            raise InputError(path, place, f"is {value}", "write a number")
    analysis = content.get("analysis")
    if not isinstance(analysis, str) or not analysis:
        raise InputError(path, "", "no `analysis`", 'write for example analysis = "area"')
    texts = {key: content.get(key, "") for key in ("title", "files", "table")}
    for key, value in texts.items():
        if not isinstance(value, str):
            raise InputError(path, f"`{key}`", f"{value!r} is no text", "write it in quotes")
    return StudyFile(
        path,
        analysis,
        texts["title"] or path.stem.replace("_", " "),
        _table(path, content, "options"),
        texts["files"],
        texts["table"],
        _listed(path, content.get("trials", [])),
        _values(path, content, "vary"),
        _values(path, content, "sweep"),
        _left_out(path, content.get("leave_out", [])),
        summary_of(path, _table(path, content, "summary")),
        surface_of(path, _table(path, content, "surface"), analysis, _table(path, content, "options")),
    )


def _table(path: Path, content: Mapping[str, Any], key: str) -> dict[str, Any]:
    found = content.get(key, {})
    if not isinstance(found, dict):
        raise InputError(path, f"[{key}]", "is no table", f"write [{key}] and names with values below")
    return found


def _values(path: Path, content: Mapping[str, Any], key: str) -> dict[str, tuple[Value, ...]]:
    found = {}
    for name, values in _table(path, content, key).items():
        if not isinstance(values, list) or not values or not all(isinstance(each, Value) for each in values):
            raise InputError(path, f"[{key}] {name}", "is no list of values", f'write {name} = ["one", "other"]')
        if len(set(map(str, values))) < len(values):
            raise InputError(path, f"[{key}] {name}", "has a value twice", "give each once")
        found[name] = tuple(values)
    return found


def _listed(path: Path, given: Any) -> tuple[Mapping[str, Any], ...]:
    """[[trials]]: the same names in each, with values; options of their own in some."""
    remedy = "write [[trials]] and names with values below, options = { … } among them"
    if not isinstance(given, list) or not all(isinstance(each, dict) and each for each in given):
        raise InputError(path, "[[trials]]", "is no list of tables", remedy)
    for number, trial in enumerate(given, 1):
        place = f"[[trials]] {number}"
        names = [name for name in trial if name != OWN]
        for name in names:
            if not isinstance(trial[name], Value):
                raise InputError(path, f"{place} {name}", "is no value", remedy)
        if not isinstance(trial.get(OWN, {}), dict):
            raise InputError(path, f"{place} {OWN}", "is no table", remedy)
        differing = set(names) ^ {name for name in given[0] if name != OWN}
        if differing:
            what = f"{min(differing)!r} is not in all of them"
            raise InputError(path, place, what, "give every trial the same names")
    return tuple(given)


def _left_out(path: Path, given: Any) -> tuple[Mapping[str, Value], ...]:
    if not isinstance(given, list) or not all(isinstance(each, dict) and each for each in given):
        raise InputError(
            path, "[[leave_out]]", "is no list of tables", "write [[leave_out]] and names with values below"
        )
    return tuple(given)
