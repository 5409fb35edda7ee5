"""What inverse kinematics starts from: a model with markers, and where they were seen."""

from __future__ import annotations

from dataclasses import dataclass, replace

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.motion.checked_trial import check_trial
from geocontact.analyses.motion.gait_cycles import events_given, strikes_and_offs
from geocontact.analyses.motion.inverse_kinematics.knees import Knee, knees_of
from geocontact.analyses.motion.inverse_kinematics.options import IkOptions
from geocontact.analyses.motion.inverse_kinematics.segments import (
    Segments,
    segment_tasks,
    segments_given,
    with_segments,
)
from geocontact.analyses.motion.marker_tasks import marker_tasks, renamed
from geocontact.analyses.motion.markers import markers_given, turn_of, with_marker_set
from geocontact.analyses.motion.model_setup import known_setup, setup_tasks
from geocontact.analyses.motion.naming import AUTO, Naming, named_markers
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.identify.signals.gait_cycles import Strikes
from geocontact.io.mocap.c3d_analogs import read_c3d_analogs
from geocontact.io.mocap.segment_poses import holds_segments
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import TextTable
from geocontact.io.text.units import si_unit
from geocontact.trial_checks.recorded import RecordedChannel, TrialInputs


@dataclass(frozen=True)
class KinematicsInputs:
    """A model, its markers as seen, what each counts, knees whose clinical angles are wanted, heel strikes, toe offs.

    `analog` are the channels of a .c3d that belong to no force plate, where they are asked for; `doubts` the checks of
    the recording that warned; `naming` the marker set that is known by name; `segments` what the markers stand for
    where poses of segments or orientations were recorded.
    """

    model: Multibody
    markers: MarkerTrajectories
    tasks: MarkerTasks
    knees: list[Knee]
    strikes: Strikes
    offs: Strikes
    analog: TextTable | None = None
    doubts: frozenset[str] = frozenset()
    naming: Naming | None = None
    segments: Segments | None = None


def read(o: IkOptions) -> KinematicsInputs:
    """Everything the options name."""
    model = read_multibody(o.model)
    add_input("`model`", o.model, bodies=len(model.bodies), coordinates=len(model.coordinates))
    if holds_segments(o.markers):
        return _of_segments(o, model)
    for option in OF_SEGMENTS:
        if getattr(o, option) is not None:
            what = f"has no effect: {o.markers.name} holds markers, not segments"
            raise InputError("", f"`{option}`", what, "leave it out")
    model = with_marker_set(model, o.model, o.marker_set)
    knees = knees_of(o.knee, model)
    seen = renamed(markers_given(o.markers, o.axes, o.time, o.c3d_unit), model, o.markers_map)
    known = None if o.model_setup is None else known_setup(model, o.model_setup)
    asked = AUTO if known is not None and o.naming is None else o.naming
    naming = None if asked is None else named_markers(model, seen, asked)
    model = model if naming is None else naming.model
    add_input("markers", o.markers, frames=len(seen), markers=len(seen.names))
    analog = _analog(o)
    doubts = check_trial(TrialInputs(markers=seen, turn=turn_of(o.axes), channels=_channels(analog)))
    strikes, offs = strikes_and_offs(events_given(o.events, o.markers), o.markers.stem)
    weights = None if naming is None else MarkerTasks(naming.weights)
    if naming is not None and known is not None:
        weights = setup_tasks(known, naming, standing=False)
    tasks = marker_tasks(model, seen, o.tasks, o.follow, o.weight, o.hold, weights)
    return KinematicsInputs(model, seen, tasks, knees, strikes, offs, analog, doubts, naming)


OF_SEGMENTS = ("calibration", "heading")
OF_MARKERS = ("tasks", "marker_set", "naming", "model_setup")
"""Options that mean nothing of the other."""


def _of_segments(o: IkOptions, model: Multibody) -> KinematicsInputs:
    """The same of poses of segments, or of orientations."""
    for option in OF_MARKERS:
        if getattr(o, option) is not None:
            what = f"has no effect: {o.markers.name} holds segments, not markers"
            raise InputError("", f"`{option}`", what, "leave it out; weights are given with `weight`")
    knees = knees_of(o.knee, model)
    segments = segments_given(o, model)
    add_input("segments", o.markers, frames=len(segments.poses), segments=len(segments.names))
    analog = _analog(o)
    doubts = check_trial(TrialInputs(turn=turn_of(o.axes), channels=_channels(analog)))
    strikes, offs = strikes_and_offs(events_given(o.events, o.markers), o.markers.stem)
    tasks, own = segment_tasks(model, segments, o), with_segments(model, segments)
    return KinematicsInputs(own, segments.seen(), tasks, knees, strikes, offs, analog, doubts, segments=segments)


def _channels(analog: TextTable | None) -> tuple[RecordedChannel, ...]:
    """Analog channels whose unit is known, in SI."""
    if analog is None:
        return ()
    found = []
    for name, unit, values in zip(analog.channels, analog.units, analog.values.T, strict=True):
        known = si_unit(unit)
        if known is not None:
            found.append(RecordedChannel(name, known[0], analog.time, known[1] * values, str(analog.file)))
    return tuple(found)


def _analog(o: IkOptions) -> TextTable | None:
    if not o.analog:
        return None
    if o.markers.suffix.lower() != ".c3d":
        raise InputError(o.markers, "`analog`", "is not a .c3d file", "leave it out: only a .c3d holds analog channels")
    found = read_c3d_analogs(o.markers, plates=False)
    if not found.channels or not len(found.time):
        raise InputError(o.markers, "`analog`", "no analog channel but those of force plates", "leave it out")
    if o.time is None:
        return found
    kept = (found.time >= o.time[0] - 1e-6) & (found.time <= o.time[1] + 1e-6)
    return replace(found, time=found.time[kept], values=found.values[kept], lines=found.lines[kept])
