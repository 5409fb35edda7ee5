"""Markers of a model along a motion."""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.analyses.motion.virtual_markers.options import MarkersOptions
from geocontact.analyses.motion.virtual_markers.result import MarkersResult
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import TextTable, read_table


@dataclass(frozen=True)
class Moved:
    """A model with markers, and its coordinates over time."""

    model: Multibody
    table: TextTable


def read(o: MarkersOptions, record: Record) -> Moved:
    """Everything the options name."""
    model = read_multibody(o.model)
    record.add_input("`model`", o.model, bodies=len(model.bodies), markers=len(model.markers))
    if not model.markers:
        raise InputError(o.model, "", "has no markers", "give a model with a MarkerSet")
    table = read_table(o.coordinates)
    record.add_input("coordinates", o.coordinates, frames=len(table.time))
    if table.time_unit != "s":
        raise InputError(o.coordinates, "", "time is in per cent of a cycle", "a .trc file needs seconds")
    return Moved(model, table)


def run(moved: Moved, o: MarkersOptions, record: Record) -> MarkersResult:
    """Places of all markers in every frame."""
    model, table = moved.model, moved.table
    names = tuple(m.name for m in model.markers)
    values = motion_of(table, model, o.angles)
    places = model.marker_places(values)
    record.results.update(frames=len(table.time), markers=len(names))
    record.say(f"{len(names)} markers in {len(table.time)} frames")
    markers = MarkerTrajectories(table.time, places, names)
    return MarkersResult(record=record, options=o, markers=markers, model=model, values=values)
