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
from geocontact.study.description.summary_settings import SummarySettings, summary_of
from geocontact.study.description.surface_settings import SurfaceSettings, surface_of

LARGEST = 4_000_000
"""Bytes of a description."""
RESERVED = ("name", "file", "state", "folder", "words")
"""Names of columns that every study has, and of what a pattern of files gives."""
OWN = "options"
"""Key of one of [[trials]] under which it has options of its own."""
KEYS = ("analysis", "title", "files", "table", "trials", "options", "vary", "sweep", "leave_out", "summary", "surface")
Value = str | int | float | bool


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
