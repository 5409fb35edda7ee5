"""Recorded arms through a zero-lag low-pass, with short gaps filled."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion, smoothed_motion
from geocontact.shoulder_exoskeleton.arms_from_markers import MarkerSettings, arm_motions
from geocontact.shoulder_exoskeleton.device_frame import (
    DeviceFrame,
)


@dataclass(frozen=True, eq=False)
class SmoothedArms:
    """Arms and device at even times, without gaps.

    Parameters
    ----------
    arms
        Right before left; filtered.
    frame
        The device in the laboratory at the same times.
    markers
        All that were recorded, in the device's frame at the same times [m]; NaN where they were not seen.
    notes
        What was assumed or cut, one sentence each.
    """

    arms: tuple[ArmMotion, ...]
    frame: DeviceFrame
    markers: Float[np.ndarray, "t m 3"]
    notes: tuple[str, ...]


def smoothed_arms(
    markers: MarkerTrajectories,
    settings: MarkerSettings | None = None,
    cutoff: float | None = 6.0,
    side: Literal["right", "left", "both"] = "both",
) -> SmoothedArms:
    """Arms of one side or of both as `simulate_arm` takes them; InputError for markers that cannot be right.

    Parameters
    ----------
    cutoff
        Of the zero-lag low-pass [Hz]; None leaves the markers as they are.
    """
    settings = settings or MarkerSettings()
    found = arm_motions(markers, settings)
    notes, wanted = found.notes, tuple(arm for arm in found.arms if side in ("both", arm.side))
    if not wanted:
        have = " and ".join(arm.side for arm in found.arms)
        raise InputError(markers.source, "`side`", f"the {side} arm was not recorded", f"recorded: {have}")
    if side == "both" and len(wanted) == 1:
        notes = (*notes, f"only the {wanted[0].side} arm was recorded")
    arms = tuple(_smoothed(arm, markers.source, cutoff, settings.gap_limit) for arm in wanted)
    frame = found.frame.at(wanted[0].time, arms[0].time)
    return SmoothedArms(arms, frame, frame.markers(markers, arms[0].time), notes)


def _smoothed(arm: ArmMotion, source: str, cutoff: float | None, gap_limit: float) -> ArmMotion:
    try:
        return smoothed_motion(arm, cutoff, gap_limit)
    except ValueError as error:
        raise InputError(source, "", f"{arm.side} arm: {error}", "give another `cutoff` or `gap_limit`") from error
