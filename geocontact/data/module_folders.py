"""Where a Python process that this one starts looks for modules: where this one does, but not in the current folder."""

from __future__ import annotations

import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
"""The folder that holds the package."""


def module_folders() -> list[str]:
    """Folders in which this process looks for modules, in its order, and the package's own.

    The current folder is left out, whoever added it, unless it holds the package: a module of somebody else's that lies
    beside the data is not run. Entries that are no folder, such as those of an editable installation, stay as they are.
    Of a current folder that was removed nothing is looked for either.
    """
    found = []
    try:
        here = os.path.realpath(os.curdir)
    except FileNotFoundError:
        here = ""
    for entry in sys.path if here else filter(os.path.isabs, sys.path):
        place = os.path.realpath(entry or os.curdir)
        if place == str(ROOT) or place != here:
            found.append(os.path.abspath(entry or os.curdir) if os.path.exists(place) else entry)
    return list(dict.fromkeys([*found, str(ROOT)]))


def searching(program: str) -> str:
    """The text of a program that looks for modules in these folders, from its first import on.

    Given to it this way and not as PYTHONPATH, which Python's own beginning searches for a sitecustomize.py.
    """
    return f"import sys\nsys.path[:] = {module_folders()!r}\n{program}"
