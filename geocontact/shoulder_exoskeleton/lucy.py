"""The exoskeleton Lucy of Yao et al. (2024), Robotics 13:27, as far as the paper describes it; the rest is invented.

The paper gives the peak torque (7.8 N m at 6 bar; 12.8 N m with a new cylinder of 482 N, of which the present one has
60 %), the interface's law, one active and two passive joints, three adjustments. From that follow bore and lever:
482 N at 6 bar is a bore of 32 mm, 60 % of it one of 25 mm, and both torques have a lever of 26.5 mm. Masses, axes,
ranges and the course of the lever are in no source.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import radians

from geocontact.data.sourced_number import Number, Source
from geocontact.shoulder_exoskeleton.device import JOINTS, Device

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
    ("cuff_length", 0.12, "invented", "only tells where the sphere leaves the cuff"),
    ("cuff_radius", 0.05, "invented", "shown only: sphere and tube have the same radius"),
    ("k", 1e3, "paper", "sec. 2.3"),
    ("b", 10.0, "paper", "sec. 2.3"),
    ("delta_full", 1e-3, "invented", "the library's law has such a depth, the paper does not tell it"),
    ("mu_s", 1.0, "paper", "sec. 2.3"),
    ("mu_k", 0.8, "paper", "sec. 2.3"),
    ("v_th", 1e-3, "invented", "the library's law has such a speed, the paper does not tell it"),
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
