"""What an identification may be asked for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import Degrees, Requires, Spelled, Typed
from geocontact.analyses.misalignment.law_numbers import MEANS, NUMBERS, TOPS, TURNING, require_names
from geocontact.analyses.misalignment.shared_options import ColumnOptions
from geocontact.data.errors import InputError
from geocontact.data.plausible import BIN

Numbers = Annotated[
    Mapping[str, float],
    Typed("-", "misalignment.law_numbers:numbers", '{"l": 0.169, "z": 0.127}'),
    Spelled(dashed=True),
    NUMBERS,
]
Spreads = Annotated[
    Mapping[str, tuple[float, float]],
    Typed("-", "misalignment.law_numbers:pairs", '{"l": gc.mm(185, 10)}'),
    Spelled(dashed=True),
    MEANS,
]
Bounds = Annotated[
    Mapping[str, tuple[float, float]],
    Typed("-", "misalignment.law_numbers:pairs", '{"l": gc.mm(160, 210)}'),
    Spelled(dashed=True),
    TOPS,
]
Names = Annotated[tuple[str, ...], Typed("-", "misalignment.law_numbers:names", '("b", "s")')]
REPLICATES = 100, 100_000
TWO_DEGREES, TEN_DEGREES = math.radians(2.0), math.radians(10.0)


@dataclass(frozen=True)
class IdentifyOptions(ColumnOptions):
    """Stiffness, link and offsets of an exoskeleton from force and angle, and what these recordings cannot identify.

    Parameters
    ----------
    recordings
        Tables of angle and force with the compensation joint locked (.csv .mot .sto .c3d): time, beta, force; as far
        as they are there also pressure, moment (of the cuff about the link's end), alpha (angle of the arm), target
        (angle to follow).

    Further recordings
    ------------------
    unlocked
        Recording with the compensation joint free and its displacement; may be repeated. Where nothing else is
        known of k and the lengths, two or more set their scale.
    rotary_free
        The device's second, rotary joint was free as well in `unlocked`, as in the paper: the free joint then slides by
        d_lin and not by d_tot.
    held_out
        Recording that is not fitted and gives R²; may be repeated. By default each of those fitted in turn.

    Numbers of the law
    ------------------
    known
        Numbers known from elsewhere (N/m, mm, N s/m, 1/mmHg, mm/N): l=169,z=127.
    prior
        Numbers known with an uncertainty, mean:SD: l=185:10.
    bounds
        Bounds of free numbers: l=160:210,z=60:130.
    start
        Where the search begins: k=300,x=30,y=40,l=200,z=120.
    free
        Additional free parameters besides k, x, y, l, z: b (damping), s (stiffness over cuff pressure), c (compliance
        of the upper arm's fixation, 0 unless known or free).

    What was measured beside the force
    ----------------------------------
    turning
        Stiffness of the cuff against turning by γ [N m/rad], part of a measured moment. By default it is identified
        from the moment.
    alpha_zeroed
        The measured angle of the arm and that of the exoskeleton have one zero: its level counts, and not only its
        change.

    scores
        Table of what was asked or scored of each trial, such as comfort or mental load: trial, comfort [-]. It and the
        tracking error, where a column target was recorded, are set beside the force.

    How it is fitted
    ----------------
    bin
        Width of the bins that are fitted.
    box
        Width of the bins of the box plots.
    bootstrap
        Replicates of the wild bootstrap, 0 for none. Each is refitted from every minimum that fits nearly as well.
    """

    writes: ClassVar[str] = """
    Writes elbow.json, bins.csv, boxes.csv, intervals.csv, scale_line.csv, held_out.csv, numbers.csv (all that ran, with
    unit and source), figures (.png, .svg), report.html and run.json into OUT, with `unlocked` also conditions.csv and
    boxes_free.csv; with a moment or an angle of the arm identifiability.csv; with a target or `scores` tracking.csv,
    tracking_conditions.csv and performance.csv. k, x, y, l and z are known up to one factor only, unless one of them
    or a moment of the cuff comes from elsewhere.
    """

    recordings: tuple[Path, ...]
    _: KW_ONLY
    unlocked: tuple[Path, ...] | None = None
    rotary_free: Annotated[bool, Requires("unlocked")] = False
    held_out: tuple[Path, ...] | None = None
    known: Numbers | None = None
    prior: Spreads | None = None
    bounds: Bounds | None = None
    start: Numbers | None = None
    free: Names | None = None
    turning: Annotated[float | None, TURNING] = None
    alpha_zeroed: bool = False
    scores: Path | None = None
    bin: Annotated[Degrees, Spelled("bin-deg", "bin_deg", default=2.0), BIN] = TWO_DEGREES
    box: Annotated[Degrees, Spelled("box-deg", "box_deg", default=10.0), BIN] = TEN_DEGREES
    bootstrap: int = 500

    def refuse_impossible(self) -> None:
        """Numbers that the law does not have, replicates that cannot be."""
        for name in ("known", "prior", "bounds", "start"):
            require_names(getattr(self, name), f"`{name}`")
        if self.bootstrap != 0 and not REPLICATES[0] <= self.bootstrap <= REPLICATES[1]:
            what = f"{self.bootstrap} is not {REPLICATES[0]} to {REPLICATES[1]}"
            raise InputError("", "`bootstrap`", what, "give 500, or 0 for none")
