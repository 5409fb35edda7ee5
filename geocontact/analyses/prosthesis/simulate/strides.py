"""A semi-active foot over the strides of a walk: each stance at its own fulcrum, if the actuator can bring it there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses.frame.collector import listener, note, reserve, say
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.words import counted
from geocontact.analyses.prosthesis.scores import SCORES
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.walk import simulated
from geocontact.below_knee_prosthesis.evaluation import PlateStance, StanceErrors, stance_errors
from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket
from geocontact.below_knee_prosthesis.plate_checks import covered_stances, part_of, whole_stances
from geocontact.below_knee_prosthesis.recorded_walk import Walk
from geocontact.below_knee_prosthesis.schedule import (
    FulcrumSchedule,
    Stride,
    fastest,
    never_reached,
    strides_by,
)
from geocontact.below_knee_prosthesis.stance_summary import in_numbers
from geocontact.data.errors import InputError

MOST = 6
"""Strides, or rows of a schedule, that a sentence lists."""


@dataclass(frozen=True, eq=False)
class ScheduledStance:
    """A stance at the fulcrum that its schedule has for it.

    Parameters
    ----------
    stride
        When, how fast, at which place of the fulcrum, moved how far before.
    walk
        With that fulcrum, and of the plate this stance.
    limb
        As it was simulated.
    errors
        Beside the plate.
    """

    stride: Stride
    walk: Walk
    limb: LimbInSocket
    errors: StanceErrors


def scheduled(walk: Walk, schedule: FulcrumSchedule, o: ProsthesisSimulateOptions) -> tuple[ScheduledStance, ...]:
    """Every whole stance on the plate that the markers cover; InputError for a schedule that no foot can follow."""
    plate, file = walk.plate, o.schedule
    if plate is None or file is None:  # options and `read` require both
        raise ValueError("a schedule needs a plate")
    stances = _covered(plate, walk)
    try:
        strides = strides_by(schedule, stances, walk.walked.motion)
    except ValueError as error:
        remedy = "move it in swing: strides count from the first whole stance on the plate, from toe-off to touch-down"
        raise InputError(file, schedule.by, str(error), remedy) from error
    _reserve_rows(schedule, strides)
    _require_actuator(file, strides, walk.foot.record.actuator)
    found = []
    with listener().progress("strides", len(strides)) as step:
        for stride in strides:
            own = replace(walk, fulcrum=stride.place.fulcrum, plate=part_of(plate, *stride.stance))
            limb = simulated(own, o)
            errors = stance_errors(limb.stance, own.plate or plate, SCORES[o.score])
            found.append(ScheduledStance(stride, own, limb, errors))
            step()
    return tuple(found)


def worst_first(strides: Sequence[ScheduledStance]) -> list[ScheduledStance]:
    """By R² of the resultant force beside the plate."""
    return sorted(strides, key=lambda each: np.nan_to_num(each.errors.table["resultant"][0], nan=-np.inf))


def of_longest(strides: Sequence[ScheduledStance]) -> tuple[ScheduledStance, str]:
    """The longest stance on the plate, and words that say which one it is."""
    longest = max(strides, key=lambda each: each.stride.stance[1] - each.stride.stance[0])
    return longest, f" (stride {longest.stride.number} of {len(strides)}{', the longest' if strides[1:] else ''})"


def _covered(plate: PlateStance, walk: Walk) -> list[tuple[float, float]]:
    """Stances that the markers see from before touch-down to after toe-off [s]."""
    start, stop = walk.walked.motion.time[[0, -1]]
    kept, count = covered_stances(plate, float(start), float(stop)), len(whole_stances(plate))
    if len(kept) < count:
        reserve(f"{count - len(kept)} of {count} stances on {plate.name} are not covered by the markers")
    return kept


def _reserve_rows(schedule: FulcrumSchedule, strides: Sequence[Stride]) -> None:
    """Warnings for rows that no stride comes to, and for a first stance whose walking speed is not known."""
    rest = never_reached(schedule, strides)
    if rest:
        listed = ", ".join(f"{each.name} from {each.start:g}" for each in rest[:MOST])
        more = f" and {len(rest) - MOST} more" if len(rest) > MOST else ""
        reserve(f"rows by {schedule.by} that none of {counted(len(strides), 'stride')} comes to: {listed}{more}")
    if schedule.by == "speed" and len(schedule.places) > 1:
        first = strides[0].place.name
        reserve(f"stride 1 is at {first}, the schedule's first row: no walking speed before it is known")


def _require_actuator(file: Path, strides: Sequence[Stride], actuator: float | None) -> None:
    """InputError for a move that the actuator cannot do in its swing; warned where its speed is not known."""
    found = fastest(strides)
    if found is None:
        return
    stride, move = found
    far, lasting = 1e3 * move.travel, move.end - move.start
    what = f"{far:.0f} mm to {stride.place.name} in {lasting:.2f} s of swing need {1e3 * move.speed:.0f} mm/s"
    if actuator is None:
        reserve(f"{file} stride {stride.number}: {what}; the foot's file has no [actuator] speed to compare with")
    elif move.speed > actuator:
        remedy = f"the actuator does {1e3 * actuator:.0f} mm/s: move it less far, or over several strides"
        raise InputError(file, f"stride {stride.number}", what, remedy)


def strides_table(strides: Sequence[ScheduledStance]) -> pd.DataFrame:
    """One row for each stance: setting, move before it, what it does, and how far it is from the plate."""
    rows = []
    for each in strides:
        one, (down, off), numbers = each.stride, each.stride.stance, in_numbers(each.limb.stance)
        r2, rmse = each.errors.table["resultant"]
        rows.append(
            {
                "stride": one.number,
                "setting": one.place.name,
                "fulcrum [mm]": 1e3 * one.place.fulcrum,
                "touch-down [s]": down,
                "toe-off [s]": off,
                "speed before [m/s]": one.speed,
                "moved [mm]": 1e3 * sum(move.travel for move in one.moves),
                "needed speed [mm/s]": 1e3 * max((move.speed for move in one.moves), default=0.0),
                "stance [s]": each.errors.stance[0],
                "vertical force [N]": numbers["vertical_N"],
                "ankle moment [N m]": numbers["ankle_moment_N_m"],
                "cop travel [mm]": numbers["cop_travel_mm"],
                "stored [J]": numbers["stored_J"],
                "returned [J]": numbers["returned_J"],
                "resultant r2 [-]": r2,
                "resultant rmse [-]": rmse,
            }
        )
    return pd.DataFrame(rows)


def say_strides(strides: Sequence[ScheduledStance], by: str) -> None:
    """What the schedule does, in a sentence."""
    table = strides_table(strides)
    note("strides", plain(table.to_dict("records")))
    listed = [
        f"{row.setting} {row.force:.0f} N, {row.moment:.0f} N m, {row.returned:.1f} J"
        for row in table.rename(
            columns={"vertical force [N]": "force", "ankle moment [N m]": "moment", "returned [J]": "returned"}
        ).itertuples()
    ]
    more = f"; {len(listed) - MOST} more in strides.csv" if len(listed) > MOST else ""
    shown = "; ".join(listed[:MOST])
    what = "peak vertical force, ankle moment, energy returned"
    say(f"schedule by {by} over {len(listed)} strides, {what}: {shown}{more}")
