"""Arms of an exoskeleton on a person who moves: what is read, controllers, simulation of each arm, tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Bool, Float

from geocontact.analyses.frame.collector import add_input, note, reserve, say
from geocontact.analyses.motion.checked_trial import StandsOn, check_trial, standing_on
from geocontact.analyses.motion.markers import markers_given, renamed_as_told, turn_of
from geocontact.analyses.shoulder.devices import device_named, read_profiles, wearer_named
from geocontact.analyses.shoulder.recordings import RAISED, current_at, doubt_tool, tool_runs
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.simulated_arm import out_of_cuff_clause, warn_of
from geocontact.data.errors import InputError
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, Side
from geocontact.shoulder_exoskeleton.arms_from_markers import SIDES, MarkerSettings
from geocontact.shoulder_exoskeleton.cuff_contact import OutOfCuffError
from geocontact.shoulder_exoskeleton.device import JOINTS, QUANTITIES, Device, Wearer, cylinder_length, lever
from geocontact.shoulder_exoskeleton.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.sensitivity import Influence
from geocontact.shoulder_exoskeleton.smoothed_arms import smoothed_arms
from geocontact.shoulder_exoskeleton.support.controlled_arm import Controller, hand_controller
from geocontact.shoulder_exoskeleton.support.controller_numbers import (
    CONTROLLED,
    controller_numbers,
    sensing_of,
    thresholds_of,
)
from geocontact.shoulder_exoskeleton.support.outcome import Factors
from geocontact.shoulder_exoskeleton.support.phase_machine import PhaseCheck, phase_check, phases_by_onset
from geocontact.shoulder_exoskeleton.support.profile_limits import FactorKey, Hand
from geocontact.shoulder_exoskeleton.work_phases import PHASES
from geocontact.shoulder_exoskeleton.working_arm import SCREWING, SimulatedArm, arm_at_work
from geocontact.trial_checks.recorded import TrialInputs
from geocontact.trial_checks.table import WORK_CHECKS

CURRENT = 1.0
"""A; a tool that idles takes less."""
WAYS = ("distal", "medial", "raising")
"""Axes of the cuff."""


@dataclass(frozen=True, eq=False)
class Worn:
    """A device on a person who moves.

    Parameters
    ----------
    arms
        Filtered, without gaps, at even times.
    frame
        The device in the laboratory at the same times.
    markers, names
        All that were recorded, in the device's frame at the same times [m]; NaN where they were not seen.
    tool
        Whether the tool runs; None where it is not known.
    controllers
        By side; None where the support is constant.
    """

    arms: tuple[ArmMotion, ...]
    frame: DeviceFrame
    markers: Float[np.ndarray, "t m 3"]
    names: tuple[str, ...]
    device: Device
    wearer: Wearer
    tool: Bool[np.ndarray, " t"] | None
    controllers: Mapping[Side, Controller] | None


def read(o: ShoulderSimulateOptions) -> Worn:
    """Everything the options name."""
    return worn_along(o, wearer_named(o.person, back=o.mass is not None))


def worn_along(
    o: ShoulderSimulateOptions,
    wearer: Wearer,
    mass: float | None = None,
    mass_option: str = "`mass`",
    age: float | None = None,
) -> Worn:
    """The same on a wearer who is known.

    Mass [kg] and age [years] are given where they are no options but stand elsewhere, the mass at `mass_option`.
    """
    device = device_named(o.device)
    seen = renamed_as_told(markers_given(o.markers, o.axes, o.time, o.c3d_unit), o.markers_map)
    add_input("markers", o.markers, frames=len(seen), markers=len(seen.names))
    mass = o.mass if mass is None else mass
    on = StandsOn() if mass is None else standing_on(seen, o.markers, turn_of(o.axes), o.c3d_unit)
    arm = None if o.person is None else wearer.upper_arm
    age = o.age if age is None else age
    given = TrialInputs(mass=mass, height=o.height, upper_arm=arm, mass_option=mass_option, age=age)
    trial = replace(given, markers=seen, plates=on.plates, turn=turn_of(o.axes))
    check_trial(replace(trial, stands_at=on.stands_at, surely=on.surely), WORK_CHECKS)
    settings = MarkerSettings(upright=o.upright, gap_limit=o.gap_limit)
    found = smoothed_arms(seen, settings, None if o.cutoff == 0.0 else o.cutoff, o.side)
    for line in found.notes:
        reserve(line)
    _doubt_upright(o, found.arms)
    time = found.arms[0].time
    tool = None if o.tool is None else tool_runs(o.tool, CURRENT if o.tool_current is None else o.tool_current, time)
    if tool is not None:
        doubt_tool(o.tool or o.markers, tool, found.arms)
    led = controllers(o, device, time)
    return Worn(found.arms, found.frame, found.markers, seen.names, device, wearer, tool, led)


def _doubt_upright(o: ShoulderSimulateOptions, arms: tuple[ArmMotion, ...]) -> None:
    """A warning where an arm is raised in the span that is to be an upright stance."""
    if o.upright is None:
        return
    start, stop = o.upright
    for arm in arms:
        within = (arm.time >= start - 1e-6) & (arm.time <= stop + 1e-6)
        raised = float(np.median(arm.elevation[within])) if within.any() else 0.0
        if raised > RAISED:
            what = f"the {arm.side} arm is {np.degrees(raised):.0f} degrees up then"
            reserve(f"`upright`: {what}: is that a stance, and not the middle of the work?")


def controllers(
    o: ShoulderSimulateOptions, device: Device, time: Float[np.ndarray, " t"]
) -> Mapping[Side, Controller] | None:
    """By side, with the device's thresholds and sensors; None where the support is constant."""
    if o.profile is None or o.tool is None:
        return None
    profiles = read_profiles(o.profile)
    add_input("`profile`", o.profile, profiles=len(profiles))
    name = next(iter(profiles)) if o.profile_name is None else o.profile_name
    if name not in profiles:
        raise InputError(o.profile, "`profile_name`", f"no profile {name!r}", f"there are {', '.join(profiles)}")
    factors = profiles[name]
    task = _task(o.profile, factors, o.task)
    note("profile", {"name": name, "task": task})
    current = current_at(o.tool, time)
    found: dict[Side, Controller] = {}
    for side in SIDES if o.side == "both" else (o.side,):
        hand: Hand = "dominant" if side == (o.dominant or "right") else "other"
        if not any(FactorKey(task, hand, phase) in factors for phase in PHASES):
            raise InputError(o.profile, name, f"no factors of the {hand} hand for {task}", "add a row")
        seed = 2 * (o.seed or 0) + (side == "left")
        found[side] = hand_controller(factors, task, hand, current, sensing_of(device), seed, thresholds_of(device))
    return found


def _task(file: Path, factors: Factors, named: str | None) -> str:
    tasks = tuple(dict.fromkeys(key.task for key in factors))
    if named is None and len(tasks) > 1:
        raise InputError(file, "`task`", f"factors of {len(tasks)} tasks", f"say which: {', '.join(tasks)}")
    if named is not None and named not in tasks:
        raise InputError(file, "`task`", f"no factors of {named!r}", f"there are {', '.join(tasks)}")
    return tasks[0] if named is None else named


def simulated_along(worn: Worn, arm: ArmMotion, o: ShoulderSimulateOptions) -> SimulatedArm:
    """One arm along the human one, and what is to be said of it."""
    control = None if worn.controllers is None else worn.controllers[arm.side]
    try:
        one = arm_at_work(arm, worn.device, worn.wearer, o.level, tool=worn.tool, controller=control, cuff=o.cuff)
    except OutOfCuffError as error:
        raise InputError(o.markers, "", f"{arm.side} arm: {error.what}", error.cause) from error
    except ArithmeticError as error:
        remedy = "check `person`, `device`, and the unit and names of the markers"
        raise InputError(o.markers, "", f"{arm.side} arm: {error}", remedy) from error
    except ValueError as error:
        raise InputError(o.tool or o.markers, "`tool`", f"{arm.side} arm: {error}", "check its clock") from error
    found = one.simulation
    warn_of(found)
    told = summary_of(one)
    say(
        f"{arm.side} arm: elevation up to {told['elevation_max_deg']:.1f} deg (shoulder "
        f"{told['shoulder_max_deg']:.1f}), supporting force {told['supporting_min_N']:.1f} … "
        f"{told['supporting_max_N']:.1f} N, slip {told['slip_mm']:.0f} mm{out_of_cuff_clause(found)}"
    )
    if control is not None and one.detected is not None:
        shares = ", ".join(f"{name} {share:.2f}" for name, share in zip(PHASES, control.factors, strict=True))
        changes = f"{np.count_nonzero(np.diff(one.detected))} changes"
        say(f"{arm.side} arm: support by phase: {shares}; {changes}{out_of_cuff_clause(found)}")
        say_detected(one)
    return one


def detection_of(one: SimulatedArm) -> PhaseCheck | None:
    """Phases that the controller detects beside those of the recorded motion; None where the support is constant."""
    if one.detected is None:
        return None
    motion = one.simulation.motion
    return phase_check(motion.time, one.detected, phases_by_onset(motion.time, motion.elevation, one.phase))


def say_detected(one: SimulatedArm) -> None:
    """Say how much of the time the controller is in a wrong phase; warn where it chatters."""
    check = detection_of(one)
    if check is None:
        return
    late = f", changes late by up to {1e3 * max(check.latencies):.0f} ms" if check.latencies else ""
    say(f"{one.side} arm: the controller is in another phase than the motion for {check.wrong:.1%} of the time{late}")
    if check.chatter:
        more = f"phases change {check.changes} times, those of the motion {check.true_changes}"
        reserve(f"{one.side} arm: the controller chatters: {more}")


def summary_of(one: SimulatedArm) -> dict[str, float]:
    """Numbers of the whole trial, and means of the screw-in."""
    s = one.simulation
    working = one.phase == SCREWING
    told = {
        "elevation_max_deg": np.degrees(s.elevation.max()),
        "shoulder_max_deg": np.degrees(s.motion.elevation.max()),
        "supporting_min_N": s.supporting.min(),
        "supporting_max_N": s.supporting.max(),
        "shear_max_N": s.shear.max(),
        "slip_mm": 1e3 * s.slip[-1],
        "support_torque_max_N_m": s.outputs["support"].max(),
        "out_of_cuff_share": s.out_of_cuff.mean(),
        "steps": float(s.steps),
    }
    if working.any():
        told["screw_in_elevation_deg"] = np.degrees(s.elevation[working].mean())
        told["screw_in_shoulder_minus_exoskeleton_deg"] = np.degrees((s.motion.elevation - s.elevation)[working].mean())
        told["screw_in_supporting_N"] = s.supporting[working].mean()
    check = detection_of(one)
    if check is not None:
        told |= {"wrong_phase_share": check.wrong, "changes_of_phase": float(check.changes)}
        told["changes_of_phase_of_the_motion"] = float(check.true_changes)
    return {name: float(value) for name, value in told.items()}


def arm_table(arm: SimulatedArm) -> pd.DataFrame:
    """Angles, forces and slip over time; forces of the cuff on the arm, in the device's frame and in the cuff's."""
    s = arm.simulation
    told, motion = s.outputs, s.motion
    led = {}
    if arm.detected is not None and arm.factor is not None:
        by_onset = phases_by_onset(motion.time, motion.elevation, arm.phase)
        led = {"phase by onset": np.array(PHASES)[by_onset], "detected phase": np.array(PHASES)[arm.detected]}
        led["factor [-]"] = arm.factor
    slide = 1e3 * told["sliding"]
    columns = {
        "time [s]": motion.time,
        "phase": np.array(PHASES)[arm.phase],
        **led,
        "shoulder elevation [deg]": np.degrees(motion.elevation),
        **{f"{joint} [deg]": np.degrees(column) for joint, column in zip(JOINTS, s.angles.T, strict=True)},
        "support torque [N m]": told["support"][:, 0],
        "cylinder [N]": s.cylinder,
        **{f"force_{axis} [N]": column for axis, column in zip("xyz", told["force"].T, strict=True)},
        "distal [N]": told["in_cuff"][:, 0],
        "medial [N]": told["in_cuff"][:, 1],
        "supporting [N]": told["in_cuff"][:, 2],
        "normal [N]": told["pressing"][:, 0],
        "shear [N]": s.shear,
        "shear around [N]": s.shear_around,
        "sliding along [mm/s]": slide[:, 0],
        "sliding across [mm/s]": np.hypot(slide[:, 1], slide[:, 2]),
        "slip [mm]": 1e3 * s.slip,
        "place in the cuff [mm]": 1e3 * told["place"][:, 0],
        "off its axis [mm]": 1e3 * np.hypot(told["place"][:, 1], told["place"][:, 2]),
        "out of the cuff": s.out_of_cuff.astype(int),
        **{f"{joint} at a stop": column.astype(int) for joint, column in zip(JOINTS, s.at_stop.T, strict=True)},
    }
    if s.cuff == "surface":
        columns |= {
            **{f"couple {way} [N m]": column for way, column in zip(WAYS, told["couple"].T, strict=True)},
            "centre of pressure [mm]": 1e3 * told["centre"][:, 0],
            "peak pressure [Pa]": told["peak"][:, 0],
            "pressed share [-]": told["share"][:, 0],
        }
    return pd.DataFrame(columns)


def numbers_table(device: Device, *, controlled: bool = False) -> pd.DataFrame:
    """Every number of the device in the unit that files have, and where it is from; the controller's as well where
    there is one.
    """
    each = [(name, number, QUANTITIES[name]) for name, number in device.numbers.items()]
    if controlled:
        own = controller_numbers(device).items()
        each += [(f"controller {name}", number, CONTROLLED[name]) for name, number in own]
    rows = []
    for name, number, quantity in each:
        unit, factor = quantity.written
        rows.append((name, number.value * factor, unit, number.source, number.note or quantity.what))
    return pd.DataFrame(rows, columns=["number", "value", "unit", "source", "note"])


def at_elevation_table(arms: Sequence[SimulatedArm], elevations: Sequence[float]) -> pd.DataFrame:
    """Joints and forces where each shoulder first comes up to an elevation [rad], between frames too; a row is missing
    where it never does.
    """
    rows = []
    for arm in arms:
        s = arm.simulation
        for elevation in elevations:
            place = first_reached(s.motion.elevation, elevation)
            if place is None:
                continue
            frames = np.arange(len(s.motion.time))
            columns = {
                "time [s]": s.motion.time,
                "shoulder elevation [deg]": np.degrees(s.motion.elevation),
                **{f"{joint} [deg]": np.degrees(column) for joint, column in zip(JOINTS, s.angles.T, strict=True)},
                "supporting [N]": s.supporting,
                "support torque [N m]": s.outputs["support"][:, 0],
            }
            own = {name: float(np.interp(place, frames, values)) for name, values in columns.items()}
            rows.append({"arm": arm.side, "frame": round(place) + 1, **own})
    return pd.DataFrame(rows)


def say_reached(arms: Sequence[SimulatedArm], elevations: Sequence[float]) -> None:
    """Say the passive joints at each elevation that was asked for; warn of one that no arm comes up to."""
    table = at_elevation_table(arms, elevations)
    for row in table.to_dict("records"):
        say(
            f"{row['arm']} arm, shoulder at {row['shoulder elevation [deg]']:.0f} deg ({row['time [s]']:.2f} s): "
            f"exoskeleton {row['elevation [deg]']:.1f} deg, passive joints {row['passive_1 [deg]']:.1f} and "
            f"{row['passive_2 [deg]']:.1f} deg"
        )
    for elevation in elevations:
        if all(first_reached(arm.simulation.motion.elevation, elevation) is None for arm in arms):
            reserve(f"no shoulder comes up to {np.degrees(elevation):.4g} deg")


def first_reached(values: Float[np.ndarray, " t"], value: float) -> float | None:
    """Place between frames at which values first rise to one [frames]; None where they never do."""
    up = np.flatnonzero((values[:-1] < value) & (values[1:] >= value))
    if not len(up):
        return None
    k = int(up[0])
    return k + float((value - values[k]) / (values[k + 1] - values[k]))


LEVER_STEP = np.radians(5.0)
"""Between rows of a cylinder's levers."""


def lever_table(device: Device) -> pd.DataFrame:
    """Length and lever of the cylinder, and its torque at full pressure, over the range of the active joint."""
    low, high = device["elevation_lower"], device["elevation_upper"]
    elevation = np.linspace(low, high, round((high - low) / LEVER_STEP) + 1)
    triangle = device["lever_a"], device["lever_b"], device["lever_phase"]
    arm, length = (np.asarray(each(elevation, *triangle), float) for each in (lever, cylinder_length))
    columns = {
        "elevation [deg]": np.degrees(elevation),
        "cylinder length [mm]": 1e3 * length,
        "lever [mm]": 1e3 * arm,
        "torque [N m]": arm * device.peak_force,
    }
    return pd.DataFrame(columns)


def sensitivity_table(side: str, found: Sequence[Influence]) -> pd.DataFrame:
    """What each number changes, root mean square; the largest change of the supporting force first."""
    rows = []
    for one in sorted(found, key=lambda each: -each.supporting):
        unit, factor = QUANTITIES[one.number].written
        changed = (np.degrees(one.elevation), one.supporting, one.shear, one.most)
        rows.append((side, one.number, one.source, one.step * factor, unit, *changed))
    names = ["side", "number", "source", "step", "unit", "elevation [deg]", "supporting [N]", "shear [N]"]
    names.append("supporting at most [N]")
    return pd.DataFrame(rows, columns=names)
