"""What a simulation starts from: arms in the device's frame, the device, its wearer, when the tool runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation, Slerp

from geocontact.analyses.motion.markers import markers_given, renamed_as_told
from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.devices import device_named, wearer_named
from geocontact.analyses.shoulder.simulate.control import controllers
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.tool import tool_runs
from geocontact.data.errors import InputError
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, Side
from geocontact.shoulder_exoskeleton.device import Device, Wearer
from geocontact.shoulder_exoskeleton.from_markers.arm_motions import MarkerSettings, arm_motions
from geocontact.shoulder_exoskeleton.from_markers.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.smoothed_motion import smoothed_motion
from geocontact.shoulder_exoskeleton.support.controlled_arm import Controller

CURRENT = 1.0
"""A; a tool that idles takes less."""


@dataclass(frozen=True, eq=False)
class Worn:
    """A device on a person who moves.

    Parameters
    ----------
    arms
        Filtered, without gaps, at even times.
    frame
        The device in the laboratory at the same times.
    markers
        All that were recorded, in the device's frame at the same times [m]; NaN where they were not seen.
    tool
        Whether the tool runs; None where nobody told.
    controllers
        By side; None where the support is constant.
    """

    arms: tuple[ArmMotion, ...]
    frame: DeviceFrame
    markers: Float[np.ndarray, "t m 3"]
    device: Device
    wearer: Wearer
    tool: Bool[np.ndarray, " t"] | None
    controllers: Mapping[Side, Controller] | None


def read(o: ShoulderSimulateOptions, record: Record) -> Worn:
    """Everything the options name."""
    return worn_along(o, wearer_named(record, o.person), record)


def worn_along(o: ShoulderSimulateOptions, wearer: Wearer, record: Record) -> Worn:
    """The same on a wearer who is known."""
    device = device_named(record, o.device)
    seen = renamed_as_told(record, markers_given(o.markers, o.axes, o.time, o.c3d_unit), o.markers_map)
    record.add_input("markers", o.markers, frames=len(seen), markers=len(seen.names))
    found = arm_motions(seen, MarkerSettings(upright=o.upright, gap_limit=o.gap_limit))
    for note in found.notes:
        record.warn(note)
    wanted = tuple(arm for arm in found.arms if o.side in ("both", arm.side))
    if not wanted:
        have = " and ".join(arm.side for arm in found.arms)
        raise InputError(o.markers, "`side`", f"the {o.side} arm was not recorded", f"recorded: {have}")
    if o.side == "both" and len(wanted) == 1:
        record.warn(f"only the {wanted[0].side} arm was recorded")
    arms = tuple(_smoothed(arm, o) for arm in wanted)
    time = arms[0].time
    frame = _frame_at(wanted[0].time, found.frame, time)
    tool = (
        None
        if o.tool is None
        else tool_runs(record, o.tool, CURRENT if o.tool_current is None else o.tool_current, time)
    )
    nearest = np.clip(np.searchsorted(0.5 * (seen.time[1:] + seen.time[:-1]), time), 0, len(seen) - 1)
    places = np.stack([frame.points(each) for each in seen.positions[nearest].swapaxes(0, 1)], axis=1)
    return Worn(arms, frame, places, device, wearer, tool, controllers(o, time, record))


def _smoothed(arm: ArmMotion, o: ShoulderSimulateOptions) -> ArmMotion:
    try:
        return smoothed_motion(arm, None if o.cutoff == 0.0 else o.cutoff, o.gap_limit)
    except ValueError as error:
        raise InputError(o.markers, "", f"{arm.side} arm: {error}", "give another `cutoff` or `gap_limit`") from error


def _frame_at(time: Float[np.ndarray, " t"], frame: DeviceFrame, wanted: Float[np.ndarray, " e"]) -> DeviceFrame:
    """The device in the laboratory at other times: origin linear, turns along the shortest arcs."""
    known = np.isfinite(frame.rotation).all(axis=(1, 2)) & np.isfinite(frame.origin).all(axis=1)
    at = np.clip(wanted, time[known][0], time[known][-1])
    origin = np.column_stack([np.interp(at, time[known], column) for column in frame.origin[known].T])
    turns = Slerp(time[known], Rotation.from_matrix(frame.rotation[known]))(at)
    return DeviceFrame(origin, turns.as_matrix())
