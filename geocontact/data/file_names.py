"""Names that can stand side by side as files or folders on Linux, macOS and Windows alike.

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
