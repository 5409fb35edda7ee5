"""Numbers of a shoulder exoskeleton, each with its source, its cylinder, and the exoskeleton Lucy of Yao et al.
(2024), Robotics 13:27.

Right arm in the LCS (x to the left, y backwards, z up), hanging down; the left arm is its mirror image.

The joint is one corner; the rod is hinged a from it on the arm, the cylinder b from it on the frame; the angle between
both is φ = φ0 + elevation. The cylinder is c = sqrt(a² + b² - 2ab cos φ) long, its lever dc/dφ = a b sin φ / c is
at most min(a, b), where it is across the shorter side.

Scalar in, scalar out: numbers, arrays and CasADi symbols (numpy mode 1).

The paper gives the peak torque (7.8 N m at 6 bar; 12.8 N m with a new cylinder of 482 N, of which the present one has
60 %), the interface's law, one active and two passive joints, three adjustments. From that follow bore and lever:
482 N at 6 bar is a bore of 32 mm, 60 % of it one of 25 mm, and both torques have a lever of 26.5 mm. Masses, axes,
ranges and the course of the lever are in no source.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import pi, radians
from typing import Any, TypeVar

import numpy as np
from jaxtyping import Float

from geocontact.data.parameter import Number, Source

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""


def piston_area(bore: X) -> X:
    """Area of the full bore [m²]: the cylinder pushes."""
    area: X = bore * bore * (0.25 * pi)
    return area


def lever(elevation: X, a: X, b: X, phase: X) -> X:
    """Torque on the arm per force of the cylinder [m]; positive where pushing raises the arm."""
    angle = phase + elevation
    length: X = a * b * np.sin(angle) / cylinder_length(elevation, a, b, phase)
    return length


def cylinder_length(elevation: X, a: X, b: X, phase: X) -> X:
    """Between its hinges [m]; the stroke is its change."""
    length: X = np.sqrt(a * a + b * b - 2.0 * a * b * np.cos(phase + elevation))
    return length


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
    usual
        Values in SI outside of which it is unusual; None where nobody knows.
    """

    unit: str
    written: tuple[str, float]
    lower: float
    upper: float
    what: str
    usual: tuple[float, float] | None = None


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
USUAL = {
    "stop_stiffness": (5.0, 5000.0), "link_1_mass": (0.02, 3.0), "link_2_mass": (0.02, 3.0), "arm_mass": (0.05, 3.0),
    "cylinder_mass": (0.02, 2.0), "bore": (8e-3, 0.1), "supply": (1e5, 1e6), "lag": (1e-3, 1.0),
    "lever_a": (5e-3, 0.4), "lever_b": (5e-3, 0.4), "cuff_length": (0.03, 0.3), "cuff_radius": (0.02, 0.12),
    "k": (100.0, 2e5), "b": (0.0, 3000.0), "mu_s": (0.05, 2.0), "mu_k": (0.05, 2.0), "delta_full": (1e-5, 0.02),
    "pad_thickness": (1e-3, 0.05), "pad_modulus": (1e3, 1e7), "tissue_thickness": (2e-3, 0.08),
    "tissue_modulus": (1e3, 1e6), "seal_friction": (0.0, 5.0), "passive_1_damping": (0.0, 5.0),
    "passive_2_damping": (0.0, 5.0), "elevation_damping": (0.0, 5.0),
}  # fmt: skip
"""What numbers of worn devices mostly are [SI]; a unit that was mixed up lies outside."""
QUANTITIES = {name: replace(each, usual=USUAL.get(name)) for name, each in QUANTITIES.items()}


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
    controller
        Thresholds and sensors of its controller as far as they are stated; names are those of `controller_numbers`.
    """

    name: str
    numbers: Mapping[str, Number]
    controller: Mapping[str, Number] = field(default_factory=dict)

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
        """Force of the cylinder at supply pressure [N]."""
        return piston_area(self["bore"]) * self["supply"]

    @property
    def peak_torque(self) -> float:
        """Most that the cylinder can support with [N m]: the lever is at most the shorter side of its triangle."""
        return self.peak_force * min(self["lever_a"], self["lever_b"])


AXES = {"passive_1": (0.0, 0.0, 1.0), "passive_2": (0.0, 0.0, 1.0), "elevation": (-1.0, 0.0, 0.0)}
LINKS = {1: (-0.07, -0.02, 0.0), 2: (0.0, -0.10, 0.04)}
RANGES = {"passive_1": (-25.0, 60.0), "passive_2": (-75.0, 30.0), "elevation": (-15.0, 150.0)}
DAMPING = {"passive_1": 0.05, "passive_2": 0.05, "elevation": 0.10}
OTHERS: tuple[tuple[str, float, Source, str], ...] = (
    ("bar_share", 0.42, "invented", "the paper scales the bar with the shoulder width, without a number"),
    ("armrest_share", 0.72, "invented", "the paper scales the armrest with the upper arm, without a number"),
    ("belt_share", 0.90, "invented", "drawn only: the frame of the arms is the shoulder bar"),
    ("cuff_x", 0.05, "invented", "the arm link runs outside of the upper arm"),
    ("stop_stiffness", 200.0, "invented", "10 N m press 3 degrees into a stop"),
    ("stop_width", radians(1.0), "invented", ""),
    ("stop_damping", 1.0, "invented", ""),
    ("link_1_mass", 0.20, "invented", ""),
    ("link_2_mass", 0.30, "invented", ""),
    ("arm_mass", 0.60, "invented", ""),
    ("arm_centre", 0.11, "invented", ""),
    ("arm_gyration", 0.08, "invented", ""),
    ("arm_twist_gyration", 0.02, "invented", "it hardly counts"),
    ("cylinder_mass", 0.20, "invented", "the usual mass of a cylinder of this bore and stroke"),
    ("cylinder_centre", 0.06, "invented", ""),
    ("bore", 0.025, "derived", "60 % of 482 N at 6 bar: 294.5 N is 61 %"),
    ("supply", 6e5, "paper", "sec. 2.1"),
    ("lag", 0.10, "invented", "valve and tube"),
    ("lever_a", 0.0265, "derived", "12.8 N m over 482.5 N, and 7.8 N m over 294.5 N"),
    ("lever_b", 0.15, "invented", "decides with the phase at which elevation the lever is longest"),
    ("lever_phase", 0.0, "invented", "no support where the arm hangs down, most at 80 degrees"),
    ("cuff_length", 0.12, "invented", "only states where the sphere leaves the cuff"),
    ("cuff_radius", 0.05, "invented", "shown only: sphere and tube have the same radius"),
    ("k", 1e3, "paper", "sec. 2.3"),
    ("b", 10.0, "paper", "sec. 2.3"),
    ("delta_full", 1e-3, "invented", "the library's law has such a depth, the paper does not state it"),
    ("mu_s", 1.0, "paper", "sec. 2.3"),
    ("mu_k", 0.8, "paper", "sec. 2.3"),
    ("v_th", 1e-3, "invented", "the library's law has such a speed, the paper does not state it"),
    ("pad_thickness", 0.01, "invented", "of the cuff as a surface"),
    ("pad_modulus", 2e4, "invented", "a soft foam; of the cuff as a surface"),
    ("tissue_thickness", 0.025, "invented", "of the cuff as a surface"),
    ("tissue_modulus", 1e4, "invented", "relaxed muscle and skin; of the cuff as a surface"),
    ("interference", 1e-3, "invented", "a strap pulled tight; of the cuff as a surface"),
    ("pad_damping", 5e3, "invented", "of the cuff as a surface"),
    ("strap", 0.0, "paper", "the paper's model has none, and no play"),
    ("seal_friction", 0.0, "paper", "the paper's model has none"),
    ("seal_speed", 0.02, "invented", "without effect where there is no friction of seals"),
    ("rounding", 5e-5, "invented", "numerical: friction is less by at most 0.05 N"),
)


def lucy() -> Device:
    """With the present cylinder of 25 mm."""
    numbers = {name: Number(value, source, note) for name, value, source, note in OTHERS}
    for joint in JOINTS:
        for axis, value in zip("xyz", AXES[joint], strict=True):
            numbers[f"axis_{joint}_{axis}"] = Number(value, "invented", "two upright axes let the active one follow")
        for end, angle in zip(("lower", "upper"), RANGES[joint], strict=True):
            numbers[f"{joint}_{end}"] = Number(radians(angle), "invented")
        numbers[f"{joint}_damping"] = Number(DAMPING[joint], "invented", "with friction all that holds the third joint")
    for k, link in LINKS.items():
        for axis, value in zip("xyz", link, strict=True):
            numbers[f"link_{k}_{axis}"] = Number(value, "invented")
    return Device("lucy", numbers)


def lucy_new_cylinder(*, with_mass: bool = True) -> Device:
    """With the new cylinder of 32 mm; the paper left out that it is heavier, as `with_mass` False does."""
    numbers = dict(lucy().numbers)
    numbers["bore"] = Number(0.032, "derived", "482 N at 6 bar (paper, sec. 5.3)")
    same = "12.8 N m over 482.5 N (paper, sec. 5.3): as that of the present cylinder"
    numbers["lever_a"] = Number(numbers["lever_a"].value, "derived", same)
    if with_mass:
        note = "as the bore's area, from that of the present cylinder"
        numbers["cylinder_mass"] = Number(numbers["cylinder_mass"].value * (32.0 / 25.0) ** 2, "invented", note)
    return Device("lucy_new_cylinder" if with_mass else "lucy_new_cylinder_massless", numbers)


def lucy_new_cylinder_massless() -> Device:
    """With the new cylinder as the paper has it: as light as the present one."""
    return lucy_new_cylinder(with_mass=False)


BUILT_IN: Mapping[str, Callable[[], Device]] = {
    "lucy": lucy,
    "lucy_new_cylinder": lucy_new_cylinder,
    "lucy_new_cylinder_massless": lucy_new_cylinder_massless,
}
"""Devices by the name that options take."""
