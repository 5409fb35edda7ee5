"""Planar coordinates of a whole body's motion: `geocontact sit-to-stand coordinates`, `gc.sit_to_stand.coordinates`.

>>> import geocontact as gc
>>> body = "meshes/whole_body/"
>>> plates = {"plates": body + "plates.mot", "feet": "right_force,left_force", "chair": "chair_force"}
>>> result = gc.sit_to_stand.coordinates(body + "ik.mot", model=body + "body.osim", **plates)
>>> print(result.sentences[0])
181 frames, both legs about their mean: segments are out of the plane by 0.0° RMS …
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import counted
from geocontact.analyses.sit_to_stand.coordinates.options import StandingCoordinatesOptions
from geocontact.analyses.sit_to_stand.coordinates.read import PlanarRecording, read
from geocontact.analyses.sit_to_stand.show import motion_page
from geocontact.analyses.sit_to_stand.trial_recordings import FEWEST
from geocontact.data.errors import InputError
from geocontact.data.motion import Course
from geocontact.data.plausible import Plausible
from geocontact.data.units import m
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.recordings.described_person import OVER_HIPS
from geocontact.standing_up.chain import COORDINATES, Subject
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.movements import TASKS, contradiction, hip_height, movements_of
from geocontact.standing_up.person_segments import SHARES, to_proximal
from geocontact.standing_up.stance import JERK, SIZES, off_the_foot, smooth, stances
from geocontact.trial_checks.body_checks import LEG_OFF
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, Shade
from geocontact.view.page.content import Section
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from geocontact.view.page.content import Page

SEATED_TASKS = ("standing up", "sitting down")
STUDY, ANGLES = "study.toml", "coordinates.mot"
FAR_OUT, FAR_APART = 15.0, 10.0
"""Degrees, root mean square, from which a warning says so. Out of the plane: a thigh of 0.42 m appears 14 mm shorter,
as much as the hip's centre is off by a functional method (13 mm: Leardini et al. 1999, J Biomech 32:99). Between both
legs: invented, twice the error from which an angle may mislead (McGinley et al. 2009, Gait Posture 29:360)."""
MEANT = [
    "Shank and thigh are the lines between the centres of their joints.",
    "The trunk is the line from the hips to the mass centre of trunk, head and arms.",
    "The foot turns from where it is with all coordinates at their default.",
    "The plane is upright and across the line of the hips, its mean over the recording.",
    "Segments are those of the model: masses of one leg, means of both.",
    "Noise and jerk of study.toml are invented, of markers on the skin: give your own.",
]
FLAT, SLIDING = np.radians(6.0), 0.1
"""Turn of a flat foot [rad], and speed of one from which a warning says so [m/s]; invented."""
UNITS = {"mass": "kg", "length": "m", "centre": "m", "gyration": "m"}
NOISE_UNITS = {"length": "m", "angle": "rad", "rate": "rad/s", "force": "N", "centre": "m"}


@dataclass(frozen=True)
class TaskSpan:
    """A trial of the recording: name and task as a study has them, begin and end [s]."""

    name: str
    task: str
    start: float
    end: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingCoordinatesResult(Result):
    """A motion in the plane.

    Parameters
    ----------
    height
        Of the body [m].
    spans
        Each movement of both legs, or stance of one.
    """

    options: StandingCoordinatesOptions
    given: PlanarRecording
    height: float
    spans: tuple[TaskSpan, ...]

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of the samples [s]."""
        return self.given.time

    @property
    def coordinates(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Each coordinate over time [m, rad]."""
        return dict(zip(COORDINATES, self.given.moved.q.T, strict=True))

    @property
    def segments(self) -> dict[tuple[str, str], float]:
        """Mass (of one leg), length, mass centre and radius of gyration of each segment [kg, m]."""
        own = self.given.moved.own
        return {(name, key): value for name, values in own.items() for key, value in values.items()}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`deviations` from the plane and between the legs, `segments`."""
        rows = []
        moved = self.given.moved
        for name, off in moved.leaning.items():
            rows.append(("out of the plane", name, "deg", *_sizes(np.degrees(off))))
        for name, off in moved.apart.items():
            unit, factor = ("mm", 1e3) if name in COORDINATES[:2] else ("deg", float(np.degrees(1.0)))
            rows.append(("right less left", name, unit, *_sizes(factor * off)))
        segments = [(name, key, UNITS[key], value) for (name, key), value in self.segments.items()]
        return {
            "deviations": pd.DataFrame(rows, columns=["what", "of", "unit", "rms", "largest"]),
            "segments": pd.DataFrame(segments, columns=["segment", "quantity", "unit", "value"]),
        }

    def curves(self) -> dict[str, CurveSheet]:
        """`coordinates` over time; force of the ground where it was recorded."""
        angles = [Curve(name, np.degrees(own)) for name, own in list(self.coordinates.items())[2:]]
        panels = [Curves("Turn of the foot, and angles", "deg", angles)]
        if self.given.feet is not None and self.given.clock is not None:
            up = np.interp(self.time, self.given.clock, self.given.feet[:, 1])
            spans = [Shade(span.task, span.start, span.end) for span in self.spans]
            panels.append(Curves("Force of the ground upwards", "N", [Curve("feet", up, stroke=INK)], spans=spans))
        return {"coordinates": CurveSheet(panels, Course("time", "s", self.time))}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Curves and tables."""
        sheet = self.curves()["coordinates"]
        sections: list[Section] = [replace(panel, over=sheet.over) for panel in sheet.panels]
        deviations = self.table("deviations").round(6)  # rounding errors of angles as nothing
        sections.append(frame_table("Deviations from the plane, and of the legs", deviations, 3))
        sections.append(frame_table("Segments", self.table("segments"), 3))
        titles = "Planar coordinates of a whole body", str(self.options.motion.name)
        return {REPORT: motion_page(titles, self.sentences, sections, MEANT)}

    def write_files(self, folder: Path) -> None:
        """Coordinates; plates and study where they were recorded; tables, figure, page."""
        q = self.given.moved.q
        hinges = np.zeros((len(q), 0)) if self.given.hinges is None else self.given.hinges
        columns = np.column_stack([q[:, :2], np.degrees(q[:, 2:]), np.degrees(hinges)])
        names = [*COORDINATES, *EXO_JOINTS[: hinges.shape[1]]]
        write_storage(folder / ANGLES, self.time, names, columns, title="Planar chain", degrees=True)
        for name, file in self.beside.items():
            if not (folder / name).exists() or not file.samefile(folder / name):
                shutil.copyfile(file, folder / name)
        if self.given.feet is not None and self.given.clock is not None:
            loads = {"feet": self.given.feet, "chair": self.given.chair}
            there = {name: load for name, load in loads.items() if load is not None}
            names, values = [], []
            for name, load in there.items():
                names += [f"{name}_force_{kind}{axis}" for kind in "vp" for axis in "xyz"]
                names += [f"{name}_torque_{axis}" for axis in "xyz"]
                values += [load[:, :3], np.zeros((len(load), 3)), load[:, 3:]]
            title = "Loads in the plane, moments about its origin"
            write_storage(folder / "plates.mot", self.given.clock, names, np.hstack(values), title=title, degrees=False)
        if self.spans:
            (folder / STUDY).write_text(self.study_toml(), encoding="utf-8")
        super().write_files(folder)

    @property
    def beside(self) -> dict[str, Path]:
        """Files of torques and strap by the names that the study has for them; none where nothing was worn."""
        named = {"torques": self.options.torques, "strap": self.options.strap}
        return {f"{key}{file.suffix}": file for key, file in named.items() if file is not None}

    def study_toml(self) -> str:
        """A study of this recording, its files beside it."""
        o = self.options
        lines = [f"# {o.motion.name} on {o.model.name} in its plane; noise and jerk are invented."]
        lines += [f'mass = {{ value = {self.given.mass:.6g}, unit = "kg" }}']
        lines += [f'height = {{ value = {self.height:.6g}, unit = "m" }}']
        on_plates = self.given.feet is not None
        worn = self.given.hinges is not None
        followed = ["coordinates", *(["force", "centre"] if on_plates else []), *(["torque", "strap"] if worn else [])]
        lines += ["exoskeleton = true"] if worn else []
        tracks = ", ".join(f'"{name}"' for name in followed)
        lines += [f"tracks = [{tracks}]", "", "[noise]"]
        lines += [f'{name} = {{ value = {size:.6g}, unit = "{NOISE_UNITS[name]}" }}' for name, size in SIZES.items()]
        if o.leg != "both":
            lines += ["", "[weights]", *(f"{name} = {size:.6g}" for name, size in JERK.items())]
        for segment, own in to_proximal(self.given.moved.own, self.height, "male").items():
            lines += ["", f"[person.segments.{OVER_HIPS if segment == 'trunk' else segment}]"]
            lines += [f'{key} = {{ value = {value:.6g}, unit = "{UNITS[key]}" }}' for key, value in own.items()]
        files = [f'coordinates = "{ANGLES}"']
        files += ['plates = "plates.mot"', 'feet = "feet_force"'] if on_plates else []
        files += [f'{Path(name).stem} = "{name}"' for name in self.beside]
        for span in self.spans:
            seat = self.given.chair is not None and span.task in SEATED_TASKS
            lines += ["", "[[trials]]", f'name = "{span.name}"', f'task = "{span.task}"', *files]
            lines += ['chair = "chair_force"'] if seat else []
            lines += [f"start = {span.start:.6g}", f"end = {span.end:.6g}"]
        return "\n".join(lines) + "\n"


def _sizes(off: Float[np.ndarray, " t"]) -> tuple[float, float]:
    return float(np.sqrt(np.mean(off**2))), float(np.abs(off).max())


def _spans(given: PlanarRecording, height: float, o: StandingCoordinatesOptions) -> tuple[TaskSpan, ...]:
    """Movements of both legs by the height of the hips; stances of one by its plate, low-passed as a calibration does.

    InputError for a recording that is too short to be filtered.
    """
    try:
        if o.leg == "both":
            return _movements(given, height)
        if given.feet is None or given.clock is None:
            return ()
        up, about = (np.interp(given.time, given.clock, given.feet[:, k]) for k in (1, 5))
        low = smooth(given.time, np.column_stack([up, given.moved.q[:, 2], about]))
    except ValueError as error:
        raise InputError(o.motion, "", str(error), "give a longer recording") from error
    found = stances(given.time, low[:, 0], low[:, 1], FEWEST)
    for start, end in found:
        inside = (given.time >= start) & (given.time <= end)
        off = off_the_foot(low[inside, 2] / low[inside, 0], given.moved.q[inside, 0])
        if off is not None:
            what = f"from {start:.2f} to {end:.2f} s the load is {off:.2f} m ahead of the {o.leg} ankle (median)"
            raise InputError(o.plates or "", "`feet`", what, "is it the plate of the other foot?")
    return tuple(TaskSpan(f"{o.leg}_{k}", "stance", *span) for k, span in enumerate(found, 1))


def _movements(given: PlanarRecording, height: float) -> tuple[TaskSpan, ...]:
    person = Subject(given.mass, height, own=given.moved.own)
    seat = None
    if given.chair is not None and given.clock is not None:
        seat = np.interp(given.time, given.clock, np.abs(given.chair[:, 1]))
    found = movements_of(given.time, hip_height(person, given.moved.q), seat, squats=seat is None)
    for k, one in enumerate(found, 1):
        if not one.agrees:
            reserve(f"T{k}, {one.kind}: {contradiction(one)}: is it the chair's plate, and no foot's, with its zero?")
    return tuple(TaskSpan(f"T{k}", TASKS.get(one.kind, one.kind), one.start, one.end) for k, one in enumerate(found, 1))


def run(given: PlanarRecording, o: StandingCoordinatesOptions) -> StandingCoordinatesResult:
    """The motion in the plane, and how far it is out of it."""
    own, share = given.moved.own, SHARES["male"]
    lower = own["shank"]["length"] + own["thigh"]["length"]
    by_legs = lower / (share["shank"].length + share["thigh"].length)
    height = by_legs if o.height is None else o.height
    if abs(by_legs / height - 1.0) > LEG_OFF:
        reserve(f"`height`: {height:.2f} m, and by shank and thigh of {o.model.name} {by_legs:.2f} m: of one person?")
    if o.height is None:
        _doubt_height(by_legs, o)
    result = StandingCoordinatesResult(options=o, given=given, height=height, spans=_spans(given, height, o))
    table = result.table("deviations")
    out, apart = (table[table["what"] == what] for what in ("out of the plane", "right less left"))
    turning = apart[apart["unit"] == "deg"]
    whose = "both legs about their mean" if o.leg == "both" else f"the {o.leg} leg"
    say(
        f"{counted(len(given.time), 'frame')}, {whose}: segments are out of the plane by {out['rms'].max():.1f}° RMS "
        f"(the worst of them), {out['largest'].max():.1f}° at most"
    )
    if len(turning):
        say(f"right and left differ by {turning['rms'].max():.1f}° RMS, {turning['largest'].max():.1f}° at most")
    if out["rms"].max() > FAR_OUT:
        worst = out["of"].iloc[int(out["rms"].argmax())]
        most = out["rms"].max()
        reserve(f"{worst} is out of the plane by {most:.0f}° (RMS), more than {FAR_OUT:g}°: the plane shortens it")
    if len(turning) and turning["rms"].max() > FAR_APART:
        most = turning["rms"].max()
        reserve(f"the legs do not move alike, by {most:.1f}° (RMS), more than {FAR_APART:g}°: their mean is of neither")
    for one in result.spans:
        _doubt_sliding(result, one)
    if o.height is None:
        say(f"height {height:.2f} m, by shank and thigh of {o.model.name}")
    if given.places:
        say(f"plates: {'; '.join(map(str, given.places))}")
        note("plates", {place.name: place.carries for place in given.places})
    if result.spans:
        say(f"{counted(len(result.spans), 'trial')}: {', '.join(f'{one.task} {one.name}' for one in result.spans)}")
    else:
        why = "no movement found" if o.leg == "both" else "no whole stance is on its plate"
        reserve(f"no {STUDY}: {'stances need `plates`' if o.leg != 'both' and given.feet is None else why}")
    note("out_of_plane_deg", dict(zip(out["of"], out["rms"], strict=True)))
    return result


BY_LEGS = Plausible("the height of a person", m, (0.8, 2.5), (0.8, 1.97), why="999 of 1000 men, ANSUR II")
"""Narrower than `TALL`: legs of a model make no height that was measured, and `height` takes its place."""


def _doubt_height(by_legs: float, o: StandingCoordinatesOptions) -> None:
    """A warning for a height by shank and thigh that is unusual; InputError for one that nobody has."""
    refusal, doubt = BY_LEGS.refusal(by_legs), BY_LEGS.doubt(by_legs)
    if refusal is not None:
        raise InputError(
            o.model, "shank and thigh", refusal[0], "is the model in m, and are `joints` those of its legs?"
        )
    if doubt is not None:
        reserve(f"{o.model}: by shank and thigh {doubt}: is it scaled to this person? give `height`")


def _doubt_sliding(r: StandingCoordinatesResult, one: TaskSpan) -> None:
    """A warning for a flat foot that moves along the ground."""
    inside = (r.time >= one.start) & (r.time <= one.end) & (np.abs(r.given.moved.q[:, 2]) < FLAT)
    if inside.sum() < FEWEST // 2:
        return
    speed = float(np.polyfit(r.time[inside], r.given.moved.q[inside, 0], 1)[0])
    if abs(speed) > SLIDING:
        given = r.options.belt
        remedy = f"check `belt`, {given:g} m/s" if given else "on a treadmill give the speed of its `belt`"
        reserve(f"{one.name}: the flat foot moves at {speed:.2f} m/s: {remedy}")


coordinates = Job("sit-to-stand coordinates", StandingCoordinatesOptions, read, run)
