"""Consent to start what a file names: a case, a study or a run.json may come from somebody else.

`geocontact rerun` and `geocontact cohort` take options from a file. A program or a module of Python that a file names
is started only where the call itself says so, and is named before.
"""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike

from geocontact.data.errors import InputError

SHOWN = 3
"""So many of what would be started are named in one line."""
LONGEST = 100
OWN = "geocontact"
ALLOWED = "run_simulator"
"""Option of analyses and of studies that lets a file name what is started."""


def foreign(reference: str) -> bool:
    """Whether "package.module:OBJECT" leads out of this package, so that importing it runs code of others."""
    return ":" in reference and reference.partition(":")[0].partition(".")[0] != OWN


def require_consent(named: Iterable[str], allowed: bool, file: str | PathLike[str]) -> str:
    """Words that name what is started, "" where nothing is; InputError unless that is allowed.

    Parameters
    ----------
    named
        What files name, each in words.
    allowed
        Whether the call itself allows it.
    file
        What the options were read from.
    """
    some = list(dict.fromkeys(each if len(each) <= LONGEST else f"{each[:LONGEST]}…" for each in named))
    if not some:
        return ""
    words = ", ".join(some[:SHOWN]) + (f" and {len(some) - SHOWN} more" if len(some) > SHOWN else "")
    if not allowed:
        raise InputError(file, "", f"would start {words}", "pass `run_simulator` if you trust it")
    return f"starts {words}"
