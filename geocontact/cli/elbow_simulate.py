"""`geocontact elbow simulate`: the options of the command; the work is in `elbow_simulation`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

Dashed = Parameter(allow_leading_hyphen=True)
Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class SimulateOptions:
    """Options of a simulation as typed.

    Parameters
    ----------
    out
        Folder for the results.
    numbers
        Numbers of the law (N/m, mm, N s/m, 1/mmHg), as many as there are to change; the paper's
        k=222.43,x=48,y=59,l=169,z=127,b=0,s=0 unless given.
    trials
        Locked trials, and as many with the compensation joint free where --stroke-mm is given; 6 unless given.
    seconds
        Length of a trial [s]; 60 unless given.
    rate
        Samples per second; 1000 unless given.
    band
        Frequencies of the multisine [Hz]; 0.05:0.35 unless given.
    range
        Angles from end to end [deg]; 8:92 unless given.
    stroke_mm
        Stroke of the compensation joint, such as -10:40: free trials are made besides, with its displacement. None
        unless given.
    pressure
        Range of cuff pressures [mmHg], one drawn for each trial, such as 10:60; no pressure unless given.
    noise
        Standard deviation of what the person adds to the force [N]; 0.8 unless given.
    memory
        Its correlation time [s]; 0.3 unless given.
    donning_mm
        Standard deviation of both offsets from trial to trial; 0 unless given.
    bits
        Of the converter, 0 for none; 12 unless given.
    seed
        Of what is drawn at random; 0 unless given.
    map
        Column of the angle in the recordings, where it has another name: beta=elbow_flexion.
    angles
        Unit of the angle where its file does not say.
    parquet
        Also write the tables as .parquet.
    """

    out: Path
    numbers: Annotated[str | None, Dashed] = None
    trials: int | None = None
    seconds: float | None = None
    rate: float | None = None
    band: str | None = None
    range: Annotated[str | None, Dashed] = None
    stroke_mm: Annotated[str | None, Dashed] = None
    pressure: str | None = None
    noise: float | None = None
    memory: float | None = None
    donning_mm: float | None = None
    bits: int | None = None
    seed: int | None = None
    map: Annotated[str | None, Dashed] = None
    angles: Literal["deg", "rad"] | None = None
    parquet: Annotated[bool, Flag] = False


def simulate(*recordings: Path, options: SimulateOptions) -> int:
    """Forces of the explicit model along recorded angles, or synthetic recordings after the paper's experiment.

    Writes a table for each trial (locked_1.csv …, free_1.csv …, or simulated_NAME.csv for a recording), truth.json,
    surfaces.csv and a figure of the displacement over angle and offsets, report.html and run.json into OUT. The tables
    say that they are synthetic.

    Parameters
    ----------
    recordings
        Angles to simulate along (.csv .mot .sto .c3d); none to make recordings.
    """
    from geocontact.analyses.misalignment.simulate.run import simulated  # numpy and friends: not for --help

    return simulated(recordings, options)
