"""Movements of one recording: `geocontact sit-to-stand movements`, `gc.sit_to_stand.movements`.

>>> import geocontact as gc
>>> recording = "meshes/standing_up_exoskeleton/T1_"
>>> chair = {"plates": recording + "plates.mot", "chair": "chair_force"}
>>> print(gc.sit_to_stand.movements(recording + "coordinates.sto", **chair))
1 movement: 1 standing up
standing up 1: 0.3… to …
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from os.path import relpath
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import counted
from geocontact.analyses.sit_to_stand.movements.options import StandingMovementsOptions
from geocontact.analyses.sit_to_stand.recorded_beside import doubt_bending, doubt_plates
from geocontact.analyses.sit_to_stand.show import motion_page
from geocontact.analyses.sit_to_stand.trial_recordings import chair_force, motion_of_file, require_one_clock
from geocontact.data.errors import InputError
from geocontact.data.motion import Course
from geocontact.io.mocap.force_plates import plate_named, read_force_plates
from geocontact.standing_up.chain import Subject, leg_chain
from geocontact.standing_up.movements import (
    LEAST_RANGE,
    PAUSE,
    TASKS,
    RecordedMovement,
    contacts_beside,
    contradiction,
    hip_height,
    movements_of,
)
from geocontact.standing_up.trial_forces import SEATED
from geocontact.trial_checks.recorded import FootPlate
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, Limit, Shade
from geocontact.view.page.content import Section
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from geocontact.view.page.content import Page

TRIALS = "trials.toml"
SHOWN = 3
"""Contacts beside all movements that are named."""
MEANT = [
    "The height of the hip over the ankle follows from the angles of shank and thigh.",
    "A movement begins and ends where the hip's speed falls below a twentieth of its largest.",
    f"Seat-off and seat contact: the force on the chair, its running median, passes {SEATED:g} N.",
    "A warning names movements that the chair contradicts: its force stays after standing up, or was there before.",
]


@dataclass(frozen=True, eq=False)
class StandingRecording:
    """Over time: height of the hip over the ankle [m], and force on the chair [N] where it was recorded."""

    time: Float[np.ndarray, " t"]
    height: Float[np.ndarray, " t"]
    chair: Float[np.ndarray, " t"] | None


def read(o: StandingMovementsOptions) -> StandingRecording:
    """Coordinates and chair on one clock."""
    subject = Subject(height=o.height)
    chain = leg_chain(subject)
    time, q = motion_of_file(o.coordinates, chain, "`coordinates`")
    height = hip_height(subject, q)
    doubt_bending(o.coordinates, chain, q, height)
    if o.plates is None or o.chair is None:
        return StandingRecording(time, height, None)
    plates = read_force_plates(o.plates, o.c3d_unit)
    add_input("`plates`", o.plates, plates=len(plates))
    plate = plate_named(plates, o.chair, o.plates, "`chair`")
    under = None if o.feet is None else plate_named(plates, o.feet, o.plates, "`feet`")
    if under is plate:
        raise InputError("", "`feet`", f"{o.feet} is the chair's plate as well", "name each plate once")
    require_one_clock(o.plates, plate, time)
    if under is not None:
        plates_there = tuple(FootPlate(each, str(o.plates)) for each in (under, plate))
        doubt_plates(plates_there, (time, q), o.height, o.coordinates)
    return StandingRecording(time, height, np.interp(time, plate.time, chair_force(plate)))


def numbered(movements: Sequence[RecordedMovement]) -> list[tuple[str, RecordedMovement]]:
    """Each with its name: its kind, and which of this kind it is."""
    seen: Counter[str] = Counter()
    named = []
    for one in movements:
        seen[one.kind] += 1
        named.append((f"{one.kind} {seen[one.kind]}", one))
    return named


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingMovementsResult(Result):
    """Movements in the order of the recording."""

    options: StandingMovementsOptions
    given: StandingRecording
    movements: tuple[RecordedMovement, ...]

    @property
    def starts(self) -> dict[str, float]:
        """When each movement starts, by its name [s]."""
        return {name: one.start for name, one in numbered(self.movements)}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`movements`."""
        rows = [
            {
                "movement": name,
                "start [s]": one.start,
                "end [s]": one.end,
                "duration [s]": one.end - one.start,
                "seat-off or contact [s]": one.contact,
                "chair before [N]": one.before,
                "chair after [N]": one.after,
                "rise [mm]": 1e3 * one.rise,
                "chair agrees": "not recorded" if self.given.chair is None else "yes" if one.agrees else "no",
            }
            for name, one in numbered(self.movements)
        ]
        return {"movements": pd.DataFrame(rows)}

    def curves(self) -> dict[str, CurveSheet]:
        """`movements`: height of the hip and force on the chair, movements shaded."""
        over = Course("time", "s", self.given.time)
        spans = [Shade(one.kind, one.start, one.end) for one in self.movements]
        panels = [Curves("Hip over ankle", "mm", [Curve("hip", 1e3 * self.given.height, stroke=INK)], spans=spans)]
        if self.given.chair is not None:
            limits = [Limit("seated", SEATED)]
            panels.append(
                Curves(
                    "Force on the chair", "N", [Curve("chair", self.given.chair, stroke=INK)], (), limits, spans=spans
                )
            )
        return {"movements": CurveSheet(panels, over)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Curves and table."""
        sheet = self.curves()["movements"]
        panels = [replace(panel, over=sheet.over) for panel in sheet.panels]
        sections: list[Section] = [*panels, frame_table("Movements", self.table("movements"), 3)]
        titles = ("Movements of a recording", str(self.options.coordinates.name))
        page = motion_page(titles, self.sentences, sections, MEANT)
        return {REPORT: page}

    def write_files(self, folder: Path) -> None:
        """trials.toml; table, figure, page."""
        (folder / TRIALS).write_text(self.trials_toml(folder), encoding="utf-8")
        super().write_files(folder)

    def trials_toml(self, folder: Path) -> str:
        """A [[trials]] for each movement, files as seen from a folder; rates, torques and straps are to be added."""
        o, blocks = self.options, ["# Movements of one recording; add rates, torques and straps of it.\n"]
        named = numbered(self.movements)
        for (name, one), (_, then) in zip(named, [*named[1:], named[-1]], strict=True):
            task = TASKS.get(one.kind, one.kind)
            lines = ["[[trials]]", f'name = "{name.replace(" ", "_")}"', f'task = "{task}"']
            lines.append(f'coordinates = "{_from(folder, o.coordinates)}"')
            if o.plates is not None:
                lines.append(f'plates = "{_from(folder, o.plates)}"')
                lines += [f'feet = "{o.feet}"'] if o.feet is not None else []
                lines += [f'chair = "{o.chair}"'] if task != "squat" else []
            lines += [f"start = {one.start:.6g}", f"end = {one.end:.6g}"]
            if (one.kind, then.kind) == ("going down", "rising") and then.start - one.end <= PAUSE:
                lines.insert(0, f'# With the next, it may be a squat: then task = "squat", end = {then.end:.6g} here.')
            blocks.append("\n".join(lines) + "\n")
        return "\n".join(blocks)


def _from(folder: Path, file: Path) -> str:
    return Path(relpath(file, folder)).as_posix()


def run(given: StandingRecording, o: StandingMovementsOptions) -> StandingMovementsResult:
    """Cut; InputError where the person did not move."""
    try:
        found = movements_of(given.time, given.height, given.chair)
    except ValueError as error:
        raise InputError(o.coordinates, "", str(error), "give a longer recording") from error
    if not found:
        size = 1e3 * float(np.ptp(given.height))
        what = f"the hip moves by {size:.0f} mm, where a movement is {1e3 * LEAST_RANGE:.0f} mm at least"
        raise InputError(o.coordinates, "", what, "check the angles' unit, and that it is the whole recording")
    named = numbered(found)
    counts = Counter(one.kind for one in found)
    say(f"{counted(len(found), 'movement')}: {', '.join(f'{count} {kind}' for kind, count in counts.items())}")
    for name, one in named:
        also = "" if np.isnan(one.contact) else f", {_event(one)} at {one.contact:.2f} s"
        say(f"{name}: {one.start:.2f} to {one.end:.2f} s{also}")
        if not one.agrees:
            reserve(
                f"{name}: {contradiction(one)}, as in no movement from seat to standing or back: check that this is "
                "the chair's plate, and its zero"
            )
    beside = () if given.chair is None else contacts_beside(given.time, given.chair, found)
    if beside:
        times = ", ".join(f"{at:.2f}" for at in beside[:SHOWN]) + (" …" if len(beside) > SHOWN else "")
        reserve(
            f"the chair's force passes {SEATED:g} N at {times} s, beside all movements: check the clocks of chair and "
            "coordinates, and that the hip's height is right"
        )
    note("movements", {name: [one.start, one.end] for name, one in named})
    return StandingMovementsResult(options=o, given=given, movements=found)


def _event(one: RecordedMovement) -> str:
    return "seat-off" if one.kind == "standing up" else "seat contact"


movements = Job("sit-to-stand movements", StandingMovementsOptions, read, run)
