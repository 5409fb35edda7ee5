"""Which markers of a recording and a model count, by how much, and how far they are from each other after a fit.

Limits are those of OpenSim's documentation, "Checklist - Evaluating your simulation": in inverse kinematics root mean
squares below about 2 cm and a largest error below 4 cm; in scaling 1 cm and 2 cm.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.collector import add_input, current, reserve
from geocontact.analyses.frame.quantities import named_file, number
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import Followed, MarkerTasks, MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import FEWEST, Poses
from geocontact.io.mocap.markers import marker_map_typed, read_marker_map
from geocontact.io.opensim.coordinates import columns_of, coordinates_of
from geocontact.io.opensim.marker_weights import read_marker_weights, tasks_file
from geocontact.io.text.column_names import near_names
from geocontact.io.text.tables import listed, read_table

MANY = 80  # names that a message still lists: marker sets of whole bodies


def renamed(seen: MarkerTrajectories, model: Multibody, given: str | None) -> MarkerTrajectories:
    """Recorded markers by the model's names, as `markers_map` says; others keep theirs."""
    if given is None:
        return seen
    file = named_file(given)
    names = marker_map_typed(given, "`markers_map`") if file is None else read_marker_map(file)
    if file is not None:
        add_input("`markers_map`", file, markers=len(names))
    own = {m.name for m in model.markers}
    usable = {lab: name for lab, name in names.items() if lab in seen.names and name in own}
    if not usable:
        what = f"does not pair a recorded marker with one of the model ({_pairs(names)})"
        raise InputError(file or "", "`markers_map`", what, names_told(seen, model))
    lost, foreign = [lab for lab in names if lab not in seen.names], [n for n in names.values() if n not in own]
    for what, which, there in (("was not recorded", lost, seen.names), ("is not in the model", foreign, tuple(own))):
        if which:
            near = near_names(which, there)
            hint = f"; perhaps {', '.join(near.values())}" if near else ""
            reserve(f"`markers_map`: {listed(tuple(which))} {what}{hint}")
    try:
        return seen.renamed(usable)
    except ValueError as error:
        raise InputError(file or "", "`markers_map`", str(error), "map that one too, or leave it out") from error


def names_told(seen: MarkerTrajectories, model: Multibody) -> str:
    """The names of both sides, and a map where they are nearly alike."""
    own = tuple(m.name for m in model.markers)
    both = f"recorded are: {listed(seen.names, MANY)}; the model's are: {listed(own, MANY)}"
    hint = map_hint(seen, [name for name in own if name not in seen.names])
    return f"{both}; {hint}" if hint else both


def map_hint(seen: MarkerTrajectories, wanted: Sequence[str]) -> str:
    """What to pass where wanted markers are nearly called like recorded ones; empty where none is."""
    near = near_names(wanted, [name for name in seen.names if name not in wanted])
    return f"perhaps `markers_map` {_pairs({lab: name for name, lab in near.items()})}" if near else ""


def _pairs(names: dict[str, str]) -> str:
    text = ",".join(f"{lab}={name}" for lab, name in names.items())
    return f'"{text}"' if " " in text else text


FAR = 0.05
"""m of root mean square that no subject has who stood model for it."""


@dataclass(frozen=True)
class MarkerLimits:
    """Largest root mean square and largest distance of markers from a model that are good enough [m]."""

    rms: float
    largest: float

    @property
    def words(self) -> str:
        """The two, in mm."""
        return f"{1e3 * self.rms:g} and {1e3 * self.largest:g} mm"


MOVING, STANDING = MarkerLimits(0.02, 0.04), MarkerLimits(0.01, 0.02)


@dataclass(frozen=True)
class MarkerErrors:
    """Distances of markers from a model over all frames and markers [m], and where the largest is [s]."""

    rms: float
    largest: float
    marker: str
    time: float

    @classmethod
    def of(cls, poses: Poses) -> MarkerErrors:
        """Errors of the markers that were seen and count."""
        frame, which = np.unravel_index(int(np.nanargmax(poses.distances)), poses.distances.shape)
        rms = float(np.sqrt(np.nanmean(poses.distances**2)))
        largest = float(poses.distances[frame, which])
        return cls(rms, largest, poses.markers[int(which)], float(poses.time[frame]))

    def within(self, limits: MarkerLimits) -> bool:
        """Whether they are good enough."""
        return self.rms <= limits.rms and self.largest <= limits.largest

    def words(self, limits: MarkerLimits) -> str:
        """The numbers in one clause."""
        return (
            f"{1e3 * self.rms:.1f} mm from the model, root mean square, and {1e3 * self.largest:.1f} mm at most, "
            f"{self.marker} at {self.time:.3g} s (OpenSim advises less than {limits.words})"
        )

    def warn(self, limits: MarkerLimits, why: str = "") -> None:
        """One line where they are beyond the limits; `why` is the cause that was found."""
        if self.within(limits):
            return
        check = f"check where {self.marker} is on the model and in the recording, the scaling, and exchanged markers"
        if self.rms > FAR:
            check = "another subject's size, axes (`axes`) or unit?"
        reserve(f"markers are {self.words(limits)}: {why or check}")


HELD = 1e3  # weight of a coordinate that is held, against 1 of a marker: a radian as dear as 30 m of a marker


def marker_tasks(
    model: Multibody,
    seen: MarkerTrajectories,
    file: Path | None,
    follow: Path | None = None,
    weight: tuple[str, ...] = (),
    hold: tuple[str, ...] = (),
    known: MarkerTasks | None = None,
) -> MarkerTasks:
    """Weights of the task file, those that are `known`, or 1 for every marker; then what single options say.

    `follow` is the recording that tasks of the kind from_file keep coordinates near.
    """
    if not model.markers:
        raise InputError(
            str(current().options["model"]), "", "has no markers", "give a model with a MarkerSet, or `marker_set`"
        )
    if file is None:
        tasks = known or MarkerTasks({m.name: 1.0 for m in model.markers})
    else:
        tasks = read_marker_weights(file)
        add_input("`tasks`", file, markers=len(tasks.markers), coordinates=len(tasks.coordinates))
        if (named := tasks_file(file)) != file:
            add_input("tasks that it names", named)
    coordinates = {c.name for c in model.coordinates}
    markers = {**tasks.markers, **weights_typed(weight, {m.name for m in model.markers}, "R.Heel=10")}
    wanted = held_near(model, hold)
    _refuse_few_in_common(model, seen, markers)
    weighed = [name for name, (weight, _) in tasks.coordinates.items() if weight > 0.0]
    _warn(model, seen, markers, [*weighed, *tasks.from_file])
    near = {name: by for name, by in tasks.from_file.items() if name in coordinates and name not in wanted}
    followed = _followed(model, seen, near, file, follow)
    return MarkerTasks(markers, {**tasks.coordinates, **wanted}, near, followed)


def weights_typed(texts: tuple[str, ...], names: set[str], example: str) -> dict[str, float]:
    """Weights by name from `weight`; InputError for a name that is not among these, and for one below 0."""
    found = _named(texts, "`weight`", names, example)
    if min(found.values(), default=0.0) < 0.0:
        raise InputError("", "`weight`", "a weight is negative", "weights are 0 or more")
    return found


def held_near(model: Multibody, hold: tuple[str, ...]) -> dict[str, tuple[float, float]]:
    """Weight and value [rad, m] of each coordinate that `hold` names."""
    known = {c.name: c for c in model.coordinates}
    held = _named(hold, "`hold`", set(known), "subtalar_angle_r=5.2")
    fixed = [name for name in held if known[name].locked]
    if fixed:
        raise InputError("", "`hold`", f"'{fixed[0]}' is locked by the model", "unlock it there, or leave it out")
    return {name: (HELD, np.radians(v) if known[name].kind == "rotational" else v) for name, v in held.items()}


def _followed(
    model: Multibody,
    seen: MarkerTrajectories,
    near: Mapping[str, float],
    tasks: Path | None,
    follow: Path | None,
) -> dict[str, Followed]:
    """Recordings of the coordinates that tasks of the kind from_file name."""
    if not near and follow is None:
        return {}
    if not near:
        raise InputError(tasks or "", "`follow`", "has no effect: no task is of the kind from_file", "leave it out")
    if follow is None:
        what = f"{listed(tuple(near))} follows a recording"
        raise InputError(tasks or "", "", what, "name its file with `follow` in ik; scale takes manual_value")
    table = read_table(follow)
    add_input("`follow`", follow, frames=len(table.time))
    columns = columns_of(table, model.joints)
    lost = [name for name in near if name not in columns]
    if lost:
        raise InputError(follow, "", f"no column for {lost[0]}", f"columns are: {listed(table.channels)}")
    values = coordinates_of(table, model.joints, columns, None)
    found = {name: Followed(table.time, values[name]) for name in near}
    try:
        found[next(iter(near))].at(seen.time)
    except ValueError as error:
        raise InputError(follow, "", str(error), "cut the markers with `time`") from error
    return found


def _refuse_few_in_common(model: Multibody, seen: MarkerTrajectories, markers: dict[str, float]) -> None:
    """InputError with the names of both sides where hardly a marker is common to them."""
    common = sum(markers.get(m.name, 0.0) > 0.0 for m in model.markers if m.name in seen.names)
    if common < FEWEST:
        what = f"{common} markers of the model were recorded and have a weight; {FEWEST} are needed"
        raise InputError(seen.source, "", what, names_told(seen, model))


def _warn(model: Multibody, seen: MarkerTrajectories, markers: dict[str, float], coordinates: list[str]) -> None:
    """Say which weights count nothing: of what was never seen, of what the model lacks."""
    visible = np.isfinite(seen.positions).all(axis=2).any(axis=0)
    there = {name for name, once in zip(seen.names, visible, strict=True) if once}
    weighty = [name for name, weight in markers.items() if weight > 0.0]
    own = {m.name for m in model.markers}
    rows = (
        ("markers that have a weight were not recorded", [n for n in weighty if n in own and n not in there]),
        ("markers that have a weight are not in the model", [n for n in weighty if n not in own]),
        (
            "coordinates that have a weight are not in the model",
            [n for n in coordinates if n not in {c.name for c in model.coordinates}],
        ),
    )
    for what, names in rows:
        if names:
            hint = map_hint(seen, names) if "recorded" in what else ""
            reserve("; ".join(each for each in (f"{seen.source}: {what}: {listed(tuple(names))}", hint) if each))


def _named(texts: tuple[str, ...], option: str, names: set[str], example: str) -> dict[str, float]:
    found = {}
    for text in texts:
        name, equals, value = text.rpartition("=")
        if not equals or name not in names:
            what = f"'{text}' is not in the model"
            raise InputError("", option, what, f"write for example {example}; there are {listed(tuple(sorted(names)))}")
        if name in found:
            raise InputError("", option, f"{name} is given twice", "give each once")
        found[name] = number(value, option, example)
    return found
