"""What a simulation of an exoskeleton may be asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import (
    AngleUnit,
    Degrees,
    Excludes,
    Expression,
    Millimetres,
    Requires,
    Spelled,
    Typed,
)
from geocontact.analyses.frame.options import Options
from geocontact.analyses.misalignment.law_numbers import (
    ANGLE_NOISE,
    MOMENT_NOISE,
    NUMBERS,
    TORQUE,
    TURNING,
    require_names,
)
from geocontact.analyses.misalignment.shared_options import (
    Stroke,
    require_at_least_0,
    require_rising,
    require_span,
    require_stroke,
    require_within,
)
from geocontact.data.errors import InputError
from geocontact.data.plausible import BAND, CUFF, LENGTH_OF_TRIAL, MEMORY, NOISE, RATE, SHIFT, Plausible
from geocontact.data.text import same_place
from geocontact.data.units import deg

ELBOW = Plausible("an angle of an elbow", deg, (-30.0, 180.0))
ALONG = Excludes("recordings", "has no effect along a recording")
Numbers = Annotated[
    Mapping[str, float],
    Typed("-", "misalignment.law_numbers:numbers", '{"l": 0.169, "z": 0.127}'),
    Spelled(dashed=True),
    NUMBERS,
]
Band = Annotated[tuple[float, float], Typed("Hz", "misalignment.law_numbers:pair", "(0.05, 0.35)"), BAND]
Angles = Annotated[
    tuple[float, float], Typed("rad", "misalignment.law_numbers:degrees", "gc.deg(8, 92)"), Spelled(dashed=True), ELBOW
]
Pressures = Annotated[tuple[float, float], Typed("Pa", "misalignment.law_numbers:mercury", "gc.mmHg(10, 60)"), CUFF]
FEWEST = 4
"""Trials of a gap case: two to fit to, two held out."""


@dataclass(frozen=True)
class SimulateOptions(Options):
    """Forces of the explicit model along recorded angles, or synthetic recordings after the paper's experiment.

    Parameters
    ----------
    recordings
        Angles to simulate along (.csv .mot .sto .c3d); none to make recordings.

    The law
    -------
    numbers
        Numbers of the law (N/m, mm, N s/m, 1/mmHg, mm/N), as many as there are to change; the paper's
        k=222.43,x=48,y=59,l=169,z=127,b=0,s=0,c=0 by default. c is the compliance of the upper arm's fixation.
    turning
        Stiffness of the cuff against turning by γ, the angle between link and forearm [N m/rad]; part of the moment.
    torque
        Torque of the actuator about the exoskeleton's axis, flexion positive [N m], in place of a column torque; the
        tables then say what the joint has of it. None by default.

    The experiment
    --------------
    trials
        Locked trials, and as many with the compensation joint free where `stroke` is given; 6 by default.
    seconds
        Length of a trial [s]; 60 by default.
    rate
        Samples per second; 1000 by default.
    band
        Frequencies of the multisine [Hz]; 0.05:0.35 by default.
    range
        Angles from end to end [deg]; 8:92 by default.
    stroke
        Stroke of the compensation joint, such as -10:40: free trials are made as well, with its displacement. None
        by default.
    case
        Also write the locked trials as a gap case (folder case) that `geocontact gap diagnose` reads.
    pressure
        Range of cuff pressures [mmHg], one drawn for each trial, such as 10:60; no pressure by default.
    bits
        Bits of the converter, 0 for none; 12 by default.

    What is drawn at random
    -----------------------
    noise
        Standard deviation of what the person adds to the force [N]; 0.8 by default.
    memory
        Its correlation time [s]; 0.3 by default.
    donning
        Standard deviation of both offsets from trial to trial; 0 by default.
    moment_noise
        Standard deviation of a sensor of the cuff's moment [N m]; with it the trials have a column moment. None by
        default.
    alpha_noise
        Standard deviation of a sensor of the arm's angle [deg]; with it the trials have a column alpha. None by
        default.
    seed
        Seed of the random draws; 0 by default.

    Columns and units
    -----------------
    map
        Columns of the recordings that have other names, of beta, pressure and torque: beta=elbow_flexion,torque=-motor.
    angles
        Unit of the angle where its file does not say.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes a table for each trial (locked_1.csv …, free_1.csv …, or simulated_NAME.csv for a recording), truth.json,
    numbers.csv with the source of every number, surfaces.csv and a figure of the displacement over angle and offsets,
    report.html and run.json into OUT. The tables say that they are synthetic.
    """

    recordings: tuple[Path, ...] = ()
    _: KW_ONLY
    numbers: Numbers | None = None
    turning: Annotated[float, TURNING] = 0.0
    torque: Annotated[float | None, TORQUE, Spelled(dashed=True)] = None
    trials: Annotated[int | None, ALONG] = None
    seconds: Annotated[float | None, ALONG, LENGTH_OF_TRIAL] = None
    rate: Annotated[float | None, ALONG, RATE] = None
    band: Annotated[Band | None, ALONG] = None
    range: Annotated[Angles | None, ALONG] = None
    stroke: Stroke | None = None
    case: Annotated[bool, ALONG] = False
    pressure: Annotated[Pressures | None, ALONG] = None
    noise: Annotated[float | None, ALONG, NOISE] = None
    memory: Annotated[float | None, ALONG, MEMORY] = None
    donning: Annotated[Millimetres | None, Spelled("donning-mm", "donning_mm"), ALONG, SHIFT] = None
    moment_noise: Annotated[float | None, ALONG, MOMENT_NOISE] = None
    alpha_noise: Annotated[Degrees | None, Spelled("alpha-noise-deg", "alpha_noise_deg"), ALONG, ANGLE_NOISE] = None
    bits: Annotated[int | None, ALONG] = None
    seed: Annotated[int | None, ALONG] = None
    map: Annotated[Expression | None, Requires("recordings")] = None
    angles: Annotated[AngleUnit | None, Requires("recordings")] = None

    def refuse_impossible(self) -> None:
        """Two recordings of one name, and values that cannot be."""
        twice = same_place(path.stem for path in self.recordings)
        if twice is not None:
            raise InputError("", "", f"two recordings are named {twice!r}", "rename one")
        require_names(self.numbers, "`numbers`")
        require_within(self.trials, "`trials`", (1, 1000), 6)
        if self.case and self.trials is not None and self.trials < FEWEST:
            what = f"{self.trials} trials are too few for `case`"
            raise InputError("", "`trials`", what, f"give {FEWEST} or more: some are held out")
        require_within(self.bits, "`bits`", (0, 32), 12)
        for name in ("seed", "moment_noise", "alpha_noise"):
            require_at_least_0(getattr(self, name), f"`{name}`")
        for name in ("band", "pressure"):
            require_rising(getattr(self, name), f"`{name}`")
        require_stroke(self.stroke)
        if self.range is not None:
            require_span(self.range)
        if (self.numbers or {}).get("s", 0.0) != 0.0 and not self.recordings and self.pressure is None:
            what = "s has no effect without a cuff pressure"
            raise InputError("", "`numbers`", what, "give `pressure`, for example 10 to 60 mmHg")
