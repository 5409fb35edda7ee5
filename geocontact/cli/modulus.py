"""`geocontact modulus`: the options of the command; the work is in `modulus_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

Dashed = Parameter(allow_leading_hyphen=True)
Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ModulusOptions:
    """Options of the identification as typed.

    Parameters
    ----------
    area
        area.csv of `geocontact area`, at one or several thresholds and adduction offsets; several files are one table.
    force
        Measured forces over time (.csv .mot .sto): medial, lateral, total, as far as they are there.
    out
        Folder for the results.
    radius_mm
        Radius R of the contact in the law.
    threshold
        Threshold of the area [mm]: 4 where it was evaluated, else the only one.
    unit
        Unit of the forces, unless each column says it: total [N].
    map
        Columns by what they are, where they have other names: medial=F1,total=-Fz,flexion=knee_flexion.
    lag
        Seconds that the force's clock is behind the area's: force(t + lag) belongs to area(t). 0 unless given.
    free
        Unknown besides E*, with bounds or without: threshold=1:6,lag=-0.05:0.05,adduction=-2:2,slope=-0.3:0.3
        (mm, s, degrees, per rad of flexion).
    profile
        profile.csv of `geocontact fit` instead of --radius-mm: R follows flexion.
    flexion
        Motion (.csv .mot .sto) whose column flexion says where on the profile the contact is, or what R may follow.
    angles
        Unit of the flexion where its file does not say.
    reading
        What the area is taken for: one circle, two, a strip, a rigid cap, a rigid cap within the threshold.
    length_mm
        Length of the strip, for the reading of that name.
    poisson
        Poisson's ratio, or several, that E is told for: 0.25,0.46. E* needs none.
    calibrate
        Table force [N], area [mm^2] of measured areas: the threshold that gives them is taken.
    predict_area
        area.csv of a trial that was not used.
    predict_force
        Its measured forces.
    bootstrap
        Replicates of the block bootstrap, 0 for none; 200 at most where more than E* is free.
    parquet
        Also write the tables as .parquet.
    """

    area: list[Path]
    force: Path
    out: Path
    radius_mm: float | None = None
    threshold: str | None = None
    unit: Literal["lbf", "N", "kN", "mN", "kgf"] | None = None
    map: Annotated[str | None, Dashed] = None
    lag: Annotated[float | None, Dashed] = None
    free: Annotated[str | None, Dashed] = None
    profile: Path | None = None
    flexion: Path | None = None
    angles: Literal["deg", "rad"] | None = None
    reading: Literal["disc", "discs", "strip", "cap", "threshold"] = "disc"
    length_mm: float | None = None
    poisson: str = "0.25"
    calibrate: Path | None = None
    predict_area: list[Path] | None = None
    predict_force: Path | None = None
    bootstrap: int = 1000
    parquet: Annotated[bool, Flag] = False


def modulus(*, options: ModulusOptions) -> int:
    """Elastic modulus E* of a contact from the evolution of its area and measured forces, with intervals.

    Writes modulus.json, curves.csv, sensitivity.csv, modulus.png, modulus.svg, report.html and run.json into OUT, and
    prediction.csv with --predict-area. Area and force give one number, E* = E/(1 - nu^2): E is told for a stated nu.
    """
    from geocontact.analyses.modulus.run import analyse  # numpy and friends: not for --help

    return analyse(options)
