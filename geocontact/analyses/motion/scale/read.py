"""What scaling starts from: a generic model, a static trial, and how much each body is to grow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.motion.marker_names import renamed
from geocontact.analyses.motion.marker_tasks import marker_tasks
from geocontact.analyses.motion.markers import markers_given, with_marker_set
from geocontact.analyses.motion.scale.factors import factors_told
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_tasks import MarkerTasks
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.scaling import Factors
from geocontact.io.opensim.osim_multibody import read_multibody

MOVED = 0.02
"""m that a marker may move in a static trial without a word."""


@dataclass(frozen=True)
class Standing:
    """A model, a static trial and its mean as one frame, factors by body, and what each marker counts."""

    model: Multibody
    recorded: MarkerTrajectories
    markers: MarkerTrajectories
    factors: Factors
    tasks: MarkerTasks


def read(o: ScaleOptions, record: Record) -> Standing:
    """Everything the options name."""
    model = read_multibody(o.model)
    record.add_input("`model`", o.model, bodies=len(model.bodies), markers=len(model.markers))
    model = with_marker_set(record, model, o.model, o.marker_set)
    whole = renamed(record, markers_given(o.static, o.axes, o.time, o.c3d_unit), model, o.markers_map)
    seen = _standing(record, whole)
    record.add_input("static", o.static, frames=len(whole), markers=len(seen.names))
    factors = factors_told(model, _measured(o, record, model, whole), o.scale)
    return Standing(model, whole, seen, factors, marker_tasks(record, model, seen, o.tasks))


def _measured(o: ScaleOptions, record: Record, model: Multibody, standing: MarkerTrajectories) -> MarkerTrajectories:
    """Trial and times of the distances of markers."""
    if o.sizes is None and o.sizes_time is None:
        return standing
    if not any("/" in text for text in o.scale):
        named = "`sizes`" if o.sizes is not None else "`sizes_time`"
        raise InputError("", named, "has no effect: no body is measured", "name pairs of markers with `scale`")
    file, time = o.sizes or o.static, o.sizes_time if o.sizes_time is not None or o.sizes is not None else o.time
    seen = renamed(record, markers_given(file, o.axes, time, o.c3d_unit), model, o.markers_map)
    if o.sizes is not None:
        record.add_input("`sizes`", o.sizes, frames=len(seen), markers=len(seen.names))
    return seen


def _standing(record: Record, seen: MarkerTrajectories) -> MarkerTrajectories:
    """One frame: the mean over the trial of each marker where it was seen."""
    there = np.isfinite(seen.positions).all(axis=2).any(axis=0)
    positions: Float[np.ndarray, "m 3"] = np.full(seen.positions.shape[1:], np.nan)
    positions[there] = np.nanmean(seen.positions[:, there], axis=0)
    off = np.linalg.norm(seen.positions - positions, axis=2)
    moved = [(float(np.nanmax(off[:, k])), seen.names[k]) for k in np.flatnonzero(there)]
    far, name = max(moved)
    if far > MOVED:
        record.warn(f"{seen.source}: {name} moves {1e3 * far:.0f} mm away from its mean: is this standing still?")
    return MarkerTrajectories(seen.time[:1], positions[None], seen.names, seen.source)
