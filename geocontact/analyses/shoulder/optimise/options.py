"""What a support profile may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import C3dUnit, Expression, Requires, Spelled
from geocontact.analyses.frame.options import Options
from geocontact.analyses.shoulder.shared_options import TORQUE_RATE, Share, require_share
from geocontact.data.errors import InputError
from geocontact.data.plausible import CUTOFF, GAP, LEFT, LIMIT, MOST_OF

FEWEST_DRAWS = 20


@dataclass(frozen=True)
class ShoulderOptimiseOptions(Options):
    """Support for each work phase, hand and task that unloads the shoulder most and never pushes the arm up.

    Parameters
    ----------
    study
        Tasks, persons and trials (.toml, with marker files and currents of the tool); without it the synthetic
        participants at work without the device.
    device
        lucy, lucy_new_cylinder (32 mm, 12.8 N m), lucy_new_cylinder_massless, or a file (.toml) with numbers.

    Objective
    ---------
    aim
        Share of the shoulder's torque that support takes away: its mean over persons, its worst person, or the
        mean over the worst cases (conditional value at risk).
    worst_share
        Share of all cases that are the worst; 25% by default.
    force_limit
        Largest force at the interface [N]; none by default.
    rate_limit
        Largest rate of the support torque [N m/s]; none by default.
    reserve
        Share of the torque that is left to the shoulder at every moment, such as 10%: a margin for other persons.
    certainty
        Share of the draws of the model's errors (weight of the arm, push, elevation, sensors) in which no arm may be
        pushed up; 95% where no reserve is given, 0% leaves them out.
    scale
        arm: each person's factors in proportion to the weight of the person's arm, and factors that are the same for
        all; held-out persons get the others' factors, scaled. none: the same for everybody.
    dominant_share
        Part of the push on the tool that the dominant hand exerts, where the study does not say: 100% by default.

    Validation
    ----------
    draws
        Draws of the model's errors for each person that is held out.
    seed
        Seed of the draws.

    The motion
    ----------
    cutoff
        Zero-lag low-pass of the markers [Hz].
    gap_limit
        Longest time for which a marker may be out of sight [s].
    markers_map
        Names of recorded markers as they are called here: R_UP=humerus_rup, or a file with a pair in each line; of all
        trials.
    axes
        Which of the markers' axes are x, y (upwards) and z of OpenSim's, of all trials: x,z,-y where z is up.
    c3d_unit
        Unit of places in .c3d files whose own, POINT:UNITS, is empty.
    """

    writes: ClassVar[str] = """
    Writes factors.csv (best, one factor for all, the paper's, each person's, by arm weight), scales.csv, simulated.csv,
    outcomes.csv (planned), held_out.csv (leave-one-person-out validation, with intervals), front.csv, a figure,
    report.html and run.json into OUT.
    """

    study: Annotated[Path | None, Spelled(keyword=True)] = None
    _: KW_ONLY
    device: str = "lucy_new_cylinder"
    aim: Literal["mean", "worst", "cvar"] = "mean"
    worst_share: Annotated[Share | None, LEFT] = None
    force_limit: Annotated[float | None, LIMIT] = None
    rate_limit: Annotated[float | None, TORQUE_RATE] = None
    reserve: Annotated[Share, LEFT, Spelled(default="0%")] = 0.0
    certainty: Annotated[Share | None, MOST_OF] = None
    scale: Literal["arm", "none"] = "arm"
    dominant_share: Annotated[Share, Spelled(default="100%")] = 1.0
    draws: int = 200
    seed: int = 0
    cutoff: Annotated[float, CUTOFF] = 6.0
    gap_limit: Annotated[float, GAP] = 0.2
    markers_map: Annotated[str | None, Requires("study")] = None
    axes: Annotated[Expression | None, Requires("study")] = None
    c3d_unit: C3dUnit = None

    def refuse_impossible(self) -> None:
        """Shares that are none, too few draws for an interval, a share that has no effect."""
        require_share(self.reserve, "reserve", "10%")
        require_share(self.dominant_share, "dominant_share", "10%")
        if self.certainty is not None:
            require_share(self.certainty, "certainty", "95%")
        if self.reserve >= 1.0:
            raise InputError("", "`reserve`", "100 % leaves no support", "give less")
        if self.worst_share is not None and self.aim != "cvar":
            raise InputError("", "`worst_share`", f"has no effect with `aim` {self.aim}", "give `aim` cvar")
        if self.worst_share is not None and not 0.0 < self.worst_share <= 1.0:
            raise InputError("", "`worst_share`", "is not more than 0 and at most 100 %", "give for example 25%")
        if self.draws < FEWEST_DRAWS:
            what = f"{self.draws} draws are too few for an interval"
            raise InputError("", "`draws`", what, f"give {FEWEST_DRAWS} or more")
        if self.cutoff == 0.0:
            raise InputError("", "`cutoff`", "0 leaves the noise in the accelerations", "give for example 6")
