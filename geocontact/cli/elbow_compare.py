"""`geocontact elbow compare`: the options of the command; the work is in `elbow_comparison`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

Dashed = Parameter(allow_leading_hyphen=True)
Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ElbowCompareOptions:
    """Options of the comparison as typed.

    Parameters
    ----------
    out
        Folder for the results.
    fit
        elbow.json of `geocontact elbow fit`: its law is simulated along each recording's angle.
    simulated
        Simulated recording instead of --fit, one for each recording, in the same order.
    stroke_mm
        Stroke of the compensation joint with --fit, such as -10:40; locked without.
    map
        Columns by what they are, where they have other names: beta=elbow_flexion,force=-Fx.
    angles
        Unit of the angle where its file does not say.
    unit
        Unit of the force where its file does not say.
    bin_deg
        Width of the bins of the picture [deg].
    cutoff
        Cut-off of a zero-lag low-pass over the measured channels [Hz]; none unless given.
    parquet
        Also write the tables as .parquet.
    """

    out: Path
    fit: Path | None = None
    simulated: list[Path] | None = None
    stroke_mm: Annotated[str | None, Dashed] = None
    map: Annotated[str | None, Dashed] = None
    angles: Literal["deg", "rad"] | None = None
    unit: Literal["lbf", "N", "kN", "mN", "kgf"] | None = None
    bin_deg: float = 2.0
    cutoff: float | None = None
    parquet: Annotated[bool, Flag] = False


def compare(recording: Path, /, *more_recordings: Path, options: ElbowCompareOptions) -> int:
    """Errors of a model of the elbow beside recordings: mean absolute, root mean square, R², by channel and trial.

    Writes comparison.csv, a figure for each channel, report.html and run.json into OUT.

    Parameters
    ----------
    recording
        Table of angle and force (.csv .mot .sto .c3d), and the free joint's displacement where it is to be compared.
    more_recordings
        Further trials.
    """
    from geocontact.analyses.misalignment.compare.run import compared  # numpy and friends: not for --help

    return compared((recording, *more_recordings), options)
