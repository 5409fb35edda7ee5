"""Names that can be files on every system, and times as text.

Results are passed on: a folder written on one system is read on another. Windows keeps a few names for devices,
whatever follows them after a dot, and drops dots and blanks at the end of a name; Windows and macOS take names that
differ in capitals alone for one, and macOS two ways to write the same accented letter.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable

DEVICES = frozenset(
    {"con", "prn", "aux", "nul", "conin$", "conout$"}
    | {f"{port}{number}" for port in ("com", "lpt") for number in "123456789¹²³"}
)
"""Names that Windows keeps for itself (Microsoft, "Naming files, paths, and namespaces")."""


def cannot_be_named(name: str) -> bool:
    """Whether some system refuses a file or folder of that name, or changes the name."""
    return not name or name[-1] in ". " or name.partition(".")[0].rstrip().lower() in DEVICES


def same_place(names: Iterable[str]) -> str | None:
    """The first name that some system takes for one that came before it; None where all of them are apart."""
    seen: set[str] = set()
    for name in names:
        key = unicodedata.normalize("NFC", unicodedata.normalize("NFC", name).casefold())
        if key in seen:
            return name
        seen.add(key)
    return None


DECIMALS = 6
"""Decimals of a second, at least: clocks that count from 1970 leave none of nine digits and two of twelve."""


def is_late(value: float, digits: int) -> bool:
    """Whether so many digits would lose microseconds of a time [s]."""
    return bool(abs(value) >= 10.0 ** (digits - DECIMALS))


def seconds(value: float, digits: int = 12) -> str:
    """A time [s] with so many digits, and with microseconds where these are not enough."""
    if not is_late(value, digits):
        return f"{value:.{digits}g}"
    return f"{value:.{DECIMALS}f}".rstrip("0").rstrip(".")
