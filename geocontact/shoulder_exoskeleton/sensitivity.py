"""Which numbers of a device matter: each one changed by itself, the others held."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.parameter import Source
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.arm_numbers import PADDED
from geocontact.shoulder_exoskeleton.cuff_contact import Cuff
from geocontact.shoulder_exoskeleton.device import JOINTS, QUANTITIES, Device, Wearer
from geocontact.shoulder_exoskeleton.simulate import ArmSimulation, simulate_arm

SHARE, TURN, SHIFT = 0.1, np.radians(5.0), 0.01
"""Changes of a number (a share), of an angle [rad] and of a length that may be 0 [m]."""
ADDED = ("strap", "seal_friction", "seal_speed")
"""What a device has only where its file says so."""
IDLE: dict[Cuff, tuple[str, ...]] = {
    "point": ("rounding", "belt_share", *ADDED, *(name for name in PADDED if name != "delta_full")),
    "surface": ("rounding", "belt_share", "k", "b", *ADDED),
}
"""Numbers that no motion depends on, one that is numerical, and what was added, by how the arm is held."""
AXES = tuple(f"axis_{joint}_{axis}" for joint in JOINTS for axis in "xyz")
"""Directions of axes: other axes have equations of their own, which are not compiled for one simulation."""


@dataclass(frozen=True)
class Influence:
    """What one number changes by plus or minus its step, the larger of both; root mean square over the trial.

    Parameters
    ----------
    number, source
        Its name, and where it is from.
    step
        By which it was changed, in SI.
    elevation
        Of the active joint [rad].
    supporting, shear
        Interface force that lifts, and friction on the arm [N].
    most
        Largest change of the supporting force in a frame [N]: mostly when something slips earlier or later.
    """

    number: str
    source: Source
    step: float
    elevation: float
    supporting: float
    shear: float
    most: float


def influences(
    motion: ArmMotion,
    device: Device,
    wearer: Wearer,
    level: float,
    cuff: Cuff = "point",
    factor: Float[np.ndarray, " t"] | None = None,
) -> Iterator[Influence]:
    """One by one, in the device's order; a number with which nothing rests at the start changes all by infinity.

    An axis is tilted by 5 degrees along the two directions across it.

    `factor` is that of `simulate_arm`; it stays as it is.
    """
    usual = simulate_arm(motion, device, wearer, level, factor=factor, cuff=cuff, most_lost=1.0)
    for name, number in device.numbers.items():
        if name in IDLE[cuff]:
            continue
        step = _tilt(device, name) if name in AXES else _step(name, number.value)
        if step == 0.0:
            continue
        lower, upper = QUANTITIES[name].lower, QUANTITIES[name].upper
        values = [v for v in (number.value - step, number.value + step) if lower <= v <= upper]
        compiled = name not in AXES
        changed = [_changed(usual, device.having(**{name: value}), factor, compiled) for value in values]
        most = np.max(changed, axis=0)
        yield Influence(name, number.source, step, *map(float, most))


def _step(name: str, value: float) -> float:
    quantity = QUANTITIES[name]
    if quantity.unit == "rad" and quantity.lower < 0.0:
        return float(TURN)
    if quantity.unit == "m" and quantity.lower < 0.0:
        return SHIFT
    return abs(SHARE * value)


def _tilt(device: Device, name: str) -> float:
    """What tilts a unit axis by `TURN` along one direction; 0 along the axis itself, which would change its length."""
    of, way = name[:-1], "xyz".index(name[-1])
    unit = np.array([device[f"{of}{each}"] for each in "xyz"])
    return 0.0 if int(np.argmax(np.abs(unit))) == way else float(np.tan(TURN) * np.linalg.norm(unit))


def _changed(
    usual: ArmSimulation, device: Device, factor: Float[np.ndarray, " t"] | None, compiled: bool
) -> tuple[float, ...]:
    motion, level, cuff = usual.motion, usual.level, usual.cuff
    try:
        other = simulate_arm(
            motion, device, usual.wearer, level, factor=factor, machine_code=compiled, cuff=cuff, most_lost=1.0
        )
    except ArithmeticError:
        return (np.inf,) * 4
    pairs = ((usual.elevation, other.elevation), (usual.supporting, other.supporting), (usual.shear, other.shear))
    changes = [float(np.sqrt(np.mean((a - b) ** 2))) for a, b in pairs]
    return (*changes, float(np.abs(usual.supporting - other.supporting).max()))
