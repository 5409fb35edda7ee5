"""Names of columns, for which upper and lower case are one where that leaves no doubt."""

from __future__ import annotations

from collections.abc import Iterable, Mapping


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
