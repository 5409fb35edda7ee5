"""Warnings of one kind as one line: the same words about several trials, frames or numbers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

WORD = re.compile(r"[^\s,;()\"'`–…]+")
NUMBER = re.compile(r"[-−+]?\d+(\.\d+)?([eE][-−+]?\d+)?%?")
NAME = re.compile(r"(?!1/)(?=.*[^\W\d_])(?!.*\^)(.*[\d_].*|.+\.\w+)")
"""Names of trials, bodies and files: letters with a digit, an underscore or an ending, but no units such as mm^2."""
NAMED = 3
"""Names that are all written out; of more, two."""
SLOT = "\0"


def merged(lines: Sequence[str]) -> list[str]:
    """One line for each kind of warning, in the order of their first.

    Lines are of one kind where they differ in one number at most, in names (with a digit, an underscore or an ending),
    or in the one word before a first colon. Of numbers that differ the least and the largest remain, of names up to
    three. Where several numbers differ they belong together in each line, so all lines remain.

    >>> merged(["arm_1: strap is slack for 4 % of the time", "arm_2: strap is slack for 12 % of the time"])
    ['arm_1, arm_2: strap is slack for 4 … 12 % of the time (2 times)']
    >>> merged(["the surface is open"])
    ['the surface is open']
    """
    kinds: dict[str, list[list[str]]] = {}
    for line in lines:
        words, skeleton = _parted(line)
        kinds.setdefault(skeleton, []).append(words)
    return [line for skeleton, rows in kinds.items() for line in _lines(skeleton, rows)]


def first_of_each_kind(trials: Iterable[tuple[str, Sequence[str]]], noun: str = "trial") -> list[str]:
    """The first warning of each kind with the name of its trial, and of how many further ones it is.

    Parameters
    ----------
    trials
        Names with their warnings.
    noun
        What they are.

    Unlike `merged` numbers and names may differ in any way: a study of hundreds of trials has a line for each kind.

    >>> first_of_each_kind([("P1", ["rms 20 mm, 40 mm at most"]), ("P2", ["rms 22 mm, 50 mm at most"])])
    ['P1: rms 20 mm, 40 mm at most (and alike in 1 other trial)']
    """
    firsts: dict[str, str] = {}
    where: dict[str, dict[str, None]] = {}
    for name, lines in trials:
        for line in lines:
            kind = _parted(line)[1]
            firsts.setdefault(kind, f"{name}: {line}")
            where.setdefault(kind, {})[name] = None
    return [f"{line}{_others(len(where[kind]) - 1, noun)}" for kind, line in firsts.items()]


def _others(count: int, noun: str) -> str:
    return f" (and alike in {count} other {noun}{'' if count == 1 else 's'})" if count else ""


def _parted(line: str) -> tuple[list[str], str]:
    """What may differ among warnings of one kind, and the line with a slot for each of it."""
    found: list[str] = []

    def slot(match: re.Match[str]) -> str:
        word = match[0].rstrip(".:")
        ending = match[0][len(word) :]
        leads = match.start() == 0 and ending == ":"
        if not (leads or NUMBER.fullmatch(word) or NAME.fullmatch(word)):
            return match[0]
        found.append(word)
        return f"{SLOT}{'n' if NUMBER.fullmatch(word) else 'w'}{ending}"

    return found, WORD.sub(slot, line)


def _lines(skeleton: str, rows: list[list[str]]) -> list[str]:
    """One line for all rows, or one for each where more than one of their numbers differs."""
    columns = zip(re.findall(rf"{SLOT}([nw])", skeleton), zip(*rows, strict=True), strict=True)
    if sum(kind == "n" and len(set(values)) > 1 for kind, values in columns) <= 1:
        return [_line(skeleton, rows)]
    alike: dict[tuple[str, ...], list[list[str]]] = {}
    for row in rows:
        alike.setdefault(tuple(row), []).append(row)
    return [_line(skeleton, same) for same in alike.values()]


def _line(skeleton: str, rows: Sequence[Sequence[str]]) -> str:
    columns = iter(zip(*rows, strict=True))
    text = re.sub(rf"{SLOT}([nw])", lambda kind: _slot(kind[1], next(columns)), skeleton)
    if len(rows) == 1:
        return text
    stop = "." if text.endswith(".") else ""
    return f"{text.removesuffix('.')} ({len(rows)} times){stop}"


def _slot(kind: str, values: Sequence[str]) -> str:
    """The value that all have, the range of numbers, or names."""
    different = list(dict.fromkeys(values))
    if len(different) == 1:
        return different[0]
    if kind == "n":
        ordered = sorted(different, key=_number)
        least = ordered[0].removesuffix("%") if ordered[-1].endswith("%") else ordered[0]
        return f"{least} … {ordered[-1]}"
    if len(different) <= NAMED:
        return ", ".join(different)
    return f"{', '.join(different[:2])} and {len(different) - 2} others"


def _number(text: str) -> float:
    return float(text.removesuffix("%").replace("−", "-"))
