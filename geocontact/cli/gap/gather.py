"""`geocontact gap gather`."""

from __future__ import annotations

from pathlib import Path

from geocontact.analyses.gap.gather.options import GatherOptions
from geocontact.analyses.result import Result
from geocontact.cli.command import Command

HELP = """Make a gap case of recordings: pressure mats, force plates under a foot, loads of a knee, angles and moments.

Writes case.toml, trials/<id>.csv, for mats trials/<id>_<site>_cells.csv and <site>_layout.csv, the tables that
SETTINGS names, and run.json into OUT, ready for `geocontact gap diagnose OUT`.
"""


def _next(_: Result, folder: Path) -> None:
    print(f"next: geocontact gap diagnose {folder} --out …")


gather = Command(
    "geocontact.analyses.gap.gather.result:gather", GatherOptions, HELP, out="Folder for the case.", after=_next
)
