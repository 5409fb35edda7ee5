"""What the person feels of the device, bounded from two sides: motion kept, and torque of the shoulder kept.

Loads of shoulder, elbow and lower back, and sway about the ankles, without and with the device.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import note, reserve, say
from geocontact.analyses.person import person_segments
from geocontact.analyses.shoulder.simulate.arms import Worn
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.data.errors import InputError
from geocontact.data.motion import Course
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.arms_from_markers import MarkerSettings
from geocontact.shoulder_exoskeleton.carried_device import forces_of_device
from geocontact.shoulder_exoskeleton.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.human_arm import ArmTrack, ToolWork, arm_track, hand_load, smoothed
from geocontact.shoulder_exoskeleton.joint_loads import (
    ArmNeeds,
    Load,
    PersonNumbers,
    Trunk,
    arm_needs,
    back_needs,
    bending_torque,
    extending_torque,
    raising_torque,
    trunk_of,
)
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation
from geocontact.shoulder_exoskeleton.sway import ANKLE, STIFFNESS, InvertedPendulum
from geocontact.shoulder_exoskeleton.torque_kept import LeavesAtOnceError, TorqueKept, torque_kept
from geocontact.shoulder_exoskeleton.working_arm import SimulatedArm
from geocontact.view.curves.declared import Curve, Curves, CurveSheet, stroke

WITHOUT, MOTION, TORQUE = "without", "motion kept", "torque kept"
WAYS = (WITHOUT, MOTION, TORQUE)
WHOLE, UNTIL = "whole recording", "until an arm leaves its range"
SHOULDERS = 0.818
"""Height of the shoulders over the stature (Winter 2009, Biomechanics and Motor Control, fig. 4.1)."""
MISSED = 0.1
"""Share of the largest torque kept, from which what the equations miss of it is warned of; a choice."""
Row = Float[np.ndarray, " t"]


@dataclass(frozen=True, eq=False)
class PersonQuantity:
    """One load or motion over time by the three ways, in SI; what keeps its torque may be shorter, or empty.

    Parameters
    ----------
    where, name
        Of whom and what.
    unit, factor
        Of tables, and how many of it one SI unit is.
    """

    where: str
    name: str
    unit: str
    factor: float
    by: Mapping[str, Row]


@dataclass(frozen=True, eq=False)
class PersonAnswers:
    """All quantities, and the motion of each arm while its torque is kept.

    Parameters
    ----------
    time
        Of the recording [s].
    kept
        By side; none in a cuff that holds by its surface.
    until
        How many frames there are before an arm leaves its range; 0 where one keeps none.
    """

    time: Row
    quantities: tuple[PersonQuantity, ...]
    kept: Mapping[Side, TorqueKept]
    until: int


@dataclass(frozen=True, eq=False)
class _Side:
    """One arm of the person: joints, what they need, loads of the device by way."""

    side: Side
    track: ArmTrack
    needs: ArmNeeds
    device: Mapping[str, Load]
    kept: TorqueKept | None
    after: ArmNeeds | None
    device_after: Mapping[str, Load]


def person_answers(worn: Worn, arms: Sequence[SimulatedArm], o: ShoulderSimulateOptions) -> PersonAnswers | None:
    """None where the person's mass is not stated; says what was found."""
    if o.mass is None:
        return None
    if o.cuff != "point":
        reserve("`cuff` surface: the person's motion while the shoulder's torque is kept is computed for a point only")
    sides = [_side(worn, arm, o, o.mass) for arm in arms]
    time = sides[0].track.time
    kept = {each.side: each.kept for each in sides if each.kept is not None}
    until = min(0 if each.kept is None else len(each.kept.departure) for each in sides)
    found = [quantity for each in sides for quantity in _of_arm(each)]
    if len(sides) == len(("right", "left")):
        found += _of_trunk(worn, sides, o, o.mass, until)
    else:
        reserve("lower back and sway need both arms: leave `side` out")
    answers = PersonAnswers(time, tuple(found), kept, until)
    _say(answers)
    return answers


def _given(o: ShoulderSimulateOptions, mass: float) -> PersonNumbers:
    segments = person_segments(o.sex or "male", o.age, mass, o.height, {}, ("", ""))
    return PersonNumbers(mass=mass, segments=segments, gravity=np.array(MarkerSettings().gravity))


def _side(worn: Worn, arm: SimulatedArm, o: ShoulderSimulateOptions, mass: float) -> _Side:
    s, frame = arm.simulation, worn.frame
    seen = np.stack(
        [frame.origin + np.einsum("tji,tj->ti", frame.rotation, each) for each in worn.markers.swapaxes(0, 1)], axis=1
    )
    track = arm_track(MarkerTrajectories(s.motion.time, seen, worn.names, str(o.markers)), frame, arm.side)
    track = track if o.cutoff == 0.0 else smoothed(track, o.cutoff)
    work = ToolWork(o.tool_mass or 0.0, o.push or 0.0)
    running = np.zeros(len(s.motion.time), bool) if worn.tool is None else worn.tool
    hand = hand_load(work, arm.side, o.dominant or "right", running)
    given = _given(o, mass)
    needs = arm_needs(track, hand, **given)
    if o.cuff != "point":
        return _Side(arm.side, track, needs, loads_in_laboratory(s, frame), None, None, {})
    try:
        kept = torque_kept(track, hand, s, frame, factor=arm.factor, **given)
    except LeavesAtOnceError as error:
        reserve(f"{arm.side} arm: {error}: it is computed for the motion kept only")
        return _Side(arm.side, track, needs, loads_in_laboratory(s, frame), None, None, {})
    except ArithmeticError as error:
        raise InputError(o.markers, "`mass`", f"{arm.side} arm: {error}", "leave `mass` out") from error
    count = len(kept.departure)
    cut = DeviceFrame(frame.origin[:count], frame.rotation[:count])
    held = type(hand)(hand.mass, np.broadcast_to(hand.force, track.hand.shape)[:count])
    after = arm_needs(kept.track, held, **given)
    device_after = loads_in_laboratory(kept.simulation, cut)
    return _Side(arm.side, track, needs, loads_in_laboratory(s, frame), kept, after, device_after)


def loads_in_laboratory(s: ArmSimulation, frame: DeviceFrame) -> dict[str, Load]:
    """All that one side of the device does to the person, by name (`forces_of_device`)."""
    found = {}
    for name, wrench in forces_of_device(s).items():
        force, place, moment = (np.asarray(np.einsum("tji,tj->ti", frame.rotation, each)) for each in wrench)
        found[name] = Load(force, frame.origin + place, moment)
    return found


def _of_arm(one: _Side) -> Iterator[PersonQuantity]:
    where, track, needs, kept, after = f"{one.side} arm", one.track, one.needs, one.kept, one.after
    cuff = one.device["cuff"]
    torque = {WITHOUT: raising_torque(track, needs), MOTION: raising_torque(track, needs, cuff)}
    bend = bending_torque(track, needs)
    elbow = {WITHOUT: bend, MOTION: bend}
    raised = np.arccos(np.clip(np.einsum("ti,ti->t", _along(track), track.down), -1.0, 1.0))
    elevation = {WITHOUT: raised, MOTION: raised}
    if kept is not None and after is not None:
        torque[TORQUE] = kept.kept
        elbow[TORQUE] = bending_torque(kept.track, after)
        elevation[TORQUE] = raised[: len(kept.departure)] + kept.departure
    yield PersonQuantity(where, "raising torque of the shoulder", "N m", 1.0, torque)
    yield PersonQuantity(where, "bending torque of the elbow", "N m", 1.0, elbow)
    yield PersonQuantity(where, "elevation", "deg", float(np.degrees(1.0)), elevation)


def _along(track: ArmTrack) -> Float[np.ndarray, "t 3"]:
    arm = track.elbow - track.shoulder
    return np.asarray(arm / np.linalg.norm(arm, axis=1, keepdims=True))


def _of_trunk(
    worn: Worn, sides: Sequence[_Side], o: ShoulderSimulateOptions, mass: float, until: int
) -> Iterator[PersonQuantity]:
    trunk = trunk_of([each.track for each in sides], worn.frame, worn.wearer.torso)
    given = _given(o, mass)
    needs = back_needs(trunk, [each.needs for each in sides], **given)
    devices = [each.device for each in sides]
    back = {WITHOUT: extending_torque(trunk, needs), MOTION: extending_torque(trunk, needs, devices)}
    if given["segments"].age is not None and o.height is None:
        reserve("the sway of a child is that of an adult's height; give `height`")
    height = o.height or given["segments"].stature
    try:
        person = InvertedPendulum(mass, height, STIFFNESS if o.ankle_stiffness is None else o.ankle_stiffness)
    except ValueError as error:
        raise InputError("", "`ankle_stiffness`", str(error), "the ankles alone have 0.91 of it") from error
    ankle = trunk.shoulders[:1] - (SHOULDERS - ANKLE) * height * np.array([[0.0, 1.0, 0.0]])
    pushed = _leaning(trunk, ankle, devices)
    before = float(pushed[0])
    lean = {WITHOUT: np.zeros(len(trunk.time)), MOTION: person.sway(trunk.time, pushed, before)}
    if until:
        cut = Trunk(trunk.time[:until], trunk.hips[:until], trunk.shoulders[:until], trunk.left[:until])
        loads = [{name: _first(load, until) for name, load in each.device_after.items()} for each in sides]
        changes = [_change(each, until) for each in sides]
        needed = extending_torque(trunk, needs)[:until]
        back[TORQUE] = needed + extending_torque(cut, _none(cut), [*changes, *loads])
        # the arms' reaction to the device's torque begins at the first frame: nobody stands in its equilibrium before
        lean[TORQUE] = person.sway(cut.time, _leaning(cut, ankle, [*changes, *loads]), before)
    yield PersonQuantity("lower back", "extending torque", "N m", 1.0, back)
    yield PersonQuantity(
        "whole body", "lean forwards about the ankles by the device", "deg", float(np.degrees(1.0)), lean
    )


def _change(one: _Side, count: int) -> dict[str, Load]:
    """What the arm does to the trunk more than in its recorded motion: the opposite of what it needs more."""
    if one.after is None:
        return {}
    return {"before": _first(one.needs.shoulder, count), "after": _first(one.after.shoulder, count).opposite()}


def _none(trunk: Trunk) -> Load:
    return Load(0.0 * trunk.hips, trunk.hips, 0.0 * trunk.hips)


def _first(load: Load, count: int) -> Load:
    return Load(load.force[:count], load.place[:count], load.moment[:count])


def _leaning(trunk: Trunk, ankle: Float[np.ndarray, "1 3"], loads: Sequence[Mapping[str, Load]]) -> Row:
    """Moment of loads about the ankles that leans forwards [N m]."""
    point = np.broadcast_to(ankle, trunk.hips.shape)
    moment = np.sum([load.about(point) for side in loads for load in side.values()], axis=0)
    return np.asarray(np.einsum("ti,ti->t", trunk.left, moment))


SIZES: Mapping[str, Callable[[Row], float]] = {
    "mean": lambda values: float(np.mean(values)),
    "largest": lambda values: float(values[np.argmax(np.abs(values))]),
}


def person_table(found: PersonAnswers) -> pd.DataFrame:
    """Mean and largest of every quantity by the three ways, over the whole recording and, where an arm that keeps its
    torque leaves its range, over the time before; empty where a way does not last as long.
    """
    whole = len(found.time)
    spans = {WHOLE: whole} | ({UNTIL: found.until} if 0 < found.until < whole else {})
    rows = []
    for part, count in spans.items():
        for each in found.quantities:
            for name, size in SIZES.items():
                by = {
                    way: each.factor * size(each.by[way][:count])
                    if way in each.by and len(each.by[way]) >= count
                    else np.nan
                    for way in WAYS
                }
                told = {"part": part, "to [s]": found.time[count - 1], "where": each.where, "quantity": each.name}
                rows.append({**told, "size": name, "unit": each.unit, **by})
    return pd.DataFrame(rows)


def _say(found: PersonAnswers) -> None:
    for each in found.quantities:
        if each.name == "elevation" or "elbow" in each.name:
            continue
        before, after = (each.factor * each.by[way] for way in (WITHOUT, MOTION))
        ends = ", ".join(f"{name} {size(before):.3g} to {size(after):.3g}" for name, size in SIZES.items())
        say(f"{each.where}, motion kept: {each.name} {ends} {each.unit}")
    for side, kept in found.kept.items():
        most = np.degrees(kept.departure[np.argmax(np.abs(kept.departure))])
        end = f"leaves its range at {kept.track.time[-1]:.2f} s" if kept.left_range else "stays in its range"
        say(f"{side} arm, torque kept: {end}, up to {most:.0f} deg from its recorded motion")
        largest = float(np.abs(kept.kept).max())
        if kept.unexplained > MISSED * largest:
            what = f"equations in three dimensions miss {kept.unexplained:.2g} N m (RMS) of up to {largest:.2g} N m"
            reserve(f"{side} arm, torque kept: {what}: its motion is a rough bound")
    if found.until:
        unexplained = {side: kept.unexplained for side, kept in found.kept.items()}
        note("torque kept", {"misses_N_m": unexplained, "until_s": float(found.time[found.until - 1])})


def person_curves(found: PersonAnswers) -> CurveSheet:
    """A panel for each quantity, by the three ways; what ended before has no values after."""
    panels = []
    for each in found.quantities:
        curves = []
        for k, way in enumerate(WAYS):
            if way in each.by:
                values = np.full(len(found.time), np.nan)
                values[: len(each.by[way])] = each.factor * each.by[way]
                curves.append(Curve(way, values, stroke=stroke(k, k)))
        panels.append(Curves(f"{each.where.capitalize()}: {each.name}", each.unit, curves))
    return CurveSheet(panels, Course("time", "s", found.time))
