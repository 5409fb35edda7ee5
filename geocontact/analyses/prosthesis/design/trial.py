"""Where a choice starts: a foot, what is known of its sole, a trial on a plate, and a step of the intact foot."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, listener, reserve
from geocontact.analyses.frame.withheld import CONTRADICTED
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.foot_file import foot_of, fulcrum_at
from geocontact.analyses.prosthesis.recorded_files import LaboratoryFiles, foot_with_law, offset_of_law, require_factors
from geocontact.below_knee_prosthesis.both_sides.standing import standing_intact_leg
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance, stance_on_plate
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.design.drawn import RecordedTrial, TrialErrors
from geocontact.below_knee_prosthesis.design.intact_step import OF_INTACT, IntactStep, intact_step, require_intact
from geocontact.below_knee_prosthesis.design.knob import Knob
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES
from geocontact.below_knee_prosthesis.design.varied import ALIGNMENTS, VariedFoot, known_pitch, varied_foot
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.data.errors import InputError
from geocontact.io.text.results import read_frame

COLUMNS = ("number", "value", "lower", "upper", "verdict")


@dataclass(frozen=True, eq=False)
class FootAndTrial:
    """A foot, a trial on it and its stance, what is known of the sole, an intact foot's step.

    Parameters
    ----------
    sd
        Standard deviation of the logarithm of each number of the sole.
    intact
        None where none is named.
    """

    foot: VariableStiffnessFoot
    trial: RecordedTrial
    stance: RecordedStance
    sd: Float[np.ndarray, " p"]
    intact: IntactStep | None = None


def read(o: ProsthesisDesignOptions) -> FootAndTrial:
    """Everything the options name."""
    with listener().preparing():
        foot = in_plane(foot_of(o.foot))
        fulcrum = fulcrum_at(foot, o.setting, o.fulcrum)
        foot = foot_with_law(foot, o.law)
        require_factors(foot, o.foot, o.law)
    lab = LaboratoryFiles(o.side, o.axes, o.markers_map, o.c3d_unit)
    own = lab.plate_under_foot(o.plates, o.plate, o.mass)
    plate = lab.stance(own, o.plates)
    standing, walking = lab.markers("`static`", o.static), lab.markers("markers", o.markers)
    lab.check(standing, walking, o.mass, o.plates, own)
    trial = RecordedTrial(
        standing=lab.right(standing),
        walking=lab.right(walking),
        plate=plate,
        person=Person(o.mass),
        keel=foot.keel,
        fulcrum=fulcrum,
        below=foot.record.below,
        cutoff=None if o.cutoff == 0.0 else o.cutoff,
        gap_limit=o.gap_limit,
        offset=offset_of_law(o.law, o.static),
    )
    given = trial.walking, trial.leg, plate, foot, trial.fulcrum
    stance = stance_on_plate(*given, cutoff=trial.cutoff, gap_limit=trial.gap_limit)
    intact = intact_side(o, trial)
    zones = ZoneParameters(foot.sole, foot.law)
    if o.numbers is None:
        reserve("for this sole only the general prior is used: give the `numbers` of a calibration")
        return FootAndTrial(foot, trial, stance, zones.sd, intact)
    return FootAndTrial(foot, trial, stance, _known(o.numbers, zones), intact)


def in_plane(foot: VariableStiffnessFoot) -> VariableStiffnessFoot:
    """Without torsion: the leg that another foot is tried under moves in its sagittal plane, where nothing twists."""
    if not foot.keel.twists:
        return foot
    reserve("the keel twists by its file, and does not here: feet are compared in the sagittal plane")
    return replace(foot, keel=replace(foot.keel, twists=False))


def _known(file: Path, zones: ZoneParameters) -> Float[np.ndarray, " p"]:
    """From intervals of known numbers; any other keeps its prior."""
    table = read_frame(file, COLUMNS, "give numbers.csv of prosthesis calibrate")
    missing = [name for name in COLUMNS if name not in table.columns]
    if missing:
        raise InputError(file, "", f"no column {missing[0]!r}", "give numbers.csv of prosthesis calibrate")
    add_input("`numbers`", file, rows=len(table))
    told = table.set_index("number")
    lost = [name for name in zones.names if name not in told.index]
    if lost:
        raise InputError(file, "", f"no row {lost[0]!r}", "give numbers.csv of prosthesis calibrate")
    if (told["verdict"] == CONTRADICTED).any():
        what = "its calibration contradicts its stance, so that no number in it is known"
        raise InputError(file, "verdict", what, "calibrate on another stance, or leave `numbers` out")
    last = told[~told.index.duplicated(keep="last")]
    known = last[(last["verdict"] == "known") & last.index.isin(zones.names)]
    ends = zip(known["lower"].map(float), known["upper"].map(float), strict=True)
    intervals = dict(zip(map(str, known.index), ends, strict=True))
    try:
        return zones.sd_within(intervals)
    except ValueError as error:
        name, _, what = str(error).partition(": ")
        raise InputError(file, name, what, "give positive bounds, lower first") from error


def intact_side(o: ProsthesisDesignOptions, trial: RecordedTrial) -> IntactStep | None:
    """The step that is named; None where none is."""
    if o.intact is None:
        return None
    if o.target is None and o.aim not in OF_INTACT:
        what = f"{MEASURES[o.aim].words} is not computed of a step of the intact foot"
        raise InputError("", "`aim`", what, f"take {', '.join(OF_INTACT)}, or give its `target`")
    if o.target is not None and o.aim in OF_INTACT:
        what = f"`intact` states already which {MEASURES[o.aim].words} is wanted"
        raise InputError("", "`target`", what, "give one of them")
    leg = standing_intact_leg(trial.standing, trial.person)
    lab = LaboratoryFiles(o.side, o.axes, o.markers_map, o.c3d_unit)
    recorded = lab.markers("`intact`", o.intact)
    plates = o.plates if o.intact_plates is None else o.intact_plates
    under = lab.plate_under_foot(plates, o.intact_plate, o.mass, "intact_plate")
    lab.check(None, recorded, o.mass, plates, other=under)
    seen, plate = lab.right(recorded), lab.stance(under, plates)
    step = intact_step(seen, leg, plate, cutoff=trial.cutoff, gap_limit=trial.gap_limit)
    require_intact(step, seen, leg, plate, trial.plate, cutoff=trial.cutoff, gap_limit=trial.gap_limit)
    return step


def varied(given: FootAndTrial, knob: Knob, o: ProsthesisDesignOptions) -> VariedFoot:
    """Draws over the values, and both ends beside the present one; InputError where the foot finds no equilibrium."""
    pitch = known_pitch(given.trial.offset, o.pitch_error)
    try:
        with listener().progress("feet", o.feet) as step:
            return varied_foot(
                given.foot,
                given.trial,
                given.sd,
                knob,
                feet=o.feet,
                walks=o.walks,
                seed=o.seed,
                errors=TrialErrors(marker=o.marker_error, pitch=pitch, force=o.force_noise),
                alignments=ALIGNMENTS.tolist() if o.together else (),
                step=step,
            )
    except (ArithmeticError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        remedy = "check `mass`, the plate and how flat the foot stood"
        raise InputError(o.markers, "", str(error), remedy) from error
