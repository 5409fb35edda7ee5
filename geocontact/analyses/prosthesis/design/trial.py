"""Where a choice starts: a foot, what is known of its sole, a trial on a plate, and a step of the intact foot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float
from scipy.stats import norm

from geocontact.analyses.frame.collector import add_input, listener, reserve
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.leg_and_foot import foot_with_law, offset_of_law
from geocontact.analyses.prosthesis.recorded_files import (
    plate_under_foot,
    require_one_clock,
    require_under_foot,
    right_markers,
)
from geocontact.below_knee_prosthesis.both_sides.standing import standing_intact_leg
from geocontact.below_knee_prosthesis.calibration.recorded_stance import (
    body_poses,
    recorded_heights,
    stance_from_markers,
)
from geocontact.below_knee_prosthesis.calibration.zone_parameters import ZoneParameters
from geocontact.below_knee_prosthesis.clocks import clock_offset, lowest_sphere
from geocontact.below_knee_prosthesis.design.drawn import RecordedTrial
from geocontact.below_knee_prosthesis.design.intact_step import OF_INTACT, IntactStep, intact_step
from geocontact.below_knee_prosthesis.design.knob import AIMS
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, Aim
from geocontact.below_knee_prosthesis.keel.sole import numbers as sole_numbers
from geocontact.below_knee_prosthesis.keel.vsf import VariableStiffnessFoot, fulcrum_of, vsf_foot
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.data.errors import InputError

INTERVAL = 0.95
"""Probability of the intervals of a calibration."""
COLUMNS = ("number", "value", "lower", "upper", "verdict")


@dataclass(frozen=True, eq=False)
class FootAndTrial:
    """A foot, a trial on it, the standard deviation of the logarithm of each number of its sole, an intact foot's step.

    The last is None where none is named.
    """

    foot: VariableStiffnessFoot
    trial: RecordedTrial
    sd: Float[np.ndarray, " p"]
    intact: IntactStep | None = None


def read(o: ProsthesisDesignOptions) -> FootAndTrial:
    """Everything the options name."""
    with listener().preparing():
        foot = foot_with_law(vsf_foot(), o.law)
    plate, name = plate_under_foot(o.plates, o.plate, o.side, o.mass, o.c3d_unit)
    trial = RecordedTrial(
        standing=right_markers("`static`", o.static, o.side, o.axes, o.markers_map, o.c3d_unit),
        walking=right_markers("markers", o.markers, o.side, o.axes, o.markers_map, o.c3d_unit),
        plate=plate,
        person=Person(o.mass),
        keel=foot.keel,
        fulcrum=fulcrum_of(o.setting) if o.fulcrum is None else o.fulcrum,
        below=sole_numbers()["below"].value,
        cutoff=None if o.cutoff == 0.0 else o.cutoff,
        gap_limit=o.gap_limit,
        offset=offset_of_law(o.law, o.static),
    )
    leg = trial.leg
    spheres = foot.sole.spheres
    time, height = recorded_heights(trial.walking, leg, spheres, cutoff=trial.cutoff, gap_limit=trial.gap_limit)
    require_one_clock(o.plates, "`plate`", name, clock_offset(time, height, plate.time, plate.force[:, 1]))
    given = (trial.walking, leg, plate, trial.fulcrum, foot.keel.length)
    stance = stance_from_markers(*given, cutoff=trial.cutoff, gap_limit=trial.gap_limit)
    require_under_foot(o.plates, name, stance.centre)
    intact = intact_side(o, trial)
    zones = ZoneParameters(foot.sole, foot.law)
    if o.numbers is None:
        reserve("nothing is known of this sole but what is believed of any: give the `numbers` of a calibration")
        return FootAndTrial(foot, trial, zones.sd, intact)
    return FootAndTrial(foot, trial, _known(o.numbers, zones), intact)


def _known(file: Path, zones: ZoneParameters) -> Float[np.ndarray, " p"]:
    """From intervals of known numbers; any other keeps its prior."""
    try:
        table = pd.read_csv(file)
    except (OSError, ValueError) as error:
        raise InputError(file, "", "cannot be read as a table", "give numbers.csv of prosthesis calibrate") from error
    missing = [name for name in COLUMNS if name not in table.columns]
    if missing:
        raise InputError(file, "", f"no column {missing[0]!r}", "give numbers.csv of prosthesis calibrate")
    add_input("`numbers`", file, rows=len(table))
    told = table.set_index("number")
    lost = [name for name in zones.names if name not in told.index]
    if lost:
        raise InputError(file, "", f"no row {lost[0]!r}", "give numbers.csv of prosthesis calibrate")
    found = []
    for name, prior in zip(zones.names, zones.sd, strict=True):
        if told["verdict"].to_dict()[name] != "known":
            found.append(float(prior))
            continue
        lower, upper = (float(told[column].to_dict()[name]) for column in ("lower", "upper"))
        if not 0.0 < lower <= upper < np.inf:
            raise InputError(file, name, f"{lower:g} to {upper:g} is no interval", "give positive bounds, lower first")
        own = np.log(upper / lower) / (2.0 * norm.ppf(0.5 + 0.5 * INTERVAL))
        found.append(min(float(own), float(prior)))
    return np.array(found)


BESIDE = 0.75
"""Lengths of the foot from its middle beyond which the centre of pressure of a step is not its in the median."""
OF_ONE_STEP = (
    "what the intact side has is of one step, and no error of it is in the bands; its rate of loading is the plate's, "
    "that of a prosthetic foot its stiffness times its speed"
)


def intact_side(o: ProsthesisDesignOptions, trial: RecordedTrial) -> IntactStep | None:
    """The step that is named; None where none is."""
    if o.intact is None:
        return None
    if o.target is not None and o.aim in OF_INTACT:
        what = f"`intact` tells already which {MEASURES[o.aim].words} is wanted"
        raise InputError("", "`target`", what, "give one of them")
    leg = standing_intact_leg(trial.standing, trial.person)
    seen = right_markers("`intact`", o.intact, o.side, o.axes, o.markers_map, o.c3d_unit)
    plates = o.plates if o.intact_plates is None else o.intact_plates
    plate, name = plate_under_foot(plates, o.intact_plate, o.side, o.mass, o.c3d_unit, "intact_plate")
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
    """Outcomes that the intact foot has, and those that it does not have, in a sentence."""
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
