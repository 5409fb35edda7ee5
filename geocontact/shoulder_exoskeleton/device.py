"""Numbers of a shoulder exoskeleton, and where each is from: the paper, derived from it, or invented.

Right arm in the LCS (x to the left, y backwards, z up), hanging down; the left arm is its mirror image.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.data.sourced_number import Number
from geocontact.shoulder_exoskeleton.cylinder import piston_area

JOINTS = ("passive_1", "passive_2", "elevation")
"""Coordinates from the frame outwards; the last is the active one."""


@dataclass(frozen=True)
class DeviceQuantity:
    """What a number of a device is.

    Parameters
    ----------
    unit
        SI unit of `Number.value`.
    written
        Unit of files and tables, and how many of it one SI unit is.
    lower, upper
        Values in SI outside of which it is a mistake.
    what
        In words.
    """

    unit: str
    written: tuple[str, float]
    lower: float
    upper: float
    what: str


MM, DEG, BAR, ONE = ("mm", 1e3), ("deg", 180.0 / np.pi), ("bar", 1e-5), ("-", 1.0)


def _length(what: str, lower: float = -0.5, upper: float = 0.5) -> DeviceQuantity:
    return DeviceQuantity("m", MM, lower, upper, what)


def _as_is(unit: str, lower: float, upper: float, what: str) -> DeviceQuantity:
    return DeviceQuantity(unit, (unit, 1.0), lower, upper, what)


def _angle(what: str) -> DeviceQuantity:
    return DeviceQuantity("rad", DEG, -2.0 * np.pi, 2.0 * np.pi, what)


QUANTITIES: Mapping[str, DeviceQuantity] = {
    "bar_share": DeviceQuantity("1", ONE, 0.1, 1.0, "first passive joint from the middle, over the shoulder width"),
    "armrest_share": DeviceQuantity(
        "1", ONE, 0.1, 1.0, "middle of the cuff from the active axis, over the upper arm's length"
    ),
    "belt_share": DeviceQuantity("1", ONE, 0.1, 2.0, "lap belt below the shoulder bar, over the torso's length"),
    **{
        f"link_{k}_{axis}": _length(f"link {k}, from its joint to the next, along {axis}")
        for k in (1, 2)
        for axis in "xyz"
    },
    "cuff_x": _length("middle of the cuff beside the plane in which the active joint turns, to the left"),
    **{
        f"axis_{joint}_{axis}": _as_is("1", -1.0, 1.0, f"axis of {joint}, along {axis}")
        for joint in JOINTS
        for axis in "xyz"
    },
    **{
        f"{joint}_{end}": _angle(f"{end} end of the range of {joint}") for joint in JOINTS for end in ("lower", "upper")
    },
    **{f"{joint}_damping": _as_is("N m s/rad", 0.0, 100.0, f"damping of {joint}") for joint in JOINTS},
    "stop_stiffness": _as_is("N m/rad", 0.0, 1e5, "stiffness of the stops"),
    "stop_width": DeviceQuantity("rad", DEG, 1e-4, 1.0, "angle over which a stop sets in"),
    "stop_damping": _as_is("s/rad", 0.0, 100.0, "share of a stop's torque added per rate into it"),
    "link_1_mass": _as_is("kg", 0.0, 10.0, "mass of link 1"),
    "link_2_mass": _as_is("kg", 0.0, 10.0, "mass of link 2"),
    "arm_mass": _as_is("kg", 0.0, 10.0, "mass of the arm link with its cuff, without cylinder"),
    "arm_centre": _length("mass centre of the arm link below the active axis", 0.0),
    "arm_gyration": _length("radius of gyration of the arm link about its mass centre", 0.0),
    "arm_twist_gyration": _length("radius of gyration of the arm link about its own line", 0.0),
    "cylinder_mass": _as_is("kg", 0.0, 10.0, "mass of the cylinder, carried by the arm link"),
    "cylinder_centre": _length("mass centre of the cylinder below the active axis", 0.0),
    "bore": _length("bore of the cylinder", 1e-3, 0.2),
    "supply": DeviceQuantity("Pa", BAR, 1e4, 2e6, "supply pressure"),
    "lag": _as_is("s", 1e-3, 10.0, "time constant of the pressure"),
    "lever_a": _length("hinge of the rod on the arm from the active axis", 1e-3),
    "lever_b": _length("hinge of the cylinder on the frame from the active axis", 1e-3),
    "lever_phase": _angle("angle between both hinges where the arm hangs down"),
    "cuff_length": _length("length of the cuff", 1e-3),
    "cuff_radius": _length("radius of cuff and sphere", 1e-3),
    "k": _as_is("N/m", 1.0, 1e6, "stiffness of the interface"),
    "b": _as_is("N s/m", 0.0, 1e4, "damping of the interface"),
    "delta_full": _length("offset from which the interface's damping acts fully", 1e-6),
    "mu_s": _as_is("1", 0.0, 5.0, "static friction of the interface"),
    "mu_k": _as_is("1", 0.0, 5.0, "kinetic friction of the interface"),
    "v_th": DeviceQuantity("m/s", ("mm/s", 1e3), 1e-5, 1.0, "threshold speed of the friction table"),
    "pad_thickness": _length("thickness of the cuff's padding", 1e-4, 0.1),
    "pad_modulus": _as_is("Pa", 10.0, 1e8, "confined modulus of the padding"),
    "tissue_thickness": _length("thickness of the arm's soft tissue", 1e-4, 0.1),
    "tissue_modulus": _as_is("Pa", 10.0, 1e8, "confined modulus of the soft tissue"),
    "interference": _length("by how much the arm is wider than the empty cuff", 0.0, 0.05),
    "pad_damping": _as_is("Pa s/m", 0.0, 1e8, "damping of the padding where it is pressed on"),
    "strap": _length("depth by which a strap pulls the arm into the cuff all around; negative: play", -0.05, 0.05),
    "seal_friction": _as_is("N m", 0.0, 50.0, "dry friction of the cylinder's seals about the active axis"),
    "seal_speed": _as_is("rad/s", 1e-4, 10.0, "rate of the active joint below which it is viscous"),
    "rounding": _length("over which friction's kink on the axis is rounded", 1e-7),
}
"""All numbers of a device."""


@dataclass(frozen=True)
class Wearer:
    """Lengths that the device is adjusted to [m]; defaults are those of an average man, invented.

    Parameters
    ----------
    upper_arm
        Shoulder to elbow.
    shoulder_width
        Between both acromia.
    torso
        Shoulder bar's height above the hips.
    """

    upper_arm: float = 0.30
    shoulder_width: float = 0.40
    torso: float = 0.50


@dataclass(frozen=True)
class Device:
    """An exoskeleton.

    Parameters
    ----------
    name
        For the record.
    numbers
        One for each of `QUANTITIES`.
    """

    name: str
    numbers: Mapping[str, Number]

    def __getitem__(self, name: str) -> float:
        """A number in SI."""
        return self.numbers[name].value

    def having(self, **values: float) -> Device:
        """The same device with other values [SI], which then count as invented. KeyError for no number of a device."""
        changed = dict(self.numbers)
        for name, value in values.items():
            changed[name] = Number(value, "invented", f"instead of {changed[name].value:g}")
        return replace(self, numbers=changed)

    def axis(self, joint: str) -> Float[np.ndarray, " 3"]:
        """Unit vector of a joint's axis; ValueError where it has no length."""
        found = np.array([self[f"axis_{joint}_{each}"] for each in "xyz"])
        length = float(np.linalg.norm(found))
        if length == 0.0:
            raise ValueError(f"the axis of {joint} has no length")
        return np.asarray(found / length)

    def link(self, k: int) -> Float[np.ndarray, " 3"]:
        """From a passive joint to the next joint [m]."""
        return np.array([self[f"link_{k}_{each}"] for each in "xyz"])

    @property
    def peak_force(self) -> float:
        """Of the cylinder at supply pressure [N]."""
        return piston_area(self["bore"]) * self["supply"]

    @property
    def peak_torque(self) -> float:
        """Most that the cylinder can support with [N m]: the lever is at most the shorter side of its triangle."""
        return self.peak_force * min(self["lever_a"], self["lever_b"])
