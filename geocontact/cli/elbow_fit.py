"""`geocontact elbow fit`: the options of the command; the work is in `elbow_fit_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

Dashed = Parameter(allow_leading_hyphen=True)
Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ElbowFitOptions:
    """Options of the identification as typed; numbers of the law in N/m, mm, N s/m, 1/mmHg.

    Parameters
    ----------
    out
        Folder for the results.
    unlocked
        Recording with the compensation joint free and its displacement, as often as there are. Where nothing else is
        known of k and the lengths, two or more set their scale.
    rotary_free
        The device's second, rotary joint was free as well in --unlocked, as in the paper: the free joint then slides by
        d_lin and not by d_tot.
    held_out
        Recording that is not fitted and tells R², as often as there are; each in turn of those fitted by default.
    known
        Numbers known from elsewhere: l=169,z=127.
    prior
        Numbers known with an uncertainty, mean:SD: l=185:10.
    bounds
        Bounds of free numbers: l=160:210,z=60:130.
    start
        Where the search begins: k=300,x=30,y=40,l=200,z=120.
    free
        Free besides k, x, y, l, z: b (damping), s (stiffness over cuff pressure).
    map
        Columns by what they are, where they have other names: beta=elbow_flexion,force=-Fx.
    angles
        Unit of the angle where its file does not say.
    unit
        Unit of the force where its file does not say.
    bin_deg
        Width of the bins that are fitted [deg].
    box_deg
        Width of the bins of the box plots [deg].
    cutoff
        Cut-off of a zero-lag low-pass over force and angle [Hz]; none unless given.
    bootstrap
        Replicates of the wild bootstrap, 0 for none. Each is searched from every minimum that fits nearly as well.
    parquet
        Also write the tables as .parquet.
    """

    out: Path
    unlocked: list[Path] | None = None
    rotary_free: Annotated[bool, Flag] = False
    held_out: list[Path] | None = None
    known: Annotated[str | None, Dashed] = None
    prior: Annotated[str | None, Dashed] = None
    bounds: Annotated[str | None, Dashed] = None
    start: Annotated[str | None, Dashed] = None
    free: str | None = None
    map: Annotated[str | None, Dashed] = None
    angles: Literal["deg", "rad"] | None = None
    unit: Literal["lbf", "N", "kN", "mN", "kgf"] | None = None
    bin_deg: float = 2.0
    box_deg: float = 10.0
    cutoff: float | None = None
    bootstrap: int = 500
    parquet: Annotated[bool, Flag] = False


def fit(recording: Path, /, *more_recordings: Path, options: ElbowFitOptions) -> int:
    """Stiffness, link and offsets of an exoskeleton from force and angle, and what these recordings cannot tell.

    Writes elbow.json, bins.csv, boxes.csv, intervals.csv, scale_line.csv, held_out.csv, figures (.png, .svg),
    report.html and run.json into OUT, with --unlocked also conditions.csv and boxes_free.csv. k, x, y, l and z are
    known up to one factor only, unless one of them comes from elsewhere.

    Parameters
    ----------
    recording
        Table of angle and force with the compensation joint locked (.csv .mot .sto .c3d): time, beta, force; pressure
        as far as it is there.
    more_recordings
        Further trials.
    """
    from geocontact.analyses.misalignment.identify.run import analyse  # numpy and friends: not for --help

    return analyse((recording, *more_recordings), options)
