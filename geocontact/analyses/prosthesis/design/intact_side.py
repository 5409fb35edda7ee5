"""The intact side as what is aimed at: a step of its foot on a plate, and what it has, in a table and in words."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.plausible_plate import require_one_clock
from geocontact.analyses.prosthesis.recorded_files import plate_under_foot, right_markers
from geocontact.analyses.run_record import Record
from geocontact.below_knee_prosthesis.both_sides.standing import standing_intact_leg
from geocontact.below_knee_prosthesis.calibration.stance_from_markers import body_poses
from geocontact.below_knee_prosthesis.clocks import clock_offset, lowest_sphere
from geocontact.below_knee_prosthesis.design.intact_step import OF_INTACT, IntactStep, intact_step
from geocontact.below_knee_prosthesis.design.knob import AIMS
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, Aim
from geocontact.below_knee_prosthesis.design.stance_again import RecordedTrial
from geocontact.data.errors import InputError

BESIDE = 0.75
"""Lengths of the foot from its middle beyond which the centre of pressure of a step is not its in the median."""
OF_ONE_STEP = (
    "what the intact side has is of one step, and no error of it is in the bands; its rate of loading is the plate's, "
    "that of a prosthetic foot its stiffness times its speed"
)


def intact_side(o: ProsthesisDesignOptions, trial: RecordedTrial, record: Record) -> IntactStep | None:
    """The step that is named; None where none is."""
    if o.intact is None:
        return None
    if o.target is not None and o.aim in OF_INTACT:
        what = f"`intact` tells already which {MEASURES[o.aim].words} is wanted"
        raise InputError("", "`target`", what, "give one of them")
    leg = standing_intact_leg(trial.standing, trial.person)
    seen = right_markers(record, "`intact`", o.intact, o.side, o.axes, o.markers_map, o.c3d_unit)
    plates = o.plates if o.intact_plates is None else o.intact_plates
    plate, name = plate_under_foot(record, plates, o.intact_plate, o.side, o.mass, o.c3d_unit, "intact_plate")
    step = intact_step(seen, leg, plate, cutoff=trial.cutoff, gap_limit=trial.gap_limit)
    foot = body_poses(seen, leg.markers, "intact_foot", seen.time, trial.cutoff, trial.gap_limit)
    height = lowest_sphere(foot, leg.spheres()[0])
    same = np.array_equal(plate.force, trial.plate.force)
    if same or not step.beside < BESIDE:
        what = f"the centre of pressure of {name} is {step.beside:.1f} lengths of it from its middle in the median"
        whose = f"{name} is under the prosthetic foot" if same else "no plate under the intact foot"
        raise InputError(plates, "`intact_plate`", f"{whose}: {what}", "name the plate of the intact foot's step")
    clocks = clock_offset(seen.time, height, plate.time, plate.force[:, 1])
    require_one_clock(plates, "`intact_plate`", name, clocks)
    try:
        values = step.outcomes()
    except ValueError as error:
        raise InputError(o.intact, "", f"the step of the intact foot is too short: {error}", "give another") from error
    for aim, value in values.items():
        if not 0.0 < value < np.inf:
            what = f"the intact foot would have a {MEASURES[aim].words} of {value:.3g} {MEASURES[aim].unit}"
            raise InputError(o.intact, "", what, "are markers and plate in the same axes, x forward along the walk?")
    return step


def intact_words(values: Mapping[Aim, float]) -> str:
    """What the intact foot has and what it does not."""
    has = "; ".join(f"{MEASURES[aim].words} {value:.3g} {MEASURES[aim].unit}" for aim, value in values.items())
    lacks = " and no ".join(MEASURES[aim].words.partition(",")[0] for aim in AIMS if aim not in values)
    return f"aimed at, of one step of the intact foot: {has}; without socket and keel it has no {lacks}"


def intact_table(values: Mapping[Aim, float]) -> pd.DataFrame:
    """One row for each outcome; those that an intact foot does not have are empty."""
    rows = [
        {
            "outcome": aim,
            "intact side": values.get(aim, np.nan),
            "unit": MEASURES[aim].unit,
            "aimed at": aim in values,
            "words": MEASURES[aim].words if aim in values else f"{MEASURES[aim].words}: an intact foot has none",
        }
        for aim in AIMS
    ]
    return pd.DataFrame(rows)
