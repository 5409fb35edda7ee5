"""Model, coordinates and the loads on its bodies, as they are read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.motion.checked_trial import check_trial, turned_plates
from geocontact.analyses.motion.gait_cycles import ONSET, events_given, strikes_and_offs
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.markers import turn_of
from geocontact.data.errors import InputError
from geocontact.data.multibody.force_plate import ForcePlate
from geocontact.data.multibody.model import Multibody, PassiveForces
from geocontact.data.sides import stem_and_side
from geocontact.data.wrench import Wrench
from geocontact.dynamics.inverse_dynamics import SMOOTH
from geocontact.dynamics.loads_on_bodies import (
    MisplacedLoad,
    added,
    farthest_line,
    from_bodies,
    misplaced_loads,
    without_torque,
    without_unloaded,
    zero_unloaded,
)
from geocontact.identify.signals.filters import UNEVEN, as_opensim
from geocontact.identify.signals.gait_cycles import Strikes, strikes_on_plates
from geocontact.io.mocap.force_plates import OPENSIM_FRAME, plate_named, read_force_plates
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.external_loads import ExternalLoad, read_external_loads
from geocontact.io.opensim.muscle_paths import require_opensim
from geocontact.io.opensim.osim_forces import read_passive_forces
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import TextTable, listed, read_table
from geocontact.trial_checks.channel_checks import SLOWEST
from geocontact.trial_checks.landmarks import body_points
from geocontact.trial_checks.recorded import FootPlate, MovedModel, TrialInputs

UP = 0.9  # smallest cosine between a plate's normal and the way up
REACH = 1.0  # m from the body's origin to the point that a plate's force acts at


def loads_on_bodies(
    o: IdOptions,
    model: Multibody,
    time: Float[np.ndarray, " t"],
    values: Float[np.ndarray, "t n"],
    unfiltered: Float[np.ndarray, "t n"] | None = None,
) -> dict[str, Wrench]:
    """One wrench on each body that a plate acts on, about the ground's origin; several plates on a body add up.

    Parameters
    ----------
    values, unfiltered
        Coordinates at those times [rad, m], and as the file has them, which checks look at.
    """
    file, loads = _external_loads(o)
    moved = MovedModel(model, time, values if unfiltered is None else unfiltered, str(o.coordinates))
    mass, key = model.mass or None, f"the model's mass (scale it: {o.model})"
    if file is None:
        seen = body_points(model, time, moved.values, moved.source)
        check_trial(TrialInputs(seen, mass=mass, mass_option=key, up=model.up, moved=moved))
        return {}
    recorded = read_force_plates(file, o.c3d_unit)
    plates = turned_plates(recorded, turn_of(o.axes), file)
    add_input("plates", file, plates=len(plates))
    plates_used: list[FootPlate] = []
    if o.axes is not None and all(load.moves for load in loads):
        raise InputError(file, "`axes`", "has no effect: all loads are expressed in bodies", "leave it out")
    found: dict[str, Wrench] = {}
    for load in loads:
        names = tuple(body.name for body in model.bodies)
        for body in (load.body, load.force_frame, load.point_frame):
            if body and body not in names:
                raise InputError(o.loads or "", load.plate, f"no body '{body}'", f"bodies are: {listed(names)}")
        named = "`plate`" if o.loads is None else f"{o.loads} <force_identifier>"
        there = recorded if load.moves else plates
        plate = plate_named(there, load.plate, file, named, model.weight, not load.force_frame)
        poses = model.poses(values)
        if load.moves:
            wrench = _carried(file, plate, load, o.threshold, time, poses)
        else:
            _require_level(plate, file, model)
            plates_used.append(FootPlate(plate, str(file), stem_and_side(load.body)[1]))
            acting = plate.wrench if load.torque else without_torque(plate.wrench)
            wrench = _during(file, replace(plate, wrench=without_unloaded(acting, o.threshold)), time)
        _warn_of_far_points(file, load, wrench, poses[load.body].translation)
        found[load.body] = added(wrench, found[load.body]) if load.body in found else wrench
    check_trial(
        TrialInputs(
            body_points(model, time, moved.values, moved.source),
            plates=tuple(plates_used),
            mass=mass,
            mass_option=key,
            up=model.up,
            turn=turn_of(o.axes),
            moved=moved,
        )
    )
    return found


def _external_loads(o: IdOptions) -> tuple[Path | None, tuple[ExternalLoad, ...]]:
    """The file of the plates, and which acts on what: by OpenSim's external loads or by `plates` and `plate`."""
    if o.loads is not None:
        file, loads = read_external_loads(o.loads)
        add_input("`loads`", o.loads, forces=len(loads))
        return file, loads
    chosen: list[ExternalLoad] = []
    for text in o.plate:
        plate, equals, body = text.rpartition("=")
        if not equals:
            raise InputError("", "`plate`", f"'{text}' is not a plate and a body", "write 1=calcn_r")
        if plate in [each.plate for each in chosen]:
            what = f"plate {plate} is given twice: its force would act twice"
            raise InputError("", "`plate`", what, "give each plate once")
        chosen.append(ExternalLoad(plate, body))
    return o.plates, tuple(chosen)


def _require_level(plate: ForcePlate, file: Path, model: Multibody) -> None:
    """InputError for a plate whose floor is not level in the model's axes."""
    down = model.gravity / max(float(np.linalg.norm(model.gravity)), 1e-12)
    if -plate.normal @ down < UP and np.linalg.norm(model.gravity) > 0.0:
        normal = " ".join(f"{x:.2g}" for x in plate.normal)
        what = f"its floor's normal is {normal}, the model's gravity pulls along {' '.join(f'{x:.2g}' for x in down)}"
        raise InputError(file, plate.name, what, "say which axes are the model's: `axes` x,z,-y where z is up")


def _during(file: Path, plate: ForcePlate, time: Float[np.ndarray, " t"]) -> Wrench:
    if time[0] < plate.time[0] - 1e-6 or time[-1] > plate.time[-1] + 1e-6:
        what = f"runs from {plate.time[0]:g} to {plate.time[-1]:g} s, the motion from {time[0]:g} to {time[-1]:g} s"
        raise InputError(file, plate.name, what, "cut the motion with `time`")
    wrench = plate.at(np.clip(time, plate.time[0], plate.time[-1]))
    lost = ~(np.isfinite(wrench.force).all(axis=1) & np.isfinite(wrench.moment).all(axis=1))
    if lost.any():
        what = (
            f"force, point or torque is missing at {time[np.argmax(lost)]:g} s and in {int(lost.sum())} frames in all"
        )
        raise InputError(file, plate.name, what, "fill the gap, or cut the motion with `time`")
    return wrench


def _carried(
    file: Path,
    plate: ForcePlate,
    load: ExternalLoad,
    threshold: float,
    time: Float[np.ndarray, " t"],
    poses: Mapping[str, RigidTransform],
) -> Wrench:
    """The wrench of a force, torque and point that are expressed in bodies, about the ground's origin."""
    own = zero_unloaded(plate.wrench if load.torque else without_torque(plate.wrench), threshold)
    still = replace(without_torque(own), origin=np.zeros_like(own.origin))
    _during(file, replace(plate, wrench=still), time)  # refuses gaps and other clocks
    turning, carrying = poses.get(load.force_frame), poses.get(load.point_frame)
    wrench = from_bodies(plate.time, own, time, turning, carrying, OPENSIM_FRAME)
    lost = ~np.isfinite(wrench.moment).all(axis=1)
    if lost.any():
        raise InputError(file, plate.name, f"point or torque is missing at {time[np.argmax(lost)]:g} s", "fill the gap")
    return wrench


def _warn_of_far_points(file: Path, load: ExternalLoad, wrench: Wrench, origin: Float[np.ndarray, "t 3"]) -> None:
    """A force whose line passes far from the body it is said to act on: exchanged plates, or noise of a small force."""
    line = farthest_line(wrench, origin)
    if line is None:
        reserve(f"{file}: {load.plate} carries nothing during the motion, or less than `threshold`")
    elif line.distance > REACH:
        what = f"a force of {line.force:.3g} N passes {line.distance:.3g} m from the origin of {load.body}"
        reserve(f"{file}: {load.plate}: {what}: exchanged plates, or a higher `threshold`?")


def warn_of_other_feet(
    model: Multibody, values: Float[np.ndarray, "t c"], loads: Mapping[str, Wrench]
) -> list[MisplacedLoad]:
    """A reservation for each load that passes nearer another loaded body than its own, in most of the frames; those."""
    misplaced = misplaced_loads(model, values, loads)
    for load in misplaced:
        reserve(
            f"the load on {load.body} acts {load.distance:.2f} m from it and {load.nearest_distance:.2f} m from "
            f"{load.nearest} (median over its frames): are the loads of the two exchanged?",
            cause=True,
        )
    return misplaced


@dataclass(frozen=True)
class Loaded:
    """A model that moves under loads.

    Parameters
    ----------
    recorded, unfiltered, values
        Times [s] and coordinates [rad, m] of the whole recording, as they are and filtered.
    time
        Those of them that are wanted.
    loads
        By body, about the ground's origin, at the wanted times.
    strikes
        When feet come to the ground.
    passive
        Forces of the model itself.
    """

    model: Multibody
    recorded: Float[np.ndarray, " n"]
    unfiltered: Float[np.ndarray, "n c"]
    values: Float[np.ndarray, "n c"]
    time: Float[np.ndarray, " t"]
    loads: dict[str, Wrench]
    strikes: Strikes
    passive: PassiveForces

    @property
    def shown(self) -> Float[np.ndarray, "t c"]:
        """Filtered coordinates at the wanted times [rad, m]."""
        first = int(np.searchsorted(self.recorded, self.time[0]))
        return self.values[first : first + len(self.time)]


def read(o: IdOptions) -> Loaded:
    """Everything the options name."""
    if o.muscles:
        require_opensim()
    model = read_multibody(o.model)
    add_input("`model`", o.model, bodies=len(model.bodies), coordinates=len(model.coordinates))
    table = read_table(o.coordinates)
    add_input("coordinates", o.coordinates, frames=len(table.time))
    unfiltered = motion_of(table, model, o.angles)
    values = _filtered(table, unfiltered, o.cutoff)
    shown = _shown(table, o.time)
    time = table.time[shown]
    loads = loads_on_bodies(o, model, time, values[shown], unfiltered[shown])
    strikes, _ = strikes_and_offs(events_given(o.events, Path()), o.coordinates.stem)
    strikes = strikes or strikes_on_plates(time, loads, model.up, ONSET)
    passive = read_passive_forces(o.model, model, o.exclude)
    return Loaded(model, table.time, unfiltered, values, time, loads, strikes, passive)


def _filtered(table: TextTable, values: Float[np.ndarray, "t n"], cutoff: float) -> Float[np.ndarray, "t n"]:
    if len(table.time) <= SMOOTH:
        raise InputError(table.file, "", f"{len(table.time)} frames are too few", f"{SMOOTH + 1} are needed")
    if table.time_unit != "s":
        raise InputError(table.file, "", "time is in per cent of a cycle", "accelerations need seconds")
    if cutoff == 0.0:
        return values
    step = float(table.time[-1] - table.time[0]) / (len(table.time) - 1)
    if np.abs(table.time - table.time[0] - step * np.arange(len(table.time))).max() > UNEVEN * step:
        what = f"frames are not {step:g} s apart to {UNEVEN:.0%} everywhere"
        raise InputError(table.file, "", what, "fill the gaps, or pass `cutoff` 0")
    try:
        return as_opensim(values, step, cutoff)
    except ValueError as error:
        seconds = "" if step < 1.0 / SLOWEST else "; is its time in s, not in ms or frames?"
        remedy = f"0 leaves the coordinates as they are{seconds}"
        raise InputError(table.file, "`cutoff`", str(error), remedy) from error


def _shown(table: TextTable, span: tuple[float, float] | None) -> slice:
    if span is None:
        return slice(None)
    first, last = span
    inside = np.flatnonzero((table.time >= first - 1e-6) & (table.time <= last + 1e-6))
    if not len(inside):
        what = f"no frame between {first:g} and {last:g} s"
        raise InputError(table.file, "`time`", what, f"it is from {table.time[0]:g} to {table.time[-1]:g} s")
    return slice(int(inside[0]), int(inside[-1]) + 1)
