"""A cylinder by the places of its two hinges and its stroke, as a drawing has them, in place of levers and an angle.

Seen along the active axis of a right arm that hangs down, from that axis: y backwards, z up. The rod's hinge turns with
the arm, the frame's does not. With ψ the angle from hanging down towards the front, the triangle of `device.lever` has
the sides a and b to the hinges and between them ψ(rod) - ψ(frame) + elevation. Where the cylinder ends, the arm stops.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.data.parameter import Number
from geocontact.shoulder_exoskeleton.device import MM, Device, DeviceQuantity, cylinder_length

HINGES: Mapping[str, DeviceQuantity] = {
    **{f"rod_{axis}": DeviceQuantity("m", MM, -0.5, 0.5, f"hinge of the rod on the arm, {axis}") for axis in "yz"},
    **{
        f"frame_{axis}": DeviceQuantity("m", MM, -0.5, 0.5, f"hinge of the cylinder on the frame, {axis}")
        for axis in "yz"
    },
    "retracted": DeviceQuantity("m", MM, 1e-3, 1.0, "shortest length of the cylinder between its hinges"),
    "extended": DeviceQuantity("m", MM, 1e-3, 1.0, "longest length of the cylinder between its hinges"),
}
"""All numbers of a cylinder's hinges."""
PLACES = ("rod_y", "rod_z", "frame_y", "frame_z")
REPLACED = ("lever_a", "lever_b", "lever_phase")
"""Numbers of a device that follow from the hinges."""
STEPS = 3601
"""Elevations at which the stroke is compared with the cylinder's length."""


def with_hinges(device: Device, hinges: Mapping[str, Number]) -> Device:
    """The device with levers, and range of the active joint, by its cylinder's hinges.

    ValueError where a place is missing, a hinge lies on the axis, or the cylinder fits at no elevation.
    """
    lacking = [name for name in PLACES if name not in hinges]
    if lacking:
        raise ValueError(f"{', '.join(lacking)} {'is' if len(lacking) == 1 else 'are'} missing")
    rod, frame = (np.array([hinges[f"{name}_{axis}"].value for axis in "yz"]) for name in ("rod", "frame"))
    a, b = (float(np.hypot(*each)) for each in (rod, frame))
    if min(a, b) < 1e-3:
        raise ValueError("a hinge lies on the active axis, where the cylinder has no lever")
    phase = float(np.arctan2(-rod[0], -rod[1]) - np.arctan2(-frame[0], -frame[1]))
    phase = float(np.mod(phase + np.pi, 2.0 * np.pi) - np.pi)
    source, note = hinges["rod_y"].source, "by the hinges of the cylinder"
    numbers = dict(device.numbers)
    for name, value in zip(REPLACED, (a, b, phase), strict=True):
        numbers[name] = Number(value, source, note)
    least, most = (
        hinges[name].value if name in hinges else end for name, end in (("retracted", 0.0), ("extended", 9.9))
    )
    elevation = np.linspace(device["elevation_lower"], device["elevation_upper"], STEPS)
    length = np.asarray(cylinder_length(elevation, a, b, phase))
    fits = np.flatnonzero((length >= least) & (length <= most))
    if not len(fits):
        ends = f"{1e3 * length.min():.0f} to {1e3 * length.max():.0f} mm"
        raise ValueError(f"the cylinder fits at no elevation, at which its hinges are {ends} apart")
    first = int(fits[0])
    last = int(fits[np.argmax(np.append(np.diff(fits), 2) > 1)])
    for end, at, whole in (("lower", first, 0), ("upper", last, STEPS - 1)):
        if at != whole:
            numbers[f"elevation_{end}"] = Number(float(elevation[at]), source, "where the stroke of the cylinder ends")
    return Device(device.name, numbers, device.controller)
