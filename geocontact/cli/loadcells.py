"""`geocontact loadcells`: the options of the command; the work is in `loadcells_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

Dashed = Parameter(allow_leading_hyphen=True)
Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class LoadcellOptions:
    """Options of the load cells as typed.

    Parameters
    ----------
    out
        Folder for the results.
    unit
        Unit of the cells' forces, unless each column says it: PM [lbf].
    map
        Columns by cell, where they have other names: PM=posterior_medial,AM=-F2 (a minus turns the sign).
    matrix
        Weights of the cells in the medial and the lateral force (.toml or .csv) instead of the published ones.
    cycles
        stride (onset of load to onset), stance (onset to end of load), 1.7:2.8,2.8:3.9 in seconds, or a table
        style, recording, start [s], end [s].
    part
        Take this first part of each cycle for the whole: 60% is the stance of a gait cycle.
    level
        Total force [N] at which load sets in, for stride and stance; a quarter of the largest unless given.
    parquet
        Also write the tables as .parquet.
    """

    out: Path
    unit: Literal["lbf", "N", "kN", "mN", "kgf"] | None = None
    map: Annotated[str | None, Dashed] = None
    matrix: Path | None = None
    cycles: Annotated[str | None, Dashed] = None
    part: str | None = None
    level: float | None = None
    parquet: Annotated[bool, Flag] = False


def loadcells(recording: Path, /, *more_recordings: Path, options: LoadcellOptions) -> int:
    """Medial and lateral contact force of a tibial tray from its load cells, and their mean over cycles.

    Writes forces.csv, loadcells.png, loadcells.svg, report.html and run.json into OUT; with --cycles also cycles.csv,
    ensemble.csv, ensemble.png, ensemble.svg, and styles.csv where there are several gait styles.

    Parameters
    ----------
    recording
        Table of the cells over time (.csv .mot .sto): time, PM, AM, AL, PL.
    more_recordings
        Further recordings: one sub-folder each.
    """
    from geocontact.analyses.loadcells.run import analyse  # numpy and friends: not for --help

    return analyse((recording, *more_recordings), options)
