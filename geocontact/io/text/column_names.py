"""Names of columns, for which upper and lower case are one where that leaves no doubt."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from difflib import SequenceMatcher

ALIKE = 0.82
"""Smallest ratio of difflib's between names that are taken to be one, without case and punctuation."""
MOST = 0.6
"""Part of the longer name that the shorter one is where it is its beginning: R.Knee.Lat and R_Knee_Lateral."""


def near_names(wanted: Sequence[str], there: Sequence[str]) -> dict[str, str]:
    """Names that are there by the wanted ones that they are like, each at most once.

    Left is never right: names of which one begins or ends with l and the other with r are not alike, and numbers must
    be the same.
    """
    pairs = [(_alike(one, other), k, m) for k, one in enumerate(wanted) for m, other in enumerate(there)]
    found: dict[str, str] = {}
    for ratio, k, m in sorted(pairs, key=lambda pair: (-pair[0], pair[1], pair[2])):
        if ratio >= ALIKE and wanted[k] not in found and there[m] not in found.values():
            found[wanted[k]] = there[m]
    return found


def _alike(one: str, other: str) -> float:
    a, b = _bare(one), _bare(other)
    if a == b:
        return 1.0 if a else 0.0
    if not a or not b or re.findall(r"\d+", a) != re.findall(r"\d+", b):
        return 0.0
    if {"l", "r"} in ({a[0], b[0]}, {a[-1], b[-1]}) or any((side in a) != (side in b) for side in ("left", "right")):
        return 0.0
    part = min(len(a), len(b)) / max(len(a), len(b))
    if part >= MOST and (a.startswith(b) or b.startswith(a)):
        return max(ALIKE, part)
    return SequenceMatcher(None, a, b).ratio()


def _bare(name: str) -> str:
    """Without what stands before a colon, case and everything but letters and digits."""
    return re.sub(r"[^a-z0-9]", "", name.rpartition(":")[2].lower())


class ColumnNames(tuple[str, ...]):
    """Names in the order of a table; one that is asked for is found as it is written, else without regard to case."""

    __slots__ = ()

    def __contains__(self, name: object) -> bool:
        """Whether there is a column of that name."""
        return self.count(name) > 0

    def count(self, name: object) -> int:
        """How many columns of that name there are."""
        return super().count(name) or len(self._alike(name))

    def index(self, name: object, *limits: int) -> int:  # type: ignore[override]  # typeshed: SupportsIndex
        """Place of the column; ValueError where there is none, or more than one by its letters alone."""
        alike = [] if super().count(name) else self._alike(name)
        return alike[0] if len(alike) == 1 else super().index(name, *limits)

    def _alike(self, name: object) -> list[int]:
        asked = name.casefold() if isinstance(name, str) else None
        return [place for place, own in enumerate(self) if own.casefold() == asked]


def spelled_as(wanted: Iterable[str], given: Iterable[str]) -> Mapping[str, str]:
    """Those of the names that are wanted and written otherwise, by how they are written."""
    names = ColumnNames(given)
    return {names[names.index(name)]: name for name in wanted if names.count(name) == 1}
