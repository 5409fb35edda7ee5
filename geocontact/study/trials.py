"""The trials of a study, from the files that a pattern fits, a table and lists of values."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path, PurePath, PureWindowsPath
from typing import Any

from geocontact.data.errors import InputError
from geocontact.io.documents import Value
from geocontact.io.text.side_table import read_side_table
from geocontact.study.description import RESERVED, StudyFile

NAME = re.compile(r"\{(\w+)\}")
TOKEN = re.compile(r"\{\{(?!\w+\}:)|\}\}|\{(\w+)\}")
"""A name in braces, or a doubled brace that stands for one; `{{name}:…}` is a file of the step that is named."""
FILE = "file"
"""Name of a trial's file, where they are found by a pattern."""
Factors = dict[str, Any]
"""Values by name, and a trial's own options under `APART`."""
APART = "[options]"


def split_pattern(pattern: str, kind: type[PurePath] = PurePath) -> tuple[str, str]:
    """Where a pattern starts, "" for the study's folder, and the rest, with / between folders on every system.

    Parameters
    ----------
    kind
        Whose paths these are: of this system, unless said. A drive or a server's share is a start on Windows only.
    """
    path = kind(pattern)
    rest = path.relative_to(path.anchor) if path.anchor else path
    return kind(path.anchor).as_posix() if path.anchor else "", rest.as_posix()


def expression_of(pattern: str, kind: type[PurePath] = PurePath) -> re.Pattern[str]:
    """What the text of a path must fit: `{name}` a part without /, the same one wherever it stands, * anything.

    `{{` and `}}` are braces.
    """
    expression, seen = "", set[str]()
    for text, name in _parts(pattern):
        expression += "[^/]*".join(map(re.escape, text.split("*")))
        if name:
            expression += f"(?P={name})" if name in seen else f"(?P<{name}>[^/]+?)"
            seen.add(name)
    alike = issubclass(kind, PureWindowsPath)  # where A.csv and a.csv are one file
    return re.compile(expression, re.IGNORECASE if alike else re.NOFLAG)


def literal(text: str) -> str:
    """The text as an option, a pattern or a file of a study names it: its braces doubled.

    `{word:…}` remains a file of an earlier step, which no path is meant by.

    >>> literal("trials {2}/a.csv")
    'trials {{2}}/a.csv'
    """
    return text.replace("{", "{{").replace("}", "}}")


def _parts(pattern: str) -> Iterator[tuple[str, str]]:
    """Texts, braces as they are meant, each with the name behind it; the last one without."""
    text, last = "", 0
    for found in TOKEN.finditer(pattern):
        text, last = text + pattern[last : found.start()], found.end()
        if found[1] is None:
            text += found[0][0]
        else:
            yield text, found[1]
            text = ""
    yield text + pattern[last:], ""


def _with_wildcards(pattern: str) -> str:
    """The pattern for `Path.glob`, which finds what fits and more; what only it takes for a wildcard is escaped.

    Wildcards side by side are one: two are refused by it in a name, and alone are folders of any depth.
    """
    parts = (re.sub(r"[\[?]", r"[\g<0>]", text) + "*" * bool(name) for text, name in _parts(pattern))
    return re.sub(r"\*{2,}", "*", "".join(parts))


def found_files(home: Path, pattern: str, study: Path) -> list[tuple[str, dict[str, str]]]:
    """Path of each file that fits, from `home` or from where the pattern starts, with what the names stand for.

    InputError where there is none.
    """
    start, rest = split_pattern(pattern, type(home))
    base = Path(start) if start else home
    expression = expression_of(rest, type(home))
    matches = sorted(each.relative_to(base).as_posix() for each in base.glob(_with_wildcards(rest)))
    fits = [(path, fit) for path in matches if (fit := expression.fullmatch(path))]
    if not fits:
        remedy = "write / between folders" if "\\" in rest else f"paths start from {base}"
        raise InputError(study, "`files`", f"no file fits {pattern!r}", remedy)
    return [((base / path).as_posix() if start else path, fit.groupdict()) for path, fit in fits]


@dataclass(frozen=True)
class CohortTrial:
    """One trial: its name, what it differs in from others, and the options of its analysis as typed."""

    name: str
    factors: Mapping[str, Value]
    options: Mapping[str, Any]


@dataclass(frozen=True)
class TrialRow:
    """One trial before any step is evaluated.

    Parameters
    ----------
    name
        What it differs in, in words.
    factors
        The same by name, swept options among them.
    given
        What `{name}` stands for in options.
    options, swept
        Of its own, and those that the study gives in turn: both of the study's own analysis.
    """

    name: str
    factors: Mapping[str, Value]
    given: Mapping[str, Value]
    options: Mapping[str, Any]
    swept: Mapping[str, Value]


@dataclass(frozen=True)
class Several:
    """What `{name}` stands for where several trials are evaluated together and differ in it."""

    values: tuple[Value, ...]


def trials_of(study: StudyFile) -> list[TrialRow]:
    """All trials, files in the order of their paths, lists as they are written, the first outermost."""
    rows: list[Factors] = [{}]
    for source, more in _sources(study):
        rows = _joined(study, source, rows, more)
    trials = [_trial(study, row) for row in _varied(study, rows)]
    found = [one for one in trials if one is not None]
    if not found:
        raise InputError(study.path, "", "every trial is left out", "see [[leave_out]]")
    return found


def _sources(study: StudyFile) -> Iterator[tuple[str, list[Factors]]]:
    if study.trials:
        yield "[[trials]]", [{**each.values, APART: each.options} for each in study.trials]
    if study.files:
        found = found_files(study.home, study.files, study.path)
        yield study.files, [{**names, FILE: path} for path, names in found]
    if study.table:
        table = read_side_table(study.home / study.table)
        yield study.table, [{str(key): value for key, value in row.items()} for row in table.to_dict("records")]


def _joined(study: StudyFile, source: str, rows: list[Factors], more: list[Factors]) -> list[Factors]:
    """Each row with what fits to it: equal in all names that both have."""
    shared = [name for name in rows[0] if name in more[0] and name != APART]
    found = [{**row, **each} for row in rows for each in more if all(str(row[n]) == str(each[n]) for n in shared)]
    lonely = [row for row in rows if not any(all(str(row[n]) == str(each[n]) for n in shared) for each in more)]
    if lonely:
        words = ", ".join(f"{name} {lonely[0][name]}" for name in shared)
        raise InputError(study.path, source, f"has no row for {words}", "add it, or leave its files out")
    return found


def _varied(study: StudyFile, rows: Iterable[Factors]) -> Iterator[tuple[Factors, Factors]]:
    """Rows with every combination of values, and with those of swept options apart."""
    for row in rows:
        for values in product(*study.vary.values()):
            varied = dict(zip(study.vary, values, strict=True))
            if all(str(row[name]) == str(value) for name, value in varied.items() if name in row):
                for swept in product(*study.sweep.values()):
                    yield {**row, **varied}, dict(zip(study.sweep, swept, strict=True))


def _trial(study: StudyFile, row: tuple[Factors, Factors]) -> TrialRow | None:
    """The trial of a row; None where it is left out."""
    given, swept = row
    own = given.get(APART, {})
    given = {name: value for name, value in given.items() if name != APART}
    reserved = next((name for name in (*given, *swept) if name in RESERVED and name != FILE), None)
    if reserved is not None:
        raise InputError(study.path, f"`{reserved}`", "is a name that every study has", "choose another one")
    factors = {**{name: value for name, value in given.items() if name != FILE}, **swept}
    for left in study.leave_out:
        if all(str(factors.get(name)) == str(value) for name, value in left.items()):
            return None
    name = " ".join(str(value) for value in factors.values()) or study.path.stem
    return TrialRow(name, factors, {**swept, **given}, own, swept)


def filled(
    study: StudyFile, name: str, value: Any, factors: Mapping[str, Value | Several], where: str = "[options]"
) -> Any:
    """A value with what `{name}` stands for; a number where it stands alone for one, several items in a list.

    `{{` and `}}` are braces.
    """
    if isinstance(value, list):
        return [each for item in value for each in _items(study, name, item, factors, where)]
    if not isinstance(value, str):
        return value
    for each in filter(None, TOKEN.findall(value)):
        known = factors.get(each)
        if known is None:
            raise InputError(
                study.path,
                f"{where} {name}".strip(),
                f"no trial has {{{each}}}",
                f"names are {', '.join(factors) or 'none'}",
            )
        if isinstance(known, Several):
            what = f"{{{each}}} stands for {len(known.values)} values"
            remedy = f'write it in a list, ["{{{each}}}"], or choose trials by `where`'
            raise InputError(study.path, f"{where} {name}".strip(), what, remedy)
    alone = NAME.fullmatch(value)
    if alone:
        return factors[alone[1]]
    return TOKEN.sub(lambda found: found[0][0] if found[1] is None else str(factors[found[1]]), value)


def _items(study: StudyFile, name: str, item: Any, factors: Mapping[str, Value | Several], where: str) -> list[Any]:
    """What an item of a list stands for."""
    alone = NAME.fullmatch(item) if isinstance(item, str) else None
    known = factors.get(alone[1]) if alone else None
    return list(known.values) if isinstance(known, Several) else [filled(study, name, item, factors, where)]
