"""The person of a study, and torques of all joints in a trial."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.person import OFF_CENTRE, SUM, WITHIN, doubt_age, doubt_centre, doubt_value, name_unused
from geocontact.data.errors import InputError
from geocontact.identify.signals.filters import zero_lag
from geocontact.io.recordings.described_person import OVER_HIPS
from geocontact.io.recordings.standing_study import StandingPerson, StandingStudy, StandingTrialFiles
from geocontact.io.text.tables import listed, read_table
from geocontact.standing_up.chain import COORDINATES, JOINTS, Subject
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.person_segments import LEG, PersonSegment, from_proximal, segments_of, to_proximal
from geocontact.standing_up.worn_device import FRICTION_NAMES, WornDevice
from geocontact.trial_checks.channel_checks import odd_rate

CUTOFF = 6.0
"""Cut-off of the hinges' angles, whose rates friction follows [Hz]; that of `sit-to-stand device` by default."""
IDLE = 3.0
"""Torque of motors that do not help, in parts of the noise of a torque, at the most."""
LOWER = {"foot": "ankle", "shank": "ankle", "thigh": "knee", "trunk": "hips"}
PROXIMAL = {"foot": "heel", "shank": "knee", "thigh": "hip", "trunk": "hips"}
"""Ends from which centres count in the former spelling, and as all commands have it."""
Times = Float[np.ndarray, " t"]
Table = Float[np.ndarray, "t c"]
Used = Bool[np.ndarray, " t"]


def person_of(study: StandingStudy) -> Subject:
    """Who is described, without the exoskeleton."""
    person = study.person
    stated = {name: values for name, values in person.own.items() if name in LEG}
    stated |= {"trunk": person.over_hips} if person.over_hips else {}
    own = from_proximal(stated, study.height, person.sex) | person.former
    return Subject(study.mass, study.height, sex=person.sex, own=own, age=person.age)


def name_odd_segments(person: StandingPerson, height: float, study: Path) -> None:
    """A warning for segments in the former spelling, and one for those that no chain of standing up has.

    The former says where the new one has their centres, which count from the other end; `height` [m] is the body's.
    """
    unused = [f"segments.{name}" for name in person.own if name not in LEG]
    name_unused((study, "[person]"), unused, "sit-to-stand", f"its head, arms and trunk are segments.{OVER_HIPS}")
    if person.former:
        tables = ", ".join(f"[person.{name}]" for name in person.former)
        new = ", ".join(f"segments.{OVER_HIPS if name == 'trunk' else name}" for name in person.former)
        there = to_proximal(person.former, height, person.sex)
        turned = [
            f"{name} {1e3 * values['centre']:.0f} mm from the {PROXIMAL[name]}, in place of "
            f"{1e3 * person.former[name]['centre']:.0f} from the {LOWER[name]}"
            for name, values in there.items()
            if "centre" in values and name in LEG
        ]
        centres = f"; centres are then {'; '.join(turned)}" if turned else ""
        reserve(f"{study} {tables}: former spelling, with centres from the lower joint; write {new}{centres}")


def confront_segments(subject: Subject, study: Path, person: StandingPerson | None = None) -> None:
    """InputError where the segments' masses leave none for the trunk, or do not sum up to the body's.

    A warning for each own value that is far from that of the table for this mass and height, or not within its segment.
    Centres count as `person` has them: from the proximal end, or from the lower joint in the former spelling and
    without a person.
    """
    doubt_age((study, "[person] age"), subject.sex, subject.age, subject.mass, subject.height)
    masses = {name: segment.mass for name, segment in subject.segments.items()}
    if masses["trunk"] <= 0.0 or abs(sum(masses.values()) / subject.mass - 1.0) > SUM:
        legs = sum(masses.values()) - masses["trunk"]
        what = (
            f"both legs have {legs:.3g} kg and the trunk {masses['trunk']:.3g} kg, of a body of {subject.mass:.3g} kg"
        )
        raise InputError(study, "[person]", what, "masses of foot, shank and thigh are of one leg; check their sum")
    usual = segments_of(subject.mass, subject.height, subject.sex, {}, subject.age)
    beside = f"a person of {subject.mass:.3g} kg and {subject.height:.3g} m"
    for name, values in subject.own.items():
        segment, where = subject.segments[name], f"{study} [person] {name}"
        for key in (key for key in values if key != "centre"):
            doubt_value(where, key, getattr(segment, key), getattr(usual[name], key), segment.length, beside)
        if "centre" in values:
            lower = person is None or name in person.former
            _doubt_own_centre(where, name, segment, usual[name], subject, lower)


def _doubt_own_centre(
    where: str, name: str, own: PersonSegment, usual: PersonSegment, subject: Subject, lower: bool
) -> None:
    """A warning for a centre outside of its segment, far from the table's, or nearer to the table's from the other end.

    `lower` is whether it counts from the lower joint.
    """
    below = [each.centre / each.length for each in (own, usual)]
    above = [
        to_proximal({name: {"centre": each.centre, "length": each.length}}, subject.height, subject.sex)[name]["centre"]
        / each.length
        for each in (own, usual)
    ]
    (share, table), other = (below, above[1]) if lower else (above, below[1])
    end = (LOWER if lower else PROXIMAL)[name]
    if not 0.0 <= share <= WITHIN["centre"]:
        doubt_value(where, "centre", share * own.length, table * own.length, own.length, "")
    elif abs(share - other) < abs(share - table) <= OFF_CENTRE:
        what = f"its centre is at {share:.2f} of its length, {table:.2f} in the table from the {end}"
        from_other = f"{other:.2f} from the {(PROXIMAL if lower else LOWER)[name]}"
        reserve(f"{where}: {what} and {from_other}: which end is it from?", cause=True)
    else:
        doubt_centre(where, share, table, end)


def joint_torques(
    files: StandingTrialFiles, device: WornDevice, time: Times, angles: Table, used: Used, noise: float
) -> Float[np.ndarray, "u j"] | None:
    """Torques of all joints at the times that are used [N m]; None where a trial has none.

    Those of the exoskeleton are in the same file, or its motors' less friction, or friction alone where it does not
    help.

    Parameters
    ----------
    time, angles
        Of the whole recording; coordinates of the exoskeleton's hinges [rad], no column without one.
    noise
        Standard deviation of a torque [N m].
    """
    if files.torques is None:
        return None
    role, at = f"{files.name} torques", time[used]
    person = torques_at(files.torques, JOINTS, role, at)
    if not angles.shape[1]:
        return person
    there = [name for name in EXO_JOINTS if name in read_table(files.torques).channels]
    if there and files.motors is not None:
        remedy = f"leave motors out, or {there[0]} out of {files.torques.name}"
        raise InputError(files.torques, "", f"has torques of the exoskeleton, as has motors of {files.name}", remedy)
    if there or (files.motors is None and files.mode in (None, "active")):
        if not there:
            remedy = f'add {", ".join(EXO_JOINTS)}, name the file of its motors as motors, or write mode = "passive"'
            raise InputError(files.torques, "", f"no column '{EXO_JOINTS[0]}'", remedy)
        torque = columns_at(files.torques, EXO_JOINTS, role, at)
        _doubt_mode(files, torque, noise)
        doubt_friction(files.name, device, f"{files.torques.name} has torques of the hinges, friction included")
        return np.hstack([person, torque])
    step = float(np.ptp(time)) / (len(time) - 1)
    friction = device.friction(np.gradient(zero_lag(angles, step, CUTOFF), step, axis=0))[used]
    if device.without_friction:
        which = ", ".join(device.without_friction)
        reserve(f"{files.name}: hinges without friction ({which}): name device.toml of sit-to-stand device as device")
    motors = np.zeros_like(friction)
    if files.motors is not None:
        motors = columns_at(files.motors, EXO_JOINTS, f"{files.name} motors", at)
        _doubt_mode(files, motors, noise)
    return np.hstack([person, motors - friction])


def doubt_friction(trial: str, device: WornDevice, why: str) -> None:
    """A warning for described friction that a trial does not use; identified one stands beside bodies that are used."""
    unused = [name for name in FRICTION_NAMES if name in device.stated and device.stated[name].value != 0.0]
    if unused and not device.identified:
        reserve(f"{trial}: friction of the exoskeleton's description ({', '.join(unused)}) has no effect, as {why}")


def _doubt_mode(files: StandingTrialFiles, torque: Table, noise: float) -> None:
    """A mode that the torques contradict."""
    size = float(np.sqrt(np.mean(torque**2, axis=0)).max())
    if files.mode in ("passive", "off") and size > IDLE * noise:
        reserve(f"{files.name}: mode {files.mode}, and torques of {size:.1f} N m (root mean square): it helps")
    if files.mode == "active" and size < noise:
        reserve(f"{files.name}: mode active, and torques of {size:.2g} N m (root mean square): it does not help")


def torques_at(file: Path, names: Sequence[str], role: str, time: Times) -> Float[np.ndarray, "t c"]:
    """Torques at the times of the trial [N m]; InputError for a file of coordinates, whose columns have these names."""
    table = read_table(file)
    placed = [name for name in COORDINATES[:3] if name in table.channels]
    if placed:
        what = f"has columns {listed(tuple(placed))}: it holds coordinates, not torques"
        raise InputError(file, "", what, "give torques of the joints in N m, such as those of inverse dynamics")
    return columns_at(file, names, role, time)


def columns_at(file: Path, names: Sequence[str], role: str, time: Times) -> Float[np.ndarray, "t c"]:
    """Columns as they are, in SI, at the times of the trial."""
    table = read_table(file)
    add_input(role, file, frames=len(table.time))
    for odd in odd_rate(str(file), "", table.time):
        reserve(str(odd))
    values = np.column_stack([table.needed(name) for name in names])
    begin, end = table.time[[0, -1]]
    if begin > time[0] + 1e-6 or end < time[-1] - 1e-6:
        what = f"runs from {begin:g} to {end:g} s, the trial from {time[0]:g} to {time[-1]:g} s"
        raise InputError(file, "", what, "is it of another trial? name its own file, or put both on one clock")
    return np.column_stack([np.interp(time, table.time, column) for column in values.T])
