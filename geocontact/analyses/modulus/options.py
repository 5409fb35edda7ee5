"""What an identification of E* may be asked for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.checks import bootstrap_rule, refuse
from geocontact.analyses.frame.marks import (
    AngleUnit,
    Excludes,
    Expression,
    ForceUnit,
    Length,
    Millimetres,
    Needs,
    Requires,
    Spelled,
    Typed,
)
from geocontact.analyses.frame.options import Options
from geocontact.data.errors import InputError
from geocontact.data.plausible import ADHESION, DELAY, POISSON, RADIUS, STRIP, THRESHOLD, TURN, ByName

FREE = ByName((("threshold", THRESHOLD), ("lag", DELAY), ("adduction", TURN), ("work", ADHESION)))
Free = Annotated[
    Mapping[str, tuple[float, float] | None],
    Typed("-", "free_numbers", '{"threshold": gc.mm(1, 6), "lag": None}'),
    Spelled(dashed=True),
    FREE,
]
Ratios = Annotated[tuple[float, ...], Typed("-", "ratios", "(0.25, 0.46)"), POISSON]


@dataclass(frozen=True)
class ModulusOptions(Options):
    """Elastic modulus E* of a contact from the evolution of its area and measured forces, with intervals.

    Parameters
    ----------
    area
        area.csv of `geocontact area`, at one or several thresholds and adduction offsets; several files are one table.
    force
        Measured forces over time (.csv .mot .sto): any of medial, lateral, total.
    radius
        Radius R of the contact in the law.
    threshold
        Threshold of the area: 4 mm where it was evaluated, else the only one.

    Inputs as they are
    ------------------
    unit
        Unit of the forces, unless each column says it: total [N].
    map
        Columns by what they are, where they have other names: medial=F1,total=-Fz,flexion=knee_flexion.
    lag
        Seconds that the force's clock is behind the area's: force(t + lag) belongs to area(t). 0 by default.

    pose_draws
        pose_draws.npz of `geocontact area` with `pose_sd` or `markers`, of the same motion and thresholds: E* of the
        total gets an interval for the error of the poses as well.

    Unknowns
    --------
    free
        Additional parameters to estimate, with bounds or without:
        threshold=1:6,lag=-0.05:0.05,adduction=-2:2,slope=-0.3:0.3,work=0.001:10 (mm, s, degrees, per rad of flexion,
        J/m^2 of `adhesion`; in Python a dict of pairs in SI, None without bounds).
    profile
        profile.csv of `geocontact fit` instead of `radius`: R follows flexion.
    flexion
        Motion (.csv .mot .sto) whose column flexion says where on the profile the contact is, or what R may follow.
    angles
        Unit of the flexion where its file does not say.

    The law
    -------
    reading
        Shape assumed for the area: one circle, two, a strip, a rigid cap, a rigid cap within the threshold.
    length
        Length of the strip, for the reading of that name.
    adhesion
        dmt or jkr: bodies that stick, for the reading disc.
    work_of_adhesion
        Work of adhesion w [J/m^2] of that law; work in `free` estimates it, where forces near zero show it.
    poisson
        Poisson's ratio, or several, that E is given for: 0.25,0.46. E* needs none.

    Checks and prediction
    ---------------------
    calibrate
        Table force [N], area [mm^2] of measured areas: the threshold that gives them is taken.
    predict_area
        area.csv of a trial that was not used.
    predict_force
        Its measured forces.
    bootstrap
        Replicates of the block bootstrap, 0 for none; 200 at most where more than E* is free.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes modulus.json, curves.csv, sensitivity.csv, modulus.png, modulus.svg, report.html and run.json into OUT, and
    prediction.csv with `predict_area`. Area and force give one number, E* = E/(1 - nu^2): E is given for a stated nu.
    """

    area: Annotated[tuple[Path, ...], Spelled(keyword=True)]
    force: Annotated[Path, Spelled(keyword=True)]
    _: KW_ONLY
    radius: Annotated[Millimetres | None, Spelled("radius-mm", "radius_mm"), RADIUS] = None
    threshold: Annotated[Length | None, THRESHOLD] = None
    unit: ForceUnit | None = None
    map: Expression | None = None
    lag: Annotated[float | None, Spelled(dashed=True), DELAY] = None
    pose_draws: Path | None = None
    free: Free | None = None
    profile: Annotated[Path | None, Needs("flexion", "give both")] = None
    flexion: Path | None = None
    angles: Annotated[AngleUnit | None, Requires("flexion", "leave it out")] = None
    reading: Literal["disc", "discs", "strip", "cap", "threshold"] = "disc"
    length: Annotated[Millimetres | None, Spelled("length-mm", "length_mm"), STRIP] = None
    adhesion: Literal["dmt", "jkr"] | None = None
    work_of_adhesion: Annotated[float | None, Requires("adhesion", "say which law"), ADHESION] = None
    poisson: Annotated[Ratios, Spelled(default="0.25")] = (0.25,)
    calibrate: Annotated[Path | None, Excludes("threshold", "finds what `threshold` gives", "give one")] = None
    predict_area: tuple[Path, ...] | None = None
    predict_force: Annotated[Path | None, Requires("predict_area", "give it too")] = None
    bootstrap: int = 1000

    def refuse_impossible(self) -> None:
        """Numbers that cannot be, unknowns that no input tells of, a radius said twice or not at all."""
        if not self.poisson:
            raise InputError("", "`poisson`", "there is none", "give for example 0.46")
        self._refuse_free()
        slope, work = ("slope" in (self.free or {}), "work" in (self.free or {}))
        refuse(
            (
                (self.radius is None) == (self.profile is None),
                "`radius`",
                "or `profile`: exactly one says the radius of the contact",
                "give for example 37 mm",
            ),
            (slope and self.flexion is None, "`free`", "slope needs `flexion`", "give the motion of the areas"),
            (
                self.flexion is not None and self.profile is None and not slope,
                "`flexion`",
                "has no effect without `profile` or slope in `free`",
                "give one of them",
            ),
            (
                self.adhesion is not None and self.reading != "disc",
                "`adhesion`",
                f"needs the radius of a patch, which the reading {self.reading} has not",
                "leave out `reading`",
            ),
            (
                self.adhesion is not None and self.work_of_adhesion is None and not work,
                "`adhesion`",
                "needs `work_of_adhesion`",
                "give for example 0.05, or work in `free`",
            ),
            (work and self.adhesion is None, "`free`", "work needs `adhesion`", "say which law"),
            (self.reading == "strip" and self.length is None, "`length`", "is missing for a strip", "give it"),
            (
                self.predict_area is not None and (self.profile is not None or slope),
                "`predict_area`",
                "and a radius of flexion do not go together: its flexion is not known",
                "give `radius`",
            ),
            bootstrap_rule(self.bootstrap, 1000),
        )

    def _refuse_free(self) -> None:
        from geocontact.analyses.frame.quantities import FREE_UNITS  # numpy and friends: not for --help

        for name, bounds in (self.free or {}).items():
            if name not in FREE_UNITS:
                raise InputError("", "`free`", f"{name!r} is none of {', '.join(FREE_UNITS)}", "name one of them")
            if bounds is not None and not -math.inf < bounds[0] < bounds[1] < math.inf:
                what = f"{name}: {bounds[0]:g} to {bounds[1]:g} has no room between its bounds"
                raise InputError("", "`free`", what, "give the lower one first")
        if "threshold" in (self.free or {}) and self.calibrate is not None:
            raise InputError("", "`free`", "threshold with `calibrate` says it twice", "give one")
